#include "cases/buckling_grains.h"

#include "cases/grain_fields.h"
#include "cases/scene_components.h"
#include "cases/section_foundation.h"
#include "cases/solid_run.h"
#include "continuum/errors.h"
#include "continuum/linear_buckling.h"
#include "coupling/output/mesh_vtu.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace antiform::cases
{
namespace
{
constexpr double unit_shortening = 1e-6; // of factor 1; any: linear

/// The rim of a packing carries less than its inside: bending stiffness is lower by this
/// over the number of grains across; measured on bare layers of 6 (14.9 %) and 12 (6.8
/// %).
constexpr double bending_deficit = 0.85;

/// Distance of a grain's centre from a wall as the scene is built [m].
double distance_from(const discrete::Wall &wall, const Vec2 &centre)
{
  return dot(centre - wall.point, wall.normal);
}

bool is_apart(const discrete::Wall &wall,
              const discrete::WallContact &contact,
              const discrete::Grains &grains)
{
  const double radius = grains.radius[contact.grain];
  return distance_from(wall, grains.reference(contact.grain)) - radius -
             contact.reference_gap >
         1e-9 * radius;
}
} // namespace

BucklingGrains::BucklingGrains(const Parameters &p,
                               const MPI_Comm communicator,
                               const Progress &progress)
    : StraightSection(p)
    , scene_(build_bodies(p, communicator, progress))
{
  if (scene_->solid && p.has("foundation"))
    scene_->solid->add_to_stiffness(section_foundation(p, *scene_->solid));
}

std::map<std::string, std::int64_t> BucklingGrains::sizes() const
{
  std::map<std::string, std::int64_t> sizes{
      {"cells", 0}, {"dofs", 0}, {"multipliers", 0}};
  if (scene_->solid)
    sizes = sizes_of_solid(*scene_->solid);
  const coupling::GrainState &state = scene_->grains->state;
  sizes["grains"] = static_cast<std::int64_t>(state.grains.size());
  sizes["joints"] = static_cast<std::int64_t>(state.joints.size());
  sizes["multipliers"] = static_cast<std::int64_t>(scene_->n_multipliers());
  return sizes;
}

coupling::StaticSystem BucklingGrains::supported(const std::vector<char> &open) const
{
  const coupling::GrainState &state = scene_->grains->state;
  coupling::StaticSystem system(state.grains, state.joints, scene_->solid.get(),
                                scene_->bridging.get());
  if (scene_->surface)
    scene_->surface->add_to(system);
  const double push = 0.5 * unit_shortening * geometry_.length();
  std::size_t k = 0;
  for (const discrete::Wall &wall : scene_->walls)
    for (const discrete::WallContact &contact : wall.contacts)
      if (open[k++] == 0)
      {
        const double stiffness = contact.weight * contact.stiffness;
        const auto i = static_cast<std::size_t>(contact.grain);
        system.add_grain_spring(i, 0, stiffness);
        system.add_grain_force(i, 0, stiffness * push * wall.normal.x);
      }
  for (const auto &support : base_supports(*scene_))
  {
    const auto i = static_cast<std::size_t>(support.grain);
    if (p_.matrix.base == "fixed" && !p_.has("foundation"))
      system.fix_grain(i, 0, 0.);
    if (std::isinf(support.stiffness))
      system.fix_grain(i, 1, 0.);
    else
      system.add_grain_spring(i, 1, support.stiffness);
  }
  if (scene_->solid)
    for (const auto &[dof, value] :
         section_supports(p_, geometry_, *scene_->solid, unit_shortening))
      system.fix_mesh(dof, value);
  if (!p_.has("matrix")) // free to fold: one grain at a wall keeps it in place
    system.fix_grain(
        static_cast<std::size_t>(scene_->walls.front().contacts.front().grain), 1, 0.);
  return system;
}

std::size_t BucklingGrains::open_pulling_contacts(const coupling::StaticSolution &state,
                                                  std::vector<char> &open) const
{
  const double push = 0.5 * unit_shortening * geometry_.length();
  std::size_t k = 0, n = 0;
  for (const discrete::Wall &wall : scene_->walls)
    for (const discrete::WallContact &contact : wall.contacts)
    {
      const auto i = static_cast<std::size_t>(contact.grain);
      const bool pulls = wall.normal.x * state.ux[i] > push;
      n += open[k] == 0 && pulls ? 1 : 0;
      open[k] |= pulls ? 1 : 0;
      ++k;
    }
  return n;
}

double BucklingGrains::layer_stress(const coupling::StaticSystem &system,
                                    const std::vector<char> &open) const
{
  const discrete::Grains &grains = system.grains();
  const discrete::Joints &joints = system.joints();
  double sum = 0.; // of force times the length over which it acts [N m]
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const auto one = static_cast<std::size_t>(joints.first[j]),
               two = static_cast<std::size_t>(joints.second[j]);
    if (!is_layer(grains.region[one]) || !is_layer(grains.region[two]))
      continue;
    const discrete::JointTension T = tension_in(joints, j, straight_);
    const Vec2 n{joints.normal_x[j], joints.normal_y[j]};
    sum -= (T.normal * n.x - T.shear * n.y) *
           (grains.reference_x[two] - grains.reference_x[one]);
  }
  const double push = 0.5 * unit_shortening * geometry_.length();
  std::size_t k = 0;
  for (const discrete::Wall &wall : scene_->walls)
    for (const discrete::WallContact &contact : wall.contacts)
    {
      const auto i = static_cast<std::size_t>(contact.grain);
      if (open[k++] == 0 && is_layer(grains.region[i]))
        sum += contact.weight * contact.stiffness *
               (push - wall.normal.x * straight_.ux[i]) *
               distance_from(wall, grains.reference(i));
    }
  return sum / (geometry_.length() * geometry_.thickness());
}

/// The cosine between the walls that is largest in the layer's motion across.
void BucklingGrains::find_half_waves()
{
  const discrete::Grains &grains = scene_->grains->state.grains;
  const SectionGeometry &g = geometry_;
  const auto shortest = static_cast<int>(g.length() / (4. * g.diameter()));
  purity_.clear();
  for (std::size_t k = 0; k < shapes_.size(); ++k)
  {
    const std::vector<double> &across = shapes_[k].shape.uy;
    double mean = 0., n = 0., largest = 0., squares = 0.;
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (is_layer(grains.region[i]))
      {
        mean += across[i];
        n += 1.;
      }
    mean /= n;
    for (int m = 1; m <= std::max(1, shortest); ++m)
    {
      double amplitude = 0.;
      for (std::size_t i = 0; i < grains.size(); ++i)
        if (is_layer(grains.region[i]))
          amplitude +=
              (across[i] - mean) *
              std::cos(m * M_PI * (grains.reference_x[i] - g.x_min()) / g.length());
      squares += amplitude * amplitude;
      if (std::abs(amplitude) > largest)
      {
        largest = std::abs(amplitude);
        modes_[k].half_waves = static_cast<unsigned int>(m);
      }
    }
    purity_.push_back(squares > 0. ? largest / std::sqrt(squares) : 0.);
  }
}

void BucklingGrains::solve(const std::function<bool()> &stop)
{
  const auto ask = [&stop]
  {
    if (stop && stop())
      throw continuum::BucklingStopped();
  };
  // Grains that a wall holds but does not touch yet are apart at an infinitesimal load.
  std::vector<char> open;
  for (const discrete::Wall &wall : scene_->walls)
    for (const discrete::WallContact &contact : wall.contacts)
      open.push_back(is_apart(wall, contact, scene_->grains->state.grains) ? 1 : 0);
  const auto n_apart = std::count(open.begin(), open.end(), 1);
  // A contact that is let go may let others pull. There are finitely many.
  do
  {
    ask();
    straight_ = supported(open).solve();
  } while (open_pulling_contacts(straight_, open) > 0);
  n_open_ = static_cast<std::size_t>(std::count(open.begin(), open.end(), 1) - n_apart);

  const coupling::StaticSystem system = supported(open);
  const double stress = layer_stress(system, open);
  ask();
  coupling::CoupledBucklingOptions options;
  options.n_modes = static_cast<unsigned int>(p_.run.modes);
  options.stop = stop;
  shapes_ = coupling::lowest_coupled_modes(
      system, coupling::geometric_stiffness(system, straight_), options);
  modes_.clear();
  for (const coupling::CoupledMode &shape : shapes_)
    modes_.push_back(
        {shape.load_factor * unit_shortening, shape.load_factor * stress, 0});
  straight_factor_ = shapes_.front().load_factor;
  find_half_waves();
}

std::vector<coupling::PvdEntry>
BucklingGrains::write_fields(const std::string &directory) const
{
  const coupling::GrainState &state = scene_->grains->state;
  std::vector<coupling::PvdEntry> fields;
  const auto list = [&](const double time, const std::string &group, std::string file)
  {
    fields.push_back({time, group, "fields/" + file + ".vtu"});
    return directory + "/" + fields.back().file;
  };
  const auto write_mesh = [&](const std::string &path,
                              const coupling::StaticSolution &shape, const double factor)
  {
    continuum::Vector u = shape.mesh;
    u *= factor;
    u.update_ghost_values();
    coupling::write_mesh_vtu(path, *scene_->solid, u);
  };
  write_static_grains(list(0., "grains", "straight_grains"), state.grains, straight_,
                      straight_factor_);
  write_static_joints(list(0., "joints", "straight_joints"), state.grains, state.joints,
                      straight_, straight_factor_);
  if (scene_->solid)
    write_mesh(list(0., "continuum", "straight"), straight_, straight_factor_);
  for (std::size_t k = 0; k < shapes_.size(); ++k)
  {
    char name[32];
    std::snprintf(name, sizeof name, "mode_%04zu", k + 1);
    const auto number = static_cast<double>(k + 1);
    write_static_grains(list(number, "grains", std::string(name) + "_grains"),
                        state.grains, shapes_[k].shape, 1.);
    if (scene_->solid)
      write_mesh(list(number, "continuum", name), shapes_[k].shape, 1.);
  }
  return fields;
}

std::vector<std::string> BucklingGrains::doubts() const
{
  std::vector<std::string> texts;
  char text[240];
  if (purity_.front() < 0.7)
  {
    std::snprintf(text, sizeof text,
                  "the lowest mode is no wave of the whole layer: its main wave makes "
                  "%.2g of it, and the number of half waves says little",
                  purity_.front());
    texts.push_back(text);
  }
  if (const double softer =
          bending_deficit * geometry_.diameter() / geometry_.thickness();
      softer > 0.05)
  {
    std::snprintf(text, sizeof text,
                  "%.3g grains across the layer: some %.2g %% softer in bending than a "
                  "layer of its modulus. Give 'Layer/Grains across' more",
                  geometry_.thickness() / geometry_.diameter(), 100. * softer);
    texts.push_back(text);
  }
  if (n_open_ > 0)
    texts.push_back(std::to_string(n_open_) +
                    " contacts of grains and walls would pull and were let go");
  return texts;
}
} // namespace antiform::cases

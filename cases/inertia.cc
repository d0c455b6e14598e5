#include "cases/inertia.h"

#include "cases/overlap.h"
#include "cases/scene.h"
#include "cases/scene_components.h"
#include "cases/section_foundation.h"
#include "continuum/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::cases
{
using discrete::StiffnessSums;

double damping_factor(const Parameters &p)
{
  return p.has("damping") ? 1. / std::sqrt(1. + p.damping.coefficient) : 1.;
}

namespace
{
/// Contacts of the grains that no joint holds. The overlap is beyond them: weight 1.
void add_contact_stiffness(const Scene &scene, StiffnessSums &sums)
{
  const coupling::GrainState &state = scene.grains->state;
  for (const discrete::Contact &contact : scene.contacts.contacts)
  {
    const discrete::LinearContact &law = scene.contacts.law(state.grains, contact);
    const double normal = discrete::normal_stiffness(
        law, state.grains.radius[contact.first], state.grains.radius[contact.second]);
    const double shear = law.friction > 0. ? normal / law.stiffness_ratio : 0.;
    for (const std::int32_t i : {contact.first, contact.second})
    {
      sums.translation[i] += normal + shear;
      sums.rotation[i] += shear * state.grains.radius[i] * state.grains.radius[i];
    }
  }
}

/// Springs under the base grains [N/m]; what stands on a rigid base is held, not sprung.
std::vector<double> base_springs(const Scene &scene)
{
  std::vector<double> springs(scene.grains->state.grains.size(), 0.);
  for (const coupling::GrainBase::Support &support : base_supports(scene))
    if (std::isfinite(support.stiffness))
      springs[support.grain] += support.stiffness;
  return springs;
}

std::vector<discrete::PairStiffness> fracture_springs(const Scene &scene)
{
  if (!scene.grains->smooth)
    return {};
  return discrete::pair_stiffness(scene.grains->state.grains, *scene.grains->smooth);
}
} // namespace

StiffnessSums grain_stiffness(const Scene &scene)
{
  const coupling::GrainState &state = scene.grains->state;
  StiffnessSums sums = discrete::stiffness_sums(state.grains, state.joints, false);
  for (const std::vector<discrete::Wall> *walls : {&scene.walls, &scene.side_walls})
    for (const discrete::Wall &wall : *walls)
      for (const discrete::WallContact &contact : wall.contacts)
        sums.translation[contact.grain] += contact.stiffness;
  const std::vector<double> base = base_springs(scene);
  for (std::size_t i = 0; i < base.size(); ++i)
    sums.translation[i] += base[i];
  add_contact_stiffness(scene, sums);
  for (const discrete::PairStiffness &pair : fracture_springs(scene))
    for (const auto &[i, lever] :
         {std::pair{pair.first, pair.lever1}, std::pair{pair.second, pair.lever2}})
    {
      sums.translation[i] += pair.translation();
      sums.rotation[i] += pair.rotation(lever);
    }
  return sums;
}

namespace
{
/// Stiffness of all that acts on grains and mesh.
struct SharedStiffness
{
  StiffnessSums grains;
  StiffnessSums grain_contacts;  ///< those of a surface interface in it
  std::vector<double> mesh;      ///< absolute row sums [N/m]; empty without a mesh
  /// What cells do not have of it: foundation, contacts of a surface interface, tied
  /// grains [N/m].
  std::vector<double> mesh_more;
};

SharedStiffness shared_stiffness(const Scene &scene,
                                 const std::vector<double> &foundation_rows)
{
  SharedStiffness all;
  const std::size_t n = scene.grains ? scene.grains->state.grains.size() : 0;
  all.grain_contacts.translation.assign(n, 0.);
  all.grain_contacts.rotation.assign(n, 0.);
  if (scene.mesh)
  {
    const continuum::Vector cells = scene.solid->absolute_row_sums();
    all.mesh.assign(cells.begin(), cells.begin() + cells.locally_owned_size());
    all.mesh_more = foundation_rows;
    all.mesh_more.resize(all.mesh.size(), 0.);
  }
  if (scene.surface)
    scene.surface->add_stiffness(all.grain_contacts, all.mesh_more);
  if (scene.bridging && !scene.bridging->ties().empty())
  {
    const coupling::GrainState &state = scene.grains->state;
    const std::vector<double> tied = scene.bridging->ties().absolute_row_sums(
        state.grains, state.joints, all.mesh.size());
    for (std::size_t i = 0; i < tied.size(); ++i)
      all.mesh_more[i] += tied[i];
  }
  for (std::size_t i = 0; i < all.mesh.size(); ++i)
    all.mesh[i] += all.mesh_more[i];
  if (!scene.grains)
    return all;
  all.grains = grain_stiffness(scene);
  for (std::size_t i = 0; i < n; ++i)
  {
    all.grains.translation[i] += all.grain_contacts.translation[i];
    all.grains.rotation[i] += all.grain_contacts.rotation[i];
  }
  return all;
}

/// Bound for the grains @p grains, with walls and base as springs to the ground; without
/// damping.
double grain_step(const Scene &scene, const discrete::Grains &grains)
{
  const coupling::GrainState &state = scene.grains->state;
  std::vector<double> ground = base_springs(scene);
  for (const std::vector<discrete::Wall> *walls : {&scene.walls, &scene.side_walls})
    for (const discrete::Wall &wall : *walls)
      for (const discrete::WallContact &contact : wall.contacts)
        ground[contact.grain] += contact.stiffness * contact.weight;
  return discrete::stable_step(grains, state.joints, scene.contacts, ground,
                               fracture_springs(scene));
}

/// The same where grains leave a part of their inertia to the contacts of a surface
/// interface, in proportion to stiffness (Irons' theorem).
double grain_step(const Scene &scene, const SharedStiffness &stiffness)
{
  if (!scene.surface || scene.surface->contacts.empty())
    return grain_step(scene, scene.grains->state.grains);
  discrete::Grains rest = scene.grains->state.grains;
  const auto leave = [](std::vector<double> &inverse, const std::vector<double> &all,
                        const std::vector<double> &contacts)
  {
    for (std::size_t i = 0; i < inverse.size(); ++i)
      if (all[i] > contacts[i])
        inverse[i] *= all[i] / (all[i] - contacts[i]);
  };
  leave(rest.inverse_mass, stiffness.grains.translation,
        stiffness.grain_contacts.translation);
  leave(rest.inverse_inertia, stiffness.grains.rotation,
        stiffness.grain_contacts.rotation);
  return grain_step(scene, rest);
}

/// Bound for the mesh, and for the contacts of a surface interface on their share of the
/// inertia.
double mesh_step(const Scene &scene, const SharedStiffness &stiffness)
{
  double largest = 0.;
  for (std::size_t i = 0; i < stiffness.mesh.size(); ++i)
    largest =
        std::max(largest, stiffness.mesh[i] * scene.mesh->inverse_mass.begin()[i]);
  if (scene.surface)
    for (const auto &contact : scene.surface->contacts)
      for (std::size_t point = 0; point < contact->states().size(); ++point)
        largest = std::max(largest, contact->square_of_frequency(
                                        point, scene.grains->state.grains,
                                        stiffness.grains, scene.mesh->inverse_mass,
                                        stiffness.mesh));
  return 2. / std::sqrt(dealii::Utilities::MPI::max(largest, scene.communicator()));
}
} // namespace

double after_search(Scene &scene)
{
  discrete::Grains &all = scene.grains->state.grains;
  for (std::vector<discrete::Wall> *walls : {&scene.walls, &scene.side_walls})
    for (discrete::Wall &wall : *walls)
    {
      find_wall_contacts(all, wall, scene.contacts.margin, scene.grains->modulus);
      if (scene.bridging)
        for (discrete::WallContact &contact : wall.contacts)
          if (contact.late)
            contact.weight =
                scene.bridging->weight().grains(all.reference(contact.grain));
    }
  double lost = 0.;
  const SharedStiffness stiffness = shared_stiffness(scene, {});
  if (scene.parameters.run.driver == "quasi-static")
  {
    lost = discrete::rescale_density(all, stiffness.grains, scene.mass_weight, scene.dt0);
    scene.factorise_constraints();
  }
  const coupling::Clock &clock = scene.simulation->clock();
  const double limit = damping_factor(scene.parameters) * grain_step(scene, stiffness);
  if (clock.dt > limit)
    throw NumericalError("contacts",
                         "grains that have come into contact have made the step "
                         "unstable; give a smaller 'Run / Step safety'",
                         clock.dt, limit, clock.step);
  return lost;
}

namespace
{
/// Half of the stable step of a free grain, for which the others are made heavier: that
/// of the softest region at its real masses. Of the layer, the stiffest region, the mean
/// counts: its least grain would make all others step for it alone. Of a mesh without
/// matrix grains beside it the least node counts, as these would.
double softest_step(const Scene &scene, const SharedStiffness &stiffness)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  double sum = 0., n = 0., matrix = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (!(stiffness.grains.translation[i] > 0.))
      continue; // nothing holds it
    const double step = std::sqrt(grains.mass[i] / stiffness.grains.translation[i]);
    if (is_layer(grains.region[i]))
    {
      sum += step;
      n += 1.;
    }
    else
      matrix = std::min(matrix, step);
  }
  if (scene.surface)
  {
    const continuum::Vector mass = scene.solid->lumped_mass();
    for (std::size_t i = 0; i < stiffness.mesh.size(); ++i)
      matrix = std::min(matrix, std::sqrt(2. * mass.begin()[i] / stiffness.mesh[i]));
  }
  const double layer = n > 0. ? sum / n : 0.;
  return std::isinf(matrix) ? layer : std::max(layer, matrix);
}
} // namespace

double choose_step(Scene &scene, const std::vector<double> &foundation_rows)
{
  const Parameters &p = scene.parameters;
  const bool scaled = p.run.driver == "quasi-static";
  const SharedStiffness stiffness = shared_stiffness(scene, foundation_rows);
  double step = std::numeric_limits<double>::infinity();
  if (scene.grains)
  {
    discrete::Grains &grains = scene.grains->state.grains;
    scene.dt0 = scaled ? softest_step(scene, stiffness) : 0.;
    discrete::scale_density(grains, stiffness.grains, scene.mass_weight, scene.dt0);
    if (scene.bridging)
      scene.bridging->ties().hold(grains);
    step = grain_step(scene, stiffness);
  }
  if (scene.mesh)
  {
    const continuum::Vector &real =
        scene.bridging ? scene.bridging->mesh_mass() : scene.solid->lumped_mass();
    // The mesh is made as slow as the grains are, no slower.
    scene.mesh->scale_density(real, stiffness.mesh_more,
                              scaled && scene.grains ? step : 0.);
    step = std::min(step, mesh_step(scene, stiffness));
  }
  return p.run.safety * damping_factor(p) * overlap_damping_factor(scene, step) * step;
}

double mesh_stable_step(Scene &scene)
{
  std::vector<double> foundation_rows;
  if (scene.parameters.has("foundation"))
    foundation_rows = coupling::MeshFoundation(
                          *scene.mesh, section_foundation(scene.parameters, *scene.solid))
                          .absolute_row_sums();
  return mesh_step(scene, shared_stiffness(scene, foundation_rows));
}

double layer_transit(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  const double modulus = p.plane_modulus();
  double density = p.layer_density();
  if (scene.grains)
  {
    const discrete::Grains &grains = scene.grains->state.grains;
    double mass = 0.;
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (is_layer(grains.region[i]))
        mass += 1. / grains.inverse_mass[i];
    density = mass / (scene.geometry.length() * scene.geometry.thickness());
  }
  return scene.geometry.length() / std::sqrt(modulus / density);
}
} // namespace antiform::cases

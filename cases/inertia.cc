#include "cases/inertia.h"

#include "cases/scene.h"
#include "cases/scene_components.h"
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
/// Bound for the grains at their present masses, with walls and base as springs to the
/// ground; without damping.
double grain_step(const Scene &scene)
{
  const coupling::GrainState &state = scene.grains->state;
  std::vector<double> ground = base_springs(scene);
  for (const std::vector<discrete::Wall> *walls : {&scene.walls, &scene.side_walls})
    for (const discrete::Wall &wall : *walls)
      for (const discrete::WallContact &contact : wall.contacts)
        ground[contact.grain] += contact.stiffness * contact.weight;
  return discrete::stable_step(state.grains, state.joints, scene.contacts, ground,
                               fracture_springs(scene));
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
  if (scene.parameters.run.driver == "quasi-static")
  {
    lost = discrete::rescale_density(all, grain_stiffness(scene), scene.mass_weight,
                                     scene.dt0);
    if (scene.bridging && !scene.bridging->is_factorised_for(all))
      scene.bridging->factorise(all, scene.mesh->inverse_mass);
  }
  const coupling::Clock &clock = scene.simulation->clock();
  const double limit = damping_factor(scene.parameters) * grain_step(scene);
  if (clock.dt > limit)
    throw NumericalError("contacts",
                         "grains that have come into contact have made the step "
                         "unstable; give a smaller 'Run / Step safety'",
                         clock.dt, limit, clock.step);
  return lost;
}

namespace
{
/// Half of the stable step of a free grain, for which the others are made heavier: that of
/// the softest region at its real masses. Of the layer, the stiffest region, the mean
/// counts: its least grain would make all others step for it alone.
double softest_step(const Scene &scene, const StiffnessSums &sums)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  double sum = 0., n = 0., matrix = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (!(sums.translation[i] > 0.))
      continue; // nothing holds it
    const double step = std::sqrt(grains.mass[i] / sums.translation[i]);
    if (is_layer(grains.region[i]))
    {
      sum += step;
      n += 1.;
    }
    else
      matrix = std::min(matrix, step);
  }
  const double layer = n > 0. ? sum / n : 0.;
  return std::isinf(matrix) ? layer : std::max(layer, matrix);
}
} // namespace

double choose_step(Scene &scene, const std::vector<double> &foundation_rows)
{
  const Parameters &p = scene.parameters;
  const bool scaled = p.run.driver == "quasi-static";
  double step = std::numeric_limits<double>::infinity();
  if (scene.grains)
  {
    discrete::Grains &grains = scene.grains->state.grains;
    const StiffnessSums sums = grain_stiffness(scene);
    scene.dt0 = scaled ? softest_step(scene, sums) : 0.;
    discrete::scale_density(grains, sums, scene.mass_weight, scene.dt0);
    step = grain_step(scene);
  }
  if (scene.mesh)
  {
    const continuum::Vector &real =
        scene.bridging ? scene.bridging->mesh_mass() : scene.solid->lumped_mass();
    // The mesh is made as slow as the grains are, no slower.
    scene.mesh->scale_density(real, foundation_rows, scaled && scene.grains ? step : 0.);
    double largest = 0.;
    const continuum::Vector sums = scene.solid->absolute_row_sums();
    for (std::size_t i = 0; i < scene.mesh->mass.locally_owned_size(); ++i)
      largest = std::max(largest, (sums.begin()[i] +
                                   (foundation_rows.empty() ? 0. : foundation_rows[i])) *
                                      scene.mesh->inverse_mass.begin()[i]);
    largest = dealii::Utilities::MPI::max(largest,
                                          scene.solid->dof_handler().get_communicator());
    step = std::min(step, 2. / std::sqrt(largest));
  }
  return p.run.safety * damping_factor(p) * step;
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

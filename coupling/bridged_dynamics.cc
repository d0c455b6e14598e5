#include "coupling/bridged_balance.h"
#include "coupling/joining_components.h"

#include "continuum/errors.h"
#include "discrete/integrate.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling
{
namespace
{
void bring_to_rest(discrete::Grains &grains, MeshState &mesh)
{
  for (std::vector<double> *v : {&grains.velocity_x, &grains.velocity_y, &grains.spin})
    std::fill(v->begin(), v->end(), 0.);
  mesh.velocity = 0.;
}
} // namespace

HeldResult BridgedBalance::settle(const HeldDynamics &settings, const RestGoal &goal)
{
  GrainState &state = grains_.state();
  discrete::Grains &grains = state.grains;
  scale_masses(); // contacts of the walls may have joined
  bring_to_rest(grains, mesh_);
  // Walls as the mesh's components know them; these do not move.
  const std::vector<discrete::Wall> held(grains_.walls().size());
  MeshMotion of_mesh(mesh_, held);
  LocalDamping damping(&state, &mesh_, settings.damping);
  of_mesh.damping = damping.mesh_forces();

  const double stable =
      std::min(discrete::stable_step(grains, state.joints, grains_.ground_stiffness()),
               mesh_.solid.stable_step(mesh_.inverse_mass));
  Clock clock;
  clock.dt = settings.step_safety * stable / std::sqrt(1. + settings.damping);
  HeldResult result;
  Energies books;
  const double potential = grains_.load_potential();
  while (true)
  {
    clock.step = result.steps;
    clock.sample_due = result.steps % settings.check_interval == 0;
    add_forces({static_cast<std::uint64_t>(result.steps),
                static_cast<double>(result.steps) * clock.dt, clock.dt},
               &state.cracks, clock.sample_due);
    const BalanceRatios found = clock.sample_due ? ratios() : BalanceRatios{};
    const discrete::GrainVelocities before =
        clock.sample_due ? discrete::velocities(grains) : discrete::GrainVelocities{};
    damping.run(Stage::damp, clock);
    damping.run(Stage::kick, clock);
    of_mesh.run(Stage::kick, clock);
    domain_.project(grains, mesh_.velocity);
    BalanceRatios allowed = goal;
    if (result.steps > settings.patience)
      allowed.mean = std::max(goal.mean, settings.collapsed);
    if (clock.sample_due &&
        (found.within(allowed) || conjugate_force() < goal.least_force))
    {
      of_mesh.add_energies(books);
      books.kinetic += discrete::kinetic_energy(grains, before);
      break;
    }
    if (result.steps >= settings.most_steps)
      throw NumericalError("held dynamics",
                           "the body does not come to rest under held supports",
                           found.mean, goal.mean, static_cast<long>(result.steps));
    discrete::drift(grains, clock.dt);
    of_mesh.run(Stage::drift, clock);
    ++result.steps;
  }
  damping.add_energies(books);
  result.dissipated = books.damping + books.kinetic;
  result.load_work = grains_.load_potential() - potential;
  bring_to_rest(grains, mesh_);
  return result;
}
} // namespace antiform::coupling

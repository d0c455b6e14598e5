#include "coupling/held_dynamics.h"

#include "continuum/errors.h"
#include "discrete/integrate.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling
{
namespace
{
using discrete::Grains;

void stop(Grains &grains)
{
  for (std::vector<double> *v : {&grains.velocity_x, &grains.velocity_y, &grains.spin})
    std::fill(v->begin(), v->end(), 0.);
}
} // namespace

double common_step(const Grains &grains, const discrete::StiffnessSums &sums)
{
  double squared = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (sums.translation[i] > 0.)
      squared = std::max({squared, grains.mass[i] / sums.translation[i],
                          grains.inertia[i] / (1.5 * sums.rotation[i])});
  return std::sqrt(squared);
}

HeldResult
settle(GrainBalance &body, const HeldDynamics &settings, const RestGoal &goal)
{
  Grains &grains = body.state().grains;
  discrete::Joints &joints = body.state().joints;
  const std::vector<double> inverse_mass = grains.inverse_mass,
                            inverse_inertia = grains.inverse_inertia;
  discrete::StiffnessSums sums = discrete::stiffness_sums(grains, joints, false);
  const std::vector<double> ground = body.ground_stiffness();
  for (std::size_t i = 0; i < ground.size(); ++i)
    sums.translation[i] += ground[i];
  discrete::scale_density(grains, sums, {}, common_step(grains, sums));
  stop(grains);

  // The factor of damping: see docs/theory/damping.md.
  const double dt = settings.step_safety * discrete::stable_step(grains, joints, ground) /
                    std::sqrt(1. + settings.damping);
  discrete::GrainDamping damping;
  damping.coefficient = settings.damping;
  damping.start(grains.size());
  HeldResult result;
  const double potential = body.load_potential();
  while (true)
  {
    const bool look = result.steps % settings.check_interval == 0;
    body.add_forces({static_cast<std::uint64_t>(result.steps),
                     static_cast<double>(result.steps) * dt, dt},
                    &body.state().cracks, look);
    const BalanceRatios ratios = look ? body.ratios() : BalanceRatios{};
    const discrete::GrainVelocities before =
        look ? discrete::velocities(grains) : discrete::GrainVelocities{};
    discrete::damped_kick(grains, dt, damping);
    BalanceRatios allowed = goal;
    if (result.steps > settings.patience)
      allowed.mean = std::max(goal.mean, settings.collapsed);
    if (look && (ratios.within(allowed) || body.conjugate_force() < goal.least_force))
    {
      result.dissipated = discrete::kinetic_energy(grains, before);
      break;
    }
    if (result.steps >= settings.most_steps)
      throw NumericalError("held dynamics",
                           "the body does not come to rest under held supports",
                           ratios.mean, goal.mean, static_cast<long>(result.steps));
    discrete::drift(grains, dt);
    ++result.steps;
  }
  for (const double energy : damping.energy)
    result.dissipated += energy;
  result.load_work = body.load_potential() - potential;
  stop(grains);
  grains.inverse_mass = inverse_mass;
  grains.inverse_inertia = inverse_inertia;
  return result;
}
} // namespace antiform::coupling

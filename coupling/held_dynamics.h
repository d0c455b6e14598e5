#pragma once

#include "coupling/grain_balance.h"

#include <cstdint>
#include <limits>

namespace antiform::coupling
{
/// Explicit damped motion of grains whose supports are held.
struct HeldDynamics
{
  double damping = 0.7; ///< local [-]
  double step_safety = 0.8;
  int check_interval = 20;            ///< steps between two looks at the ratios
  std::int64_t most_steps = 10000000; ///< before it is given up
  /// Steps after which the motion counts as a collapse: loose fragments settle slowly and
  /// joints carry little, and the mean ratio need only be below `collapsed`.
  std::int64_t patience = 10000000;
  double collapsed = 1e-3;
};

/// Where explicit motion ends: in balance within the limits, or with a load parameter's
/// conjugate force [J] that has fallen below a least one, at which the run ends anyway.
struct RestGoal : BalanceRatios
{
  RestGoal(const BalanceRatios &limits) // NOLINT: limits alone are a goal
      : BalanceRatios(limits)
  {
  }
  double least_force = -std::numeric_limits<double>::infinity();
};

/// What came of it.
struct HeldResult
{
  std::int64_t steps = 0;
  double dissipated = 0.; ///< by the damping, and what was kinetic at the end [J]
  double load_work = 0.;  ///< of the constant loads [J]
};

/// The least step at which scaling reaches all grains that have joints [s].
double common_step(const discrete::Grains &grains, const discrete::StiffnessSums &sums);

/// Let the grains go from rest, prescribed components held, bonds breaking, until the
/// goal is reached; stop them there. Densities are scaled so that
/// every grain has the same stable step, and put back afterwards. Cracks go to the
/// state; their step and time are those of this motion, in units in which the stiffest
/// grain's own period is of order 1. Throws NumericalError after the most steps.
HeldResult
settle(GrainBalance &body, const HeldDynamics &settings, const RestGoal &goal);
} // namespace antiform::coupling

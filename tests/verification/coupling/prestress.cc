// A column with an overlap under prestress: at rest its constrained forces vanish, and
// pulled slowly it answers like the static solution, damped or not. Built on the
// unconstrained forces neither holds: on a grain that carries multipliers f = C^T L at
// rest.
#include "support/column_fixture.h"
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::prestress_tests
{
namespace
{
constexpr double pressure = 1e-5; // strain 1e-5: geometric stiffness 1e-5 of the elastic

/// Unbalanced ratio of the prestressed column at rest.
double ratio_at_rest(const bool constrained)
{
  Column column;
  column.prestress(pressure);
  column.support(0., false);
  column.equilibrate(0.);
  Loop::Options options;
  options.constrained = constrained;
  options.wall_speed = [](double) { return 0.; };
  Loop run(column.model, 0.8 * column.model.stable_step(), options);
  run.add(std::make_unique<MeshLoads>(*column.model.mesh, column.load), {Stage::forces},
          60, "prestress");
  run.probe(1, [](const Clock &) {});
  run.advance(1);
  return run.unbalanced_ratio();
}

struct Pull
{
  double error = 0.; ///< of the reaction's change, over its last static value
  double ratio = 0.; ///< unbalanced, at the end
};

/// Pull the end by a tenth of the prestress' shortening along half a cosine, hold it, and
/// compare the reaction with the static one from the middle of the ramp on.
Pull pull(const double alpha, const bool constrained, const bool combined = false)
{
  Column column;
  column.prestress(pressure);
  column.support(0., false);
  column.equilibrate(0.);
  const double length = column.end - column.begin;
  const double distance = 0.1 * pressure * length;
  const double rest = column.pressing_force();
  column.equilibrate(distance);
  const double change = column.pressing_force() - rest;
  column.equilibrate(0.);

  // Lowest axial period 2 L / c = 60; the lowest bending periods are of some hundreds.
  const double ramp = 6000., hold = 1000.;
  const auto speed = [=](const double t)
  { return t < ramp ? -0.5 * distance * M_PI / ramp * std::sin(M_PI * t / ramp) : 0.; };
  Loop::Options options;
  options.damping = alpha;
  options.constrained = constrained;
  options.combined = combined;
  options.wall_speed = speed;
  const double dt = 0.8 * column.model.stable_step();
  Loop run(column.model, dt, options);
  run.add(std::make_unique<MeshLoads>(*column.model.mesh, column.load), {Stage::forces},
          60, "prestress");
  Pull result;
  run.probe(20,
            [&](const Clock &clock)
            {
              if (clock.time < 0.5 * ramp)
                return;
              const double moved = -run.walls().closure() / distance;
              const double found = run.walls().mesh_reaction() - rest;
              result.error = std::max(result.error, std::abs(found / change - moved));
            });
  run.advance(static_cast<std::int64_t>((ramp + hold) / dt));
  result.ratio = run.unbalanced_ratio();
  std::printf("  alpha = %g%s, %s forces: reaction error %.2e, last ratio %.1e\n", alpha,
              combined ? " combined" : "", constrained ? "constrained" : "unconstrained",
              result.error, result.ratio);
  return result;
}
} // namespace

TEST(PrestressedColumn, IsAtRest)
{
  const double ratio = ratio_at_rest(true);
  std::printf("  unbalanced ratio at rest: %.1e\n", ratio);
  EXPECT_LT(ratio, 1e-8);
}

TEST(PrestressedColumn, PulledSlowlyAnswersLikeTheStaticOne)
{
  EXPECT_LT(pull(0., true).error, 1e-3);
  const Pull damped = pull(0.7, true);
  EXPECT_LT(damped.error, 1e-3);
  EXPECT_LT(damped.ratio, 1e-6);
  const Pull combined = pull(0.7, true, true);
  EXPECT_LT(combined.error, 1e-3);
  EXPECT_LT(combined.ratio, 1e-6);
}

TEST(PrestressedColumn, UnconstrainedForcesMisjudgeIt)
{
  const double ratio = ratio_at_rest(false);
  const Pull damped = pull(0.7, false);
  std::printf("  unconstrained ratio at rest: %.1e\n", ratio);
  EXPECT_GT(ratio, 1e-3);
  EXPECT_GT(damped.error, 3e-3);
}
} // namespace antiform::coupling::test::prestress_tests

// Layers of grains in a mesh that lose their stability, followed by the event driver with
// the walls' displacement given.
#include "support/fold_fixture.h"

#include "coupling/bridged_balance.h"
#include "coupling/coupled_buckling.h"
#include "coupling/event_driver.h"
#include "coupling/present_stability.h"

#include <gtest/gtest.h>

#include <ctime>

namespace antiform::coupling::test::bridged_buckling_tests
{
namespace
{
/// The fold of fold_fixture.h as a body in balance.
struct FoldInBalance
{
  Fold fold;
  BridgedBalance body;
  EventDriver driver;

  FoldInBalance(const FoldShape &shape,
                const FoldMatrix matrix,
                const DriverSettings &settings)
      : fold(shape, matrix, 100.)
      , body(fold.model().state,
             {{&fold.model().walls[0], 0.5 * shape.length, false, 0.},
              {&fold.model().walls[1], 0.5 * shape.length, false, 0.}},
             held(fold),
             *fold.model().mesh,
             *fold.model().domain)
      , driver(
            fold.model().state,
            body,
            [this](const RestGoal &goal) { return body.settle({}, goal); },
            settings)
  {
  }
  int n_unstable()
  {
    return n_unstable_directions(body.grains(), &*fold.model().mesh,
                                 fold.model().domain.get());
  }

private:
  /// A node of the mesh keeps its height, which no balanced force would change, and the
  /// grains on the walls do not turn.
  static std::vector<PrescribedMotion> held(Fold &fold)
  {
    fold.model().mesh->prescribe(1, -1);
    std::vector<PrescribedMotion> all;
    for (const std::int32_t grain : fold.on_plane())
      all.push_back({grain, 2, 0.});
    return all;
  }
};

double cpu_seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}
} // namespace

namespace
{
/// Linear static state at a shortening of 1, walls as springs that move in.
StaticSystem shortened(Fold &fold, const FoldShape &shape)
{
  Bridged &model = fold.model();
  const discrete::Grains &grains = model.state.grains;
  StaticSystem system(grains, model.state.joints, model.solid.get(), model.domain.get());
  const double way = 0.5 * shape.length;
  for (const discrete::Wall &wall : model.walls)
    for (const discrete::WallContact &contact : wall.contacts)
    {
      const double stiffness = contact.weight * contact.stiffness;
      system.add_grain_spring(contact.grain, 0, stiffness);
      system.add_grain_force(contact.grain, 0, stiffness * way * wall.normal.x);
    }
  for (const std::int32_t grain : fold.on_plane())
    system.fix_grain(grain, 2, 0.);
  for (const PrescribedDof &entry : model.mesh->prescribed)
    system.fix_mesh(entry.dof,
                    entry.wall < 0 ? 0. : way * model.walls[entry.wall].normal.x);
  return system;
}

DriverSettings elastic_settings()
{
  DriverSettings settings;
  settings.stop_drop = 0.;
  settings.largest_step = 2.5e-3;
  settings.limits = {1e-4, 1e-2, 1e-2};
  return settings;
}
} // namespace

// The lowest load of the linear prestress; at present the body is looked at as shortened
// as it is, by 6 %.
TEST(BridgedBuckling, IsFoundWhereLinearBucklingHasIt)
{
  FoldShape shape;
  shape.amplitude = 0.; // straight
  FoldInBalance run(shape, FoldMatrix::semi_linear_mesh, elastic_settings());
  const StaticSystem system = shortened(run.fold, shape);
  const auto modes =
      lowest_coupled_modes(system, geometric_stiffness(system, system.solve()), {2});
  const double critical = modes[0].load_factor;
  ASSERT_GT(modes[1].load_factor, 1.1 * critical);
  run.driver.run_to(0.95 * critical);
  EXPECT_EQ(run.n_unstable(), 0);
  run.driver.run_to(1.05 * critical);
  EXPECT_EQ(run.n_unstable(), 1);
  EXPECT_LT(std::abs(run.fold.shape_now().amplitude), 0.01); // nothing has pushed it
}

// A pre-bent layer through the load at which a straight one buckles, until its limbs dip
// by 19 degrees.
TEST(BridgedBuckling, IsFollowedAsInTimeLong)
{
  const FoldShape shape;
  constexpr double end = 0.1, critical = 0.0596;
  double begin = cpu_seconds();
  FoldInBalance run(shape, FoldMatrix::semi_linear_mesh, elastic_settings());
  std::vector<double> force;
  for (int k = 0; k <= 20; ++k)
  {
    run.driver.run_to(end * k / 20.);
    force.push_back(run.body.conjugate_force() / shape.length);
    EXPECT_LE(run.body.gap(), 1e-12 * largest_displacement(run.fold.model())) << k;
  }
  const double seconds = cpu_seconds() - begin;
  const FoldState now = run.fold.shape_now();
  const DriverReport &report = run.driver.report();

  DriverSettings usual = elastic_settings();
  usual.limits = DriverSettings().limits;
  FoldInBalance loose(shape, FoldMatrix::semi_linear_mesh, usual);
  loose.driver.run_to(end);
  std::printf("  at the usual limits %.4f, %d solves\n", loose.fold.shape_now().amplitude,
              static_cast<int>(loose.driver.report().solves));

  begin = cpu_seconds();
  Fold slow(shape, FoldMatrix::semi_linear_mesh, 100.);
  slow.shorten([](const FoldState &state) { return state.shortening >= end - 1e-9; });
  const FoldState &in_time = slow.history().back();
  std::printf("  amplitude %.4f, in time %.4f; dip %.2f, %.2f; force %.5f, %.5f; %d "
              "solves, at most %d a load, %.1f s, in time %.1f s\n",
              now.amplitude, in_time.amplitude, now.dip, in_time.dip, force.back(),
              in_time.force, static_cast<int>(report.solves),
              static_cast<int>(report.most_corrections), seconds, cpu_seconds() - begin);
  EXPECT_GT(now.dip, 18.);
  // In time at a rate that is worth 0.5 % of the amplitude at most (fold.cc).
  EXPECT_NEAR(now.amplitude / in_time.amplitude, 1., 5e-3);
  EXPECT_NEAR(force.back() / in_time.force, 1., 2e-3);
  EXPECT_NEAR(loose.fold.shape_now().amplitude / in_time.amplitude, 1., 1e-2);
  EXPECT_EQ(report.hand_overs, 0);
  for (const LoadRecord &record : report.records)
    EXPECT_TRUE(record.ratios.within(elastic_settings().limits)) << record.load;
  // Stiffness before and well after the critical load.
  static_assert(end > 1.5 * critical);
  EXPECT_LT(force[20] - force[19], 0.25 * (force[1] - force[0]));
}
} // namespace antiform::coupling::test::bridged_buckling_tests

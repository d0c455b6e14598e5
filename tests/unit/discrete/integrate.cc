#include "discrete/integrate.h"
#include "discrete/joint_kernel.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace antiform::discrete::test::integrate_tests
{
namespace
{
/// Three grains with velocities of either sign and of none, and a force on each.
struct MovingGrains
{
  Grains grains;
  GrainDamping damping;
  MovingGrains()
  {
    for (const double radius : {0.5, 0.4, 0.3})
      grains.add({2. * radius, 0.}, radius, 1., 0);
    grains.velocity_x = {0.2, -0.3, 0.};
    grains.velocity_y = {-0.1, 0., 0.4};
    grains.spin = {0., 0.5, -0.6};
    grains.force_x = {3., 4., 5.};
    grains.force_y = {-6., 7., -8.};
    grains.torque = {1., -2., 3.};
    damping.coefficient = 0.7;
  }
};
} // namespace

TEST(GrainDamping, OpposesTheVelocityByAShareOfTheForce)
{
  MovingGrains moving;
  damped_kick(moving.grains, 0.1, moving.damping);
  const double a = 0.7;
  EXPECT_EQ(moving.damping.force_x, (std::vector<double>{-a * 3., a * 4., 0.}));
  EXPECT_EQ(moving.damping.force_y, (std::vector<double>{a * 6., 0., -a * 8.}));
  EXPECT_EQ(moving.damping.torque, (std::vector<double>{0., -a * 2., a * 3.}));
}

TEST(GrainDamping, CombinedFollowsTheChangeOfTheForceToo)
{
  MovingGrains moving;
  moving.damping.combined = true;
  moving.damping.start(3);
  moving.damping.before_x = {5., 1., 5.}; // falls, rises, stays
  Grains &g = moving.grains;
  const std::vector<double> velocity = g.velocity_x;
  damped_kick(g, 0.1, moving.damping);
  const double half = 0.35;
  const auto sign = [](const double v) { return v > 0. ? 1. : v < 0. ? -1. : 0.; };
  const std::vector<double> change{-1., 1., 0.};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_DOUBLE_EQ(moving.damping.force_x[i],
                     half * std::abs(g.force_x[i]) * (change[i] - sign(velocity[i])));
  EXPECT_EQ(moving.damping.before_x, g.force_x);
}

TEST(GrainDamping, BooksTheWorkOfTheMeanVelocity)
{
  MovingGrains moving;
  Grains &g = moving.grains;
  const double dt = 0.1;
  const auto half_work = [&](const GrainVelocities &v)
  {
    double power = 0.;
    for (std::size_t i = 0; i < g.size(); ++i)
      power += moving.damping.force_x[i] * v.x[i] + moving.damping.force_y[i] * v.y[i] +
               moving.damping.torque[i] * v.spin[i];
    return 0.5 * dt * power;
  };
  const GrainVelocities first = velocities(g);
  damped_kick(g, dt, moving.damping);
  double work = half_work(first);
  ASSERT_EQ(moving.damping.energy.size(), 1u);
  EXPECT_NEAR(moving.damping.energy[0], -work, 1e-15); // round-off
  const GrainVelocities second = velocities(g);
  work += half_work(second); // of the first forces, by the velocities after the kick
  damped_kick(g, dt, moving.damping);
  work += half_work(second);
  EXPECT_NEAR(moving.damping.energy[0], -work, 1e-15);
}

TEST(Kick, AcceleratesByForceOverInertia)
{
  MovingGrains moving;
  Grains &g = moving.grains;
  hold(g, 1);
  const Grains before = g;
  kick(g, 0.1);
  for (const std::size_t i : {0, 2})
  {
    EXPECT_DOUBLE_EQ(g.velocity_x[i],
                     before.velocity_x[i] + 0.1 * before.force_x[i] / g.mass[i]);
    EXPECT_DOUBLE_EQ(g.velocity_y[i],
                     before.velocity_y[i] + 0.1 * before.force_y[i] / g.mass[i]);
    EXPECT_DOUBLE_EQ(g.spin[i], before.spin[i] + 0.1 * before.torque[i] / g.inertia[i]);
  }
  EXPECT_EQ(g.velocity_x[1], -0.3); // prescribed motion goes on as it is
  EXPECT_EQ(g.spin[1], 0.5);
}

TEST(DampedKick, AcceleratesByForceAndDampingOverInertia)
{
  MovingGrains moving;
  Grains &g = moving.grains;
  hold(g, 1);
  const Grains before = g;
  damped_kick(g, 0.1, moving.damping);
  const GrainDamping &d = moving.damping;
  for (const std::size_t i : {0, 2})
  {
    EXPECT_DOUBLE_EQ(g.velocity_x[i],
                     before.velocity_x[i] +
                         0.1 * (before.force_x[i] + d.force_x[i]) / g.mass[i]);
    EXPECT_DOUBLE_EQ(g.velocity_y[i],
                     before.velocity_y[i] +
                         0.1 * (before.force_y[i] + d.force_y[i]) / g.mass[i]);
    EXPECT_DOUBLE_EQ(g.spin[i], before.spin[i] + 0.1 * (before.torque[i] + d.torque[i]) /
                                                     g.inertia[i]);
  }
  EXPECT_EQ(g.velocity_x[1], -0.3); // held: prescribed motion goes on as it is
  EXPECT_EQ(g.spin[1], 0.5);
}

/// Every vector level does what one grain at a time does: the same bits.
TEST(DampedKick, IsTheSameAtEveryLevelAndForEveryNumberOfGrains)
{
  for (const bool combined : {false, true})
    for (const std::size_t n : {1, 2, 3, 4, 5, 11})
    {
      struct State
      {
        std::vector<double> force, before, inverse_mass, velocity, damping;
      } start;
      for (std::size_t i = 0; i < n; ++i)
      {
        const double s = std::sin(1. + 3. * static_cast<double>(i));
        start.force.push_back(i % 5 == 3 ? 0. : s);
        start.before.push_back(i % 3 == 0 ? start.force[i] : s * s - 0.3);
        start.inverse_mass.push_back(i % 4 == 2 ? 0. : 1. + s * s);
        start.velocity.push_back(i % 6 == 4 ? 0. : s - 0.2);
        start.damping.push_back(0.1 * s);
      }
      const auto kick = [&](const KernelLevel &level, State &s, const std::size_t begin,
                            const std::size_t end)
      {
        return level.damped_kick(
            {0.7, 0.1, s.force.data(), combined ? s.before.data() : nullptr,
             s.inverse_mass.data(), s.velocity.data(), s.damping.data()},
            begin, end);
      };
      State single = start;
      double power = 0.;
      for (std::size_t i = 0; i < n; ++i)
        power += kick(supported_kernel_levels().front(), single, i, i + 1);
      std::set<double> powers;
      for (const KernelLevel &level : supported_kernel_levels())
      {
        State all = start;
        const double its_power = kick(level, all, 0, n);
        EXPECT_EQ(all.velocity, single.velocity) << level.name << ", " << n;
        EXPECT_EQ(all.damping, single.damping) << level.name << ", " << n;
        EXPECT_EQ(all.before, combined ? start.force : start.before);
        EXPECT_NEAR(its_power, power, 1e-14); // another order of the sum
        powers.insert(its_power);
      }
      EXPECT_EQ(powers.size(), 1u);
    }
}

TEST(Drift, MovesByTheVelocities)
{
  MovingGrains moving;
  drift(moving.grains, 0.5);
  EXPECT_EQ(moving.grains.displacement_x, (std::vector<double>{0.1, -0.15, 0.}));
  EXPECT_EQ(moving.grains.displacement_y, (std::vector<double>{-0.05, 0., 0.2}));
  EXPECT_EQ(moving.grains.rotation, (std::vector<double>{0., 0.25, -0.3}));
}

TEST(KineticEnergy, IsThatOfTheTwoHalfStepVelocities)
{
  Grains g;
  g.add({0., 0.}, 0.5, 1., 0);
  g.velocity_x = {0.4};
  g.spin = {0.2};
  const GrainVelocities before{{0.3}, {0.}, {0.1}};
  EXPECT_DOUBLE_EQ(kinetic_energy(g, before),
                   0.5 * g.mass[0] * 0.3 * 0.4 + 0.5 * g.inertia[0] * 0.1 * 0.2);
  hold(g, 0);
  EXPECT_EQ(kinetic_energy(g, before), 0.);
}

TEST(DensityScaling, RaisesInertiaOnlyWhereTheStepAsksForIt)
{
  Grains g;
  g.add({0., 0.}, 0.5, 1., 0);
  g.add({0., 0.}, 0.5, 1., 0);
  scale_density(g, {{1., 1e6}, {1., 1e6}}, {0.5, 0.25}, 0.01);
  EXPECT_DOUBLE_EQ(1. / g.inverse_mass[0], 0.5 * g.mass[0]);
  EXPECT_DOUBLE_EQ(1. / g.inverse_inertia[0], 0.5 * g.inertia[0]);
  EXPECT_DOUBLE_EQ(1. / g.inverse_mass[1], 0.25 * 100.);
  EXPECT_DOUBLE_EQ(1. / g.inverse_inertia[1], 0.25 * 150.); // half as much again
}

TEST(DensityScaling, InTheCourseOfARunTellsTheEnergyLost)
{
  Grains g;
  for (int i = 0; i < 3; ++i)
    g.add({0., 0.}, 0.5, 1., 0);
  scale_density(g, {{2e4, 4e4, 2e4}, {1e4, 2e4, 1e4}}, {}, 0.01);
  g.velocity_x = {3., 5., 1.};
  g.velocity_y = {-4., 12., 1.};
  g.spin = {2., -6., 1.};
  hold(g, 2);
  // The first grain carries twice as much now, the second half; the third is held.
  const double lost = rescale_density(g, {{4e4, 2e4, 4e4}, {2e4, 1e4, 2e4}}, {}, 0.01);
  EXPECT_DOUBLE_EQ(1. / g.inverse_mass[0], 4.);
  EXPECT_DOUBLE_EQ(1. / g.inverse_inertia[0], 3.);
  EXPECT_DOUBLE_EQ(1. / g.inverse_mass[1], 2.);
  EXPECT_DOUBLE_EQ(1. / g.inverse_inertia[1], 1.5);
  EXPECT_EQ(g.inverse_mass[2], 0.);
  EXPECT_EQ(g.velocity_x, (std::vector<double>{3., 5., 1.}));
  // 1/2 (2 - 4) 25 + 1/2 (4 - 2) 169 and, of the spins, 1/2 (1.5 - 3) 4 + 1/2 (3 - 1.5)
  // 36.
  EXPECT_DOUBLE_EQ(lost, -25. + 169. - 3. + 27.);
}
} // namespace antiform::discrete::test::integrate_tests

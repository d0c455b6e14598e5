// Walls that follow a pressure: the loop of servo and contact alone, whose error is a
// geometric series, and a specimen between two such walls and two platens.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::servo_tests
{
namespace
{
Wall wall_at(const Grains &g, const Vec2 &normal)
{
  double nearest = 1e300;
  for (std::size_t i = 0; i < g.size(); ++i)
    nearest = std::min(nearest, dot(g.reference(i), normal) - g.radius[i]);
  Wall wall;
  wall.point = nearest * normal;
  wall.normal = normal;
  install_wall_contacts(g, wall, 0.6, 0.25, {1e3});
  return wall;
}
} // namespace

TEST(Servo, ErrorOfAHeldSpecimenShrinksByOneMinusGainAStep)
{
  for (const double gain : {0.1, 0.5, 0.9})
  {
    Grains g; // a column: all of them touch the wall
    for (int i = 0; i < 8; ++i)
      g.add({0., static_cast<double>(i)}, 0.5, 1., 0);
    Wall wall = wall_at(g, {1., 0.});
    ASSERT_EQ(wall.contacts.size(), 8u);
    const double area = 7., pressure = 20., dt = 1e-3;
    double overshoot = 0.;
    for (int step = 0; step < 60; ++step)
    {
      add_wall_forces(g, wall);
      const double error = 1. - wall.reaction / (pressure * area);
      // All contacts press from the first step on, and before it all are counted.
      EXPECT_NEAR(error, std::pow(1. - gain, step), 1e-12) << gain << ' ' << step;
      overshoot = std::max(overshoot, -error);
      wall.displacement += dt * servo_speed(wall, area, pressure, gain, 1e9, dt);
    }
    EXPECT_LT(overshoot, 1e-12);
  }
}

TEST(Servo, NeverExceedsItsSpeedLimit)
{
  Grains g = lattice(1, 4);
  Wall wall = wall_at(g, {1., 0.});
  add_wall_forces(g, wall);
  EXPECT_EQ(servo_speed(wall, 1., 1e6, 0.5, 0.3, 1e-3), 0.3);
  wall.displacement = 0.1;
  add_wall_forces(g, wall);
  EXPECT_EQ(servo_speed(wall, 1., 0., 0.5, 0.3, 1e-3), -0.3);
}

// 10 MPa on a rock of 50 GPa is 2e-4 of the modulus: 0.2 in the units of the samples.
TEST(Servo, HoldsItsPressureThroughElasticLoadingWithoutOvershoot)
{
  const Threads threads(1);
  const double pressure = 0.2, gain = 0.5;
  Sample sample;
  sample.grains = random_pack(10, 20, 31);
  bond_all(sample, strong_law());
  ExplicitRun run(sample);
  Grains &g = run.sample.grains;
  run.damping.coefficient = 0.7;
  run.walls = {wall_at(g, {1., 0.}), wall_at(g, {-1., 0.}), wall_at(g, {0., 1.}),
               wall_at(g, {0., -1.})};
  const auto span = [&](const int a, const int b)
  {
    return -dot(run.walls[a].point, run.walls[a].normal) -
           dot(run.walls[b].point, run.walls[b].normal);
  };
  const double height = span(2, 3), width = span(0, 1);
  std::vector<double> springs(g.size(), 0.);
  for (const Wall &wall : run.walls)
    for (const WallContact &contact : wall.contacts)
      springs[contact.grain] += contact.stiffness;
  const double dt = 0.2 * stable_step(g, run.sample.joints, springs);
  // An axial wave through the specimen, within 10 %: E' / rho of the pack are 1.6e3 /
  // 0.9.
  const double transit = height / 42.;
  const double fastest = 0.05; // of the walls

  const auto servo = [&](const int wall, const double area, const double wanted)
  {
    run.walls[wall].velocity =
        servo_speed(run.walls[wall], area, wanted, gain, fastest, dt);
  };
  double overshoot = 0., off = 0., first = 0.;
  const double settled = 20. * transit, loaded = 60. * transit;
  while (run.time < loaded)
  {
    run.first_half(dt);
    const bool loading = run.time > settled;
    for (const int side : {0, 1})
    {
      const double measured = run.walls[side].reaction / height / pressure;
      overshoot = std::max(overshoot, measured - 1.);
      if (loading)
        off = std::max(off, std::abs(measured - 1.));
      servo(side, height, pressure); // asked for at once: a step
    }
    for (const int end : {2, 3})
      if (loading) // shortened by 1e-3 in all, five times the strain of the confinement
        run.walls[end].velocity = 5e-4 * height / (loaded - settled) *
                                  std::min(1., (run.time - settled) / (5. * transit));
      else
        servo(end, width, pressure);
    if (!loading)
      first = 0.5 * (run.walls[2].reaction + run.walls[3].reaction) / width;
    run.second_half(dt);
  }
  const double last = 0.5 * (run.walls[2].reaction + run.walls[3].reaction) / width;
  EXPECT_NEAR(first / pressure, 1., 0.005);
  EXPECT_GT(last, 4. * pressure); // it has been loaded
  EXPECT_LT(overshoot, 0.05);
  EXPECT_LT(off, 0.005);
  std::printf("overshoot %.3g, off by %.3g in loading, axial %.3g\n", overshoot, off,
              last / pressure);
}
} // namespace antiform::discrete::test::servo_tests

#include "discrete/walls.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::walls_tests
{
namespace
{
/// A floor at y = 0 below a row of disks: overlapping, touching, a gap that is taken as
/// installed, one that is not, and one out of reach.
struct RowOnFloor
{
  Grains grains;
  Wall floor;
  RowOnFloor()
  {
    int column = 0;
    for (const double gap : {-0.02, 0., 0.03, 0.08, 2.})
      grains.add({1.5 * column++, 0.5 + gap}, 0.5, 1., 0);
    floor.normal = {0., 1.};
    install_wall_contacts(grains, floor, 0.5, 0.05, {1e3});
  }
  void evaluate()
  {
    grains.force_x.assign(grains.size(), 0.);
    grains.force_y.assign(grains.size(), 0.);
    add_wall_forces(grains, floor);
  }
};
} // namespace

TEST(Wall, HoldsTheGrainsInReachFreeOfStress)
{
  RowOnFloor row;
  ASSERT_EQ(row.floor.contacts.size(), 4u);
  row.evaluate();
  EXPECT_EQ(row.floor.reaction, 0.);
  EXPECT_EQ(wall_energy(row.grains, row.floor), 0.);
  for (std::size_t i = 0; i < row.grains.size(); ++i)
    EXPECT_EQ(row.grains.force_y[i], 0.);
}

TEST(Wall, PushesFromTheInstalledGapOrFromContact)
{
  RowOnFloor row;
  row.floor.displacement = 0.1;
  row.evaluate();
  // k_n = 2 E* = 2000; the fourth grain was 0.08 away and not installed. Round-off of a
  // difference of numbers of the grain's size.
  const double expected[] = {200., 200., 200., 40., 0.};
  for (std::size_t i = 0; i < row.grains.size(); ++i)
    EXPECT_NEAR(row.grains.force_y[i], expected[i], 1e-11) << i;
  EXPECT_NEAR(wall_energy(row.grains, row.floor), 3. * 10. + 0.4, 1e-11);
}

TEST(Wall, GivesNoTensionAndNoShear)
{
  RowOnFloor row;
  row.floor.displacement = -0.1;
  row.evaluate();
  EXPECT_EQ(row.floor.reaction, 0.);
  row.floor.displacement = 0.05;
  for (double &x : row.grains.displacement_x)
    x = 0.3;
  row.grains.torque.assign(row.grains.size(), 0.);
  row.evaluate();
  EXPECT_GT(row.floor.reaction, 0.);
  for (std::size_t i = 0; i < row.grains.size(); ++i)
  {
    EXPECT_EQ(row.grains.force_x[i], 0.);
    EXPECT_EQ(row.grains.torque[i], 0.);
  }
}

TEST(Wall, ReactionIsTheSumOfItsWeightedContactForces)
{
  RowOnFloor row;
  row.floor.normal = {std::sin(0.3), std::cos(0.3)}; // an inclined wall as well
  install_wall_contacts(row.grains, row.floor, 10., 10., {1e3});
  for (std::size_t c = 0; c < row.floor.contacts.size(); ++c)
    row.floor.contacts[c].weight = 1. / static_cast<double>(c + 1);
  row.floor.displacement = 0.02;
  row.evaluate();
  double along = 0., across = 0.;
  for (std::size_t i = 0; i < row.grains.size(); ++i)
  {
    const Vec2 force{row.grains.force_x[i], row.grains.force_y[i]};
    along += dot(force, row.floor.normal);
    across += dot(force, perpendicular(row.floor.normal));
  }
  const double harmonic = 1. + 1. / 2. + 1. / 3. + 1. / 4. + 1. / 5.;
  EXPECT_NEAR(row.floor.reaction, 2000. * 0.02 * harmonic, 1e-11); // round-off
  EXPECT_NEAR(along, row.floor.reaction, 1e-12 * row.floor.reaction);
  EXPECT_NEAR(across, 0., 1e-12 * row.floor.reaction);
}

TEST(Wall, PrestressPushesBeforeAnythingMoves)
{
  RowOnFloor row;
  row.floor.contacts[1].initial_gap = -0.01;
  row.evaluate();
  EXPECT_DOUBLE_EQ(row.floor.reaction, 20.);
  EXPECT_DOUBLE_EQ(row.grains.force_y[1], 20.);
}

TEST(Wall, WorkOfASlowPushIsTheEnergyOfTheSpring)
{
  // One grain held fast, the wall presses on it: work is the elastic energy exactly,
  // since the force is linear and the trapezoidal rule exact.
  Sample sample;
  sample.grains.add({0., 0.5}, 0.5, 1., 0);
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(1);
  hold(sample.grains, 0);
  ExplicitRun run(sample);
  Wall floor;
  floor.normal = {0., 1.};
  floor.velocity = 0.01;
  install_wall_contacts(run.sample.grains, floor, 0.1, 0.1, {1e3});
  run.walls.push_back(floor);
  for (int i = 0; i < 100; ++i)
    run.advance(0.01);
  run.first_half(0.01);
  EXPECT_NEAR(run.walls[0].displacement, 0.01, 1e-15);
  EXPECT_NEAR(run.walls[0].work, 0.5 * 2000. * 1e-4, 1e-13); // round-off
  EXPECT_NEAR(run.energies().strain, run.walls[0].work, 1e-13);
}

TEST(Walls, HoldGrainsThatComeToThemLater)
{
  Grains grains;
  grains.add({0.5, 0.}, 0.5, 1., 0); // at the wall
  grains.add({2., 3.}, 0.5, 1., 0);  // a diameter and a half away
  grains.add({0.45, 5.}, 0.5, 1., 0);
  Wall wall;
  wall.normal = {1., 0.};
  install_wall_contacts(grains, wall, 0.2, 0.3, {1e3});
  ASSERT_EQ(wall.contacts.size(), 2u);
  find_wall_contacts(grains, wall, 0.2, {1e3});
  EXPECT_EQ(wall.contacts.size(), 2u); // nothing has come nearer

  grains.displacement_x[1] = -1.4;
  find_wall_contacts(grains, wall, 0.2, {1e3});
  ASSERT_EQ(wall.contacts.size(), 3u);
  EXPECT_EQ(wall.contacts[1].grain, 1); // in the order of grains
  EXPECT_TRUE(wall.contacts[1].late);
  EXPECT_FALSE(wall.contacts[2].late);
  add_wall_forces(grains, wall);
  EXPECT_EQ(grains.force_x[1], 0.); // 0.1 away

  grains.displacement_x[1] = -1.52; // 0.02 into the wall: 2 E* times that
  add_wall_forces(grains, wall);
  EXPECT_NEAR(grains.force_x[1], 2e3 * 0.02, 1e-9);
  EXPECT_EQ(grains.force_x[2], 0.); // its overlap was there when the wall was made
}
} // namespace antiform::discrete::test::walls_tests

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

namespace
{
/// Grains above each other at a wall along y that turns about the origin, at rest.
struct ColumnAtTurningWall
{
  Grains grains;
  Wall wall;
  /// \param side of the wall on which the grains are, 1 or -1 along x
  explicit ColumnAtTurningWall(const double side)
  {
    for (const double y : {-2., -1., 0., 1., 2.})
      grains.add({0.5 * side, y}, 0.5, 1., 0);
    wall.normal = {side, 0.};
    wall.turn.emplace();
    install_wall_contacts(grains, wall, 0.1, 0.1, {1e3});
  }
  void evaluate(const double rotation)
  {
    wall.turn->rotation = rotation;
    grains.force_x.assign(grains.size(), 0.);
    grains.force_y.assign(grains.size(), 0.);
    add_wall_forces(grains, wall);
  }
  double energy(const double rotation)
  {
    wall.turn->rotation = rotation;
    return wall_energy(grains, wall);
  }
};
} // namespace

TEST(TurningWall, PressesOneSideAndLeavesTheOther)
{
  ColumnAtTurningWall left(1.);
  constexpr double rotation = 0.01, k = 2000.;
  left.evaluate(rotation); // counter-clockwise: the upper end goes away
  const double way = std::sin(rotation), expected[] = {2. * k * way, k * way, 0., 0., 0.};
  for (std::size_t i = 0; i < left.grains.size(); ++i)
  {
    EXPECT_NEAR(left.grains.force_x[i], expected[i], 1e-10) << i; // of round-off
    EXPECT_EQ(left.grains.force_y[i], 0.) << i;
  }
  EXPECT_NEAR(left.wall.reaction, 3. * k * way, 1e-10);
  // Levers 2 and 1 below the point: the push turns the grains counter-clockwise too.
  EXPECT_NEAR(left.wall.turn->moment, (4. + 1.) * k * way * std::cos(rotation), 1e-10);
}

TEST(TurningWall, PushesAsItsEnergyFalls)
{
  ColumnAtTurningWall left(1.);
  left.wall.displacement = 0.005; // so that some contacts above press too
  for (std::size_t i = 0; i < left.grains.size(); ++i)
    left.grains.displacement_x[i] = 1e-3 * std::sin(1. + static_cast<double>(i));
  for (const double rotation : {-0.02, 0.003, 0.2})
  {
    left.evaluate(rotation);
    constexpr double step = 1e-6; // the energy is smooth to the second order
    const double moment =
        (left.energy(rotation + step) - left.energy(rotation - step)) / (2. * step);
    EXPECT_NEAR(left.wall.turn->moment / moment, 1., 1e-6) << rotation;
    left.evaluate(rotation);
    for (std::size_t i = 0; i < left.grains.size(); ++i)
    {
      double &x = left.grains.displacement_x[i];
      const double here = x, force = left.grains.force_x[i];
      x = here + step;
      const double ahead = wall_energy(left.grains, left.wall);
      x = here - step;
      const double behind = wall_energy(left.grains, left.wall);
      x = here;
      EXPECT_NEAR(force, -(ahead - behind) / (2. * step), 1e-6 * left.wall.reaction);
    }
  }
}

TEST(TurningWall, OfTheOtherSideIsItsMirrorImage)
{
  ColumnAtTurningWall left(1.), right(-1.);
  left.evaluate(pressing_sense(left.wall) * 0.01);
  right.evaluate(pressing_sense(right.wall) * 0.01);
  EXPECT_EQ(right.wall.reaction, left.wall.reaction);
  EXPECT_EQ(right.wall.turn->moment, -left.wall.turn->moment);
  for (std::size_t i = 0; i < left.grains.size(); ++i)
    EXPECT_EQ(right.grains.force_x[i], -left.grains.force_x[i]);
}

TEST(TurningWall, FindsGrainsWhereItHasTurnedTo)
{
  ColumnAtTurningWall left(1.);
  const std::size_t held = left.wall.contacts.size();
  left.grains.add({0.7, -3.}, 0.5, 1., 0); // 0.2 away, out of reach at first
  left.grains.add({0.7, 3.}, 0.5, 1., 0);
  for (auto *v : {&left.grains.displacement_x, &left.grains.displacement_y,
                  &left.grains.force_x, &left.grains.force_y, &left.grains.torque})
    v->assign(left.grains.size(), 0.);
  left.wall.turn->rotation = 0.05; // 0.15 towards the lower one
  find_wall_contacts(left.grains, left.wall, 0.1, {1e3});
  ASSERT_EQ(left.wall.contacts.size(), held + 1);
  EXPECT_EQ(left.wall.contacts.back().grain, 5);
}
} // namespace antiform::discrete::test::walls_tests

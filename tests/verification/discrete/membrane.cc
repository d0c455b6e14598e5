// Case 20: a membrane around grains is a self-equilibrated follower load, and a body in
// it has its pressure inside.
#include "discrete/measurement_circles.h"
#include "discrete/membrane.h"
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace antiform::discrete::test::membrane_tests
{
namespace
{
Membrane around(const Grains &grains, const double reach)
{
  Membrane membrane;
  membrane.ring = outer_ring(grains, reach);
  membrane.loaded.assign(membrane.ring.size(), 1);
  return membrane;
}
} // namespace

TEST(Membrane, RingOfALatticeIsItsOutline)
{
  const Grains grains = lattice(8, 7);
  const Membrane membrane = around(grains, 0.8);
  std::set<std::int32_t> outline;
  for (int r = 0; r < 7; ++r)
    for (int c = 0; c < 8; ++c)
      if (r == 0 || r == 6 || c == 0 || c == 7)
        outline.insert(8 * r + c);
  EXPECT_EQ(std::set<std::int32_t>(membrane.ring.begin(), membrane.ring.end()), outline);
  EXPECT_EQ(membrane.ring.size(), outline.size());
  // Counter-clockwise: six rows of trapezoids of two rows of 8.
  EXPECT_NEAR(enclosed_area(grains, membrane), 6. * 7. * std::sqrt(3.) / 2., 1e-12);
  // The same ring whatever the numbers of the grains.
  Grains reversed;
  for (std::size_t i = grains.size(); i-- > 0;)
    reversed.add(grains.reference(i), 0.5, 1., 0);
  EXPECT_NEAR(enclosed_area(reversed, around(reversed, 0.8)),
              enclosed_area(grains, membrane), 1e-12);
}

TEST(Membrane, LeavesOutWhatHasComeOffAndFollowsNotches)
{
  Grains grains = lattice(8, 7);
  grains.add({-5., 3.}, 0.5, 1., 0); // a chip on its way
  const Membrane whole = around(grains, 0.8);
  EXPECT_EQ(std::count(whole.ring.begin(), whole.ring.end(), 56), 0);
  // Without grain 4 of the top row the ball gets into the notch, a large one does not.
  Grains notched;
  for (std::size_t i = 0; i < 56; ++i)
    if (i != 52)
      notched.add(grains.reference(i), 0.5, 1., 0);
  EXPECT_LT(enclosed_area(notched, around(notched, 0.8)),
            enclosed_area(grains, whole) - 0.8);
  const Grains lattice_again = lattice(8, 7);
  EXPECT_NEAR(enclosed_area(notched, around(notched, 3.)),
              enclosed_area(lattice_again, around(lattice_again, 3.)), 1e-12);
  EXPECT_THROW(outer_ring(grains, 0.1), std::invalid_argument);
}

TEST(Membrane, ClosedRingIsInEquilibriumWithItself)
{
  for (const std::uint64_t seed : {1u, 2u, 3u})
  {
    Grains grains = random_pack(9, 8, seed);
    const Membrane membrane = around(grains, 1.2);
    add_membrane_forces(grains, membrane, 10.);
    double x = 0., y = 0., moment = 0., size = 0.;
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const Vec2 force{grains.force_x[i], grains.force_y[i]};
      x += force.x;
      y += force.y;
      moment += cross(grains.position(i), force);
      size += norm(force);
    }
    EXPECT_GT(size, 100.);
    EXPECT_NEAR(x / size, 0., 1e-12);
    EXPECT_NEAR(y / size, 0., 1e-12);
    EXPECT_NEAR(moment / size, 0., 1e-12);
  }
}

TEST(Membrane, ItsPowerIsPressureTimesTheLossOfArea)
{
  Grains grains = random_pack(9, 8, 4);
  const Membrane membrane = around(grains, 1.2);
  shake(grains, 0.3, 0., 5);
  const double power = membrane_power(grains, membrane, 10.);
  constexpr double h = 1e-6;
  const auto area_after = [&](const double dt)
  {
    Grains moved = grains;
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      moved.displacement_x[i] += dt * grains.velocity_x[i];
      moved.displacement_y[i] += dt * grains.velocity_y[i];
    }
    return enclosed_area(moved, membrane);
  };
  EXPECT_NEAR(power, -10. * (area_after(h) - area_after(-h)) / (2. * h),
              1e-6 * std::abs(power));
  EXPECT_DOUBLE_EQ(power, add_membrane_forces(grains, membrane, 10.));
}

TEST(Membrane, BodyInAClosedRingHasItsPressure)
{
  Sample sample;
  sample.grains = random_pack(24, 24, 8);
  bond_all(sample, strong_law(), 0.5); // none is loose
  ExplicitRun run(std::move(sample));
  Grains &grains = run.sample.grains;
  const Membrane membrane = around(grains, 1.2);
  const double dt = 0.8 * stable_step(grains, run.sample.joints), pressure = 1.;
  run.damping.coefficient = 0.7;
  run.damping.start(grains.size());
  for (int n = 0; n < 6000; ++n)
  {
    run.add_forces(dt);
    add_membrane_forces(grains, membrane, pressure * std::min(1., n / 2000.));
    damped_kick(grains, dt, run.damping);
    drift(grains, dt);
    ++run.step;
    run.time += dt;
  }
  run.add_forces(dt);
  // Sum over joints of the branch times the force, over the area in the membrane.
  double xx = 0., yy = 0., xy = 0.;
  const Joints &joints = run.sample.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const Vec2 branch =
        grains.position(joints.second[j]) - grains.position(joints.first[j]);
    xx -= branch.x * joints.force[j].x;
    yy -= branch.y * joints.force[j].y;
    xy -= 0.5 * (branch.x * joints.force[j].y + branch.y * joints.force[j].x);
  }
  const double area = enclosed_area(grains, membrane);
  EXPECT_NEAR(xx / area, -pressure, 0.01 * pressure);
  EXPECT_NEAR(yy / area, -pressure, 0.01 * pressure);
  EXPECT_NEAR(xy / area, 0., 0.01 * pressure);
}
} // namespace antiform::discrete::test::membrane_tests

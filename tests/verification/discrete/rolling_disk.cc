// A disk slides and rolls on a plane, level and inclined; a vibrating one feels the
// dashpots of its contact. Closed forms of a rigid disk with Coulomb friction.
#include "support/disk_on_plane.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::rolling_disk_tests
{
namespace
{
constexpr double g = 10., radius = 0.5, friction = 0.3;
// sqrt(3 k_s / m) = 4170 1/s: what the contact's shear spring holds back is mu g over
// that, 7e-4 m/s.
constexpr double stiffness = 1e7;
constexpr double dt = 2e-5; // 0.07 of a period over 2 pi

LinearContact rubbing()
{
  LinearContact law;
  law.friction = friction;
  return law;
}

/// In equilibrium under the normal part of gravity, at rest on a plane of slope
/// @p angle.
DiskOnPlane resting(const double angle, const LinearContact &law = rubbing())
{
  const double normal = g * std::cos(angle);
  DiskOnPlane test(radius, 1., -M_PI * radius * radius * normal / stiffness, law,
                   stiffness);
  test.run.gravity = {g * std::sin(angle), -normal};
  return test;
}

/// Acceleration down the slope and spin's share of it, from rest, between the times 0.1
/// and 0.3: the contact's shear spring has been stretched by then.
struct Acceleration
{
  double along, spin;
};
Acceleration acceleration(const double angle, const bool turns = true)
{
  DiskOnPlane test = resting(angle);
  Grains &grains = test.grains();
  if (!turns)
    grains.inverse_inertia[DiskOnPlane::disk] = 0.;
  const auto advance_to = [&](const double time)
  {
    while (test.run.time < time)
      test.run.advance(dt);
  };
  advance_to(0.1);
  const double v = grains.velocity_x[1], w = grains.spin[1], start = test.run.time;
  advance_to(0.3);
  const double span = test.run.time - start;
  return {(grains.velocity_x[1] - v) / span, (grains.spin[1] - w) / span};
}
} // namespace

TEST(SlidingDisk, RollsAfterVOverThreeMuGAtTwoThirdsOfItsSpeed)
{
  const double v0 = 1.;
  DiskOnPlane test = resting(0.);
  Grains &grains = test.grains();
  const double mass = grains.mass[1];
  grains.velocity_x[1] = v0;
  double stops = 0., slip = 0., sum_v = 0., sum_w = 0.;
  int n = 0;
  while (test.run.time < 0.25)
  {
    test.run.advance(dt);
    // The first step without slip; the spring, let go at the limit, swings back to it.
    if (stops == 0. && slip > 0. && test.contact().slip_energy == slip)
      stops = test.run.time;
    slip = test.contact().slip_energy;
    if (test.run.time > 0.15) // the shear spring swings on: mean over many periods
    {
      sum_v += grains.velocity_x[1];
      sum_w += grains.spin[1];
      ++n;
    }
  }
  // The shear spring swings by 1e-3 of the speed, and takes a period (1.5e-3 s) to fill.
  EXPECT_NEAR(stops / (v0 / (3. * friction * g)), 1., 1e-2);
  EXPECT_NEAR(sum_v / n / (2. / 3. * v0), 1., 2e-3);
  EXPECT_NEAR(sum_w / n / (-2. / 3. * v0 / radius), 1., 2e-3);
  // A third of the energy has gone into friction.
  EXPECT_NEAR(slip / (mass * v0 * v0 / 6.), 1., 1e-2);
}

TEST(DiskOnIncline, RollsBelowThreeTimesFrictionAndSlidesAbove)
{
  const double threshold = std::atan(3. * friction);
  for (const double share : {0.3, 0.9, 0.99})
  {
    const double angle = share * threshold;
    const Acceleration a = acceleration(angle);
    EXPECT_NEAR(a.along / (2. / 3. * g * std::sin(angle)), 1., 2e-3) << share;
    EXPECT_NEAR(a.spin / (-2. / 3. * g * std::sin(angle) / radius), 1., 2e-3) << share;
  }
  for (const double share : {1.01, 1.1, 1.6})
  {
    const double angle = share * threshold;
    const Acceleration a = acceleration(angle);
    const double rub = friction * g * std::cos(angle);
    EXPECT_NEAR(a.along / (g * std::sin(angle) - rub), 1., 2e-3) << share;
    EXPECT_NEAR(a.spin / (-2. * rub / radius), 1., 2e-3) << share;
  }
}

TEST(BlockOnIncline, StandsBelowTheFrictionAngleAndSlidesAbove)
{
  // A disk that may not turn.
  const double threshold = std::atan(friction);
  for (const double share : {0.5, 0.9}) // its spring swings by as much again
  {
    DiskOnPlane test = resting(share * threshold);
    test.grains().inverse_inertia[1] = 0.;
    test.run.damping.coefficient = 0.7;
    double creep = 0.;
    for (int i = 0; i < 20000; ++i)
    {
      test.run.advance(dt);
      if (i == 10000)
        creep = test.grains().displacement_x[1];
    }
    // At rest on the shear spring: m g sin / k_s, plus what slid at the first swing.
    EXPECT_LT(test.grains().displacement_x[1], 1e-5 * radius) << share;
    EXPECT_EQ(test.contact().shear_force < friction * test.contact().normal_force, true);
    EXPECT_NEAR(test.grains().displacement_x[1] - creep, 0., 1e-9 * radius) << share;
  }
  for (const double share : {1.05, 1.5, 3.})
  {
    const double angle = share * threshold;
    const double exact = g * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(acceleration(angle, false).along / exact, 1., 5e-3) << share;
  }
}

namespace
{
/// Successive extremes of a decaying oscillation and the time between them.
struct Decay
{
  double ratio = 0., half_period = 0.;
};
/// The disk sits on the plane and is knocked along the normal, or along the plane: its
/// contact, never open and never sliding, is a spring beside a dashpot.
Decay knocked(const double beta, const bool along_normal)
{
  LinearContact law = rubbing();
  law.friction = 10.;
  (along_normal ? law.normal_dashpot : law.shear_dashpot) = beta;
  DiskOnPlane test = resting(0., law);
  Grains &grains = test.grains();
  if (!along_normal)
    grains.inverse_inertia[1] = 0.;
  const double rest = grains.position(1).y;
  std::vector<double> &velocity = along_normal ? grains.velocity_y : grains.velocity_x;
  velocity[1] = 1e-3; // a third of what would open the contact
  const double step = 0.1 * dt;
  // Where the first step has led to: its shear is in the spring at the first evaluation.
  (along_normal ? grains.displacement_y : grains.displacement_x)[1] = step * velocity[1];
  std::vector<double> extreme, when;
  double last = velocity[1];
  while (extreme.size() < 4)
  {
    test.run.advance(step);
    const double v = velocity[1];
    if (last * v < 0.) // turned between the last two half steps
    {
      extreme.push_back(std::abs(along_normal ? grains.position(1).y - rest
                                              : grains.displacement_x[1]));
      when.push_back(test.run.time - step * (0.5 + v / (v - last)));
    }
    last = v;
  }
  return {std::cbrt(extreme[3] / extreme[0]), (when[3] - when[0]) / 3.};
}
} // namespace

TEST(ViscoElasticPair, DecaysAsADampedOscillatorInBothDirections)
{
  const double mass = M_PI * radius * radius;
  for (const bool along_normal : {true, false})
    for (const double beta : {0.05, 0.1, 0.2})
    {
      const Decay decay = knocked(beta, along_normal);
      const double damped = std::sqrt(1. - beta * beta);
      const double omega = std::sqrt((along_normal ? stiffness : stiffness / 2.2) / mass);
      // The dashpot sees the velocity half a step late: omega dt / 2 = 4e-3 of its force
      // is an error of the frequency of beta omega dt / 2.
      EXPECT_NEAR(decay.half_period / (M_PI / (omega * damped)), 1., 2e-3)
          << beta << along_normal;
      EXPECT_NEAR(std::log(decay.ratio) / (-M_PI * beta / damped), 1., 1e-2)
          << beta << along_normal;
    }
}

TEST(ViscoElasticPair, CreepsUnderASuddenLoadAsKelvinsBody)
{
  // Overdamped, beta = 2: x = F/k (1 - (s2 e^(s1 t) - s1 e^(s2 t)) / (s2 - s1)),
  // s = -omega (beta -+ sqrt(beta^2 - 1)).
  LinearContact law = rubbing();
  law.normal_dashpot = 2.;
  DiskOnPlane test = resting(0., law);
  const double mass = test.grains().mass[1], omega = std::sqrt(stiffness / mass);
  const double extra = 2.; // of its weight, from now on
  test.run.gravity.y -= extra * g;
  const double step = 0.1 * dt;
  const double s1 = -omega * (2. - std::sqrt(3.)), s2 = -omega * (2. + std::sqrt(3.));
  const double rest = extra * mass * g / stiffness;
  double worst = 0.;
  for (int i = 1; i <= 15000; ++i)
  {
    test.run.advance(step);
    const double t = test.run.time;
    const double exact =
        rest * (1. - (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s2 - s1));
    worst = std::max(worst, std::abs(-test.grains().displacement_y[1] - exact));
  }
  EXPECT_NEAR(-test.grains().displacement_y[1] / rest, 1., 1e-3);
  EXPECT_LT(worst, 1e-2 * rest); // the dashpot's delay, 2 beta omega dt / 2 at first
}
} // namespace antiform::discrete::test::rolling_disk_tests

// Two disks meet head on (linear contact, without and with a dashpot), and the decrement
// of local damping: closed forms of a single oscillator.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::impact_tests
{
namespace
{
constexpr double k_n = 1e3; // E*, of equal disks of unit thickness

struct Impact
{
  double contact_time = 0.;     ///< both ends interpolated [s]
  double restitution = 0.;      ///< rebound over approach
  double energy_change = 0.;    ///< relative, of the whole impact
  double drift_afterwards = 0.; ///< of the kinetic energy in free flight, relative
};

/// Head-on impact of two disks of different mass at @p steps steps a contact time.
Impact impact(const int steps, const LinearContact &law, const double speed = 0.1)
{
  Sample sample;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.grains.add({1.001, 0.}, 0.5, 3., 0);
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(2);
  Grains &initial = sample.grains;
  initial.velocity_x = {speed, -0.25 * speed};
  const double reduced = 1. / (initial.inverse_mass[0] + initial.inverse_mass[1]);
  const double dt = M_PI * std::sqrt(reduced / k_n) / steps;

  ExplicitRun run(sample);
  run.has_contacts = true;
  run.contacts.margin = 0.2;
  run.contacts.groups.push_back({0, 0, law});
  const auto gap = [&]
  {
    return 1e-3 + run.sample.grains.displacement_x[1] -
           run.sample.grains.displacement_x[0];
  };
  Impact result;
  double start = 0., end = 0., last = gap(), first_kinetic = 0., kinetic = 0.;
  for (int i = 0; i < 3 * steps; ++i)
  {
    run.first_half(dt);
    if (i == 0)
      first_kinetic = run.energies().kinetic;
    run.second_half(dt);
    const double now = gap();
    if (last >= 0. && now < 0.)
      start = run.time - dt * now / (now - last);
    else if (last < 0. && now >= 0.)
      end = run.time - dt * now / (now - last);
    last = now;
    if (end > 0. && kinetic == 0. && run.time > end + 2. * dt)
    {
      run.first_half(dt);
      kinetic = run.energies().kinetic;
      run.second_half(dt);
    }
  }
  run.first_half(dt);
  const Grains &g = run.sample.grains;
  result.contact_time = end - start;
  result.restitution = (g.velocity_x[1] - g.velocity_x[0]) / (1.25 * speed);
  result.energy_change = kinetic / first_kinetic - 1.;
  result.drift_afterwards = run.energies().kinetic / kinetic - 1.;
  return result;
}

LinearContact elastic()
{
  LinearContact law;
  law.effective_modulus = k_n;
  return law;
}

/// Restitution of a contact that may not pull: it ends when spring and dashpot balance.
double restitution_without_tension(const double beta)
{
  // overlap x'' + 2 beta x' + x = 0, x(0) = 0, x'(0) = 1; ends at x = -2 beta x'.
  const double damped = std::sqrt(1. - beta * beta);
  const double phase = std::atan2(2. * beta * damped, 2. * beta * beta - 1.);
  const double t = phase / damped;
  return -std::exp(-beta * t) *
         (std::cos(damped * t) - beta / damped * std::sin(damped * t));
}
} // namespace

TEST(TwoDiskImpact, LastsHalfAPeriodAndRebounds)
{
  const Impact result = impact(50, elastic());
  Grains grains;
  grains.add({0., 0.}, 0.5, 1., 0);
  grains.add({0., 0.}, 0.5, 3., 0);
  const double reduced = 1. / (grains.inverse_mass[0] + grains.inverse_mass[1]);
  const double exact = M_PI * std::sqrt(reduced / k_n);
  // Leapfrog shortens the period by (w dt)^2/24 = 1.6e-4 at 50 steps a half period; the
  // step in which the contact closes adds as much.
  EXPECT_NEAR(result.contact_time / exact, 1., 1e-3);
  EXPECT_NEAR(result.restitution, 1., 1e-3);
  EXPECT_NEAR(result.drift_afterwards, 0., 1e-6); // free flight: round-off
}

TEST(TwoDiskImpact, EnergyErrorVanishesWithTheStep)
{
  // The force is continuous but not smooth when the contact closes: the error of a whole
  // impact is of second order, with a phase that depends on where in its step the contact
  // closes. Bounded by (w dt)^2 / 4 of the energy.
  for (const int steps : {50, 200, 800, 3200})
  {
    const double w_dt = M_PI / steps;
    EXPECT_NEAR(impact(steps, elastic()).energy_change, 0., 0.25 * w_dt * w_dt) << steps;
  }
  EXPECT_NEAR(impact(3200, elastic()).energy_change, 0., 1e-6);
}

TEST(DashpotImpact, RestitutionFollowsTheClosedForm)
{
  for (const double beta : {0.02, 0.1, 0.3, 0.6})
  {
    LinearContact law = elastic();
    law.normal_dashpot = beta;
    const double exact = std::exp(-M_PI * beta / std::sqrt(1. - beta * beta));
    // The dashpot sees the velocity half a step late: an error of the order of w dt,
    // here pi / 4000.
    EXPECT_NEAR(impact(4000, law).restitution / exact, 1., 5e-3) << beta;
  }
}

TEST(DashpotImpact, ReboundsALittleMoreWithoutTension)
{
  for (const double beta : {0.02, 0.1, 0.3, 0.6})
  {
    LinearContact law = elastic();
    law.normal_dashpot = beta;
    law.tension_in_dashpot = false;
    const double exact = restitution_without_tension(beta);
    EXPECT_GT(exact, std::exp(-M_PI * beta / std::sqrt(1. - beta * beta)));
    EXPECT_NEAR(impact(4000, law).restitution / exact, 1., 5e-3) << beta; // as above
  }
}

TEST(DashpotImpact, BooksWhatItDissipates)
{
  LinearContact law = elastic();
  law.normal_dashpot = 0.2;
  Sample sample;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.grains.add({1.001, 0.}, 0.5, 1., 0);
  sample.grains.velocity_x = {0.1, 0.};
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(2);
  ExplicitRun run(sample);
  run.has_contacts = true;
  run.contacts.margin = 0.2;
  run.contacts.groups.push_back({0, 0, law});
  const double dt = 2e-5;
  run.first_half(dt);
  const double initial = run.energies().kinetic;
  run.second_half(dt);
  for (int i = 0; i < 10000; ++i)
    run.advance(dt);
  run.first_half(dt);
  const EnergyTerms end = run.energies();
  EXPECT_GT(end.dashpot, 0.1 * initial);
  EXPECT_NEAR((end.kinetic + end.dashpot) / initial, 1., 2e-3); // first order in w dt
}

namespace
{
/// A grain on a bond to another, pulled out along the bond and let go, damped: successive
/// extremes of their distance and the time between them. The other grain is held, or both
/// drift along at a speed that no vibration turns.
struct Decrement
{
  double ratio = 0., half_period = 0.;
};
Decrement
decrement(const double alpha, const bool combined = false, const bool drift = false)
{
  Sample pair = bonded_pair(strong_law());
  pair.grains.displacement_x[1] = 1e-4;
  const double omega = std::sqrt((drift ? 2. : 1.) * k_n / pair.grains.mass[1]);
  const double dt = 2. * M_PI / omega / 20000.;
  if (drift)
    pair.grains.velocity_x = {20. * 1e-4 * omega, 20. * 1e-4 * omega};
  else
    hold(pair.grains, 0);
  ExplicitRun run(pair);
  run.damping.coefficient = alpha;
  run.damping.combined = combined;
  const Grains &grains = run.sample.grains;
  std::vector<double> extreme{1e-4}, when{0.};
  double last = 0.;
  while (extreme.size() < 4)
  {
    run.advance(dt);
    const double v = grains.velocity_x[1] - grains.velocity_x[0];
    if (last * v < 0.) // turned between the last two half steps
    {
      extreme.push_back(std::abs(grains.displacement_x[1] - grains.displacement_x[0]));
      when.push_back(run.time - dt * (0.5 + v / (v - last)));
    }
    last = v;
  }
  return {std::cbrt(extreme[3] / extreme[0]), (when[3] - when[0]) / 3.};
}
} // namespace

TEST(LocalDamping, DecrementIsThatOfTheClosedForm)
{
  // The damping force turns its sign up to one step late: an error of the order of
  // w dt = 3e-4 a half cycle.
  EXPECT_NEAR(decrement(0.1).ratio, 0.9045, 1e-3 * 0.9045);
  EXPECT_NEAR(decrement(0.5).ratio, 0.57735, 1e-3 * 0.57735);
  EXPECT_NEAR(decrement(0.7).ratio, 0.42008, 1e-3 * 0.42008);
}

TEST(LocalDamping, HalfPeriodIsThatOfTheClosedForm)
{
  Grains grains;
  grains.add({0., 0.}, 0.5, 1., 0);
  const double omega = std::sqrt(k_n / grains.mass[0]);
  for (const double alpha : {0., 0.1, 0.5, 0.7})
  {
    const double exact =
        0.5 * M_PI / omega * (1. / std::sqrt(1. - alpha) + 1. / std::sqrt(1. + alpha));
    EXPECT_NEAR(decrement(alpha).half_period / exact, 1., 1e-3) << alpha; // as above
  }
}

// sgn(v) is that of the drift: the two grains' damping forces are equal and the distance
// between them does not feel them. Hence combined damping.
TEST(LocalDamping, LeavesAVibrationOnADriftAlone)
{
  EXPECT_NEAR(decrement(0.7, false, true).ratio, 1., 1e-3);
}

TEST(CombinedDamping, IsLocalDampingAboutAPlaceOfRest)
{
  EXPECT_NEAR(decrement(0.1, true).ratio, 0.9045, 1e-3 * 0.9045); // as above
  EXPECT_NEAR(decrement(0.7, true).ratio, 0.42008, 1e-3 * 0.42008);
}

TEST(CombinedDamping, DampsAVibrationOnADriftByHalfTheCoefficient)
{
  // Of the two grains one is damped, the one whose force falls: -alpha |r| of 2 |r| that
  // change the distance.
  for (const double alpha : {0.1, 0.7})
  {
    const double exact = std::sqrt((1. - 0.5 * alpha) / (1. + 0.5 * alpha));
    EXPECT_NEAR(decrement(alpha, true, true).ratio / exact, 1., 1e-3) << alpha;
  }
}

TEST(LocalDamping, LeavesAGrainWithoutForceAlone)
{
  Sample sample;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(1);
  sample.grains.velocity_x[0] = 1.;
  ExplicitRun run(sample);
  run.damping.coefficient = 0.7;
  for (int i = 0; i < 10; ++i)
    run.advance(0.1);
  EXPECT_EQ(run.sample.grains.velocity_x[0], 1.);
}
} // namespace antiform::discrete::test::impact_tests

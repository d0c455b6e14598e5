// The benchmark of Chung & Ooi (2011) at particle impact level, tests 1, 3 and 4. Their
// figures are those of spheres on Hertz's law with Mindlin's shear; a disk has a moment
// of inertia of m R^2 / 2 instead of 2/5, and its contact is a linear spring, so the
// curves cannot be theirs. Material, size, speeds, angles, friction and restitution are;
// the expected values are the closed forms of the linear disk. The duration of a contact
// with linear springs does not depend on the speed, and none of the rebounds on the
// stiffness.
#include "support/disk_on_plane.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::oblique_impact_tests
{
namespace
{
// Aluminium oxide, tests 3 and 4.
constexpr double radius = 2.5e-3, density = 4000., speed = 3.9;
constexpr double overlap = 1e-3 * radius; // at the deepest: the arm is R within 1e-3
constexpr double omega = speed / overlap; // sqrt(k_n / m)
constexpr double kappa = 2.2;

/// What the plane leaves of a disk that came with unit speed at @p angle from the normal.
struct Rebound
{
  double normal, tangential, surface; ///< v / speed; surface: R spin / speed
};
Rebound rebound(const double angle, const LinearContact &law, const int steps)
{
  const double mass = density * M_PI * radius * radius;
  DiskOnPlane test(radius, density, 1e-3 * overlap, law, mass * omega * omega);
  Grains &grains = test.grains();
  grains.velocity_x[1] = speed * std::sin(angle);
  grains.velocity_y[1] = -speed * std::cos(angle);
  const double dt = M_PI / omega / steps;
  bool touched = false;
  while (!touched || test.contact().normal_force > 0.)
  {
    test.run.advance(dt);
    touched = touched || test.contact().normal_force > 0.;
  }
  return {grains.velocity_y[1] / speed, grains.velocity_x[1] / speed,
          radius * grains.spin[1] / speed};
}

/// The rebound of a rigid disk on springs, by pieces: the linear specialisation of Maw,
/// Barber & Fawcett (1976). With tau = sqrt(k_n/m) t, w = (tangential speed of the
/// contact point) / (mu v_n), f = (shear force) / (mu times the largest normal force):
///   w' = -3 f;   stick: f' = w / kappa;   slip: f = +- sin(tau).
/// \return w after the impact for the w before it
double normalised_rebound(const double incident)
{
  const double turn = std::sqrt(3. / kappa); // frequency while it sticks
  double tau = 0., w = incident, f = 0.;
  bool slips = std::abs(w) > kappa;
  double sign = w > 0. ? 1. : -1.;
  constexpr int n_scan = 20000;
  const double scan = M_PI / n_scan;
  while (tau < M_PI - 1e-12)
  {
    const double tau0 = tau, w0 = w, f0 = f;
    const auto speed_at = [&](const double at)
    {
      return slips ? w0 - 3. * sign * (std::cos(tau0) - std::cos(at))
                   : w0 * std::cos(turn * (at - tau0)) -
                         kappa * turn * f0 * std::sin(turn * (at - tau0));
    };
    const auto force_at = [&](const double at)
    {
      return slips ? sign * std::sin(at)
                   : f0 * std::cos(turn * (at - tau0)) +
                         w0 / (kappa * turn) * std::sin(turn * (at - tau0));
    };
    // The phase ends where this becomes negative.
    const auto margin = [&](const double at)
    {
      return slips ? sign * speed_at(at) - kappa * std::cos(at)
                   : std::sin(at) - std::abs(force_at(at));
    };
    double low = tau0 + 1e-6, high = low; // the margin is zero where a phase begins
    while (high < M_PI && margin(high) >= 0.)
    {
      low = high;
      high = std::min(high + scan, M_PI);
    }
    for (int i = 0; i < 60 && margin(high) < 0.; ++i)
    {
      const double middle = 0.5 * (low + high);
      (margin(middle) >= 0. ? low : high) = middle;
    }
    tau = high;
    w = speed_at(tau);
    f = force_at(tau);
    slips = !slips;
    sign = f > 0. ? 1. : -1.;
  }
  return w;
}
} // namespace

TEST(ObliqueImpactReference, HasItsClosedFormsAtBothEnds)
{
  // Gross sliding from beginning to end: the friction impulse is mu times the normal one.
  for (const double incident : {std::max(kappa, 6. - kappa) + 1e-6, 5., 30.})
    EXPECT_NEAR(normalised_rebound(incident), incident - 6., 1e-9);
  // Near the normal it sticks: half a period of the normal spring is turn / 2 of one of
  // the shear spring, whatever the size. It slides at the end only, for a time of the
  // order of the incident angle.
  const double small = 1e-6;
  EXPECT_NEAR(normalised_rebound(small) / small, std::cos(M_PI * std::sqrt(3. / kappa)),
              1e-3);
}

// Test 1: elastic normal impact of two identical bodies (glass, 10 m/s).
TEST(ChungOoi1, ForceOfTwoDisksIsAHalfSine)
{
  Sample sample;
  const double r = 0.01, v = 10., stiffness = 4.8e10;
  sample.grains.add({0., 0.}, r, 2800., 0);
  sample.grains.add({2. * r, 0.}, r, 2800., 0);
  sample.grains.velocity_x = {v, -v};
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(2);
  const double reduced = 0.5 * sample.grains.mass[0];
  const double w = std::sqrt(stiffness / reduced), dt = M_PI / w / 400.;
  ExplicitRun run(sample);
  LinearContact law;
  law.effective_modulus = stiffness; // of equal disks
  run.has_contacts = true;
  run.contacts.margin = 0.1 * r;
  run.contacts.groups.push_back({0, 0, law});
  const double largest = 2. * v * std::sqrt(stiffness * reduced);
  double worst = 0., peak = 0., last_touch = 0.;
  for (int i = 0; i < 450; ++i)
  {
    run.first_half(dt);
    const double force = run.contacts.contacts.at(0).normal_force;
    // The velocities given are those of time zero; leapfrog takes them half a step back.
    const double t = run.time;
    worst = std::max(worst, std::abs(force - std::max(0., largest * std::sin(w * t))));
    peak = std::max(peak, force);
    if (force > 0.)
      last_touch = t;
    run.second_half(dt);
  }
  EXPECT_LT(worst, 1e-2 * largest); // w dt = 8e-3: half a step of phase at most
  EXPECT_NEAR(peak / largest, 1., 1e-4);
  EXPECT_NEAR(last_touch * w / M_PI, 1., 5e-3);
}

// Test 3: a body falls normally on a rigid plane; what it keeps is the restitution asked
// for, the dashpot being beta = -ln e / sqrt(pi^2 + ln^2 e).
TEST(ChungOoi3, RestitutionIsThatAskedFor)
{
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.})
  {
    LinearContact law;
    law.friction = 0.;
    law.normal_dashpot = -std::log(e) / std::hypot(M_PI, std::log(e));
    // With a dashpot the contact pulls at its end: until it opens, not until the force
    // vanishes, the closed form holds. The delay of half a step is an error of w dt.
    EXPECT_NEAR(rebound(0., law, 4000).normal / e, 1., 5e-3) << e;
  }
}

// Test 4: oblique impacts on a rigid plane at one speed, from near-normal to grazing.
TEST(ChungOoi4, ObliqueReboundsFollowMawBarberAndFawcett)
{
  const double mu = 0.092;
  LinearContact law;
  law.stiffness_ratio = kappa;
  law.friction = mu;
  bool slid_throughout = false, reversed = false;
  for (const double degrees : {5., 10., 15., 20., 25., 30., 40., 50., 60., 70., 80., 85.})
  {
    const double angle = degrees * M_PI / 180., incident = std::tan(angle) / mu;
    const double after = normalised_rebound(incident);
    // The friction impulse, over m times the speed.
    const double impulse = mu * std::cos(angle) * (incident - after) / 3.;
    const Rebound result = rebound(angle, law, 2000);
    // Overlap takes 1e-3 of the arm; events within a step of pi/2000: first order.
    EXPECT_NEAR(result.normal, std::cos(angle), 1e-3) << degrees;
    EXPECT_NEAR(result.tangential, std::sin(angle) - impulse, 1e-3 * mu) << degrees;
    EXPECT_NEAR(result.surface, -2. * impulse, 3e-3 * mu) << degrees;
    // Speed of the contact point: the abscissa and ordinate of Maw's figure.
    EXPECT_NEAR((result.tangential + result.surface) / (mu * std::cos(angle)), after,
                1e-2)
        << degrees;
    slid_throughout = slid_throughout || incident > 6. - kappa;
    reversed = reversed || after < 0.;
  }
  EXPECT_TRUE(slid_throughout && reversed); // every regime was met
}

TEST(ChungOoi4, GrazingImpactLosesTwiceTheNormalMomentumTimesFriction)
{
  // In the regime of gross sliding the tangential restitution is 1 - mu (1 + e) / tan,
  // here with the published e = 0.98.
  const double mu = 0.092, e = 0.98;
  LinearContact law;
  law.friction = mu;
  law.normal_dashpot = -std::log(e) / std::hypot(M_PI, std::log(e));
  law.tension_in_dashpot = true;
  for (const double degrees : {40., 60., 80.})
  {
    const double angle = degrees * M_PI / 180.;
    const Rebound result = rebound(angle, law, 2000);
    EXPECT_NEAR(result.normal, e * std::cos(angle), 1e-3);
    // Coulomb's limit is that of the spring alone: its impulse, with a dashpot beside
    // it, is (1 + e) less what the dashpot gave, 2 beta w times the way: nothing when the
    // way ends where it began.
    EXPECT_NEAR(result.tangential / std::sin(angle), 1. - mu * (1. + e) / std::tan(angle),
                1e-3)
        << degrees;
  }
}
} // namespace antiform::discrete::test::oblique_impact_tests

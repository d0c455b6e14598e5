// A joint of three elements that loses its outer one, along bending, compression and
// sliding paths, against a fibre section written here on its own.
#include "support/element_quadrature.h"
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace antiform::discrete::test::damage_path_tests
{
namespace
{
FlatJoint brittle_law(const int n = 3)
{
  FlatJoint law = strong_law(n);
  law.tensile_strength = 1.;
  law.residual_friction = 0.5;
  return law;
}

/// Section of elements without shear: bonded ones carry tension up to a mean stress.
class FibreSection
{
public:
  FibreSection(const double stiffness, const double half_length, const double strength)
      : k_(stiffness)
      , R_(half_length)
      , strength_(strength)
  {
  }
  std::pair<double, double> force_and_moment(const double gap, const double rotation)
  {
    double force = 0., moment = 0.;
    for (int e = 0; e < 3; ++e)
    {
      const double a = R_ * (2. * e - 3.) / 3., b = R_ * (2. * e - 1.) / 3.;
      if (bonded[e])
      {
        const double whole = element_by_quadrature(k_, gap, rotation, a, b, true).force;
        bonded[e] = whole / (b - a) < strength_;
      }
      const QuadratureResult r =
          element_by_quadrature(k_, gap, rotation, a, b, bonded[e]);
      force += r.force;
      moment += r.moment;
    }
    return {force, moment};
  }
  std::array<bool, 3> bonded{true, true, true};

private:
  double k_, R_, strength_;
};

struct Section
{
  Sample pair;
  FibreSection fibres;
  explicit Section(const double angle = 0.3)
      : pair(bonded_pair(brittle_law(), 0.5, 0.45, 0.02, angle))
      , fibres(pair.joints.stiffness[0], pair.joints.half_length[0], 1.)
  {
  }
  double k() const { return pair.joints.stiffness[0]; }
  double R() const { return pair.joints.half_length[0]; }

  /// Moment at the deformation; joint and fibres agree on it and on the force.
  double moment(const double gap, const double rotation)
  {
    const Resultants joint = load(pair, {gap, 0., rotation});
    const auto [force, moment] = fibres.force_and_moment(gap, rotation);
    const double scale = 2. * R(); // a mean stress of 1
    EXPECT_NEAR(joint.normal, force, 1e-9 * scale) << gap << ' ' << rotation;
    EXPECT_NEAR(joint.moment, moment, 1e-9 * scale * R()) << gap << ' ' << rotation;
    return joint.moment;
  }
};
} // namespace

TEST(DamagePath, MomentDropsFromThreeElementsToTwo)
{
  Section s;
  const double inertia = 2. * std::pow(s.R(), 3) / 3.;
  // Outer element: mean stress k theta 2R/3 = 1.
  const double at_break = 1.5 / (s.k() * s.R());
  const double before = s.moment(0., at_break * (1. - 1e-10));
  EXPECT_EQ(s.pair.cracks.size(), 0u);
  EXPECT_NEAR(before, -s.k() * at_break * inertia, 1e-9);
  const double after = s.moment(0., at_break * (1. + 1e-10));
  EXPECT_EQ(s.pair.cracks.size(), 1u);
  // What is left spans [-R/3, R]: its second moment about the centre is (1 + 1/27) R^3/3.
  EXPECT_NEAR(after, -s.k() * at_break * std::pow(s.R(), 3) * 28. / 81., 1e-9);
}

TEST(DamagePath, FollowsTheFibresThroughLoadingUnloadingAndReversal)
{
  Section s;
  const double at_break = 1.5 / (s.k() * s.R());
  for (int i = 0; i <= 120; ++i) // opens the outer element
    s.moment(0., at_break * 1.2 * i / 120.);
  EXPECT_EQ(s.pair.cracks.size(), 1u);
  for (int i = 120; i >= -110; --i) // back, closes it, bends the other way
    s.moment(0., at_break * 1.2 * i / 120.);
  EXPECT_EQ(s.pair.cracks.size(), 2u); // the other outer element
  for (int i = -110; i <= 120; ++i)    // and with a compression on top
    s.moment(-2e-3, at_break * 1.2 * i / 120.);
  for (int i = 120; i >= 0; --i)
    s.moment(1e-4 * (120 - i) / 120., at_break * 1.2 * i / 120.);
  EXPECT_EQ(s.fibres.bonded[0], false);
  EXPECT_EQ(s.fibres.bonded[1], true);
  EXPECT_EQ(s.fibres.bonded[2], false);
}

TEST(DamagePath, CrackedSectionUnloadsWithItsOwnStiffness)
{
  Section s;
  const double at_break = 1.5 / (s.k() * s.R());
  s.moment(0., 1.1 * at_break);
  ASSERT_EQ(s.pair.cracks.size(), 1u);
  const double cracked = -s.k() * std::pow(s.R(), 3) * 28. / 81.;
  const double whole = -s.k() * std::pow(s.R(), 3) * 2. / 3.;
  for (const double share : {1.05, 0.7, 0.2, 0.9}) // down and up on one line
    EXPECT_NEAR(s.moment(0., share * at_break), cracked * share * at_break, 1e-9);
  for (const double share : {-0.2, -0.9, -0.5}) // closed: as if whole
    EXPECT_NEAR(s.moment(0., share * at_break), whole * share * at_break, 1e-9);
}

TEST(DamagePath, CrackClosesAtTheMomentThatCompressionHolds)
{
  Section s;
  const double at_break = 1.5 / (s.k() * s.R());
  s.moment(0., 1.1 * at_break);
  ASSERT_EQ(s.pair.cracks.size(), 1u);
  // Under the gap -g0 the crack's edge opens at theta R = g0: up to there the section is
  // whole, beyond it softens.
  const double g0 = 5e-4, at_closure = g0 / s.R();
  const double whole = -s.k() * std::pow(s.R(), 3) * 2. / 3.;
  const double closure = s.moment(-g0, at_closure);
  EXPECT_NEAR(closure, whole * at_closure, 1e-9);
  const double h = 1e-3 * at_closure;
  const double below = (closure - s.moment(-g0, at_closure - h)) / h;
  const double above = (s.moment(-g0, at_closure + 100. * h) - closure) / (100. * h);
  EXPECT_NEAR(below / whole, 1., 1e-9);
  EXPECT_LT(above / whole, 1. - 1e-3);
  EXPECT_GT(above / whole, 0.9);
}

TEST(BrokenElement, ClosesOpensAndSlidesWithoutHealing)
{
  Sample pair = bonded_pair(brittle_law(1));
  const double k = pair.joints.stiffness[0], k_s = k / 2.2, A = 1., mu = 0.5;
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_tension);
  const auto expect = [&](const JointDeformation &d, const double F, const double S)
  {
    const Resultants r = load(pair, d);
    EXPECT_NEAR(r.normal, F, 1e-12) << d.gap << ' ' << d.shear; // round-off of k * 1e-3
    EXPECT_NEAR(r.shear, S, 1e-12) << d.gap << ' ' << d.shear;
  };
  expect({-1e-3, 0., 0.}, -k * A * 1e-3, 0.);
  expect({-1e-3, 4e-4, 0.}, -k * A * 1e-3, k_s * A * 4e-4);  // sticks
  expect({-1e-3, 2e-3, 0.}, -k * A * 1e-3, mu * k * 1e-3);   // slides
  expect({-1e-3, 1.9e-3, 0.}, -k * A * 1e-3,                 // sticks again
         mu * k * 1e-3 - k_s * 1e-4);                        //
  expect({-1e-3, -3e-3, 0.}, -k * A * 1e-3, -mu * k * 1e-3); // slides back
  expect({-5e-4, -3e-3, 0.}, -k * A * 5e-4, -mu * k * 5e-4); // limit follows N
  expect({1e-3, -3e-3, 0.}, 0., 0.);                         // open: nothing
  expect({1e-3, 5e-3, 0.}, 0., 0.);                          //
  expect({1.1, 5e-3, 0.}, 0., 0.);                           // parted for good
  EXPECT_TRUE(pair.joints.damaged.removed[0]);
}

TEST(BrokenElement, ShearsOnlyFromTheClosedPartOfTheStep)
{
  Sample pair = bonded_pair(brittle_law(1));
  const double k = pair.joints.stiffness[0], k_s = k / 2.2;
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_tension);
  load(pair, {1e-3, 7e-3, 0.});
  // Closes a quarter of the way through the step; of a shear of 4e-4, 3e-4 are felt.
  const Resultants r = load(pair, {-3e-3, 7.4e-3, 0.});
  EXPECT_NEAR(r.normal, -k * 3e-3, 1e-12); // round-off
  EXPECT_NEAR(r.shear, k_s * 3e-4, 1e-12);
}

TEST(BrokenElement, NewlyClosedPartsCarryNoShear)
{
  // Half closed and sheared, then closed as a whole: the force is that of the first half.
  Sample pair = bonded_pair(brittle_law(1));
  const double k = pair.joints.stiffness[0], k_s = k / 2.2, R = 0.5;
  std::get<FlatJoint>(pair.joints.groups[0].law).residual_friction = 100.;
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_tension);
  const double theta = 1e-2;
  load(pair, {0., 0., theta}); // closed for s > 0
  const double half = load(pair, {0., 1e-4, theta}).shear;
  EXPECT_NEAR(half, k_s * R * 1e-4, 1e-12); // round-off
  EXPECT_NEAR(load(pair, {-1e-2, 1e-4, theta}).shear, half, 1e-12);
  // From there on the whole length resists.
  EXPECT_NEAR(load(pair, {-1e-2, 2e-4, theta}).shear, half + k_s * 2. * R * 1e-4, 1e-12);
  // What opens again takes its share along.
  EXPECT_NEAR(load(pair, {0., 2e-4, theta}).shear, 0.5 * (half + k_s * 2. * R * 1e-4),
              1e-12);
}

TEST(BrokenElement, BooksEveryChangeOfItsEnergy)
{
  // A closed path in gap, shear and rotation that closes, opens, sticks and slides: work
  // of the resultants by the trapezoidal rule is what has been dissipated.
  const auto imbalance = [](const int steps)
  {
    Sample pair = bonded_pair(brittle_law(2));
    for (const int e : {0, 1})
      break_element(pair.grains, pair.joints, 0, e, Bond::broken_in_shear);
    const auto at = [](const double t)
    {
      return JointDeformation{1e-3 * (std::sin(t) - 0.3), 2e-3 * std::sin(2. * t + 1.),
                              3e-3 * std::sin(3. * t)};
    };
    JointDeformation last = at(0.);
    Resultants old = load(pair, last);
    const double start = joint_energies(pair.grains, pair.joints).strain +
                         joint_energies(pair.grains, pair.joints).slip;
    double work = 0.;
    for (int i = 1; i <= steps; ++i)
    {
      const JointDeformation d = at(4. * M_PI * i / steps);
      const Resultants r = load(pair, d);
      work += 0.5 * ((r.normal + old.normal) * (d.gap - last.gap) +
                     (r.shear + old.shear) * (d.shear - last.shear) -
                     (r.moment + old.moment) * (d.rotation - last.rotation));
      old = r;
      last = d;
    }
    const JointEnergies energy = joint_energies(pair.grains, pair.joints);
    EXPECT_GT(energy.slip, 1e-4);
    return std::abs(start + work - energy.strain - energy.slip) / energy.slip;
  };
  // First order: the closed length changes before the slip of a step does, not with it.
  const double coarse = imbalance(4000), fine = imbalance(40000);
  EXPECT_LT(coarse, 2e-4);
  EXPECT_NEAR(std::log10(coarse / fine), 1., 0.1) << coarse << ' ' << fine;
}

TEST(BrokenElement, NeverBondsAgain)
{
  Sample pair = bonded_pair(brittle_law());
  load(pair, {2e-3, 0., 0.});
  ASSERT_EQ(pair.cracks.size(), 3u);
  for (int cycle = 0; cycle < 5; ++cycle)
  {
    load(pair, {-5e-3, 0., 1e-3});
    const Resultants open = load(pair, {1e-4, 0., 0.});
    EXPECT_EQ(open.normal, 0.);
    EXPECT_EQ(open.shear, 0.);
    EXPECT_EQ(open.moment, 0.);
  }
  EXPECT_EQ(pair.cracks.size(), 3u); // and breaks only once
}

TEST(BrokenElement, SlidingDissipatesForceTimesPath)
{
  // N = 1, constant gap: after the elastic 1.1e-3 the whole path slides at mu N.
  Sample pair = bonded_pair(brittle_law(1));
  const double limit = 0.5 * 1e3 * 1e-3, k_s = 1e3 / 2.2;
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_shear);
  load(pair, {-1e-3, 0., 0.});
  for (int i = 1; i <= 100; ++i)
    load(pair, {-1e-3, 1e-2 * i / 100., 0.});
  const double path = 1e-2 - limit / k_s;
  // The step in which sliding begins is integrated by the trapezoidal rule: its slip is
  // at most 1e-4 long and its force at most k_s 1e-4 short.
  EXPECT_NEAR(joint_energies(pair.grains, pair.joints).slip, limit * path,
              0.5 * 1e-4 * k_s * 1e-4);
}

TEST(BrokenElement, BreakInTheMiddleOfAStepTakesHalfOfItsWork)
{
  // From gap 0.9e-3 to 1.1e-3 in one step; afterwards nothing pulls. The trapezoidal rule
  // sees 1/2 k 0.9e-3 * 0.2e-3 of work after 1/2 k 0.9e-3^2: together 1/2 k 0.9 * 1.1e-6.
  Sample pair = bonded_pair(brittle_law(1));
  load(pair, {0.9e-3, 0., 0.});
  set_deformation(pair, {1.1e-3, 0., 0.});
  pair.grains.velocity_x = {0., 0.2e-3};
  compute_joint_forces(pair.grains, pair.joints, {0, 0., 1.}, &pair.cracks);
  ASSERT_EQ(pair.cracks.size(), 1u);
  EXPECT_NEAR(joint_energies(pair.grains, pair.joints).fracture,
              0.5 * 1e3 * 0.9e-3 * 1.1e-3, 1e-16); // round-off
}

TEST(UnloadedBreak, LeavesAGapOrOverlapFreeOfForce)
{
  for (const double gap : {0.025, -0.025}) // 5 % of R
  {
    Sample pair = bonded_pair(strong_law(), 0.5, 0.5, gap, 0.8);
    const auto expect_nothing = [&]
    {
      compute_joint_forces(pair.grains, pair.joints, {}, &pair.cracks);
      for (const int i : {0, 1})
      {
        EXPECT_EQ(pair.grains.force_x[i], 0.);
        EXPECT_EQ(pair.grains.force_y[i], 0.);
        EXPECT_EQ(pair.grains.torque[i], 0.);
      }
      const JointEnergies energy = joint_energies(pair.grains, pair.joints);
      EXPECT_EQ(energy.strain, 0.);
      EXPECT_EQ(energy.fracture, 0.);
      EXPECT_EQ(energy.slip, 0.);
    };
    expect_nothing();
    for (const int e : {0, 1, 2})
    {
      break_element(pair.grains, pair.joints, 0, e, Bond::broken_in_tension);
      expect_nothing();
    }
    const double k = pair.joints.stiffness[0];
    EXPECT_EQ(load(pair, {1e-3, 0., 0.}).normal, 0.);
    EXPECT_NEAR(load(pair, {-1e-3, 0., 0.}).normal, -k * 1e-3, 1e-12); // round-off
  }
}

TEST(BrokenElement, LosesItsOwnEnergyToTheFractureSink)
{
  Sample pair = bonded_pair(brittle_law());
  const double g = 1e-3 * (1. + 1e-9), k = pair.joints.stiffness[0];
  load(pair, {g, 2e-4, 0.});
  ASSERT_EQ(pair.cracks.size(), 3u);
  const JointEnergies energy = joint_energies(pair.grains, pair.joints);
  EXPECT_NEAR(energy.fracture, 0.5 * k * (g * g + 4e-8 / 2.2), 1e-15); // round-off
  EXPECT_EQ(energy.strain, 0.);
}

TEST(RemovedJoint, LeavesItsEnergyInTheFractureSink)
{
  Sample pair = bonded_pair(brittle_law(1));
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_shear);
  load(pair, {-1e-3, 0., 0.});
  load(pair, {-1e-3, 0.99, 0.});
  EXPECT_FALSE(pair.joints.damaged.removed[0]);
  const double slip = joint_energies(pair.grains, pair.joints).slip;
  load(pair, {-1e-3, 1.01, 0.}); // slid off: 2 R = 1
  EXPECT_TRUE(pair.joints.damaged.removed[0]);
  const JointEnergies energy = joint_energies(pair.grains, pair.joints);
  EXPECT_EQ(energy.strain, 0.);
  const double limit = 0.5 * 1., k_s = 1e3 / 2.2;
  EXPECT_NEAR(energy.fracture, 0.5 * 1e3 * 1e-6 + 0.5 * limit * limit / k_s, 1e-15);
  EXPECT_NEAR(energy.slip - slip, limit * 0.02, 1e-12); // and it slid to the end
}

TEST(RemovedJoint, HandsOverToALinearContactWithTheInstalledGap)
{
  // Same stiffness and same origin for the compression of the joint and of the contact.
  for (const double installed : {0.05, -0.05})
  {
    Sample pair = bonded_pair(strong_law(), 0.5, 0.4, installed);
    for (const int e : {0, 1, 2})
      break_element(pair.grains, pair.joints, 0, e, Bond::broken_in_tension);
    const double joint_force = load(pair, {-1e-3, 0., 0.}).normal;

    Contacts contacts;
    contacts.margin = 0.01;
    LinearContact law;
    law.effective_modulus = 1e3;
    contacts.groups.push_back({0, 0, law});
    search_contacts(pair.grains, pair.joints, contacts);
    EXPECT_TRUE(contacts.contacts.empty()); // the joint still holds the pair

    const Resultants far = load(pair, {1., 0., 0.});
    EXPECT_TRUE(pair.joints.damaged.removed[0]);
    EXPECT_EQ(far.normal, 0.);
    const auto contact_force = [&](const double gap)
    {
      const Resultants none = load(pair, {gap, 0., 0.});
      EXPECT_EQ(none.normal, 0.); // the joint stays removed
      search_contacts(pair.grains, pair.joints, contacts);
      add_contact_forces(pair.grains, contacts, 0.);
      return pair.grains.force_x[1];
    };
    EXPECT_EQ(contact_force(1.), 0.);
    EXPECT_EQ(contact_force(1e-6), 0.);
    EXPECT_NEAR(contact_force(-1e-6), 1e-6 * 800. / 0.9, 1e-11); // rounding of 1 * k
    EXPECT_NEAR(contact_force(-1e-3), -joint_force, 1e-11);
  }
}
} // namespace antiform::discrete::test::damage_path_tests

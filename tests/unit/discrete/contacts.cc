#include "discrete/contacts.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::contacts_tests
{
namespace
{
LinearContact contact_law(const double friction = 0.4)
{
  LinearContact law;
  law.effective_modulus = 1e3;
  law.stiffness_ratio = 2.;
  law.friction = friction;
  return law;
}

/// Two equal disks along x, @p gap apart; the first is held.
struct TouchingPair
{
  Grains grains;
  Joints joints;
  Contacts contacts;

  explicit TouchingPair(const double gap,
                        const double margin = 0.1,
                        const LinearContact &law = contact_law())
  {
    grains.add({0., 0.}, 0.5, 1., 0);
    grains.add({1. + gap, 0.}, 0.5, 1., 0);
    hold(grains, 0);
    contacts.margin = margin;
    contacts.groups.push_back({0, 0, law});
    search_contacts(grains, joints, contacts);
  }

  /// Move the second grain by (x, y) within one step of length 1 and evaluate.
  void move(const double x, const double y)
  {
    grains.velocity_x[1] = x;
    grains.velocity_y[1] = y;
    drift(grains, 1.);
    for (std::vector<double> *v : {&grains.force_x, &grains.force_y, &grains.torque})
      v->assign(2, 0.);
    add_contact_forces(grains, contacts, 1.);
  }
};
} // namespace

TEST(LinearContact, StiffnessFollowsTheDeformabilityMethod)
{
  EXPECT_DOUBLE_EQ(normal_stiffness(contact_law(), 0.5, 0.5), 1e3);
  EXPECT_DOUBLE_EQ(normal_stiffness(contact_law(), 0.25, 0.75), 500.);
}

TEST(LinearContact, PushesByTheOverlapAndNeverPulls)
{
  TouchingPair pair(0.01);
  pair.move(-0.03, 0.);
  EXPECT_NEAR(pair.grains.force_x[1], 20., 1e-11); // k_n = 1e3, overlap 0.02
  EXPECT_EQ(pair.grains.force_x[0], -pair.grains.force_x[1]);
  pair.move(0.05, 0.);
  EXPECT_EQ(pair.grains.force_x[1], 0.);
  EXPECT_EQ(pair.grains.torque[1], 0.);
}

TEST(LinearContact, ShearsOnlyByTheClosedPartOfTheStep)
{
  // The gap goes from +0.01 to -0.03 to first order: closed for 3/4 of the step, during
  // which it slides by 3/4 of 1e-3. k_s = 500, and y shears against the fixed grain.
  TouchingPair pair(0.01, 0.1, contact_law(10.));
  pair.move(-0.04, 1e-3);
  // The slide turns the contact's frame by 1e-3, and lengthens it by 5e-7: relative
  // effects of a few 1e-3 on what is compared (the normal rate enters along the tangent).
  const double turn = 0.04 * 1e-3 / 0.97;
  EXPECT_NEAR(pair.contacts.contacts[0].shear_force, 500. * 0.75 * (1e-3 + turn),
              500. * 0.75 * 1e-3 * 1e-3);
}

TEST(LinearContact, SlidesAtCoulombsLimit)
{
  TouchingPair pair(0., 0.1, contact_law(0.4));
  pair.move(-0.01, 0.);
  pair.move(0., 0.1);
  const Contact &contact = pair.contacts.contacts[0];
  EXPECT_DOUBLE_EQ(contact.shear_force, 0.4 * contact.normal_force);
  EXPECT_GT(contact.slip_energy, 0.);
  // The shear force opposes the motion of the second grain.
  EXPECT_LT(pair.grains.force_y[1], 0.);
}

TEST(LinearContact, DissipatesItsShearEnergyWhenItOpens)
{
  TouchingPair pair(0., 0.1, contact_law(10.));
  pair.move(-0.01, 0.);
  pair.move(0., 0.01);
  const double S = pair.contacts.contacts[0].shear_force;
  EXPECT_GT(std::abs(S), 1.);
  EXPECT_EQ(contact_energies(pair.grains, pair.contacts).slip, 0.);
  pair.move(0.05, 0.);
  const ContactEnergies energy = contact_energies(pair.grains, pair.contacts);
  EXPECT_DOUBLE_EQ(energy.slip, 0.5 * S * S / 500.);
  EXPECT_EQ(energy.strain, 0.);
}

TEST(LinearContact, TorquesBalanceTheForces)
{
  TouchingPair pair(0.);
  pair.grains.spin = {0.02, -0.01};
  pair.move(-0.02, 0.015);
  const Vec2 branch = pair.grains.position(1) - pair.grains.position(0);
  const Vec2 force{pair.grains.force_x[1], pair.grains.force_y[1]};
  EXPECT_NE(pair.grains.torque[1], 0.);
  EXPECT_NEAR(pair.grains.torque[0] + pair.grains.torque[1] + cross(branch, force), 0.,
              1e-13 * norm(force)); // round-off
}

TEST(LinearContact, FrictionlessGroupGivesNoShear)
{
  TouchingPair pair(0., 0.1, contact_law(0.));
  pair.move(-0.01, 0.);
  pair.move(0., 0.05);
  EXPECT_EQ(pair.contacts.contacts[0].shear_force, 0.);
  EXPECT_EQ(pair.grains.torque[0], 0.);
  EXPECT_EQ(pair.grains.torque[1], 0.);
  EXPECT_GT(pair.contacts.contacts[0].normal_force, 0.);
  // The force is along the line of centres.
  const Vec2 branch = pair.grains.position(1) - pair.grains.position(0);
  EXPECT_NEAR(cross(branch, {pair.grains.force_x[1], pair.grains.force_y[1]}), 0., 1e-14);
}

TEST(LinearContact, RollingOfAFreePairGivesNoShear)
{
  // Equal and opposite spins roll the two disks over one another.
  TouchingPair pair(-0.01);
  pair.grains.spin = {0.01, -0.01};
  pair.move(0., 0.);
  EXPECT_NEAR(pair.contacts.contacts[0].shear_force, 0., 1e-12); // k_s * round-off
}

TEST(ContactSearch, KeepsTheStateOfPairsThatStay)
{
  TouchingPair pair(0., 0.1, contact_law(10.));
  pair.move(-0.01, 0.002);
  const Contact before = pair.contacts.contacts[0];
  ASSERT_NE(before.shear_force, 0.);
  pair.grains.add({0., 1.02}, 0.5, 1., 0); // a newcomer
  search_contacts(pair.grains, pair.joints, pair.contacts);
  ASSERT_EQ(pair.contacts.contacts.size(), 2u);
  EXPECT_EQ(pair.contacts.contacts[0].shear_force, before.shear_force);
  EXPECT_EQ(pair.contacts.contacts[0].gap, before.gap);
  EXPECT_EQ(pair.contacts.contacts[1].second, 2);
  EXPECT_EQ(pair.contacts.contacts[1].shear_force, 0.);
}

TEST(ContactSearch, ForgetsPairsThatLeaveButNotTheirEnergy)
{
  TouchingPair pair(0., 0.1, contact_law(0.2));
  pair.move(-0.01, 0.);
  pair.move(0., 0.05);
  ASSERT_GT(contact_energies(pair.grains, pair.contacts).slip, 0.);
  pair.move(1., 0.);
  const double slip = contact_energies(pair.grains, pair.contacts).slip;
  search_contacts(pair.grains, pair.joints, pair.contacts);
  EXPECT_TRUE(pair.contacts.contacts.empty());
  EXPECT_EQ(contact_energies(pair.grains, pair.contacts).slip, slip);
}

TEST(ContactSearch, IsDueWhenAGrainHasMovedHalfTheMargin)
{
  TouchingPair pair(0.05, 0.1);
  EXPECT_FALSE(needs_search(pair.grains, pair.contacts));
  pair.move(0.0499, 0.);
  EXPECT_FALSE(needs_search(pair.grains, pair.contacts));
  pair.move(0.0002, 0.);
  EXPECT_TRUE(needs_search(pair.grains, pair.contacts));
  search_contacts(pair.grains, pair.joints, pair.contacts);
  EXPECT_FALSE(needs_search(pair.grains, pair.contacts));
  pair.grains.add({5., 5.}, 0.5, 1., 0);
  EXPECT_TRUE(needs_search(pair.grains, pair.contacts)); // a grain it has not seen
}

TEST(ContactSearch, NeverMissesATouchingPairBetweenSearches)
{
  // Grains wander at random; every overlapping pair must be among the candidates.
  Grains grains = random_pack(10, 10, 8);
  Joints joints;
  Contacts contacts;
  contacts.margin = 0.2;
  contacts.groups.push_back({0, 0, contact_law()});
  Random random(9);
  int searches = 0;
  for (int step = 0; step < 60; ++step)
  {
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      grains.displacement_x[i] += random(-0.02, 0.02);
      grains.displacement_y[i] += random(-0.02, 0.02);
    }
    if (needs_search(grains, contacts))
    {
      search_contacts(grains, joints, contacts);
      ++searches;
    }
    auto candidate = contacts.contacts.begin();
    for (const auto &[i, j] : pairs_within(grains, 0., 0, 0))
    {
      while (candidate != contacts.contacts.end() &&
             (candidate->first < i || (candidate->first == i && candidate->second < j)))
        ++candidate;
      ASSERT_TRUE(candidate != contacts.contacts.end() && candidate->first == i &&
                  candidate->second == j)
          << "pair " << i << ", " << j << " in step " << step;
    }
  }
  EXPECT_GT(searches, 2); // and searches were rarer than steps
  EXPECT_LT(searches, 40);
}

TEST(ContactSearch, LeavesJointedPairsToTheirJoint)
{
  Sample sample = bonded_pair(strong_law());
  Contacts contacts;
  contacts.margin = 0.1;
  contacts.groups.push_back({0, 0, contact_law()});
  search_contacts(sample.grains, sample.joints, contacts);
  EXPECT_TRUE(contacts.contacts.empty());
}

TEST(ContactSearch, InstalledPairsAreStressFreeAtTheirGap)
{
  for (const double gap : {0.05, -0.05})
  {
    TouchingPair pair(gap, 0.01);
    pair.contacts.installed.push_back({0, 1, gap});
    pair.contacts.contacts.clear();
    search_contacts(pair.grains, pair.joints, pair.contacts);
    ASSERT_EQ(pair.contacts.contacts.size(), 1u);
    pair.move(0., 0.);
    EXPECT_NEAR(pair.grains.force_x[1], 0., 1e-12); // k_n times the rounding of 1 + gap
    pair.move(-1e-3, 0.);
    EXPECT_NEAR(pair.grains.force_x[1], 1., 1e-11);
  }
}

TEST(PairsWithin, AgreesWithTheFullDoubleLoop)
{
  Grains grains = random_pack(12, 11, 6);
  for (std::size_t i = 0; i < grains.size(); i += 3)
    grains.region[i] = 1;
  for (const double gap : {-0.02, 0., 0.1, 0.6})
    for (const auto &[a, b] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}})
    {
      std::vector<std::pair<std::int32_t, std::int32_t>> all;
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(grains.size()); ++i)
        for (std::int32_t j = i + 1; j < static_cast<std::int32_t>(grains.size()); ++j)
        {
          const int p = grains.region[i], q = grains.region[j];
          if (((p == a && q == b) || (p == b && q == a)) &&
              norm(grains.position(j) - grains.position(i)) <=
                  grains.radius[i] + grains.radius[j] + gap)
            all.emplace_back(i, j);
        }
      EXPECT_EQ(pairs_within(grains, gap, a, b), all) << gap << ' ' << a << b;
    }
}
} // namespace antiform::discrete::test::contacts_tests

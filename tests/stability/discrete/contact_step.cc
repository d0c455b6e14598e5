// Contacts add to the stiffness that the step was chosen for: the bound counts them.
#include "support/highest_mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::contact_step_tests
{
namespace
{
/// Contacts of all pairs that no joint holds and whose gap is at most 0.15, pressed by
/// @p overlap where they stand.
Contacts pressed(const Sample &sample, const double overlap, const double friction)
{
  Contacts contacts;
  contacts.margin = 1e-3;
  LinearContact law;
  law.effective_modulus = 1e3;
  law.friction = friction;
  contacts.groups.push_back({0, 0, law});
  for (const auto &[i, j] : pairs_within(sample.grains, 0.15, 0, 0))
    contacts.installed.push_back(
        {i, j,
         norm(sample.grains.position(j) - sample.grains.position(i)) -
             sample.grains.radius[i] - sample.grains.radius[j] + overlap});
  search_contacts(sample.grains, sample.joints, contacts);
  // They have pressed before: no part of the first step comes before closing.
  for (Contact &contact : contacts.contacts)
    contact.gap = -overlap;
  return contacts;
}

/// Joints on a share of the pairs that are near; the rest is left to contacts.
Sample partly_bonded(const double share, const std::uint64_t seed)
{
  Sample sample;
  sample.grains = random_pack(6, 6, seed);
  sample.joints.begin_group(strong_law(), 0, "rock");
  Random random(seed + 100);
  for (const auto &[i, j] : pairs_within(sample.grains, 0.15, 0, 0))
    if (random(0., 1.) < share)
      sample.joints.add(sample.grains, i, j, 1e3, 1e3);
  sample.joints.finish(sample.grains.size());
  return sample;
}
} // namespace

TEST(StableStep, IsALowerBoundWithContacts)
{
  for (const double share : {0., 0.5, 0.9})
    for (const double friction : {0., 1e6}) // none, or too much to slide
      for (const std::uint64_t seed : {21, 22})
      {
        const Sample sample = partly_bonded(share, seed);
        // Deeper than the differences of the mode; a geometric stiffness of 1e-4.
        const Contacts contacts = pressed(sample, 1e-4, friction);
        ASSERT_GT(contacts.contacts.size(), 2u);
        const double step = stable_step(sample.grains, sample.joints, contacts);
        const double ratio = 0.5 * step * highest_mode(sample, contacts).omega;
        EXPECT_LE(ratio, 1. + 1e-4) << share << ' ' << friction << ' ' << seed;
        EXPECT_GT(ratio, 0.5) << share << ' ' << friction << ' ' << seed;
      }
}

TEST(StableStep, OfTwoGrainsInContactIsExact)
{
  // omega^2 = 2 k / m without friction. As springs to the ground, k / m each, they would
  // be taken for slower by sqrt(2).
  Sample pair;
  pair.grains.add({0., 0.}, 0.5, 1., 0);
  pair.grains.add({1., 0.}, 0.5, 1., 0);
  pair.joints.finish(2);
  const Contacts contacts = pressed(pair, 1e-4, 0.);
  const double exact = 2. / std::sqrt(2. * 1e3 / pair.grains.mass[0]);
  EXPECT_NEAR(stable_step(pair.grains, pair.joints, contacts) / exact, 1., 1e-12);
}

TEST(StableStep, ShrinksAsContactsJoinAndForgetsRemovedJoints)
{
  Sample sample = partly_bonded(0.5, 23);
  const double alone = stable_step(sample.grains, sample.joints);
  const double together =
      stable_step(sample.grains, sample.joints, pressed(sample, 1e-4, 0.4));
  EXPECT_LT(together, alone);

  // A broken joint may close again; one that is removed may not.
  Sample pair = bonded_pair(strong_law());
  EXPECT_TRUE(std::isfinite(stable_step(pair.grains, pair.joints)));
  for (const int e : {0, 1, 2})
    break_element(pair.grains, pair.joints, 0, e, Bond::broken_in_tension);
  EXPECT_TRUE(std::isfinite(stable_step(pair.grains, pair.joints)));
  pair.grains.displacement_x[1] = 2.;
  compute_joint_forces(pair.grains, pair.joints, {}, &pair.cracks);
  ASSERT_TRUE(pair.joints.damaged.removed[0] != 0);
  EXPECT_TRUE(std::isinf(stable_step(pair.grains, pair.joints)));
}

TEST(StableStep, HoldsThroughAPileOfLooseGrainsThatPress)
{
  // Frictionless contacts alone: at 0.99 of the bound the energy stays what it was.
  const Threads threads(1);
  Sample sample = partly_bonded(0., 24);
  const Contacts contacts = pressed(sample, 0.05, 0.);
  for (const bool below : {true, false})
  {
    ExplicitRun run(sample);
    run.has_contacts = true;
    run.contacts = contacts;
    run.contacts.margin = 10.; // no further search
    run.contacts.search_x = run.contacts.search_y =
        std::vector<double>(sample.grains.size(), 0.);
    // The rim flies off by itself: hold it all.
    for (std::size_t i = 0; i < sample.grains.size(); ++i)
      if (i % 6 == 0 || i % 6 == 5 || i / 6 == 0 || i / 6 == 5)
        hold(run.sample.grains, i);
    shake(run.sample.grains, 1e-6, 0., 25);
    for (std::size_t i = 0; i < sample.grains.size(); ++i)
      if (run.sample.grains.inverse_mass[i] == 0.)
        run.sample.grains.velocity_x[i] = run.sample.grains.velocity_y[i] = 0.;
    const double step = stable_step(run.sample.grains, run.sample.joints, run.contacts);
    const double dt = below ? 0.99 * step : 2.2 * step;
    double fastest = 0.;
    for (int i = 0; i < 4000; ++i)
    {
      run.advance(dt);
      for (std::size_t k = 0; k < sample.grains.size(); ++k)
        fastest = std::max(fastest, std::hypot(run.sample.grains.velocity_x[k],
                                               run.sample.grains.velocity_y[k]));
      if (!(fastest < 100.))
        break;
    }
    // The pack settles from its overlaps of 0.05: sqrt(k / m) times that is 2.
    EXPECT_EQ(fastest < 20., below) << fastest;
  }
}
} // namespace antiform::discrete::test::contact_step_tests

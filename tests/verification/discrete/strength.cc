// Strengths of a joint, found by bisection on the prescribed deformation: every trial
// starts from an intact pair, so the load at the break is sharp to the bisection's end.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace antiform::discrete::test::strength_tests
{
namespace
{
FlatJoint rock_1(const int n = 3)
{
  FlatJoint law;
  law.effective_modulus = 50e9;
  law.stiffness_ratio = 2.2;
  law.tensile_strength = 15e6;
  law.cohesion = 60e6;
  law.tan_friction = std::tan(8. * M_PI / 180.);
  law.residual_friction = 0.4;
  law.n_elements = n;
  return law;
}
FlatJoint rock_2(const int n = 3)
{
  FlatJoint law = rock_1(n);
  law.effective_modulus = 20e9;
  law.tensile_strength = 2.76e6;
  law.cohesion = 18.61e6;
  law.tan_friction = std::tan(17. * M_PI / 180.);
  return law;
}

/// Resultants of the last unbroken state on the path d(load), and the break that ends it.
struct Break
{
  Resultants before;
  Crack crack;
};
Break first_break(const Sample &intact,
                  const std::function<JointDeformation(double)> &path,
                  double high)
{
  Break result{};
  double low = 0.;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    Sample trial = intact;
    const Resultants r = load(trial, path(middle));
    if (trial.cracks.empty())
    {
      low = middle;
      result.before = r;
    }
    else
    {
      high = middle;
      result.crack = trial.cracks.front();
    }
  }
  return result;
}
constexpr double R1 = 1.1e-3, R2 = 0.8e-3; // grains of a rock, polydisperse
} // namespace

TEST(JointStrength, PureTensionBreaksAtStrengthTimesArea)
{
  for (const int n : {1, 2, 3, 4})
  {
    const Sample pair = bonded_pair(rock_1(n), R1, R2, 5e-5, 0.4);
    const Break result = first_break(
        pair,
        [](const double g) {
          return JointDeformation{g, 0., 0.};
        },
        1e-5);
    const double exact = 15e6 * 2. * R2;
    // Bisection ends at round-off of the displacement, 1e-16 of 1e-6 to 1e-5.
    EXPECT_NEAR(result.before.normal / exact, 1., 1e-9) << n;
    EXPECT_EQ(result.crack.mode, Bond::broken_in_tension);
  }
}

TEST(JointStrength, PureShearBreaksOnTheCoulombLine)
{
  for (const FlatJoint &law : {rock_1(), rock_2()})
    for (const double sigma : {-80e6, -50e6, -10e6, 0., 0.9 * law.tensile_strength})
    {
      const Sample pair = bonded_pair(law, R1, R2, -3e-5, -1.1);
      const double gap = sigma / pair.joints.stiffness[0];
      const Break result = first_break(
          pair,
          [&](const double u) {
            return JointDeformation{gap, u, 0.};
          },
          2e-5);
      const double strength = law.cohesion - sigma * law.tan_friction;
      EXPECT_NEAR(result.before.shear / (2. * R2) / strength, 1., 1e-9) << sigma;
      EXPECT_EQ(result.crack.mode, Bond::broken_in_shear);
    }
}

TEST(JointStrength, AtFiftyMegapascalIsThatOfTheTwoRocks)
{
  const auto strength = [](const FlatJoint &law)
  {
    const Sample pair = bonded_pair(law, R1, R2);
    const double gap = -50e6 / pair.joints.stiffness[0];
    return first_break(
               pair,
               [&](const double u) {
                 return JointDeformation{gap, u, 0.};
               },
               2e-5)
               .before.shear /
           (2. * R2);
  };
  EXPECT_NEAR(strength(rock_1()), 67.03e6, 0.005e6); // printed digits
  EXPECT_NEAR(strength(rock_2()), 33.90e6, 0.005e6);
}

TEST(JointStrength, PureBendingBreaksTheOuterElementFirst)
{
  for (const int n : {2, 3, 4, 7})
    for (const double sign : {1., -1.})
    {
      const Sample pair = bonded_pair(rock_1(n), R1, R2, 0., 2.);
      const Break result = first_break(
          pair,
          [&](const double t) {
            return JointDeformation{0., 0., sign * t};
          },
          1e-1);
      const double exact = 15e6 * 4. * R2 * R2 / 6. * n / (n - 1.);
      EXPECT_NEAR(std::abs(result.before.moment) / exact, 1., 1e-9) << n;
      // g(s) = -theta s: positive rotation opens the element of smallest s.
      EXPECT_EQ(result.crack.element, sign > 0. ? 0 : n - 1);
      EXPECT_EQ(result.crack.mode, Bond::broken_in_tension);
    }
}

TEST(JointStrength, OneElementDoesNotBreakInBending)
{
  Sample pair = bonded_pair(rock_1(1), R1, R2);
  load(pair, {0., 0., 0.1});
  EXPECT_TRUE(pair.cracks.empty()); // its mean stress is zero
}

TEST(JointStrength, AfterTheShearBreakFrictionRemains)
{
  for (const double sigma : {-10e6, -50e6})
  {
    Sample pair = bonded_pair(rock_1(), R1, R2);
    const double gap = sigma / pair.joints.stiffness[0];
    for (const double shear : {2e-5, 2.1e-5, 2.5e-5})
    {
      const double stress = load(pair, {gap, shear, 0.}).shear / (2. * R2);
      EXPECT_EQ(pair.cracks.size(), 3u);
      EXPECT_NEAR(stress / (0.4 * -sigma), 1., 1e-9) << shear; // round-off
    }
    // And in the other direction.
    const double back = load(pair, {gap, -2e-5, 0.}).shear / (2. * R2);
    EXPECT_NEAR(back / (0.4 * sigma), 1., 1e-9);
  }
}

TEST(JointStrength, TheLimitReachedFirstWithinTheStepDecides)
{
  // One big step beyond both limits. Tension is reached at 15/150 of it, shear depends.
  const auto mode = [](const double shear_stress)
  {
    Sample pair = bonded_pair(rock_1(1), R1, R2);
    const double k = pair.joints.stiffness[0];
    const JointDeformation d{150e6 / k, shear_stress / (k / 2.2), 0.};
    set_deformation(pair, d);
    const double dt = 1.; // the velocities say that the step began at rest
    pair.grains.velocity_x = pair.grains.displacement_x;
    pair.grains.velocity_y = pair.grains.displacement_y;
    compute_joint_forces(pair.grains, pair.joints, {0, 0., dt}, &pair.cracks);
    return pair.cracks.at(0).mode;
  };
  // |tau| + sigma tan 8 deg = c at the same share when tau = 600 MPa - 150 MPa tan 8 deg
  // = 578.9 MPa.
  EXPECT_EQ(mode(578e6), Bond::broken_in_tension);
  EXPECT_EQ(mode(580e6), Bond::broken_in_shear);
  EXPECT_EQ(mode(-580e6), Bond::broken_in_shear);
}

TEST(JointStrength, CountsThePrestressIn)
{
  Sample pair = bonded_pair(rock_1(), R1, R2);
  const double k = pair.joints.stiffness[0], k_s = k / 2.2;
  pair.joints.initial_gap = {-20e6 / k};
  pair.joints.initial_shear = {30e6 / k_s};
  pair.joints.initial_rotation = {0.};
  const double shear = first_break(
                           pair,
                           [](const double u) {
                             return JointDeformation{0., u, 0.};
                           },
                           2e-5)
                           .before.shear;
  const double strength = 60e6 + 20e6 * pair.joints.groups[0].flat().tan_friction;
  EXPECT_NEAR(shear / (2. * R2) / strength, 1., 1e-9); // bisection's round-off
  const double tension = first_break(
                             pair,
                             [](const double g) {
                               return JointDeformation{g, 0., 0.};
                             },
                             1e-5)
                             .before.normal;
  EXPECT_NEAR(tension / (2. * R2) / 15e6, 1., 1e-9);
}

TEST(JointStrength, CrackRecordSaysWhereAndHow)
{
  Sample pair = bonded_pair(rock_1(3), R1, R1, 0., M_PI / 6.);
  load(pair, {0., 0., 0.05});
  ASSERT_EQ(pair.cracks.size(), 1u);
  const Crack &crack = pair.cracks[0];
  EXPECT_EQ(crack.element, 0);
  EXPECT_NEAR(crack.length, 2. * R1 / 3., 1e-15);
  // Tangent of a joint at 30 degrees: 120, as a line -60.
  EXPECT_NEAR(crack.orientation, -M_PI / 3., 1e-12);
  const Vec2 n{std::cos(M_PI / 6.), std::sin(M_PI / 6.)};
  const Vec2 expected = R1 * n + (-2. / 3. * R1) * perpendicular(n);
  EXPECT_NEAR(crack.reference_place.x, expected.x, 1e-15);
  EXPECT_NEAR(crack.reference_place.y, expected.y, 1e-15);
  // The first grain has turned back by half of the joint's rotation, face and all.
  const Vec2 place = R1 * rotated(n, -0.025) + (-2. / 3. * R1) * perpendicular(n);
  EXPECT_NEAR(norm(crack.place - place), 0., 1e-15);
}
} // namespace antiform::discrete::test::strength_tests

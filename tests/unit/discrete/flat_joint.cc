#include "discrete/flat_joint.h"

#include "support/element_quadrature.h"
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::flat_joint_tests
{
namespace
{
/// Which part of the element is closed, so that the sweep can show it met every case.
int cut_case(const double gap_a, const double gap_b, const bool bonded)
{
  if (bonded)
    return 0;
  return 1 + (gap_a < 0. ? 1 : 0) + (gap_b < 0. ? 2 : 0);
}
} // namespace

TEST(FlatJointElement, AgreesWithQuadratureInEveryCutCase)
{
  Random random(11);
  int met[5] = {};
  for (int i = 0; i < 20000; ++i)
  {
    const double k = random(0.1, 1e4), gap = random(-1e-3, 1e-3),
                 rotation = random(-5e-3, 5e-3);
    const double a = random(-1., 0.8), b = a + random(0.05, 0.5);
    const bool bonded = random(0., 1.) < 0.3;
    ++met[cut_case(gap - rotation * a, gap - rotation * b, bonded)];
    const ElementResultant element = element_resultant(k, gap, rotation, a, b, bonded);
    const QuadratureResult exact = element_by_quadrature(k, gap, rotation, a, b, bonded);
    // The cut's place carries the rounding of gap / rotation; what it moves is second
    // order in it. The scale is what the element could carry at most.
    const double opening = std::abs(gap) + std::abs(rotation) * 1.3;
    const double scale = k * (b - a) * opening;
    ASSERT_NEAR(element.normal_force, exact.force, 1e-12 * scale);
    ASSERT_NEAR(element.moment, exact.moment, 1e-12 * scale);
    ASSERT_NEAR(element.strain_energy, exact.energy, 1e-12 * scale * opening);
  }
  for (const int count : met)
    EXPECT_GT(count, 500); // no case was left to chance
}

TEST(FlatJointElement, CarriesNothingWhereItOpensAfterTheBreak)
{
  for (const double rotation : {-1e-3, 0., 1e-3})
  {
    const ElementResultant element =
        element_resultant(1e3, 2e-3, rotation, -1., 1., false);
    EXPECT_EQ(element.normal_force, 0.);
    EXPECT_EQ(element.moment, 0.);
    EXPECT_EQ(element.active_length, 0.);
    EXPECT_EQ(element.strain_energy, 0.);
  }
}

TEST(FlatJointElement, KeepsTheClosedSideOfTheCut)
{
  // g(s) = -1e-3 s: closed for s > 0, open for s < 0.
  const ElementResultant element = element_resultant(1e3, 0., 1e-3, -0.5, 1., false);
  EXPECT_DOUBLE_EQ(element.active_length, 1.);
  EXPECT_DOUBLE_EQ(element.normal_force, -0.5);
  EXPECT_DOUBLE_EQ(element.moment, -1. / 3.);
}

TEST(FlatJointElement, IsContinuousWhereItOpensAndCloses)
{
  // Force and moment vanish like the square of the closed length: no jump at either end.
  for (const double edge : {-1., 1.})
  {
    const double rotation = -edge * 1e-3;
    const double at_edge = rotation * edge; // gap for which g(edge) = 0
    const ElementResultant open =
        element_resultant(1e3, at_edge + 1e-12, rotation, -1., 1., false);
    const ElementResultant closed =
        element_resultant(1e3, at_edge - 1e-12, rotation, -1., 1., false);
    EXPECT_NEAR(open.normal_force - closed.normal_force, 0., 4.1e-9); // k l 2e-12, l = 2
    EXPECT_NEAR(open.moment - closed.moment, 0., 4.1e-9);
  }
}

TEST(FlatJointBending, BondedMomentDoesNotDependOnTheNumberOfElements)
{
  for (const int n : {1, 2, 3, 4, 5, 8, 13})
  {
    Sample pair = bonded_pair(strong_law(n), 0.5, 0.4, 0.03, 0.7);
    const JointDeformation d{0., 0., 1e-3};
    const double full = 2. * pair.joints.half_length[0];
    const double exact = -pair.joints.stiffness[0] * 1e-3 * full * full * full / 12.;
    EXPECT_NEAR(load(pair, d).moment, exact, 1e-12 * std::abs(exact)) << n; // round-off
    // The same from the damaged joint's loop over elements.
    DamagedJoints damaged;
    damaged.append(0, 0, n);
    evaluate_damaged(pair.grains, pair.joints, damaged, 0, d, {}, nullptr);
    pair.grains.torque[1] = damaged.force[0].torque2;
    pair.grains.force_x[1] = damaged.force[0].x;
    pair.grains.force_y[1] = damaged.force[0].y;
    EXPECT_NEAR(resultants(pair, d).moment, exact, 1e-12 * std::abs(exact)) << n;
  }
}

TEST(FlatJointBending, CentroidRuleLosesOneOverNSquaredOfTheMoment)
{
  for (const int n : {1, 2, 3, 5})
  {
    FlatJoint law = strong_law(n);
    law.element_moment = false;
    Sample pair = bonded_pair(law);
    const JointDeformation d{0., 0., 1e-3};
    const double exact = -pair.joints.stiffness[0] * 1e-3 / 12.;
    const double wanted = (1. - 1. / (n * n)) * exact;
    const double intact = load(pair, d).moment;
    EXPECT_NEAR(intact, wanted, 1e-12 * std::abs(exact)) << n; // round-off
    break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_tension);
    pair.joints.damaged.set_bond(0, 0,
                                 Bond::bonded); // as if whole, by the loop over elements
    EXPECT_NEAR(load(pair, d).moment, wanted, 1e-12 * std::abs(exact)) << n;
  }
}
} // namespace antiform::discrete::test::flat_joint_tests

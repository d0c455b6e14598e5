// Joints that begin without bonds: slits and gapped ones (case 12 of the verification
// list), and their shares.
#include "discrete/joint_types.h"
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::joint_types_tests
{
namespace
{
constexpr double g0 = 0.003;

FlatJoint weak_law()
{
  FlatJoint law = strong_law();
  law.tensile_strength = 1e-9; // no bond is there to feel it
  law.cohesion = 1e-9;
  law.residual_friction = 0.3;
  return law;
}
} // namespace

TEST(JointTypes, GappedJointCarriesNothingUntilItsGapHasClosed)
{
  Sample pair = bonded_pair(weak_law(), 0.5, 0.4, 0.02);
  unbond(pair.joints, 0, g0);
  const double stiffness = pair.joints.stiffness[0] * 2. * pair.joints.half_length[0];
  for (const double closing : {0., 0.5 * g0, 0.999 * g0})
  {
    const Resultants r = load(pair, {-closing, 0.001, 0.});
    EXPECT_EQ(r.normal, 0.);
    EXPECT_EQ(r.shear, 0.);
    EXPECT_EQ(r.moment, 0.);
    EXPECT_EQ(joint_energies(pair.grains, pair.joints).strain, 0.);
  }
  for (const double more : {1e-6, 1e-4, 1e-3})
  {
    const Resultants r = load(pair, {-g0 - more, 0.001, 0.});
    EXPECT_NEAR(r.normal, -stiffness * more, 1e-12 * stiffness);
    EXPECT_NEAR(joint_energies(pair.grains, pair.joints).strain,
                0.5 * stiffness * more * more, 1e-12 * stiffness * more);
  }
  EXPECT_EQ(load(pair, {0., 0., 0.}).normal, 0.);
  EXPECT_TRUE(pair.cracks.empty());
}

TEST(JointTypes, SlitCarriesCompressionAndSlidesByItsFriction)
{
  Sample pair = bonded_pair(weak_law(), 0.5, 0.5);
  unbond(pair.joints, 0, 0.);
  const double stiffness = pair.joints.stiffness[0] * 2. * pair.joints.half_length[0];
  EXPECT_EQ(load(pair, {1e-3, 0., 0.}).normal, 0.);
  const double closed = 1e-3, pressure = stiffness * closed;
  EXPECT_NEAR(load(pair, {-closed, 0., 0.}).normal, -pressure, 1e-12 * pressure);
  // Sticks below mu N, slides at it, both ways.
  const double stick = 0.5 * 0.3 * pressure / (stiffness / 2.2);
  EXPECT_NEAR(load(pair, {-closed, stick, 0.}).shear, 0.5 * 0.3 * pressure,
              1e-12 * pressure);
  EXPECT_NEAR(load(pair, {-closed, 10. * stick, 0.}).shear, 0.3 * pressure,
              1e-12 * pressure);
  EXPECT_NEAR(load(pair, {-closed, -10. * stick, 0.}).shear, -0.3 * pressure,
              1e-12 * pressure);
  EXPECT_TRUE(pair.cracks.empty()); // nothing was bonded
}

TEST(JointTypes, ResidualCohesionAddsToTheFrictionOfWhatIsClosed)
{
  FlatJoint law = weak_law();
  law.residual_cohesion = 2.;
  Sample pair = bonded_pair(law, 0.5, 0.5);
  unbond(pair.joints, 0, 0.);
  const double stiffness = pair.joints.stiffness[0] * 2. * pair.joints.half_length[0];
  load(pair, {-1e-3, 0., 0.});
  const Resultants r = load(pair, {-1e-3, 0.5, 0.});
  EXPECT_NEAR(r.shear, 0.3 * 1e-3 * stiffness + 2. * 2. * pair.joints.half_length[0],
              1e-12 * stiffness);
  // Turned about its middle, half of it is closed; the middle element of three as well.
  const double half = pair.joints.half_length[0];
  load(pair, {0., 0., 0.01});
  const Resultants turned = load(pair, {0., 0.5, 0.01});
  EXPECT_NEAR(turned.shear, -0.3 * turned.normal + 2. * half, 1e-12 * stiffness);
  EXPECT_EQ(load(pair, {0.1, 0.6, 0.}).shear, 0.); // open: nothing
}

TEST(JointTypes, SharesAreThoseAskedForAndBelongToThePair)
{
  JointTypes types;
  types.slit_fraction = 0.2;
  types.gapped_fraction = 0.3;
  types.gap_ratio = 0.01;
  types.gap_deviation = 0.5;
  Sample sample;
  sample.grains = random_pack(60, 60, 5);
  bond_all(sample, strong_law());
  unbond_some(sample.joints, 0, types, 0.5, 11);
  double slits = 0., gapped = 0., sum = 0., squares = 0.;
  const DamagedJoints &damaged = sample.joints.damaged;
  for (std::size_t k = 0; k < damaged.size(); ++k)
  {
    for (const int e : {0, 1, 2})
      EXPECT_EQ(damaged.bond(k, e), Bond::unbonded);
    EXPECT_GE(damaged.gap[k], 0.);
    (damaged.gap[k] > 0. ? gapped : slits) += 1.;
    sum += damaged.gap[k];
    squares += damaged.gap[k] * damaged.gap[k];
  }
  // Binomial: four standard deviations. Of the normal, 2.3 % are cut off at 0: they are
  // slits.
  const double n = static_cast<double>(sample.joints.size());
  const double cut = 0.02275;
  const auto four_deviations = [n](const double p)
  { return 4. * std::sqrt(p * (1. - p) / n); };
  EXPECT_GT(n, 9000.);
  EXPECT_NEAR(slits / n, 0.2 + cut * 0.3, four_deviations(0.2));
  EXPECT_NEAR(gapped / n, (1. - cut) * 0.3, four_deviations(0.3));
  // Of those left: mean 2 + phi(2)/Phi(2) = 2.0552 deviations of 0.0025.
  const double mean = sum / gapped;
  EXPECT_NEAR(mean / (0.0025 * 2.0552), 1., 4. * 0.47 / std::sqrt(gapped));
  EXPECT_NEAR(std::sqrt(squares / gapped - mean * mean), 0.0025 * 0.942, 0.0001);

  // The same bits again, others with another seed.
  Sample again, other;
  again.grains = other.grains = random_pack(60, 60, 5);
  bond_all(again, strong_law());
  bond_all(other, strong_law());
  unbond_some(again.joints, 0, types, 0.5, 11);
  unbond_some(other.joints, 0, types, 0.5, 12);
  EXPECT_EQ(again.joints.damage, sample.joints.damage);
  EXPECT_EQ(again.joints.initial_gap, sample.joints.initial_gap);
  EXPECT_NE(other.joints.damage, sample.joints.damage);
}

TEST(StrengthScatter, IsNormalBelongsToThePairAndComesOfTheSeed)
{
  Sample sample;
  sample.grains = random_pack(60, 60, 5);
  bond_all(sample, strong_law());
  Joints &joints = sample.joints;
  scatter_strengths(joints, 0, {0.2, 0.1}, 11);
  const double n = static_cast<double>(joints.size());
  ASSERT_GT(n, 9000.);
  const auto moments = [n](const std::vector<double> &factor)
  {
    double sum = 0., squares = 0.;
    for (const double f : factor)
    {
      EXPECT_GT(f, 0.);
      sum += f;
      squares += f * f;
    }
    const double mean = sum / n;
    return std::pair{mean, std::sqrt(squares / n - mean * mean)};
  };
  // Cut at three deviations a normal has 0.9866 of its deviation; four standard errors.
  const auto [tension, tension_deviation] = moments(joints.tension_factor);
  EXPECT_NEAR(tension, 1., 4. * 0.2 / std::sqrt(n));
  EXPECT_NEAR(tension_deviation, 0.9866 * 0.2, 4. * 0.2 / std::sqrt(2. * n));
  const auto [cohesion, cohesion_deviation] = moments(joints.cohesion_factor);
  EXPECT_NEAR(cohesion, 1., 4. * 0.1 / std::sqrt(n));
  EXPECT_NEAR(cohesion_deviation, 0.9866 * 0.1, 4. * 0.1 / std::sqrt(2. * n));
  double product = 0.; // independent of one another
  for (std::size_t j = 0; j < joints.size(); ++j)
    product += (joints.tension_factor[j] - 1.) * (joints.cohesion_factor[j] - 1.);
  EXPECT_NEAR(product / (n * 0.2 * 0.1), 0., 4. / std::sqrt(n));

  Sample swapped = sample;
  std::swap(swapped.joints.first, swapped.joints.second);
  scatter_strengths(swapped.joints, 0, {0.2, 0.1}, 11);
  EXPECT_EQ(swapped.joints.tension_factor, joints.tension_factor);
  scatter_strengths(swapped.joints, 0, {0.2, 0.1}, 12);
  EXPECT_NE(swapped.joints.tension_factor, joints.tension_factor);
}

// Closed forms of case 10 with the joint's own strengths: a pull breaks it at factor x
// sigma_b, a shear without pressure at factor x c_b.
TEST(StrengthScatter, MovesTheStrengthsOfEachLaw)
{
  FlatJoint flat = strong_law();
  flat.tensile_strength = 1.;
  flat.cohesion = 2.;
  ParallelBond parallel;
  parallel.bond_modulus = 1e3;
  parallel.tensile_strength = 1.;
  parallel.cohesion = 2.;
  ContactBond glued;
  glued.effective_modulus = 1e3;
  glued.tensile_strength = 1.;
  glued.shear_strength = 2.;
  for (const JointLaw &law : {JointLaw{flat}, JointLaw{parallel}, JointLaw{glued}})
    for (const double factor : {0.5, 1.5})
    {
      const auto make = [&]
      {
        Sample pair = bonded_pair(law);
        pair.joints.tension_factor = {factor};
        pair.joints.cohesion_factor = {factor};
        return pair;
      };
      Sample pulled = make();
      const double k = pulled.joints.stiffness[0], to_break = factor * 1. / k;
      load(pulled, {0.999 * to_break, 0., 0.});
      EXPECT_TRUE(pulled.cracks.empty());
      load(pulled, {1.001 * to_break, 0., 0.});
      EXPECT_FALSE(pulled.cracks.empty());
      Sample sheared = make();
      const double to_shear = factor * 2. / (k / constants(law).stiffness_ratio);
      load(sheared, {0., 0.999 * to_shear, 0.});
      EXPECT_TRUE(sheared.cracks.empty());
      load(sheared, {0., 1.001 * to_shear, 0.});
      ASSERT_FALSE(sheared.cracks.empty());
      EXPECT_EQ(sheared.cracks.front().mode, Bond::broken_in_shear);
    }
}

TEST(StrengthScatter, StaysWithAJointThatHasLostAnElement)
{
  FlatJoint flat = strong_law();
  flat.tensile_strength = 1.;
  flat.cohesion = 2.;
  Sample pair = bonded_pair(flat);
  pair.joints.tension_factor = {1.5};
  pair.joints.cohesion_factor = {1.5};
  break_element(pair.grains, pair.joints, 0, 0, Bond::broken_in_tension);
  const double k = pair.joints.stiffness[0];
  load(pair, {1.499 / k, 0., 0.});
  EXPECT_TRUE(pair.cracks.empty());
  load(pair, {1.501 / k, 0., 0.});
  EXPECT_EQ(pair.cracks.size(), 2u);
}
} // namespace antiform::discrete::test::joint_types_tests

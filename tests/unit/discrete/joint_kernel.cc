#include "discrete/joint_kernel.h"
#include "discrete/joint_types.h"

#include "support/grain_fixtures.h"
#include "support/plain_joint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace antiform::discrete::test::joint_kernel_tests
{
namespace
{
/// A pack with joints, displaced and turned at random; @p prestress and @p weights
/// optional.
Sample moved_sample(const double displacement,
                    const double rotation,
                    const int n_elements,
                    const bool weights,
                    const bool prestress)
{
  Sample sample;
  sample.grains = random_pack(14, 13, 5);
  FlatJoint law = strong_law(n_elements);
  law.element_moment = n_elements != 2;
  bond_all(sample, law);
  Random random(21);
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    sample.grains.displacement_x[i] = random(-displacement, displacement);
    sample.grains.displacement_y[i] = random(-displacement, displacement);
    sample.grains.rotation[i] = random(-rotation, rotation);
  }
  Joints &joints = sample.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    if (weights)
      joints.weight.push_back(random(0.001, 1.));
    if (!prestress)
      continue;
    joints.initial_gap.push_back(random(-displacement, displacement));
    joints.initial_shear.push_back(random(-displacement, displacement));
    joints.initial_rotation.push_back(random(-rotation, rotation));
  }
  return sample;
}

/// Forces and the list of joints over a strength from one level's kernels alone.
struct KernelResult
{
  std::vector<GrainLine> lines;
  std::vector<JointForce> force;
  std::vector<std::int32_t> over;
};
KernelResult run_kernel(const KernelLevel &level, Sample &sample)
{
  const Grains &grains = sample.grains;
  Joints &joints = sample.joints;
  KernelResult result;
  result.lines.resize(grains.size());
  result.force.resize(joints.size());
  level.lines(grains.displacement_x.data(), grains.displacement_y.data(),
              grains.rotation.data(), result.lines.data(), 0, grains.size());
  IntactKernelInput in{};
  in.grains = result.lines.data();
  in.first = joints.first.data();
  in.second = joints.second.data();
  in.normal_x = joints.normal_x.data();
  in.normal_y = joints.normal_y.data();
  in.length = joints.length.data();
  in.lever_difference = joints.lever_difference.data();
  in.stiffness = joints.stiffness.data();
  in.half_length = joints.half_length.data();
  const auto pointer = [](const std::vector<double> &v)
  { return v.empty() ? nullptr : v.data(); };
  in.weight = pointer(joints.weight);
  in.initial_gap = pointer(joints.initial_gap);
  in.initial_shear = pointer(joints.initial_shear);
  in.initial_rotation = pointer(joints.initial_rotation);
  in.tension_factor = pointer(joints.tension_factor);
  in.cohesion_factor = pointer(joints.cohesion_factor);
  in.shear_ratio = 1. / 2.2;
  in.moment_factor = 1. / 12.;
  in.tension_arm = in.coulomb_arm = 2. / 3.;
  in.tensile_strength = 1.; // many of the moved joints are over one of these
  in.cohesion = 2.;
  in.tan_friction = 0.2;
  for (std::size_t begin = 0; begin < joints.size(); begin += intact_block)
  {
    std::int32_t over[intact_block];
    const std::size_t n =
        level.intact(in, begin, std::min(begin + intact_block, joints.size()),
                     result.force.data() + begin, over);
    result.over.insert(result.over.end(), over, over + n);
  }
  return result;
}

/// Largest error of a component of force (over k A u) or torque (over k A u R).
double twin_error(const double displacement,
                  const double rotation,
                  const int n_elements,
                  const bool weights,
                  const bool prestress)
{
  Sample sample = moved_sample(displacement, rotation, n_elements, weights, prestress);
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  double worst = 0.;
  for (std::size_t j = 0; j < sample.joints.size(); ++j)
  {
    const JointForce plain = plain_joint_force(sample.grains, sample.joints, j);
    const JointForce fast = sample.joints.force[j];
    const double scale = sample.joints.stiffness[j] * 2. * sample.joints.half_length[j] *
                         (displacement + rotation) *
                         (weights ? sample.joints.weight[j] : 1.);
    for (const double error :
         {fast.x - plain.x, fast.y - plain.y, fast.torque1 - plain.torque1,
          fast.torque2 - plain.torque2})
      worst = std::max(worst, std::abs(error) / scale);
  }
  return worst;
}
} // namespace

TEST(IntactKernel, AgreesWithThePlainTwin)
{
  // Scale: the force of a joint that carries the whole motion. The kernel forms a gap
  // from a dozen products of that size, each with half an ulp (1.1e-16) of rounding, and
  // Cephes' sine is good to about one ulp. Smaller motions are not for this twin: its own
  // cancellation, 5e-20 of the grain's size, is 5e-15 of the smallest here.
  for (const bool weights : {false, true})
    for (const bool prestress : {false, true})
      for (const int n : {1, 2, 3})
        for (const double size : {1e-5, 1e-4, 1e-2})
          EXPECT_LT(twin_error(size, size, n, weights, prestress), 1e-13)
              << size << ' ' << n << ' ' << weights << prestress;
}

TEST(IntactKernel, AgreesWithThePlainTwinWhenGrainsHaveTurnedFar)
{
  for (const double turn : {0.5, 2., 6., 20.})
    EXPECT_LT(twin_error(0.1, turn, 3, true, true), 1e-13) << turn; // as above
}

TEST(IntactKernel, EveryLevelOfThisProcessorGivesTheSameBits)
{
  const std::vector<KernelLevel> levels = supported_kernel_levels();
  ASSERT_FALSE(levels.empty());
  for (const double turn : {1e-3, 3.})
    for (const bool weights : {false, true})
      for (const bool prestress : {false, true})
      {
        Sample sample = moved_sample(1e-3, turn, 3, weights, prestress);
        KernelResult plain = run_kernel(levels.front(), sample);
        ASSERT_GT(plain.over.size(), 10u); // the lists that are compared are not empty
        if (weights) // scatter changes who is over its strength, and nothing else
        {
          const std::vector<std::int32_t> without_scatter = plain.over;
          scatter_strengths(sample.joints, 0, {0.4, 0.4}, 3);
          plain = run_kernel(levels.front(), sample);
          if (turn < 1.) // turned far, joints are over any strength
          {
            EXPECT_NE(plain.over, without_scatter);
          }
        }
        for (const KernelLevel &level : levels)
        {
          const KernelResult other = run_kernel(level, sample);
          for (std::size_t i = 0; i < sample.grains.size(); ++i)
          {
            EXPECT_EQ(plain.lines[i].half_cos, other.lines[i].half_cos) << level.name;
            EXPECT_EQ(plain.lines[i].half_sin, other.lines[i].half_sin) << level.name;
          }
          EXPECT_EQ(std::memcmp(plain.force.data(), other.force.data(),
                                plain.force.size() * sizeof(JointForce)),
                    0)
              << level.name;
          EXPECT_EQ(plain.over, other.over) << level.name;
        }
      }
}

TEST(IntactKernel, SineAndCosineAreGoodToTwoUlp)
{
  const KernelLevel level = supported_kernel_levels().back();
  constexpr std::size_t n = 4096;
  std::vector<double> zero(n, 0.), angle(n);
  std::vector<GrainLine> lines(n);
  for (const double range : {1e-3, 1., 10., 1e4})
  {
    Random random(3);
    for (double &a : angle)
      a = random(-range, range);
    level.lines(zero.data(), zero.data(), angle.data(), lines.data(), 0, n);
    for (std::size_t i = 0; i < n; ++i)
    {
      const long double half = 0.5L * angle[i];
      // One ulp of 1 for both: near a zero of the function the reduction's own error,
      // some 1e-17 a quarter turn, is absolute.
      EXPECT_NEAR(lines[i].half_sin, static_cast<double>(std::sin(half)), 2.3e-16);
      EXPECT_NEAR(lines[i].half_cos, static_cast<double>(std::cos(half)), 2.3e-16);
      if (range <= 1e-3) // no reduction: one ulp relative
      {
        EXPECT_NEAR(lines[i].half_sin / static_cast<double>(std::sin(half)), 1., 2.3e-16);
      }
    }
  }
}

TEST(IntactKernel, AtRestGivesExactlyZero)
{
  Sample sample;
  sample.grains = random_pack(9, 8, 4);
  bond_all(sample, strong_law());
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    EXPECT_EQ(sample.grains.force_x[i], 0.);
    EXPECT_EQ(sample.grains.force_y[i], 0.);
    EXPECT_EQ(sample.grains.torque[i], 0.);
  }
  EXPECT_EQ(joint_energies(sample.grains, sample.joints).strain, 0.);
}

TEST(IntactKernel, CountsWouldBeBreaksOfUnbreakableJoints)
{
  FlatJoint law = strong_law();
  law.tensile_strength = 1.;
  law.breakable = false;
  Sample pair = bonded_pair(law);
  load(pair, {0.9e-3, 0., 0.});
  EXPECT_EQ(pair.joints.would_break[0], 0);
  const double force = load(pair, {1.1e-3, 0., 0.}).normal;
  EXPECT_EQ(pair.joints.would_break[0], 1);
  EXPECT_TRUE(pair.cracks.empty());
  EXPECT_NEAR(force, 1.1, 1e-12); // and it still carries: k_n A g, round-off
}
} // namespace antiform::discrete::test::joint_kernel_tests

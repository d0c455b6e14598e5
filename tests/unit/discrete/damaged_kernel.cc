// The vector kernel of the full law against its plain twin, through breaks, closing,
// opening and sliding.
#include "discrete/joint_damage.h"
#include "discrete/joint_kernel.h"

#include "support/grain_fixtures.h"
#include "support/plain_damage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace antiform::discrete::test::damaged_kernel_tests
{
namespace
{
constexpr double size = 2e-3; // of the motion, in grain diameters

/// A record as the plain twin keeps it.
PlainDamagedJoint twin_of(const Joints &joints, const std::size_t k)
{
  const DamagedJoints &damaged = joints.damaged;
  PlainDamagedJoint twin = plain_damaged(joints, damaged.joint[k]);
  for (std::size_t e = 0; e < twin.bond.size(); ++e)
  {
    twin.bond[e] = damaged.bond(k, static_cast<int>(e));
    twin.slip[e] = damaged.slip(k, static_cast<int>(e));
  }
  twin.gap = damaged.gap[k];
  twin.shear = damaged.shear[k];
  twin.rotation = damaged.rotation[k];
  twin.slip_energy = damaged.slip_energy[k];
  twin.fracture_energy = damaged.fracture_energy[k];
  return twin;
}

/// Grains that move to and fro, each at its own pace; two joints in three have lost an
/// element from the start.
class Shaken
{
public:
  Shaken(const int n_elements, const bool weights, const bool prestress)
  {
    sample.grains = random_pack(9, 9, 81);
    FlatJoint law = strong_law(n_elements);
    law.tensile_strength = 1.5;
    law.cohesion = 2.;
    law.residual_friction = 0.5;
    law.residual_cohesion = 0.05;
    law.element_moment = n_elements != 2;
    bond_all(sample, law);
    Joints &joints = sample.joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
      if (weights)
        joints.weight.push_back(random_(0.001, 1.));
      if (!prestress)
        continue;
      joints.initial_gap.push_back(random_(-0.3 * size, 0.3 * size));
      joints.initial_shear.push_back(random_(-0.3 * size, 0.3 * size));
      joints.initial_rotation.push_back(random_(-0.3 * size, 0.3 * size));
    }
    for (std::size_t i = 0; i < 3 * sample.grains.size(); ++i)
    {
      phase_.push_back(random_(0., 2. * M_PI));
      pace_.push_back(random_(0.5, 1.5));
    }
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (j % 3 != 0)
        break_element(sample.grains, joints, j, static_cast<int>(j) % n_elements,
                      Bond::broken_in_tension);
    for (std::size_t k = 0; k < joints.damaged.size(); ++k)
      twins.push_back(twin_of(joints, k));
  }

  void move_to(const double t)
  {
    Grains &g = sample.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const auto at = [&](const std::size_t c)
      { return size * (std::sin(pace_[c] * t + phase_[c]) - std::sin(phase_[c])); };
      g.displacement_x[i] = at(3 * i);
      g.displacement_y[i] = at(3 * i + 1);
      g.rotation[i] = at(3 * i + 2);
    }
  }

  void advance_twins()
  {
    for (PlainDamagedJoint &twin : twins)
      if (!twin.removed)
        plain_evaluate(sample.grains, sample.joints, twin,
                       deformation(sample.grains, sample.joints, twin.joint),
                       {twin.gap, twin.shear, twin.rotation}, {}, &plain_cracks);
  }

  Sample sample;
  std::vector<PlainDamagedJoint> twins;
  std::vector<Crack> plain_cracks;

private:
  Random random_{82};
  std::vector<double> phase_, pace_;
};

void expect_same(const Joints &joints, const std::size_t k, const PlainDamagedJoint &twin)
{
  const DamagedJoints &damaged = joints.damaged;
  const double weight = joints.weight.empty() ? 1. : joints.weight[twin.joint];
  const double area =
      weight * joints.stiffness[twin.joint] * 2. * joints.half_length[twin.joint];
  // 300 steps, each with half an ulp of some ten quantities of the size of the motion.
  constexpr double rounding = 300. * 10. * 1.1e-16;
  const double force = rounding * area * size, energy = force * size;
  EXPECT_NEAR(damaged.force[k].x, twin.force.x, force) << k;
  EXPECT_NEAR(damaged.force[k].y, twin.force.y, force) << k;
  EXPECT_NEAR(damaged.force[k].torque1, twin.force.torque1, force) << k;
  EXPECT_NEAR(damaged.force[k].torque2, twin.force.torque2, force) << k;
  EXPECT_NEAR(strain_energy(joints, damaged, k), plain_strain_energy(joints, twin),
              energy);
  // What has been dissipated is a sum over a path some 30 sizes long.
  EXPECT_NEAR(damaged.slip_energy[k], twin.slip_energy, 30. * energy) << k;
  EXPECT_NEAR(damaged.fracture_energy[k], twin.fracture_energy, 30. * energy) << k;
  for (std::size_t e = 0; e < twin.bond.size(); ++e)
  {
    EXPECT_EQ(damaged.bond(k, static_cast<int>(e)), twin.bond[e]) << k << ' ' << e;
    EXPECT_NEAR(damaged.slip(k, static_cast<int>(e)), twin.slip[e], rounding * size);
  }
}

/// 300 steps of the kernel and of its plain twin.
void run_with_twin(const int n_elements, const bool weights, const bool prestress)
{
  Shaken shaken(n_elements, weights, prestress);
  Sample &sample = shaken.sample;
  for (int step = 1; step <= 300; ++step)
  {
    shaken.move_to(0.02 * step);
    evaluate_broken_joints(sample.grains, sample.joints, {}, &sample.cracks);
    shaken.advance_twins();
  }
  const DamagedJoints &damaged = sample.joints.damaged;
  ASSERT_GT(damaged.size(), 100u);
  std::size_t n_slid = 0;
  for (std::size_t k = 0; k < damaged.size(); ++k)
  {
    expect_same(sample.joints, k, shaken.twins[k]);
    n_slid += damaged.slip_energy[k] > 0. ? 1 : 0;
  }
  EXPECT_GT(n_slid, damaged.size() / 2);
  EXPECT_EQ(sample.cracks.size(), shaken.plain_cracks.size());
  if (n_elements > 1)
  {
    EXPECT_GT(sample.cracks.size(), 20u);
  }
}

template <class T>
bool same_bits(const T *a, const T *b, const std::size_t n)
{
  return std::memcmp(a, b, n * sizeof(T)) == 0;
}

void expect_same_bits(const DamagedJoints &a,
                      const DamagedJoints &b,
                      const int n_elements)
{
  const std::size_t n = a.size();
  EXPECT_TRUE(same_bits(a.force.data(), b.force.data(), n));
  EXPECT_TRUE(same_bits(a.gap.data(), b.gap.data(), n));
  EXPECT_TRUE(same_bits(a.shear.data(), b.shear.data(), n));
  EXPECT_TRUE(same_bits(a.rotation.data(), b.rotation.data(), n));
  EXPECT_TRUE(same_bits(a.slip_energy.data(), b.slip_energy.data(), n));
  for (std::size_t k = 0; k < n; ++k)
    for (int e = 0; e < n_elements; ++e)
    {
      const double slip_a = a.slip(k, e), slip_b = b.slip(k, e);
      EXPECT_TRUE(same_bits(&slip_a, &slip_b, 1)) << k << ' ' << e;
    }
}
} // namespace

TEST(DamagedKernel, AgreesWithThePlainTwin)
{
  for (const int n : {1, 2, 3, 5})
    for (const bool weights : {false, true})
      for (const bool prestress : {false, true})
        run_with_twin(n, weights, prestress);
}

TEST(DamagedKernel, GivesTheBitsOfTheScalarLawOnEveryLevel)
{
  for (const int n : {1, 3})
    for (const bool more : {false, true})
    {
      Shaken shaken(n, more, more);
      Joints &joints = shaken.sample.joints;
      const Grains &grains = shaken.sample.grains;
      for (int step = 1; step <= 40; ++step)
      {
        shaken.move_to(0.05 * step);
        std::vector<Joints> outcomes;
        for (const KernelLevel &level : supported_kernel_levels())
        {
          outcomes.push_back(joints);
          fill_lines(grains, outcomes.back());
          const DamagedKernelInput in = damaged_input(outcomes.back(), false);
          for (std::size_t k = 0; k < joints.damaged.size(); k += 4)
            ASSERT_FALSE(level.damaged(in, k));
        }
        DamagedJoints &scalar = joints.damaged;
        for (std::size_t k = 0; k < scalar.size(); ++k)
          evaluate_damaged(grains, joints, scalar, k,
                           {scalar.gap[k], scalar.shear[k], scalar.rotation[k]}, {},
                           nullptr);
        for (const Joints &outcome : outcomes)
          expect_same_bits(outcome.damaged, scalar, n);
      }
    }
}

TEST(DamagedKernel, LeavesJointsInWhichSomethingBreaksAsTheyWere)
{
  Shaken shaken(3, false, false);
  Joints &joints = shaken.sample.joints;
  shaken.move_to(3.); // at once: many strengths are passed
  const Joints before = joints;
  fill_lines(shaken.sample.grains, joints);
  const DamagedKernelInput in = damaged_input(joints, true);
  std::size_t n_left = 0;
  for (std::size_t k = 0; k < joints.damaged.size(); k += 4)
    if (kernel_level().damaged(in, k))
    {
      ++n_left;
      for (std::size_t l = k; l < std::min(k + 4, joints.damaged.size()); ++l)
      {
        EXPECT_EQ(joints.damaged.gap[l], before.damaged.gap[l]);
        EXPECT_EQ(joints.damaged.slip(l, 0), before.damaged.slip(l, 0));
      }
    }
  EXPECT_GT(n_left, 10u);
}
} // namespace antiform::discrete::test::damaged_kernel_tests

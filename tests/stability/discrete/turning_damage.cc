// A cluster with intact, half-broken and broken joints turns once about, rubbing and
// pressed as it is: nothing that it carries may change.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::turning_damage_tests
{
namespace
{
/// Joint j is intact, has lost one element, two, or all, by turns.
Sample cluster()
{
  Sample sample;
  FlatJoint law = strong_law();
  law.residual_friction = 0.3;
  sample.grains = random_pack(6, 6, 55);
  bond_all(sample, law);
  for (std::size_t j = 0; j < sample.joints.size(); ++j)
    for (int e = 0; e < static_cast<int>(j % 4); ++e)
      break_element(sample.grains, sample.joints, j, e, Bond::broken_in_shear);
  return sample;
}

/// Turn the state @p still, whatever its deformation, by @p angle about a far point.
void turn(Grains &g, const Grains &still, const double angle)
{
  const Vec2 centre{-7., 3.};
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 there = centre + rotated(still.position(i) - centre, angle);
    g.displacement_x[i] = there.x - g.reference_x[i];
    g.displacement_y[i] = there.y - g.reference_y[i];
    g.rotation[i] = still.rotation[i] + angle;
  }
}
} // namespace

TEST(TurningDamage, PrescribedTurnLeavesForcesEnergyAndSlipAlone)
{
  Sample sample = cluster();
  Grains &g = sample.grains;
  // Squeezed and sheared until many of the broken elements slide.
  Random random(56);
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    g.displacement_x[i] = -0.01 * g.reference_x[i] + 0.02 * g.reference_y[i];
    g.displacement_y[i] = -0.01 * g.reference_y[i] + random(-1e-3, 1e-3);
    g.rotation[i] = random(-0.02, 0.02);
  }
  compute_joint_forces(g, sample.joints, {}, &sample.cracks);
  compute_joint_forces(g, sample.joints, {}, &sample.cracks); // at rest
  const Grains still = g;
  const JointEnergies before = joint_energies(g, sample.joints);
  ASSERT_GT(before.slip, 1e-3 * before.strain);
  double scale = 0.;
  for (std::size_t i = 0; i < g.size(); ++i)
    scale = std::max({scale, std::abs(still.force_x[i]), std::abs(still.force_y[i])});
  for (int degree = 1; degree <= 360; ++degree)
  {
    const double angle = degree * M_PI / 180.;
    turn(g, still, angle);
    compute_joint_forces(g, sample.joints, {}, &sample.cracks);
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const Vec2 f = rotated({still.force_x[i], still.force_y[i]}, angle);
      // Rounding of displacements of ten diameters, 2e-15, times a stiffness of 1e3 is
      // 1e-12; a ratchet of friction would add up 360 of them.
      ASSERT_NEAR(g.force_x[i], f.x, 1e-10 * scale) << degree;
      ASSERT_NEAR(g.force_y[i], f.y, 1e-10 * scale) << degree;
      ASSERT_NEAR(g.torque[i], still.torque[i], 1e-10 * scale) << degree;
    }
  }
  const JointEnergies after = joint_energies(g, sample.joints);
  EXPECT_NEAR(after.strain / before.strain, 1., 1e-10);
  EXPECT_NEAR(after.slip / before.slip, 1., 1e-10);
  EXPECT_EQ(after.fracture, before.fracture);
}

TEST(TurningDamage, FreeTurnKeepsEnergyAndMomentum)
{
  // Spinning freely through one turn and more, with what holds it intact and the rest
  // broken: the centrifugal strain is 1e-5, and bonds are strong.
  const Threads threads(1);
  Sample sample = cluster();
  Vec2 centre;
  double mass = 0.;
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    centre += sample.grains.mass[i] * sample.grains.position(i);
    mass += sample.grains.mass[i];
  }
  centre = (1. / mass) * centre;
  const double spin = 0.05;
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    const Vec2 v = spin * perpendicular(sample.grains.position(i) - centre);
    sample.grains.velocity_x[i] = v.x;
    sample.grains.velocity_y[i] = v.y;
    sample.grains.spin[i] = spin;
  }
  ExplicitRun run(sample);
  const double dt = 0.2 * stable_step(run.sample.grains, run.sample.joints);
  const auto angular = [&]
  {
    const Grains &g = run.sample.grains;
    double sum = 0.;
    for (std::size_t i = 0; i < g.size(); ++i)
      sum += g.mass[i] * cross(g.position(i), g.velocity(i)) + g.inertia[i] * g.spin[i];
    return sum;
  };
  const double angular_before = angular();
  double first = 0., worst = 0., strain = 0.;
  while (run.time < 1.1 * 2. * M_PI / spin)
  {
    run.first_half(dt);
    if (run.step % 200 == 0)
    {
      const EnergyTerms e = run.energies();
      const double sum = e.kinetic + e.strain + e.slip + e.fracture;
      first = run.step == 0 ? sum : first;
      worst = std::max(worst, std::abs(sum / first - 1.));
      strain = std::max(strain, e.strain / first);
    }
    run.second_half(dt);
  }
  EXPECT_GT(run.sample.grains.rotation[0], 2. * M_PI);
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(strain, 1e-3);
  EXPECT_NEAR(angular() / angular_before, 1., 1e-11);
  EXPECT_TRUE(run.sample.cracks.empty());
}
} // namespace antiform::discrete::test::turning_damage_tests

// What total kinematics promise: nothing from a rigid motion, forces that are the
// gradient of an energy however far the grains have turned.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::rigid_motion_tests
{
namespace
{
void turn_rigidly(Grains &grains,
                  const Vec2 &centre,
                  const Vec2 &translation,
                  const double angle)
{
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 arm = grains.reference(i) - centre;
    const Vec2 u = rotated(arm, angle) - arm + translation;
    grains.displacement_x[i] = u.x;
    grains.displacement_y[i] = u.y;
    grains.rotation[i] = angle;
  }
}

double largest_force(const Grains &grains)
{
  double largest = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
    largest = std::max({largest, std::abs(grains.force_x[i]), std::abs(grains.force_y[i]),
                        std::abs(grains.torque[i])});
  return largest;
}

/// Central difference of the joints' strain energy in one degree of freedom.
double energy_slope(Sample &sample, double &freedom, const double h)
{
  const double start = freedom;
  const auto energy = [&](const double at)
  {
    freedom = at;
    // Damaged joints hold the deformation of their last evaluation.
    compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
    return joint_energies(sample.grains, sample.joints).strain;
  };
  const double slope = (energy(start + h) - energy(start - h)) / (2. * h);
  freedom = start;
  return slope;
}

/// Largest difference of force and minus energy slope, over the largest force.
double gradient_error(Sample sample, const double h)
{
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  const Grains forces = sample.grains;
  const double scale = largest_force(forces);
  double worst = 0.;
  for (std::size_t i = 0; i < forces.size(); ++i)
  {
    Grains &g = sample.grains;
    worst = std::max(
        {worst,
         std::abs(forces.force_x[i] + energy_slope(sample, g.displacement_x[i], h)),
         std::abs(forces.force_y[i] + energy_slope(sample, g.displacement_y[i], h)),
         std::abs(forces.torque[i] + energy_slope(sample, g.rotation[i], h))});
  }
  return worst / scale;
}

/// A small pack, turned by @p turn as a whole and deformed by @p size on top.
Sample deformed_pack(const double turn, const double size)
{
  Sample sample;
  sample.grains = random_pack(4, 4, 3);
  bond_all(sample, strong_law());
  turn_rigidly(sample.grains, {1., 2.}, {3., -2.}, turn);
  Random random(31);
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    sample.grains.displacement_x[i] += random(-size, size);
    sample.grains.displacement_y[i] += random(-size, size);
    sample.grains.rotation[i] += random(-size, size);
  }
  return sample;
}
} // namespace

TEST(RigidMotion, GivesNoForceMomentOrEnergyAtAnyAngle)
{
  // Polydisperse, with gaps and overlaps; also with elements that were broken at rest,
  // whose law is that of the loop over elements.
  for (const bool damaged : {false, true})
  {
    Sample sample;
    sample.grains = random_pack(8, 8, 12);
    bond_all(sample, strong_law());
    for (std::size_t j = 0; damaged && j < sample.joints.size(); j += 2)
      break_element(sample.grains, sample.joints, j, static_cast<int>(j / 2 % 3),
                    Bond::broken_in_shear);
    double smallest = 1e300, largest = -1e300;
    for (std::size_t j = 0; j < sample.joints.size(); ++j)
    {
      const double gap = sample.joints.length[j] -
                         sample.grains.radius[sample.joints.first[j]] -
                         sample.grains.radius[sample.joints.second[j]];
      smallest = std::min(smallest, gap);
      largest = std::max(largest, gap);
    }
    ASSERT_LT(smallest, -0.05);
    ASSERT_GT(largest, 0.05);
    // k_n R^2 with k_n = E*/2R, R = 1/2: a joint's force when it is opened by R. Rounding
    // of displacements of ten diameters is 1e-15 of it, times the sum over neighbours.
    const double scale = 1e3 * 0.25;
    for (int degree = 0; degree <= 360; ++degree)
    {
      turn_rigidly(sample.grains, {2., 1.}, {0.3, -4.}, degree * M_PI / 180.);
      compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
      ASSERT_LT(largest_force(sample.grains), 1e-10 * scale) << degree;
      ASSERT_LT(joint_energies(sample.grains, sample.joints).strain, 1e-10 * scale);
    }
  }
}

TEST(RigidMotion, OfADeformedPackTurnsItsForces)
{
  // Objectivity with deformation: forces turn with the body, torques stay.
  Sample still = deformed_pack(0., 0.02);
  compute_joint_forces(still.grains, still.joints, {}, nullptr);
  const double scale = largest_force(still.grains);
  for (const double turn : {0.4, 1.9, 3.1, 5.})
  {
    Sample turned = still;
    for (std::size_t i = 0; i < turned.grains.size(); ++i)
    {
      const Vec2 u = rotated(still.grains.position(i), turn) - still.grains.reference(i);
      turned.grains.displacement_x[i] = u.x;
      turned.grains.displacement_y[i] = u.y;
      turned.grains.rotation[i] += turn;
    }
    compute_joint_forces(turned.grains, turned.joints, {}, nullptr);
    for (std::size_t i = 0; i < turned.grains.size(); ++i)
    {
      const Vec2 f = rotated({still.grains.force_x[i], still.grains.force_y[i]}, turn);
      // Rounding of displacements of the pack's size: 1e-15 over deformations of 0.02.
      EXPECT_NEAR(turned.grains.force_x[i], f.x, 1e-12 * scale);
      EXPECT_NEAR(turned.grains.force_y[i], f.y, 1e-12 * scale);
      EXPECT_NEAR(turned.grains.torque[i], still.grains.torque[i], 1e-12 * scale);
    }
  }
}

TEST(JointPotential, ForcesAreMinusTheGradientOfTheEnergyAtLargeRotations)
{
  // Central differences with h = 1e-5: truncation h^2, rounding 1e-16 E / (h F), both
  // near 1e-10.
  for (const double turn : {0., 0.7, 2.5, 4.})
    for (const double size : {0.01, 0.3})
      EXPECT_LT(gradient_error(deformed_pack(turn, size), 1e-5), 1e-7)
          << turn << ' ' << size;
}

TEST(JointPotential, HoldsWithWeightsAndPrestress)
{
  Sample sample = deformed_pack(1.2, 0.05);
  Random random(7);
  for (std::size_t j = 0; j < sample.joints.size(); ++j)
  {
    sample.joints.weight.push_back(random(0.001, 1.));
    sample.joints.initial_gap.push_back(random(-0.05, 0.05));
    sample.joints.initial_shear.push_back(random(-0.05, 0.05));
    sample.joints.initial_rotation.push_back(random(-0.1, 0.1));
  }
  EXPECT_LT(gradient_error(sample, 1e-5), 1e-7); // as above
}

TEST(JointPotential, HoldsForCrackedJointsThatDoNotSlide)
{
  // Without friction a broken joint has a potential as well: a compressed part that
  // grows and shrinks. Its second derivative jumps where the crack's tip passes an
  // element's end: first order in h at worst, within 1e-5 of such a place.
  for (const bool weights : {false, true})
  {
    FlatJoint law = strong_law();
    law.residual_friction = 0.;
    Sample sample;
    sample.grains = random_pack(4, 4, 3);
    bond_all(sample, law);
    for (std::size_t j = 0; j < sample.joints.size(); ++j)
    {
      if (weights)
        sample.joints.weight.push_back(0.1 + 0.01 * static_cast<double>(j));
      for (int e = 0; e < 1 + static_cast<int>(j % 3); ++e)
        break_element(sample.grains, sample.joints, j, e, Bond::broken_in_tension);
    }
    turn_rigidly(sample.grains, {0., 0.}, {1., 0.}, 0.5);
    Random random(32);
    for (std::size_t i = 0; i < sample.grains.size(); ++i)
    {
      sample.grains.displacement_x[i] += random(-0.02, 0.02);
      sample.grains.displacement_y[i] += random(-0.02, 0.02);
      sample.grains.rotation[i] += random(-0.05, 0.05);
    }
    EXPECT_LT(gradient_error(sample, 1e-6), 1e-6);
  }
}

TEST(JointForces, BalanceForcesAndMomentsOfEveryJoint)
{
  Sample sample = deformed_pack(1., 0.2);
  for (std::size_t j = 0; j < sample.joints.size(); j += 3)
    break_element(sample.grains, sample.joints, j, 1, Bond::broken_in_shear);
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  for (std::size_t j = 0; j < sample.joints.size(); ++j)
  {
    const JointForce f = sample.joints.force[j];
    const Vec2 branch = sample.grains.position(sample.joints.second[j]) -
                        sample.grains.position(sample.joints.first[j]);
    // Round-off of products of force and distance.
    const double scale = norm({f.x, f.y}) + std::abs(f.torque1) + std::abs(f.torque2);
    EXPECT_NEAR(f.torque1 + f.torque2 + cross(branch, {f.x, f.y}), 0., 1e-13 * scale);
  }
}
} // namespace antiform::discrete::test::rigid_motion_tests

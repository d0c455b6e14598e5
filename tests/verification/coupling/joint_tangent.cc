// The tangent of joints against the kernel's forces: intact, prestressed, damaged,
// sliding.
#include "coupling/geometric_stiffness.h"
#include "discrete/joint_tangent.h"
#include "support/coupling_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::joint_tangent_tests
{
namespace
{
/// Grains in general position with joints of every kind of load, weighted, that turn.
GrainState loaded_assembly(const bool displaced, const bool prestressed)
{
  GrainState state;
  discrete::Random random(11, 3);
  const auto number = [&](const double size)
  { return size * (2. * random.uniform() - 1.); };
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      state.grains.add({c + 0.5 * (r % 2) + number(0.05), 0.87 * r + number(0.05)},
                       0.45 + number(0.08), 1., 0);
  discrete::Joints &joints = state.joints;
  joints.begin_group(elastic_law(), 0, "grains");
  for (const auto &[i, j] : discrete::pairs_within(state.grains, 0.35, 0, 0))
    joints.add(state.grains, i, j, 1., 1.7);
  joints.finish(state.grains.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    joints.weight.push_back(0.6 + number(0.4));
    if (prestressed)
    {
      joints.initial_gap.push_back(number(0.1));
      joints.initial_shear.push_back(number(0.1));
      joints.initial_rotation.push_back(number(0.1));
    }
  }
  if (displaced)
    for (std::size_t i = 0; i < state.grains.size(); ++i)
    {
      state.grains.displacement_x[i] = number(0.2);
      state.grains.displacement_y[i] = number(0.2);
      state.grains.rotation[i] = 0.6 + number(0.4);
    }
  return state;
}

double &unknown(discrete::Grains &grains, const Eigen::Index k)
{
  const auto i = static_cast<std::size_t>(k / 3);
  return k % 3 == 0   ? grains.displacement_x[i]
         : k % 3 == 1 ? grains.displacement_y[i]
                      : grains.rotation[i];
}

Eigen::VectorXd kernel_forces(GrainState &state)
{
  discrete::Grains &g = state.grains;
  discrete::compute_joint_forces(g, state.joints, {}, nullptr);
  Eigen::VectorXd f(3 * static_cast<Eigen::Index>(g.size()));
  for (std::size_t i = 0; i < g.size(); ++i)
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        Eigen::Vector3d(g.force_x[i], g.force_y[i], g.torque[i]);
  return f;
}

/// -df/dq by central differences, error of order step^2 and 1e-16 / step.
Eigen::MatrixXd differences(GrainState &state, const double step = 1e-5)
{
  const auto n = 3 * static_cast<Eigen::Index>(state.grains.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    double &q = unknown(state.grains, k);
    const double before = q;
    q = before + step;
    const Eigen::VectorXd forward = kernel_forces(state);
    q = before - step;
    K.col(k) = (kernel_forces(state) - forward) / (2. * step);
    q = before;
  }
  return K;
}

double antisymmetric_share(const Eigen::MatrixXd &K)
{
  return 0.5 * (K - K.transpose()).norm() / K.norm();
}
} // namespace

TEST(JointTangent, IsTheDerivativeOfTheKernelsForcesAtAnyRotation)
{
  for (const bool prestressed : {false, true})
  {
    GrainState state = loaded_assembly(true, prestressed);
    const StaticSystem system(state.grains, state.joints, nullptr, nullptr);
    const Eigen::MatrixXd tangent = Eigen::MatrixXd(
        system.saddle_point().stiffness + present_geometric_stiffness(system, nullptr));
    const Eigen::MatrixXd found = differences(state);
    const double error = (tangent - found).norm() / found.norm();
    std::printf("  tangent against differences: %.1e, antisymmetric %.1e and %.1e\n",
                error, antisymmetric_share(tangent), antisymmetric_share(found));
    EXPECT_LT(error, 1e-6);
    // The law derives from a potential: symmetric also out of equilibrium, under shear.
    EXPECT_LT(antisymmetric_share(tangent), 1e-15);
    EXPECT_LT(antisymmetric_share(found), 1e-8); // of the differences
    // That it is the geometric part which is tested: without it the error is of the
    // size of the strain, some tenths here.
    EXPECT_GT((Eigen::MatrixXd(system.saddle_point().stiffness) - found).norm(),
              0.05 * found.norm());
  }
}

TEST(JointTangent, OfPrestressAtRestIsTheGeometricStiffnessOfItsForces)
{
  GrainState state = loaded_assembly(false, true);
  const StaticSystem system(state.grains, state.joints, nullptr, nullptr);
  const Eigen::MatrixXd found =
      differences(state) - Eigen::MatrixXd(system.saddle_point().stiffness);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(found.rows(), found.cols());
  const discrete::Joints &joints = state.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const auto of_joint = discrete::geometric_stiffness_at_rest(
        joints, j,
        discrete::intact_tension(joints, j,
                                 {joints.initial_gap[j], joints.initial_shear[j], 0.}));
    for (Eigen::Index a = 0; a < 6; ++a)
      for (Eigen::Index b = 0; b < 6; ++b)
        G(3 * (a < 3 ? joints.first[j] : joints.second[j]) + a % 3,
          3 * (b < 3 ? joints.first[j] : joints.second[j]) + b % 3) += of_joint[a][b];
  }
  EXPECT_LT((G - found).norm(), 1e-6 * found.norm());
}

// Friction follows the normal force but not the other way: dS = mu k_n dg. Of the block
// of one grain's displacements, k_n A (n n + mu t n), that is (mu / sqrt 2) / sqrt(1 +
// mu^2).
TEST(JointTangent, OfASlidingJointIsNotSymmetric)
{
  GrainState state;
  state.grains.add({0., 0.}, 0.5, 1., 0);
  state.grains.add({1., 0.}, 0.5, 1., 0);
  FlatJoint law = elastic_law();
  law.breakable = true;
  state.joints.begin_group(law, 0, "grains");
  state.joints.add(state.grains, 0, 1, 1., 1.);
  state.joints.finish(2);
  discrete::Grains &g = state.grains;
  g.displacement_x[1] = -0.01;
  for (int e = 0; e < law.n_elements; ++e)
    discrete::break_element(g, state.joints, 0, e, discrete::Bond::broken_in_shear);
  g.displacement_y[1] = 0.1; // far past friction
  kernel_forces(state);
  const auto force_after = [&](const double dx, const double dy) // slides further
  {
    GrainState moved = state;
    moved.grains.displacement_x[1] += dx;
    moved.grains.displacement_y[1] += 1e-4 + dy;
    const Eigen::VectorXd f = kernel_forces(moved);
    return Eigen::Vector2d(f[3], f[4]);
  };
  const double step = 1e-5;
  Eigen::Matrix2d K;
  K.col(0) = (force_after(-step, 0.) - force_after(step, 0.)) / (2. * step);
  K.col(1) = (force_after(0., -step) - force_after(0., step)) / (2. * step);
  const double mu = law.residual_friction;
  EXPECT_NEAR(antisymmetric_share(K), mu / std::sqrt(2. * (1. + mu * mu)), 1e-6);
  // What is offered for it sticks: symmetric, and stiffer along the slip.
  const auto sticks = discrete::tangent_stiffness(g, state.joints, 0);
  EXPECT_NEAR(sticks[3][3], K(0, 0), 1e-6);
  EXPECT_NEAR(sticks[4][4], 1. / 2.2 + K(1, 1), 1e-6);
  const StaticSystem system(state.grains, state.joints, nullptr, nullptr);
  EXPECT_THROW(geometric_stiffness(system, {}), std::invalid_argument);
}

// Bonds left of some elements, others open, or closed and sticking over all of their
// length: the derivative of the kernel's forces.
TEST(JointTangent, OfADamagedJointIsThatOfWhatHolds)
{
  FlatJoint law = elastic_law();
  law.breakable = true;
  for (const double gap : {-0.05, 0.05})
    for (const int n_broken : {1, 2, 3})
    {
      if (gap > 0. && n_broken == 3)
        continue; // nothing holds
      GrainState state;
      state.grains.add({0., 0.}, 0.5, 1., 0);
      state.grains.add({0.8, 0.7}, 0.55, 1., 0);
      state.joints.begin_group(law, 0, "grains");
      state.joints.add(state.grains, 0, 1, 1., 1.5);
      state.joints.finish(2);
      state.joints.weight = {0.7};
      for (int e = 0; e < n_broken; ++e)
        discrete::break_element(state.grains, state.joints, 0, e,
                                discrete::Bond::broken_in_tension);
      discrete::Grains &g = state.grains;
      const Vec2 n{state.joints.normal_x[0], state.joints.normal_y[0]};
      // Rotations of 0.01 keep each face wholly open or closed; shear below friction.
      g.displacement_x[1] = gap * n.x - 0.003 * n.y;
      g.displacement_y[1] = gap * n.y + 0.003 * n.x;
      g.rotation = {0.004, 0.010};
      kernel_forces(state);
      const GrainState here = state;
      const double step = 1e-6;
      Eigen::MatrixXd found(6, 6), tangent(6, 6);
      for (Eigen::Index k = 0; k < 6; ++k)
      {
        GrainState forward = here, backward = here; // slips are those of here
        unknown(forward.grains, k) += step;
        unknown(backward.grains, k) -= step;
        found.col(k) = (kernel_forces(backward) - kernel_forces(forward)) / (2. * step);
      }
      const auto K = discrete::tangent_stiffness(here.grains, here.joints, 0);
      for (Eigen::Index a = 0; a < 6; ++a)
        for (Eigen::Index b = 0; b < 6; ++b)
          tangent(a, b) = K[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
      EXPECT_LT((tangent - found).norm(), 1e-6 * found.norm())
          << "gap " << gap << ", " << n_broken << " broken";
      EXPECT_LT(antisymmetric_share(tangent), 1e-15);
    }
}
} // namespace antiform::coupling::test::joint_tangent_tests

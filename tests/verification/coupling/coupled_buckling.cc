// Geometric stiffness of joints against the kernel's forces, struts of grains and of mesh
// against closed forms, and the count of unstable directions on either side of a load.
#include "coupling/coupled_buckling.h"
#include "discrete/joint_tangent.h"
#include "support/coupling_fixtures.h"

#include "continuum/errors.h"
#include "continuum/linear_buckling.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::coupled_buckling_tests
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

namespace
{
/// Grains in a row along x, ends held across, the first along: a Timoshenko beam in
/// finite differences whose buckling has a closed form.
struct Chain
{
  explicit Chain(const int n)
      : n(n)
  {
    for (int i = 0; i <= n; ++i)
      state.grains.add({static_cast<double>(i), 0.}, 0.5, 1., 0);
    state.joints.begin_group(elastic_law(), 0, "grains");
    for (int i = 0; i < n; ++i)
      state.joints.add(state.grains, i, i + 1, 1., 1.);
    state.joints.finish(state.grains.size());
  }
  StaticSystem supported() const
  {
    StaticSystem system(state.grains, state.joints, nullptr, nullptr);
    system.fix_grain(0, 0, 0.);
    system.fix_grain(0, 1, 0.);
    system.fix_grain(static_cast<std::size_t>(n), 1, 0.);
    return system;
  }
  /// Force of m half waves [N], by k_n A = S kappa = 1, k_n I = B, s = sin(k d/2):
  ///   4 B s^2 = N (l c^2 + d s^2) + N^2 c^2 / S
  /// with l the distance of the grains under N, or d where its shortening is not
  /// followed (linear buckling).
  double force(const int m, const bool shortened) const
  {
    const double S = 1. / 2.2, B = 1. / 12.;
    const double s2 = std::pow(std::sin(0.5 * m * M_PI / n), 2), c2 = 1. - s2;
    // a N^2 + N = 4 B s^2
    const double a = c2 / S - (shortened ? c2 : 0.);
    return 8. * B * s2 / (1. + std::sqrt(1. + 16. * a * B * s2));
  }

  int n;
  GrainState state;
};
} // namespace

TEST(CoupledBuckling, PinnedChainHasTheLoadsOfItsClosedForm)
{
  const Chain chain(40);
  StaticSystem system = chain.supported();
  system.add_grain_force(40, 0, -1.);
  const auto modes =
      lowest_coupled_modes(system, geometric_stiffness(system, system.solve()), {4});
  ASSERT_EQ(modes.size(), 4u);
  for (int m = 1; m <= 4; ++m)
  {
    const CoupledMode &mode = modes[static_cast<std::size_t>(m - 1)];
    EXPECT_NEAR(mode.load_factor / chain.force(m, false), 1., 1e-8) << m; // round-off
    EXPECT_LT(mode.residual, 1e-6);
  }
  // Euler's force of the slender chain with the shear of its joints (Haringx):
  // N (1 + N / S) = pi^2 D / L^2; finite differences take k^2 d^2 / 12 = 5e-4 of it.
  const double euler = M_PI * M_PI / 12. / 1600.;
  EXPECT_NEAR(modes[0].load_factor * (1. + 2.2 * modes[0].load_factor) / euler, 1., 1e-3);
}

TEST(CoupledBuckling, InertiaCountsTheLoadsBelow)
{
  const Chain chain(40);
  StaticSystem system = chain.supported();
  system.add_grain_force(40, 0, -1.);
  const SparseMatrix G = geometric_stiffness(system, system.solve());
  for (int m = 1; m <= 4; ++m)
    for (const double side : {-1., 1.})
      EXPECT_EQ(
          n_unstable_directions(system, G, (1. + 1e-6 * side) * chain.force(m, false)),
          side > 0. ? m : m - 1);
}

TEST(CoupledBuckling, ThePresentStateLosesItsStabilityAtTheClosedForm)
{
  for (const int m : {1, 2, 3})
    for (const double side : {-1., 1.})
    {
      Chain chain(40);
      const double N = (1. + 1e-6 * side) * chain.force(m, true);
      for (int i = 0; i <= 40; ++i) // k_n A = 1
        chain.state.grains.displacement_x[static_cast<std::size_t>(i)] = -N * i;
      const StaticSystem system = chain.supported();
      EXPECT_EQ(
          n_unstable_directions(system, present_geometric_stiffness(system, nullptr)),
          side > 0. ? m : m - 1);
    }
}

// A beam that yields to shear buckles under tension too, at about its shear stiffness:
// the other root of the quadratic (Kelly 2003 for bearings of rubber).
TEST(CoupledBuckling, APulledChainShearsAtTheOtherRoot)
{
  const Chain chain(40);
  StaticSystem system = chain.supported();
  system.add_grain_force(40, 0, 1.);
  const auto modes =
      lowest_coupled_modes(system, geometric_stiffness(system, system.solve()));
  const double S = 1. / 2.2, B = 1. / 12.;
  for (int m = 0; m <= 1; ++m) // m = 0: all grains turn alike, at S
  {
    const double s2 = std::pow(std::sin(0.5 * m * M_PI / 40), 2), a = (1. - s2) / S;
    EXPECT_NEAR(modes[static_cast<std::size_t>(m)].load_factor,
                (1. + std::sqrt(1. + 16. * a * B * s2)) / (2. * a), 1e-8);
  }
}

TEST(CoupledBuckling, WhatIsLooseIsRefused)
{
  const Chain chain(10);
  StaticSystem loose(chain.state.grains, chain.state.joints, nullptr, nullptr);
  loose.fix_grain(0, 0, 0.);
  const auto n = static_cast<Eigen::Index>(loose.n_unknowns());
  EXPECT_THROW(n_unstable_directions(loose, SparseMatrix(n, n)), NumericalError);
  EXPECT_THROW(lowest_coupled_modes(loose, SparseMatrix(n, n)), NumericalError);
}

// The mesh alone: the same loads as the continuum's own solver, which knows no
// constraint. Under tension nothing buckles.
TEST(CoupledBuckling, AMeshAloneHasTheLoadsOfTheContinuumsSolver)
{
  dealii::parallel::distributed::Triangulation<2> triangulation(MPI_COMM_SELF);
  make_cells(triangulation, lines(0., 40., 40), lines(-0.5, 0.5, 2),
             [](const Vec2 &) { return true; });
  const continuum::ElasticSolid solid(
      triangulation, {continuum::ElasticMaterial::isotropic(12., 0.25, 1.)}, 2);
  const discrete::Grains none;
  const discrete::Joints no_joints;
  StaticSystem system(none, no_joints, &solid, nullptr);
  continuum::DirichletValues values;
  for (unsigned int dof = 0; dof < solid.dof_handler().n_dofs(); ++dof)
  {
    const auto p = solid.support_point(dof);
    const bool end = p[0] < 1e-6 || p[0] > 40. - 1e-6;
    const bool first = p[0] < 1e-6 && std::abs(p[1]) < 1e-6;
    if ((end && solid.component(dof) == 1) || (first && solid.component(dof) == 0))
    {
      system.fix_mesh(dof, 0.);
      values[dof] = 0.;
    }
    if (end && solid.component(dof) == 0) // Simpson's rule on two cells
      system.add_mesh_force(dof, (p[0] < 1. ? 1. : -1.) *
                                     (std::abs(p[1]) == 0.25  ? 1. / 3.
                                      : std::abs(p[1]) < 1e-6 ? 1. / 6.
                                                              : 1. / 12.));
  }
  const StaticSolution pressed = system.solve();
  const SparseMatrix G = geometric_stiffness(system, pressed, StrainMeasure::green);
  const auto modes = lowest_coupled_modes(system, G, {3});
  const auto expected = continuum::lowest_buckling_modes(
      solid, solid.geometric_stiffness(pressed.mesh),
      continuum::DofReduction(solid, values, {}), {3, 1e-10, 200});
  for (std::size_t m = 0; m < 3; ++m)
    EXPECT_NEAR(modes[m].load_factor / expected[m].load_factor, 1., 1e-8);
  // Biot's strain for Green's: D and the shear change by some strains, pi^2 / 12 / 1600
  // = 5e-4 here.
  const auto biot =
      lowest_coupled_modes(system, geometric_stiffness(system, pressed), {1});
  EXPECT_NEAR(biot[0].load_factor / modes[0].load_factor, 1., 3e-3);
  EXPECT_GT(std::abs(biot[0].load_factor / modes[0].load_factor - 1.), 1e-4);
  EXPECT_THROW(lowest_coupled_modes(system, -1. * G), NumericalError);
}

namespace
{
/// A strut of five rows of the lattice, pinned in the middle of its ends.
struct LatticeStrut
{
  static constexpr int length = 100;

  LatticeStrut()
  {
    state.grains = hexagonal_lattice({0., length, -1.8, 1.8}, {0., 0.},
                                     [](const Vec2 &) { return true; });
    state.joints.begin_group(elastic_law(), 0, "grains");
    for (const auto &[i, j] : discrete::pairs_within(state.grains, 1e-6, 0, 0))
      state.joints.add(state.grains, i, j, 1., 1.);
    state.joints.finish(state.grains.size());
  }
  std::size_t at(const Vec2 &place) const
  {
    for (std::size_t i = 0; i < state.grains.size(); ++i)
      if (norm(state.grains.reference(i) - place) < 1e-6)
        return i;
    throw std::logic_error("no grain there");
  }
  StaticSystem supported() const
  {
    StaticSystem system(state.grains, state.joints, nullptr, nullptr);
    system.fix_grain(at({0., 0.}), 0, 0.);
    system.fix_grain(at({0., 0.}), 1, 0.);
    system.fix_grain(at({length, 0.}), 1, 0.);
    return system;
  }
  /// Force on the three grains of an end of even rows: axial share, and couple's share.
  void load_end(StaticSystem &system,
                const double x,
                const double axial,
                const double couple) const
  {
    for (const int r : {-2, 0, 2})
      system.add_grain_force(at({x, 0.5 * std::sqrt(3.) * r}), 0,
                             axial / 3. + couple * r / (4. * std::sqrt(3.)));
  }
  /// Of the lattice, in pure bending (no geometric term in it): M over curvature.
  double bending_stiffness() const
  {
    StaticSystem system = supported();
    load_end(system, 0., 0., 1e-3);
    load_end(system, length, 0., -1e-3);
    const StaticSolution bent = system.solve();
    // w = curvature / 2 (x - L/4)(x - 3L/4) relative to the quarters: far from the ends
    const auto w = [&](const double x) { return bent.uy[at({x, 0.})]; };
    const double span = 0.25 * length;
    return 1e-3 / (std::abs(w(0.25 * length) - 2. * w(0.5 * length) + w(0.75 * length)) /
                   (span * span));
  }
  GrainState state;
};
} // namespace

TEST(CoupledBuckling, LatticeStrutHasEulersLoadWithShear)
{
  const LatticeStrut strut;
  StaticSystem system = strut.supported();
  strut.load_end(system, 0., 1., 0.);
  strut.load_end(system, LatticeStrut::length, -1., 0.);
  const auto modes =
      lowest_coupled_modes(system, geometric_stiffness(system, system.solve()), {3});
  const double D = strut.bending_stiffness();
  // Shear stiffness of the sheet, 5/6 G h with h = 5 rows.
  const double GA =
      5. / 6. * lattice_material(elastic_law()).stiffness[2][2] * 2.5 * std::sqrt(3.);
  for (int m = 1; m <= 3; ++m)
  {
    const double euler = D * std::pow(m * M_PI / LatticeStrut::length, 2),
                 found = modes[static_cast<std::size_t>(m - 1)].load_factor;
    std::printf("  mode %d: %.6f of Euler, shear predicts %.6f\n", m, found / euler,
                1. / (1. + euler / GA));
    // Shear takes 0.4 % of the first, 3.4 % of the third. What is left: the shear factor
    // of a lattice five rows high, 10 % of that, and ends, 0.1 %.
    EXPECT_NEAR(found / euler, 1. / (1. + euler / GA), 1e-3 + 0.1 * euler / GA);
  }
}
} // namespace antiform::coupling::test::coupled_buckling_tests

// Struts of grains and of mesh against closed forms, and the count of unstable directions
// on either side of a load.
#include "coupling/coupled_buckling.h"
#include "support/coupling_fixtures.h"

#include "continuum/errors.h"
#include "continuum/linear_buckling.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::coupled_buckling_tests
{
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

// Broken joints that are pressed shut bend as intact ones, so that the limit is the same;
// one that is open leaves a half without support.
TEST(CoupledBuckling, ACrackedChainIsStableWhileItIsPressedShut)
{
  for (const double side : {-1., 1.})
  {
    Chain chain(40);
    const double N = (1. + 1e-6 * side) * chain.force(1, true);
    discrete::Grains &g = chain.state.grains;
    for (std::size_t i = 0; i <= 40; ++i)
      g.displacement_x[i] = -N * static_cast<double>(i);
    for (const std::size_t j : {5, 20, 21})
      for (int e = 0; e < 3; ++e)
        discrete::break_element(g, chain.state.joints, j, e,
                                discrete::Bond::broken_in_tension);
    const StaticSystem system = chain.supported();
    const auto n = [&](const double kept)
    {
      return n_unstable_directions(
          system,
          present_geometric_stiffness(system, nullptr, StrainMeasure::biot, kept));
    };
    EXPECT_EQ(n(0.), side > 0. ? 1 : 0);
    for (std::size_t i = 0; i <= 40; ++i) // the joint in the middle opens, no force left
      g.displacement_x[i] = i > 20 ? 0.1 : 0.;
    EXPECT_THROW(n(0.), NumericalError);
    EXPECT_EQ(n(1e-3), 0);
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

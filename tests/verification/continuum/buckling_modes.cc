// Struts by linear buckling: ends, springs, buoyancy, and what the solver refuses.
#include "continuum/errors.h"
#include "continuum/foundation.h"
#include "continuum/layer_theory.h"
#include "continuum/linear_buckling.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace buckling_modes_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
enum class End
{
  free,
  pinned, ///< does not move across
  clamped ///< does not turn either
};

/// A strip of Q2 cells, 1 thick, compressed along x by one newton a metre.
class Strut
{
public:
  Strut(const double length, const unsigned int n_columns, const unsigned int n_rows = 2)
      : triangulation_(MPI_COMM_WORLD)
      , solid_(mesh(length, n_columns, n_rows),
               {ElasticMaterial::isotropic(12., 0., 1.)}, // D = 1 N m
               2)
      , length_(length)
  {
  }

  void add_springs(const double stiffness)
  {
    solid_.add_to_stiffness(winkler_foundation(solid_, {boundary::top}, stiffness));
  }

  /// Lowest forces [N/m]. \param force of the prestress: 1 compression, -1 tension
  std::vector<BucklingMode> modes(const End left,
                                  const End right,
                                  const unsigned int n,
                                  const double force = 1.) const
  {
    DirichletValues values;
    hold(boundary::left, left, values);
    hold(boundary::right, right, values);
    if (left != End::clamped)
      hold_node(solid_, Point<2>(0., 0.), 0, values);
    dealii::SymmetricTensor<2, 2> stress;
    stress[0][0] = -force;
    return lowest_buckling_modes(solid_, solid_.geometric_stiffness(stress),
                                 DofReduction(solid_, values, {}), {n, 1e-10, 200});
  }

  double lowest(const End left, const End right) const
  {
    return modes(left, right, 1).front().load_factor;
  }

private:
  const Triangulation &
  mesh(const double length, const unsigned int n_columns, const unsigned int n_rows)
  {
    make_rectangle(triangulation_, length, 1., n_columns, n_rows);
    return triangulation_;
  }

  void hold(const unsigned int side, const End end, DirichletValues &values) const
  {
    const auto zero = [](const Point<2> &) { return 0.; };
    if (end != End::free)
      prescribe(solid_, side, 1, zero, values);
    // A straight section that does not turn; what it moves along x is no part of bending.
    if (end == End::clamped)
      prescribe(solid_, side, 0, zero, values);
  }

  Triangulation triangulation_;
  ElasticSolid solid_;
  double length_;
};
} // namespace

// Case 35. Shear lowers the force by 0.2 (k h)^2 and turning sections by (k h)^2 / 12,
// together 1e-3 of the clamped strut at this length.
TEST(BucklingModes, EndsOfAStrutDecideItsForce)
{
  const double length = 100.;
  const Strut strut(length, 100);
  const double euler = M_PI * M_PI / (length * length);
  EXPECT_NEAR(strut.lowest(End::pinned, End::pinned) / euler, 1., 1e-3);
  const double pinned = strut.lowest(End::pinned, End::pinned);
  EXPECT_NEAR(strut.lowest(End::clamped, End::clamped) / pinned, 4., 0.005 * 4.);
  EXPECT_NEAR(strut.lowest(End::clamped, End::free) / pinned, 0.25, 0.005 * 0.25);
  EXPECT_NEAR(strut.lowest(End::clamped, End::pinned) / pinned, 2.0457, 0.005 * 2.0457);
}

TEST(BucklingModes, HigherOnesOfAPinnedStrutAreSquares)
{
  const Strut strut(200., 200);
  const auto modes = strut.modes(End::pinned, End::pinned, 5);
  ASSERT_EQ(modes.size(), 5u);
  for (unsigned int m = 1; m <= 5; ++m)
  {
    // (k h)^2 (0.2 + 1/12) = 1.8e-3 of the fifth.
    const double k = m * M_PI / 200.;
    EXPECT_NEAR(modes[m - 1].load_factor / (k * k), 1., 0.3 * k * k + 1e-5) << m;
    EXPECT_NEAR(largest(modes[m - 1].shape), 1., 1e-12);
  }
}

// Case 37, the lowest of all: the fifth of L = 1, D = 1, k_w = 5e4, in units of a
// thickness of L/500.
TEST(BucklingModes, OnSpringsTheLowestIsNotTheLongest)
{
  const double length = 500.;
  Strut strut(length, 240);
  strut.add_springs(5e4 / std::pow(length, 4));
  const auto modes = strut.modes(End::pinned, End::pinned, 3);
  EXPECT_NEAR(modes[0].load_factor * length * length, 449.3825, 1e-3 * 449.3825);
  // m = 4: 16 pi^2 + k_w / 16 pi^2, m = 6 likewise.
  const double pi2 = M_PI * M_PI;
  EXPECT_NEAR(modes[1].load_factor * length * length, 16. * pi2 + 5e4 / (16. * pi2), 0.5);
  EXPECT_NEAR(modes[2].load_factor * length * length, 36. * pi2 + 5e4 / (36. * pi2), 0.5);
}

// Case 48: a layer that floats, lighter above than below, by K_g = (rho_d - rho_u) g.
TEST(BucklingModes, AFloatingLayerBucklesAtTwiceTheRootOfBuoyancyAndStiffness)
{
  // Long waves: k = (K_g / D)^(1/4) = 0.1; eight half waves fit the length.
  const double K = 1e-4, length = 8. * M_PI / 0.1;
  Strut strut(length, 128);
  strut.add_springs(K);
  const auto modes = strut.modes(End::pinned, End::pinned, 1);
  EXPECT_NEAR(modes.front().load_factor / theory::winkler_critical_force(1., K), 1.,
              0.01);
  EXPECT_NEAR(theory::winkler_critical_force(1., K), 2. * std::sqrt(K), 1e-12);
}

// Four levels: the force falls, by order 4 of Q2 (the energy's error).
TEST(BucklingModes, ForcesOfAPinnedStrutConverge)
{
  std::vector<double> force;
  for (const unsigned int n : {1, 2, 4, 8})
    force.push_back(Strut(8., 2 * n, n).lowest(End::pinned, End::pinned));
  for (const std::size_t k : {1, 2})
  {
    const double order = std::log2((force[k - 1] - force[k]) / (force[k] - force[k + 1]));
    EXPECT_GT(force[k], force[k + 1]);
    EXPECT_NEAR(order, 4., k == 1 ? 0.8 : 0.5);
  }
}

TEST(BucklingModes, WhatIsPulledDoesNotBuckle)
{
  const Strut strut(20., 20);
  EXPECT_THROW(strut.modes(End::pinned, End::pinned, 1, -1.), antiform::NumericalError);
}

TEST(BucklingModes, ALoosePartHasNoStiffnessToBuckleAgainst)
{
  const Strut strut(20., 20);
  EXPECT_THROW(strut.modes(End::free, End::pinned, 1), antiform::NumericalError);
}
} // namespace buckling_modes_tests

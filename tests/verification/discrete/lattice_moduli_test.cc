#include "discrete/homogenise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lattice_moduli_tests
{
using namespace antiform;
using namespace antiform::discrete;

namespace
{
constexpr double radius = 0.0015; // [m]

/// Periodic tile of touching equal disks on the triangular lattice; rows along x, or
/// along y when @p turned.
PeriodicTile triangular_lattice(const bool turned)
{
  const double a = 2. * radius, h = std::sqrt(3.) * a; // two rows
  const int columns = 4, row_pairs = 3;
  PeriodicTile tile;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < row_pairs; ++j)
    {
      tile.disks.push_back({{i * a, j * h}, radius});
      tile.disks.push_back({{(i + 0.5) * a, (j + 0.5) * h}, radius});
    }
  tile.size = {columns * a, row_pairs * h};
  if (turned)
  {
    std::swap(tile.size.x, tile.size.y);
    for (Disk &disk : tile.disks)
      std::swap(disk.centre.x, disk.centre.y);
  }
  return tile;
}

class LatticeModuli : public ::testing::TestWithParam<bool>
{
};
INSTANTIATE_TEST_SUITE_P(Orientation, LatticeModuli, ::testing::Bool());
} // namespace

/// Closed form of the triangular lattice, in two dimensions:
///   E = 2 sqrt(3) E* (kappa + 1) / (3 kappa + 1),  nu = (kappa - 1) / (3 kappa + 1);
/// the same in-plane response in plane strain: nu_e = nu / (1 + nu), E_e = E (1 -
/// nu_e^2).
TEST_P(LatticeModuli, AreThoseOfTheClosedForm)
{
  const PeriodicTile tile = triangular_lattice(GetParam());
  for (const double kappa : {1., 2.2, 2.6, 20.})
  {
    SCOPED_TRACE(kappa);
    FlatJoint law;
    law.effective_modulus = 50e9;
    law.stiffness_ratio = kappa;
    const TileResponse r = homogenise(tile, 0.1 * radius, law);
    ASSERT_EQ(r.joints.size(), 3 * tile.disks.size());

    const double e_2d =
        2. * std::sqrt(3.) * law.effective_modulus * (kappa + 1.) / (3. * kappa + 1.);
    const double nu_2d = (kappa - 1.) / (3. * kappa + 1.);
    const double nu = nu_2d / (1. + nu_2d);
    const double e = e_2d * (1. - nu * nu);
    // Round-off of the lattice's coordinates and of the solve, amplified by its
    // condition.
    EXPECT_NEAR(r.young_modulus, e, 1e-8 * e);
    EXPECT_NEAR(r.poisson_ratio, nu, 1e-8);

    const auto &c = r.stiffness;
    const double scale = c[0][0];
    EXPECT_NEAR(c[0][0], c[1][1], 1e-8 * scale);
    EXPECT_NEAR(c[2][2], 0.5 * (c[0][0] - c[0][1]), 1e-8 * scale);
    EXPECT_NEAR(c[0][2], 0., 1e-8 * scale);
    EXPECT_NEAR(c[1][2], 0., 1e-8 * scale);
  }
}

/// The deck's first rock, kappa = 2.2: E = 1.4586 E*, nu = 0.15789 in two dimensions.
TEST_P(LatticeModuli, OfTheFirstRockAreThePrintedOnes)
{
  const TileResponse r =
      homogenise(triangular_lattice(GetParam()), 0.1 * radius, FlatJoint{});
  const double nu_2d = r.poisson_ratio / (1. - r.poisson_ratio);
  const double e_2d = r.young_modulus / (1. - r.poisson_ratio * r.poisson_ratio);
  EXPECT_NEAR(nu_2d, 0.15789, 5e-6);
  EXPECT_NEAR(e_2d / FlatJoint{}.effective_modulus, 1.4586, 5e-5);
  EXPECT_NEAR(r.density_factor, M_PI / (2. * std::sqrt(3.)), 1e-12);
}
} // namespace lattice_moduli_tests

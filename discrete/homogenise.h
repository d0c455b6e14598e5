#pragma once

#include "discrete/flat_joint.h"
#include "discrete/packing.h"

#include <array>
#include <vector>

namespace antiform::discrete
{
/// Joint of a periodic tile: the second grain is shifted by whole periods.
struct TileJoint
{
  int first = 0, second = 0;
  Vec2 shift; ///< added to the centre of the second grain [m]
};

/// Linear elastic response of a periodic tile of flat-jointed grains.
struct TileResponse
{
  /// In-plane stiffness, Voigt (xx, yy, xy engineering shear) [Pa].
  std::array<std::array<double, 3>, 3> stiffness{};
  double young_modulus = 0.;  ///< plane strain E of the isotropic part [Pa]
  double poisson_ratio = 0.;  ///< plane strain nu of the isotropic part [-]
  double density_factor = 0.; ///< solid fraction: bulk density / grain density [-]
  std::vector<TileJoint> joints;
  /// Per joint, for the unit strains xx, yy, xy: gap, shear, rotation at equilibrium.
  std::vector<std::array<std::array<double, 3>, 3>> deformation;
};

/// Response to the three unit strains (engineering shear 1) by a static solve with
/// periodic fluctuations; joints between all pairs whose gap is at most the installation
/// gap of
/// @p parameters. @p law gives stiffness only.
/// The isotropic part is the fit C11 = C22 = (c11 + c22) / 2, C12; plane strain:
/// nu = C12 / (C11 + C12), E = (C11 - C12)(1 + nu). Throws std::runtime_error when the
/// tile has a mechanism.
TileResponse
homogenise(const PeriodicTile &tile, double installation_gap, const FlatJoint &law);

/// Law whose tile response has the wanted plane-strain moduli within 0.1 %: kappa by a
/// bracketing root finder (boost::math::tools::toms748_solve), E* by linearity. Starts
/// from @p law for everything else. Throws std::invalid_argument with the reachable range
/// when @p poisson_ratio is out of it.
FlatJoint match_moduli(const PeriodicTile &tile,
                       double installation_gap,
                       FlatJoint law,
                       double young_modulus,
                       double poisson_ratio);
} // namespace antiform::discrete

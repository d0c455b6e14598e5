#pragma once

#include "continuum/material_law.h"

/// Laws of an isotropic elastic point. With an initial stress S0 each answers S0 + S(E).
/// Formulas and sources: docs/theory/continuum.md, 13.
namespace antiform::continuum
{
/// Strain with its component across the plane: xx, yy, zz and the engineering shear 2 xy.
using PointStrain = std::array<double, 4>;

/// Isotropic elastic constants [Pa].
struct LameConstants
{
  double lambda;
  double mu; ///< shear modulus

  /// Throws std::invalid_argument unless @p young_modulus > 0 [Pa] and
  /// -1 < @p poisson_ratio < 1/2.
  static LameConstants from_young_poisson(double young_modulus, double poisson_ratio);

  double bulk_modulus() const { return lambda + 2. / 3. * mu; }
  /// Hooke's law, both ways.
  PointStress stress(const PointStrain &strain) const;
  PointStrain strain(const PointStress &stress) const;
  /// d (xx, yy, xy) / d strain in plane strain.
  std::array<PlaneVector, 3> plane_stiffness() const;
};

/// Hooke's law of small strain.
class LinearElastic : public MaterialLaw
{
public:
  explicit LinearElastic(const LameConstants &constants)
      : constants_(constants)
  {
  }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;

private:
  LameConstants constants_;
};

/// Compressible neo-Hookean solid, S = mu (1 - C^-1) + lambda ln J C^-1 with C = 1 + 2 E
/// and C_33 = 1 (Bonet & Wood 2008). It resists without bound as J -> 0 and J ->
/// infinity. Throws NumericalError where det C = J^2 <= 0. An inverted cell has det C > 0
/// again: only who knows F can tell.
class NeoHookean : public MaterialLaw
{
public:
  explicit NeoHookean(const LameConstants &constants)
      : constants_(constants)
  {
  }
  bool is_finite_strain() const override { return true; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;
  /// S at a Green-Lagrange strain, and the energy per area of the reference body that it
  /// derives from, mu/2 (tr C - 3 - 2 ln J) + lambda/2 (ln J)^2 [J/m^3]. Throw as
  /// respond().
  PointStress stress(const PlaneVector &strain) const;
  double energy(const PlaneVector &strain) const;

private:
  LameConstants constants_;
};

/// St Venant-Kirchhoff solid, S = lambda tr E 1 + 2 mu E: Hooke's law for any rotation,
/// but small strain. In uniaxial compression its force is greatest at the stretch
/// 1/sqrt(3) and falls beyond; it answers there all the same. Throws NumericalError where
/// det C <= 0.
class StVenantKirchhoff : public MaterialLaw
{
public:
  explicit StVenantKirchhoff(const LameConstants &constants)
      : constants_(constants)
  {
  }
  bool is_finite_strain() const override { return true; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;

private:
  LameConstants constants_;
};
} // namespace antiform::continuum

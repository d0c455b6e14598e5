#pragma once

#include "continuum/elastic_laws.h"

namespace antiform::continuum
{
/// Semi-linear solid (John 1960): Biot's stress is linear in the stretch,
///   psi = mu tr (U - 1)^2 + lambda/2 (tr U - 2)^2   with C = U^2 in plane strain.
/// It is what bonded grains are whose joints obey linear laws in frames that turn with
/// them (docs/theory/finite_strain_in_time.md): equal to a regular lattice of them at any
/// uniform deformation. Its energy stays finite as J -> 0. Throws NumericalError where
/// det C <= 0.
class SemiLinear : public MaterialLaw
{
public:
  explicit SemiLinear(const LameConstants &constants)
      : constants_(constants)
  {
  }
  bool is_finite_strain() const override { return true; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;
  /// As those of NeoHookean; the stress across the plane is that of U_zz = 1.
  PointStress stress(const PlaneVector &strain) const;
  double energy(const PlaneVector &strain) const;

private:
  LameConstants constants_;
};
} // namespace antiform::continuum

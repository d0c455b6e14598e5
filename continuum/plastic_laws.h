#pragma once

#include "continuum/elastic_laws.h"
#include "continuum/principal_return.h"

#include <optional>

/// Elastic, perfectly plastic laws of small strain, in plane strain: backward Euler with
/// return mapping and consistent tangent (de Souza Neto, Peric & Owen 2008). Stress is
/// positive in tension, also in the yield functions; angles are in radians. The stress at
/// the start is part of the trial stress: where it lies outside of the yield surface the
/// first answer takes it back. History: plastic strain xx, yy, zz, 2 xy. Strain that is
/// not finite throws NumericalError.
/// Formulas, regions and sources: docs/theory/continuum.md, 13.
namespace antiform::continuum
{
/// Mohr-Coulomb with tension cut-off:
/// f = (s_I - s_III)/2 + (s_I + s_III)/2 sin phi - c cos phi <= 0 and s_I <= sigma_t.
struct MohrCoulombParameters
{
  double cohesion;            ///< c [Pa], >= 0; > 0 without friction
  double friction_angle;      ///< phi [rad], 0 to below pi/2
  double dilation_angle = 0.; ///< psi [rad], 0 to phi
  /// sigma_t [Pa], 0 to c cot phi; its flow is associated. None: up to the apex.
  std::optional<double> tension_cutoff;
};

class MohrCoulomb : public MaterialLaw
{
public:
  /// Throws std::invalid_argument for parameters outside of their ranges.
  MohrCoulomb(const LameConstants &elastic, const MohrCoulombParameters &parameters);

  unsigned int n_history() const override { return 4; }
  double plastic_strain(const double *history) const override;
  bool has_symmetric_tangent() const override { return associated_; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;

private:
  LameConstants elastic_;
  bool associated_;
  PrincipalReturn principal_return_;
};

/// Cone of Drucker and Prager, f = alpha I_1 + sqrt(J_2) - k <= 0, matched to a
/// Mohr-Coulomb rock.
struct DruckerPragerParameters
{
  enum class Match
  {
    outer,                   ///< touches its edges of triaxial compression
    inner,                   ///< and of triaxial extension
    plane_strain_associated, ///< collapses with it in plane strain if psi = phi
    plane_strain_isochoric   ///< and if psi = 0
  };

  double cohesion;       ///< c [Pa], as above
  double friction_angle; ///< phi [rad], 0 to below pi/2
  /// psi [rad], 0 to phi. The slope of the potential is alpha of the same match with psi
  /// for phi.
  double dilation_angle = 0.;
  Match match = Match::outer;
};

class DruckerPrager : public MaterialLaw
{
public:
  /// Throws std::invalid_argument for parameters outside of their ranges.
  DruckerPrager(const LameConstants &elastic, const DruckerPragerParameters &parameters);

  double friction_slope() const { return alpha_; }    ///< alpha [-]
  double dilation_slope() const { return dilation_; } ///< alpha of the potential [-]
  double shear_strength() const { return k_; }        ///< k, sqrt(J_2) at I_1 = 0 [Pa]

  unsigned int n_history() const override { return 4; }
  double plastic_strain(const double *history) const override;
  bool has_symmetric_tangent() const override { return alpha_ == dilation_; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;

private:
  /// Tangent of a return to the cone with the trial deviator @p s, of which it keeps the
  /// share @p kept; @p resistance is the fall of f per plastic multiplier [Pa].
  std::array<PlaneVector, 3> cone_tangent(const PointStress &s,
                                          double root_j2,
                                          double kept,
                                          double resistance) const;

  LameConstants elastic_;
  double alpha_, dilation_, k_;
};
} // namespace antiform::continuum

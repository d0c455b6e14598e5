#pragma once

#include <array>

namespace antiform::continuum
{
/// Strain or stress in the plane in Voigt order: xx, yy, xy; of strains the engineering
/// shear 2 e_xy.
using PlaneVector = std::array<double, 3>;

/// Stress with its component across the plane, tension positive [Pa].
struct PointStress
{
  double xx = 0., yy = 0., zz = 0., xy = 0.;
};

/// What a point of a body in plane strain is given at the end of a step.
struct PointInput
{
  /// Whole strain since the start. In a body of small strain the usual one; of finite
  /// strain Green-Lagrange's, E = (F^T F - 1)/2.
  PlaneVector strain{};
  PointStress initial;   ///< stress at strain 0 (lithostatic), part of the stress told
  double time_step = 0.; ///< [s]; 0 in problems without time
};

/// What it answers.
struct PointResponse
{
  /// With the initial one: Cauchy's in a body of small strain, the second
  /// Piola-Kirchhoff of finite strain.
  PointStress stress;
  /// d (xx, yy, xy) / d strain [Pa], consistent with the update of the step.
  std::array<PlaneVector, 3> tangent{};
};

/// How a material answers to strain at a point, in plane strain (e_zz = 0). Objects are
/// immutable: what a point remembers is with the caller.
class MaterialLaw
{
public:
  virtual ~MaterialLaw() = default;

  /// Numbers that a point remembers from step to step; all are 0 at the start.
  virtual unsigned int n_history() const { return 0; }
  /// Whether strain is Green-Lagrange's and may be large.
  virtual bool is_finite_strain() const { return false; }
  /// Whether the tangent is symmetric whatever the state.
  virtual bool has_symmetric_tangent() const { return true; }

  /// Equivalent plastic strain that a history tells of, sqrt(2/3 e_p : e_p) [-]; 0 of
  /// laws that do not yield.
  virtual double plastic_strain(const double * /*history*/) const { return 0.; }

  /// \param begin history at the start of the step, n_history() numbers
  /// \param end   history at its end, if the step is accepted; may not alias @p begin
  /// Throws NumericalError where no answer exists (J <= 0, a return that does not
  /// converge).
  virtual PointResponse
  respond(const PointInput &input, const double *begin, double *end) const = 0;
};
} // namespace antiform::continuum

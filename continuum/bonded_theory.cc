#include "continuum/bonded_theory.h"

#include <cmath>
#include <stdexcept>

namespace antiform::continuum::theory
{
namespace
{
/// Beyond this k H a layer is a half-space to round-off: k H exp(-2 k H) < 1e-28.
constexpr double deep = 35.;

/// sinh x - x, by its series where the difference would cancel.
double sinh_minus(const double x)
{
  if (std::abs(x) > 1.)
    return std::sinh(x) - x;
  double term = x * x * x / 6., sum = term;
  for (int n = 4; std::abs(term) > 1e-17 * std::abs(sum); n += 2)
    sum += term *= x * x / (n * (n + 1.));
  return sum;
}

FaceStiffness scaled(const FaceStiffness &a, const double factor)
{
  return {factor * a.normal, factor * a.coupling, factor * a.shear};
}

FaceStiffness sum(const FaceStiffness &a, const FaceStiffness &b)
{
  return {a.normal + b.normal, a.coupling + b.coupling, a.shear + b.shear};
}

FaceStiffness half_space(const double nu)
{
  const double kappa = 3. - 4. * nu, face = 2. * (1. - nu) / kappa;
  return {face, (1. - 2. * nu) / kappa, face};
}

/// The closed forms over 2 G0 k, with x = k H. Differences of nearly equal terms are
/// written as sums, but for the coupling where it changes sign.
struct ClosedForms
{
  ClosedForms(const double chi, const double poisson_ratio)
      : nu(poisson_ratio)
      , x(chi)
      , s(std::sinh(chi))
      , c(std::cosh(chi))
      , sc_minus_x(0.5 * sinh_minus(2. * chi))
  {
  }

  FaceStiffness free() const
  {
    const double both = kappa * s * s + x * x + 4. * (1. - nu) * (1. - nu);
    return scaled({2. * (1. - nu) * sc_minus_x, (1. - 2. * nu) * s * s + x * x,
                   2. * (1. - nu) * (s * c + x)},
                  1. / both);
  }
  FaceStiffness rough_rigid() const
  {
    // kappa^2 s^2 - x^2
    const double both =
        kappa * kappa * sinh_minus(x) * (s + x) + kappa_minus_1 * (kappa + 1.) * x * x;
    return scaled({2. * (1. - nu) * (kappa * s * c + x),
                   kappa * (1. - 2. * nu) * s * s - x * x,
                   2. * (1. - nu) * (kappa * sc_minus_x + kappa_minus_1 * x)},
                  1. / both);
  }
  FaceStiffness smooth_rigid() const
  {
    // kappa s c - x
    const double both = kappa * sc_minus_x + kappa_minus_1 * x;
    return scaled({2. * (1. - nu) * c * c, (1. - 2. * nu) * sc_minus_x - 2. * nu * x,
                   2. * (1. - nu) * s * s},
                  1. / both);
  }

  double nu, x, s, c, sc_minus_x;
  double kappa = 3. - 4. * nu;
  double kappa_minus_1 = 2. * (1. - 2. * nu); // without rounding near nu = 1/2
};

/// A smooth far face on springs k_f, exact: (R k_f + F m) / (k_f + m) with the forms R of
/// a rigid and F of a free far face, and m the stiffness of the far face while the loaded
/// one is held.
FaceStiffness
on_springs(const Side &side, const ClosedForms &forms, const double wavenumber)
{
  Side seen_from_below = side;
  seen_from_below.far_face = Side::FarFace::rough_rigid;
  const double m = seen_from_below.stiffness(wavenumber), k_f = side.beyond(wavenumber);
  return sum(scaled(forms.smooth_rigid(), k_f / (k_f + m)),
             scaled(forms.free(), m / (k_f + m)));
}
} // namespace

FaceStiffness bonded_stiffness(const Side &side, const double wavenumber)
{
  const double unit = side.young_modulus / (1. + side.poisson_ratio) * wavenumber;
  if (unit == 0.)
    return {0., 0., 0.};
  const double chi = wavenumber * side.thickness;
  if (side.far_face == Side::FarFace::half_space || chi > deep)
    return scaled(half_space(side.poisson_ratio), unit);
  const ClosedForms forms(chi, side.poisson_ratio);
  switch (side.far_face)
  {
  case Side::FarFace::free:
    return scaled(forms.free(), unit);
  case Side::FarFace::smooth_rigid:
    return scaled(forms.smooth_rigid(), unit);
  case Side::FarFace::rough_rigid:
    return scaled(forms.rough_rigid(), unit);
  case Side::FarFace::spring:
    return scaled(on_springs(side, forms, wavenumber), unit);
  default:
    throw std::logic_error("unknown far face");
  }
}

double bonded_support_stiffness(const Layer &layer,
                                const std::vector<Side> &sides,
                                const double wavenumber)
{
  // Twice the energy is a_ww W^2 + 2 a_wu W u0 + a_uu u0^2.
  const double lever = 0.5 * wavenumber * layer.thickness;
  double a_ww = 0., a_wu = 0.;
  double a_uu = layer.plane_modulus() * layer.thickness * wavenumber * wavenumber;
  double direction = 1.;
  for (const Side &side : sides)
  {
    const FaceStiffness face = bonded_stiffness(side, wavenumber);
    a_ww += face.normal + 2. * lever * face.coupling + lever * lever * face.shear;
    a_wu += direction * (face.coupling + lever * face.shear);
    a_uu += face.shear;
    direction = -1.; // the other side sees the layer mirrored
  }
  return a_ww - a_wu * a_wu / a_uu;
}
} // namespace antiform::continuum::theory

#include "continuum/layer_theory.h"

#include "continuum/bonded_theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

namespace antiform::continuum::theory
{
namespace
{
constexpr double pi = 3.14159265358979323846;

double square(const double x)
{
  return x * x;
}

/// Beyond this k H hyperbolic functions overflow long after every Phi has become 1 to
/// round-off (chi^2 exp(-2 chi) < 1e-26).
constexpr double deep = 35.;

/// Where @p f is least between @p low < 0 and @p high > 0, at which it is above f(0).
/// Brent's method; it is exact relative to the place, hence the 0 in the middle.
double place_of_minimum(const std::function<double(double)> &f,
                        const double low,
                        const double high)
{
  gsl_function function;
  function.params = const_cast<std::function<double(double)> *>(&f);
  function.function = [](const double x, void *self)
  { return (*static_cast<std::function<double(double)> *>(self))(x); };
  const std::unique_ptr<gsl_min_fminimizer, decltype(&gsl_min_fminimizer_free)> minimum(
      gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent), gsl_min_fminimizer_free);
  // To the root of round-off, beyond which the values of a minimum do not differ.
  constexpr double tolerance = 1e-9;
  gsl_error_handler_t *const before = gsl_set_error_handler_off();
  int status = gsl_min_fminimizer_set(minimum.get(), &function, 0., low, high);
  for (int i = 0; i < 200 && status == GSL_SUCCESS; ++i)
  {
    status = gsl_min_fminimizer_iterate(minimum.get());
    if (gsl_min_fminimizer_x_upper(minimum.get()) -
            gsl_min_fminimizer_x_lower(minimum.get()) <
        tolerance * (high - low))
      break;
  }
  gsl_set_error_handler(before);
  return gsl_min_fminimizer_x_minimum(minimum.get());
}
} // namespace

double plane_modulus(const double young_modulus, const double poisson_ratio)
{
  return young_modulus / (1. - square(poisson_ratio));
}

double oedometer_modulus(const double young_modulus, const double poisson_ratio)
{
  return young_modulus * (1. - poisson_ratio) /
         ((1. + poisson_ratio) * (1. - 2. * poisson_ratio));
}

double Layer::plane_modulus() const
{
  return theory::plane_modulus(young_modulus, poisson_ratio);
}

double Layer::bending_stiffness() const
{
  return plane_modulus() * thickness * thickness * thickness / 12.;
}

double Layer::thick_bending_force(const double wavenumber) const
{
  const double shear_modulus = young_modulus / (2. * (1. + poisson_ratio));
  const double thin = bending_stiffness() * square(wavenumber);
  return thin / (1. + thin / (5. / 6. * shear_modulus * thickness) +
                 square(wavenumber * thickness) / 12.);
}

double slenderness(const double length, const double thickness)
{
  return std::sqrt(12.) * length / thickness;
}

double
euler_stress_pinned(const double modulus, const double length, const double thickness)
{
  return square(pi / slenderness(length, thickness)) * modulus;
}

double
euler_stress_guided(const double modulus, const double length, const double thickness)
{
  return 4. * euler_stress_pinned(modulus, length, thickness);
}

double critical_slenderness(const double modulus, const double compressive_strength)
{
  return pi * std::sqrt(modulus / compressive_strength);
}

double slenderness_ratio(const double modulus,
                         const double compressive_strength,
                         const double length,
                         const double thickness)
{
  return slenderness(length, thickness) /
         critical_slenderness(modulus, compressive_strength);
}

double stress_ratio_at_buckling(const double slenderness_ratio)
{
  return 1. / square(slenderness_ratio);
}

double winkler_mode_force(const double bending_stiffness,
                          const double foundation_stiffness,
                          const double length,
                          const unsigned int half_waves)
{
  const double k2 = square(half_waves * pi / length);
  return bending_stiffness * k2 + foundation_stiffness / k2;
}

Mode winkler_critical_mode(const double bending_stiffness,
                           const double foundation_stiffness,
                           const double length)
{
  // N_m <= N_m+1 first holds where k_w L^4 / (pi^4 D) <= m^2 (m + 1)^2.
  const double ratio =
      std::sqrt(foundation_stiffness / bending_stiffness) * square(length / pi);
  auto m = static_cast<unsigned int>(std::sqrt(0.25 + ratio));
  while (m < 1 || m * (m + 1.) < ratio)
    ++m;
  return {m, winkler_mode_force(bending_stiffness, foundation_stiffness, length, m)};
}

double winkler_critical_force(const double bending_stiffness,
                              const double foundation_stiffness)
{
  return 2. * std::sqrt(foundation_stiffness * bending_stiffness);
}

double phi_free(const double chi)
{
  if (chi > deep)
    return 1.;
  if (chi < 0.05) // sinh^2 - chi^2 cancels; the next term, 4 chi^6 / 945, is below 1e-10
    return chi * chi * chi / 6. * (1. - square(chi) / 5. + square(square(chi)) / 105.);
  const double s = std::sinh(chi), c = std::cosh(chi);
  return (s * s - chi * chi) / (s * c + chi);
}

double phi_smooth_rigid(const double chi)
{
  if (chi > deep)
    return 1.;
  const double s = std::sinh(chi), c = std::cosh(chi);
  return (s * c + chi) / (s * s);
}

double phi_rough_rigid(const double chi, const double poisson_ratio)
{
  if (chi > deep)
    return 1.;
  const double s = std::sinh(chi), c = std::cosh(chi);
  const double kappa = 3. - 4. * poisson_ratio;
  return (kappa * c * c + chi * chi + square(1. - 2. * poisson_ratio)) /
         (kappa * s * c - chi);
}

double Side::stiffness(const double wavenumber) const
{
  const double half_space =
      0.5 * plane_modulus(young_modulus, poisson_ratio) * wavenumber;
  const double chi = wavenumber * thickness;
  switch (far_face)
  {
  case FarFace::half_space:
    return half_space;
  case FarFace::free:
    return half_space * phi_free(chi);
  case FarFace::smooth_rigid:
    return half_space * phi_smooth_rigid(chi);
  case FarFace::rough_rigid:
    return half_space * phi_rough_rigid(chi, poisson_ratio);
  case FarFace::spring:
  {
    // Two smooth faces: p = a V + b V_far and p_far = b V + a V_far, with a the value
    // for a rigid and a - b^2/a that for a free far face. Put p_far = -k_far V_far.
    const double rigid = half_space * phi_smooth_rigid(chi);
    const double free = half_space * phi_free(chi);
    const double far = beyond(wavenumber);
    return rigid > 0. ? rigid * (free + far) / (rigid + far) : 0.;
  }
  }
  throw std::logic_error("unknown far face");
}

double SupportedLayer::bending_force(const double wavenumber) const
{
  return thick ? layer.thick_bending_force(wavenumber)
               : layer.bending_stiffness() * square(wavenumber);
}

double SupportedLayer::support_stiffness(const double wavenumber) const
{
  double sum = direct_foundation + direct_shear * square(wavenumber);
  if (bonded)
    return sum + bonded_support_stiffness(layer, sides, wavenumber);
  for (const Side &side : sides)
    sum += side.stiffness(wavenumber);
  return sum;
}

double SupportedLayer::buckling_force(const double wavenumber) const
{
  return bending_force(wavenumber) + support_stiffness(wavenumber) / square(wavenumber);
}

double SupportedLayer::shortest_wave() const
{
  return 2. * pi * 1e1 / layer.thickness;
}

std::optional<CriticalState> SupportedLayer::critical() const
{
  // N(k) can have two minima (a thin cover, then the base): scan before refining.
  const double first = std::log(2. * pi * 1e-6 / layer.thickness);
  const double last = std::log(shortest_wave());
  constexpr int n = 3200; // 460 a decade: no minimum is narrower than a tenth of one
  const auto log_k = [&](const double i) { return first + (last - first) * i / n; };
  const auto force = [&](const double i) { return buckling_force(std::exp(log_k(i))); };
  int best = 0;
  for (int i = 1; i <= n; ++i)
    if (force(i) < force(best))
      best = i;
  if (best == 0 || best == n)
    return std::nullopt;

  // Of equal neighbours the one after the last, so that both ends are higher.
  int after = best + 1;
  while (after < n && !(force(after) > force(best)))
    ++after;
  const double shift = place_of_minimum([&](const double i) { return force(best + i); },
                                        -1., after - best);
  const double k = std::exp(log_k(best + shift));
  const double least = buckling_force(k);
  return CriticalState{least, least / layer.thickness, k, 2. * pi / k};
}

Mode SupportedLayer::critical_mode(const double length) const
{
  Mode best{1, buckling_force(pi / length)};
  // Bending alone grows with m: no mode can be better once it exceeds the best force. The
  // other bound is that of critical().
  for (unsigned int m = 2; m * pi / length < shortest_wave(); ++m)
  {
    const double k = m * pi / length;
    if (bending_force(k) > best.force)
      break;
    if (const double force = buckling_force(k); force < best.force)
      best = {m, force};
  }
  return best;
}

std::optional<double>
SupportedLayer::stress_ratio_at_buckling(const double compressive_strength) const
{
  const auto state = critical();
  return state ? std::optional<double>(state->stress / compressive_strength)
               : std::nullopt;
}

CriticalState
deep_limit(const Layer &layer, const double matrix_plane_modulus, const bool both_sides)
{
  const double n_sides = both_sides ? 2. : 1.;
  const double bending = layer.bending_stiffness();
  const double k = std::cbrt(n_sides * matrix_plane_modulus / (4. * bending));
  const double force = 3. * bending * k * k;
  return {force, force / layer.thickness, k, 2. * pi / k};
}

double cover_variable(const double cover_ratio,
                      const double layer_plane_modulus,
                      const double matrix_plane_modulus)
{
  return cover_ratio * std::cbrt(matrix_plane_modulus / layer_plane_modulus);
}

double amplification(const double force, const double buckling_force)
{
  if (!(force < buckling_force))
    throw std::domain_error("axial force " + std::to_string(force) +
                            " N/m is not below the buckling force " +
                            std::to_string(buckling_force) + " N/m.");
  return 1. / (1. - force / buckling_force);
}
} // namespace antiform::continuum::theory

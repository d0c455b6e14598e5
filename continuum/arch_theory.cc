#include "continuum/arch_theory.h"

#include <cmath>
#include <stdexcept>

namespace antiform::continuum::theory
{
namespace
{
constexpr double pi = 3.14159265358979323846;

/// Least positive root of tan x = x, by Newton's method on sin x - x cos x, which has no
/// poles: 4.4934.
double root_of_tan()
{
  double x = 1.5 * pi - 1. / (1.5 * pi); // the first two terms of its expansion
  for (int i = 0; i < 5; ++i)
    x -= (std::sin(x) - x * std::cos(x)) / (x * std::sin(x));
  return x;
}

/// Axial force that the slack 1/2 integral of w'^2 releases, over l^7 [N/m^8].
double slack_force(const Layer &layer, const double load, const double total_length)
{
  const double load_ratio = load / layer.bending_stiffness();
  return layer.plane_modulus() * layer.thickness / total_length * 0.5 *
         upheaval_constants().squared_slope * load_ratio * load_ratio;
}
} // namespace

UpheavalConstants upheaval_constants()
{
  // With l = D = q = 1 and n = 2 x: n^2 w = 1/8 - s^2/2 + (1 - cos(n s) / cos x) / n^2
  // for s in (-1/2, 1/2), and 1/cos x = -sqrt(1 + x^2) by tan x = x.
  const double x = root_of_tan(), n2 = 4. * x * x;
  const double crest = 1. + std::sqrt(1. + x * x);
  UpheavalConstants c;
  c.force = n2;
  c.deflection = (1. / 8. + crest / n2) / n2;
  c.moment = crest / n2;
  c.squared_slope = (1. / 8. + 1. / 12.) / (n2 * n2); // the mixed term is 0 by tan x = x
  return c;
}

Upheaval upheaval(const Layer &layer,
                  const double load,
                  const double total_length,
                  const double length)
{
  const UpheavalConstants c = upheaval_constants();
  const double load_ratio = load / layer.bending_stiffness(), l2 = length * length;
  Upheaval state;
  state.length = length;
  state.force = c.force * layer.bending_stiffness() / l2;
  state.deflection = c.deflection * load_ratio * l2 * l2;
  state.moment = c.moment * load * l2;
  state.prebuckling_force =
      state.force + slack_force(layer, load, total_length) * std::pow(length, 7);
  return state;
}

Upheaval least_upheaval(const Layer &layer, const double load, const double total_length)
{
  // P_0(l) = a / l^2 + b l^7 is least where 2 a = 7 b l^9.
  const double a = upheaval_constants().force * layer.bending_stiffness();
  const double b = slack_force(layer, load, total_length);
  return upheaval(layer, load, total_length, std::pow(2. * a / (7. * b), 1. / 9.));
}

double arch_deflection(const double load,
                       const double length,
                       const double bending_stiffness,
                       const ArchEnds ends)
{
  const double pi4 = std::pow(pi, 4), l4 = std::pow(length, 4);
  const double share = ends == ArchEnds::pinned ? 4. / (pi * pi4) : 0.25 / pi4;
  return share * load * l4 / bending_stiffness;
}

double arch_critical_load(const double rise,
                          const double length,
                          const double bending_stiffness,
                          const ArchEnds ends)
{
  return rise / arch_deflection(1., length, bending_stiffness, ends);
}

double arch_rise(const double initial_rise,
                 const double deflection,
                 const double force,
                 const double euler_force)
{
  return (initial_rise - deflection) * amplification(force, euler_force);
}

double pinned_beam_deflection(const double load,
                              const double length,
                              const double bending_stiffness,
                              const double force_ratio)
{
  const double without = 5. / 384. * load * std::pow(length, 4) / bending_stiffness;
  const double u = 0.5 * pi * std::sqrt(force_ratio), u2 = u * u;
  if (u < 0.02) // the closed form cancels to 1e-16 / u^4; next term 0.07 u^6
    return without * (1. + 61. / 150. * u2 + 277. / 1680. * u2 * u2);
  return without * 12. * (2. / std::cos(u) - 2. - u2) / (5. * u2 * u2);
}

double snap_load_unit(const Layer &layer, const double length)
{
  return layer.bending_stiffness() * std::pow(pi / length, 4) * layer.thickness /
         std::sqrt(12.);
}

double shallow_arch_load(const double initial_rise, const double rise)
{
  return (initial_rise - rise) * (1. + 0.25 * rise * (initial_rise + rise));
}

std::optional<SnapThrough> snap_through(const double initial_rise)
{
  if (!(initial_rise > 2.))
    return std::nullopt;
  const double squared = initial_rise * initial_rise;
  const bool sways = squared > 22.;
  const double rise = std::sqrt(sways ? squared - 16. : (squared - 4.) / 3.);
  return SnapThrough{rise, shallow_arch_load(initial_rise, rise), sways};
}
} // namespace antiform::continuum::theory

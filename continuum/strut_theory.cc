#include "continuum/strut_theory.h"

#include <cmath>

namespace antiform::continuum::theory
{
namespace
{
constexpr double pi = 3.14159265358979323846;
} // namespace

double perry_robertson(const double strength,
                       const double euler_stress,
                       const double imperfection)
{
  // s^2 - 2 b s + c = 0; its lower root without cancellation.
  const double b = 0.5 * (strength + (1. + imperfection) * euler_stress);
  const double c = strength * euler_stress;
  return c / (b + std::sqrt(b * b - c));
}

double strength_slope(const double friction_angle)
{
  return (1. + std::sin(friction_angle)) / (1. - std::sin(friction_angle));
}

double confined_failure_ratio(const double strength_slope,
                              const double pressure_over_strength)
{
  return 1. + (strength_slope - 1.) * pressure_over_strength;
}

double confined_slenderness_limit(const double strength_slope,
                                  const double pressure_over_strength)
{
  return 1. / std::sqrt(confined_failure_ratio(strength_slope, pressure_over_strength));
}

Elastica elastica_pinned(const double end_slope)
{
  const double modulus = std::sin(0.5 * end_slope);
  const double first = std::comp_ellint_1(modulus), second = std::comp_ellint_2(modulus);
  Elastica state;
  state.force = 4. * first * first / (pi * pi);
  state.chord = 2. * second / first - 1.;
  state.deflection = modulus / first;
  state.curvature = 4. * modulus * first;
  return state;
}

double stack_bending_stiffness(const std::vector<Layer> &beds, const bool stick)
{
  double own = 0., stretching = 0., first_moment = 0., below = 0.;
  for (const Layer &bed : beds)
  {
    const double stiffness = bed.plane_modulus() * bed.thickness;
    own += bed.bending_stiffness();
    stretching += stiffness;
    first_moment += stiffness * (below + 0.5 * bed.thickness);
    below += bed.thickness;
  }
  if (!stick)
    return own;
  const double axis = first_moment / stretching; // no axial force in pure bending
  double about_axis = own;
  below = 0.;
  for (const Layer &bed : beds)
  {
    const double lever = below + 0.5 * bed.thickness - axis;
    about_axis += bed.plane_modulus() * bed.thickness * lever * lever;
    below += bed.thickness;
  }
  return about_axis;
}

double viscous_growth_rate(const Layer &layer,
                           const double axial_stress,
                           const double viscosity,
                           const double wavenumber)
{
  const double force = axial_stress * layer.thickness;
  return (force - layer.bending_stiffness() * wavenumber * wavenumber) * wavenumber /
         (4. * viscosity);
}

double viscous_dominant_wavelength(const Layer &layer, const double axial_stress)
{
  return pi * layer.thickness * std::sqrt(layer.plane_modulus() / axial_stress);
}
} // namespace antiform::continuum::theory

#pragma once

#include "continuum/layer_theory.h"

/// Closed forms for a layer of finite length, and for what the thesis' plot leaves out:
/// imperfection, confinement, large rotation, beds; and for a layer in a viscous matrix.
/// Signs as in layer_theory.h; derivations: docs/theory/continuum.md, sections 7 and 8.
namespace antiform::continuum::theory
{
/// Perry-Robertson: the stress [Pa] at which the inner fibre of a strut with an initial
/// wave reaches @p strength, the lower root of
/// (strength - s) (euler - s) = imperfection s euler.
/// \param imperfection bending over axial stress without amplification: 6 a0/h for a
/// half wave of rise a0 between ends that may turn, 3 a0/h for a full wave of height a0,
/// crest to trough, between guided ends [-]
double perry_robertson(double strength, double euler_stress, double imperfection);

// --- confinement by a pressure p on both faces; it follows them, and so acts like an
// axial tension p h: the layer buckles at sigma_1 - p = sigma_cr

/// N_phi = (1 + sin phi) / (1 - sin phi) of a friction angle [rad]: rise of the strength
/// sigma_1 = UCS + N_phi p [-].
double strength_slope(double friction_angle);
/// gamma_p = (sigma_1 - p) / UCS at failure, 1 + (N_phi - 1) p / UCS [-].
double confined_failure_ratio(double strength_slope, double pressure_over_strength);
/// Lambda_c(p): slenderness ratio at which the confined strut buckles as it fails,
/// [1 + (N_phi - 1) p / UCS]^(-1/2); 1 without confinement [-].
double confined_slenderness_limit(double strength_slope, double pressure_over_strength);

// --- large rotation

/// State of an inextensible strut between pinned ends (elastica; Timoshenko & Gere 1961).
struct Elastica
{
  double force;      ///< over the Euler force [-]
  double chord;      ///< distance of the ends over the length [-]
  double deflection; ///< of the middle over the length [-]
  double curvature;  ///< of the middle times the length [-]
};
/// \param end_slope alpha in (0, pi) [rad]
Elastica elastica_pinned(double end_slope);

// --- stack of beds

/// Bending stiffness D of a stack of beds, from below [N m]: about one common axis where
/// they stick together, the sum of their own where they slide freely.
double stack_bending_stiffness(const std::vector<Layer> &beds, bool stick);

// --- elastic layer in a viscous matrix, half-spaces on both sides (Biot 1961)

/// Rate at which a wave k [1/m] grows under an axial stress [Pa], (N k - D k^3) / (4 eta)
/// [1/s]; incompressible matrix of viscosity @p viscosity [Pa s], smooth contact.
double viscous_growth_rate(const Layer &layer,
                           double axial_stress,
                           double viscosity,
                           double wavenumber);
/// The wavelength that grows fastest, pi h sqrt(E' / sigma_1) [m].
double viscous_dominant_wavelength(const Layer &layer, double axial_stress);
} // namespace antiform::continuum::theory

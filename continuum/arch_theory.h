#pragma once

#include "continuum/layer_theory.h"

/// Closed forms for a layer under a load across it: lifted from a rigid base, arched
/// under a dead load, or snapping through. Signs as in layer_theory.h; loads are per unit
/// area [Pa], downward; rises are positive up. Derivations: docs/theory/continuum.md,
/// section 9.
namespace antiform::continuum::theory
{
// --- upheaval of a straight layer from a rigid base (Hobbs 1984)

/// The lifted part of length l has w = w' = w'' = 0 at both ends, so that
/// x = l/2 sqrt(P/D) is the least root of tan x = x. Everything follows from it.
struct UpheavalConstants
{
  double force;         ///< P l^2 / D
  double deflection;    ///< w_max D / (q l^4)
  double moment;        ///< M_max / (q l^2), at the middle
  double squared_slope; ///< integral of w'^2, times D^2 / (q^2 l^7)
};
UpheavalConstants upheaval_constants();

/// A layer lifted over some length.
struct Upheaval
{
  double prebuckling_force; ///< axial force of the layer at rest that leads there [N/m]
  double force;             ///< P, what is left of it [N/m]
  double length;            ///< l, lifted [m]
  double deflection;        ///< w_max [m]
  double moment;            ///< M_max [N]
};
/// The state with a lifted @p length, in a layer of @p total_length that slips freely on
/// its base: the shortening P L/(E' h) + 1/2 integral of w'^2 is what the layer at rest
/// had.
Upheaval upheaval(const Layer &layer, double load, double total_length, double length);
/// That of least prebuckling force, where a sufficiently uneven layer snaps up; a flat
/// one never does. Below this force it cannot stay up.
Upheaval least_upheaval(const Layer &layer, double load, double total_length);

// --- arch under a dead load

/// Ends of an arch of span L: pinned with a half wave between them, rise a0; or guided,
/// with a full wave from trough to trough, height a0.
enum class ArchEnds
{
  pinned,
  guided
};
/// Rise a_q [m] that the load takes from an arch without axial force: 4 q L^4 / (pi^5 D)
/// pinned, q L^4 / (4 pi^4 D) guided (one term; +0.4 % and -1.5 % of the deflection of a
/// beam's middle).
double
arch_deflection(double load, double length, double bending_stiffness, ArchEnds ends);
/// q* [Pa]: the load under which an arch of rise @p rise neither grows nor sinks,
/// whatever the axial force.
double
arch_critical_load(double rise, double length, double bending_stiffness, ArchEnds ends);
/// y = (a0 - a_q) / (1 - N / N_E) [m]. Throws std::domain_error at or above N_E.
double
arch_rise(double initial_rise, double deflection, double force, double euler_force);
/// Deflection of the middle of a pinned beam under load and axial force, exact
/// (Timoshenko & Gere 1961) [m]. \param force_ratio N / N_E in [0, 1)
double pinned_beam_deflection(double load,
                              double length,
                              double bending_stiffness,
                              double force_ratio);

// --- snap-through of a shallow arch, pinned at fixed ends, load q sin(pi x / L)

/// D k^4 r [Pa], k = pi/L, r = h/sqrt(12): the load that the figures below are multiples
/// of. Rises are multiples of r.
double snap_load_unit(const Layer &layer, double length);
/// Load in equilibrium with @p rise of an arch made with @p initial_rise:
/// (e0 - e) + e (e0^2 - e^2) / 4 [-].
double shallow_arch_load(double initial_rise, double rise);

struct SnapThrough
{
  double rise;        ///< e at which the arch gives way [-]
  double load;        ///< [-]
  bool antisymmetric; ///< by swaying, before the top of the symmetric path
};
/// Where the arch gives way: at the limit point e_c = sqrt((e0^2 - 4)/3), or, for
/// e0 > sqrt(22), at the bifurcation e_b = sqrt(e0^2 - 16) before it. Nothing for e0 <=
/// 2: such an arch is pressed flat without a snap.
std::optional<SnapThrough> snap_through(double initial_rise);
} // namespace antiform::continuum::theory

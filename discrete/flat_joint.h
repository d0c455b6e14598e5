#pragma once

#include "discrete/vec2.h"

#include <string>
#include <vector>

namespace antiform::discrete
{
/// Parameters of the flat-joint contact law (Potyondy 2012): an interface of two faced
/// grains, cut into elements, each bonded or broken. Stress and gap: tension and opening
/// positive. The derivation is in docs/theory/flat_joint.md.
struct FlatJoint
{
  double effective_modulus = 50e9;   ///< E*, of the grains and the bond [Pa]
  double stiffness_ratio = 2.2;      ///< kappa = k_n / k_s [-]
  double tensile_strength = 15e6;    ///< sigma_b [Pa]
  double cohesion = 60e6;            ///< c_b [Pa]
  double tan_friction = 0.140540835; ///< tan(phi_b) of the bonded element [-]
  double residual_friction = 0.4;    ///< mu of the broken element [-]
  double residual_cohesion = 0.;     ///< of the closed part of a broken element [Pa]
  double radius_multiplier = 1.;     ///< lambda: half length over the smaller radius [-]
  int n_elements = 3;                ///< N, elements of a joint [-]
  bool element_moment = true;        ///< stress varies linearly within an element
  bool breakable = true;             ///< false: would-be breaks are counted, not made
};

/// Bond state of one element; the codes are those of PFC.
enum class Bond : signed char
{
  unbonded = 0, ///< never bonded (slit or gapped element)
  broken_in_tension = 1,
  broken_in_shear = 2,
  bonded = 3
};

/// What one element gives for the joint's present opening: resultants, per unit
/// thickness.
struct ElementResultant
{
  double normal_force = 0.;  ///< F_e, tension positive [N]
  double moment = 0.;        ///< M_e about the joint's centre, on the second grain [N m]
  double active_length = 0.; ///< bonded, or in contact [m]
  double strain_energy = 0.; ///< of the normal stress [J]
};

/// Normal resultants of an element that covers @p a <= s <= @p b of a joint whose gap is
/// g(s) = @p gap - @p rotation * s [m]. Bonded: the whole element carries k_n g. Broken:
/// only its closed part does; the cut is exact.
/// \param stiffness k_n [Pa/m]
ElementResultant element_resultant(double stiffness,
                                   double gap,
                                   double rotation,
                                   double a,
                                   double b,
                                   bool bonded,
                                   bool element_moment = true);
} // namespace antiform::discrete

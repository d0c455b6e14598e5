#pragma once

#include "discrete/flat_joint.h"

#include <string>
#include <variant>

namespace antiform::discrete
{
/// Cement beside the linear contact of two grains (Potyondy & Cundall 2004): an elastic
/// beam as wide as the smaller grain, gone at once when its edge is over a strength. The
/// contact acts in parallel from the start and stays. Tension positive. The stresses at
/// the edge are
///   sigma = F/A + beta |M| R/I,   tau = |S|/A.
struct ParallelBond
{
  double bond_modulus = 25e9;      ///< E_c of the cement [Pa]
  double stiffness_ratio = 2.2;    ///< kappa of the cement, k_n/k_s [-]
  double tensile_strength = 15e6;  ///< sigma_c [Pa]
  double cohesion = 60e6;          ///< c, shear strength without normal stress [Pa]
  double tan_friction = 0.;        ///< tan(phi) by which F/A changes it; 0 in 2004 [-]
  double radius_multiplier = 1.;   ///< lambda: half width over the smaller radius [-]
  double moment_contribution = 1.; ///< beta of the bending stress; 1 in 2004 [-]
  double contact_modulus = 25e9;   ///< E* of the linear contact beside it [Pa]
  double contact_stiffness_ratio = 2.2; ///< of the contact [-]
  double residual_friction = 0.4;       ///< mu of the contact [-]
  bool breakable = true;
};

/// Linear contact that also pulls, glued at a point (Cundall & Strack 1979; PFC's contact
/// bond): no moment, no friction until it breaks; then the plain contact stays. Strengths
/// are stresses over the width of the smaller grain, A = 2 min(R). The point stays where
/// it was glued on either grain: rolling turns the pair about it, which differs from
/// PFC's rolling contact by the square of the relative rotation.
struct ContactBond
{
  double effective_modulus = 50e9; ///< E* [Pa]
  double stiffness_ratio = 2.2;    ///< kappa = k_n / k_s [-]
  double tensile_strength = 15e6;  ///< T_F/A [Pa]
  double shear_strength = 60e6;    ///< S_F/A [Pa]
  double residual_friction = 0.4;  ///< mu of the contact that stays [-]
  bool breakable = true;
};

/// The law of a group of joints.
using JointLaw = std::variant<FlatJoint, ParallelBond, ContactBond>;

/// What the kernel of intact joints needs to know of any law. A joint is over a strength
/// where, with the mean normal stress s, the bending stress b at its edge and the shear
/// stress t,
///   s + tension_arm b >= tensile_strength,  or
///   |t| + (s + coulomb_arm b) tan_friction > cohesion.
struct BondConstants
{
  double stiffness_ratio = 1.;   ///< k_n / k_s [-]
  double radius_multiplier = 1.; ///< half length over the smaller radius [-]
  double moment_factor = 0.;     ///< bending stiffness over k_n A (2R)^2: 1/12 of a beam
  double tension_arm = 0., coulomb_arm = 0.;
  double tensile_strength = 0., cohesion = 0.; ///< [Pa]
  double tan_friction = 0.;
  int n_elements = 1; ///< that break one by one
  bool breakable = true;
};
BondConstants constants(const JointLaw &law);

/// E* by which joints of a law are stiff [Pa].
double joint_modulus(const JointLaw &law);
/// A joint that breaks is gone, and the linear contact of its grains has what is left.
inline bool is_brittle(const JointLaw &law)
{
  return !std::holds_alternative<FlatJoint>(law);
}
/// The linear contact acts from the start, beside the bond.
inline bool has_contact_beside(const JointLaw &law)
{
  return std::holds_alternative<ParallelBond>(law);
}
} // namespace antiform::discrete

#pragma once

#include "discrete/joints.h"

namespace antiform::discrete
{
/// The full flat-joint law for one joint that has lost a bond (steps in the order
/// tension, shear, friction; docs/theory/flat_joint.md), breaks included: the vector
/// kernel leaves to it the joints in which something breaks.
///
/// @p before is the deformation at the last step: it decides which of two strengths was
/// reached first within the step, and from where on a closing element sticks.
/// \param[in,out] damaged records of which number @p k is advanced
/// \param[in,out] cracks new breaks are appended; null: no bond is tested
void evaluate_damaged(const Grains &grains,
                      const Joints &joints,
                      DamagedJoints &damaged,
                      std::size_t k,
                      const JointDeformation &before,
                      const StepTime &time,
                      std::vector<Crack> *cracks);

/// What a bonded element of a flat joint carries, and what it could.
struct BondedElement
{
  double normal = 0., shear = 0.; ///< mean stresses, tension positive [Pa]
  double tensile_strength = 0., cohesion = 0.; ///< of this joint [Pa]
  double tan_friction = 0.;
  double a = 0., b = 0.; ///< its place along the joint's tangent, from the centre [m]
};
/// Element @p e of breakable flat joint @p j, bonded, at the deformation @p d: the
/// stresses that the law compares with the strengths.
BondedElement bonded_element(const Joints &joints,
                             std::size_t j,
                             int e,
                             const JointDeformation &d);

/// Record of intact joint @p joint, which is about to lose its first bond.
/// \return its number
std::size_t add_damaged(Joints &joints, std::size_t joint);

/// The line of cracks.csv for a break of element @p element, which covers @p a to @p b of
/// the joint, along its tangent from its centre [m].
Crack make_crack(const Grains &grains,
                 const Joints &joints,
                 std::size_t joint,
                 int element,
                 double a,
                 double b,
                 Bond mode,
                 const StepTime &time);

/// Share of the step, from its start, at which a quantity that goes linearly from @p old
/// to @p now reaches @p limit; infinity when it does not, 0 when it was there already.
double share_at_limit(double old, double now, double limit);

/// Strain energy of a damaged joint, weighted [J].
double strain_energy(const Joints &joints, const DamagedJoints &damaged, std::size_t k);
} // namespace antiform::discrete

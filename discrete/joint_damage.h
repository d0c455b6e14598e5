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

#pragma once

#include "discrete/joints.h"

namespace antiform::discrete
{
/// The full flat-joint law for joints that have lost a bond (contact-law steps in the
/// order tension, shear, friction; docs/theory/flat_joint.md). Serial over the elements
/// of one joint; different joints may be evaluated at the same time.
///
/// @p before is the deformation at the last step: it decides which of two strengths was
/// reached first within the step, and from where on a closing element sticks.
/// \param[in,out] cracks new breaks are appended; null: no bond is tested
void evaluate_damaged(const Grains &grains,
                      const Joints &joints,
                      DamagedJoint &damaged,
                      const JointDeformation &now,
                      const JointDeformation &before,
                      const StepTime &time,
                      std::vector<Crack> *cracks);

/// Record of an intact joint about to lose its first bond.
DamagedJoint make_damaged(const Joints &joints, std::size_t joint);

/// Strain energy of a damaged joint, weighted [J].
double strain_energy(const Joints &joints, const DamagedJoint &damaged);
} // namespace antiform::discrete

#pragma once

#include "discrete/joint_damage.h"

namespace antiform::discrete
{
/// Break a parallel or contact bond that the kernel found over a strength, of which
/// @p record is the number of the new record: the joint is gone, its energy goes to the fracture sink less what the contact of its grains keeps.
/// That of a contact bond is new and waits in Joints::released; it has the force of this
/// step. Nothing happens where the joint is not over a strength but for the kernel's
/// rounding. @p before is the deformation at the last step.
void break_bond(const Grains &grains,
                Joints &joints,
                const JointLaw &law,
                std::size_t record,
                const JointDeformation &before,
                const StepTime &time,
                std::vector<Crack> &cracks);

/// Strain energy of the contacts that nobody has taken over yet [J].
double released_energy(const Grains &grains, const Joints &joints);
} // namespace antiform::discrete

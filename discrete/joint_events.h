#pragma once

#include "discrete/joint_damage.h"
#include "discrete/joints.h"

#include <cstddef>
#include <vector>

namespace antiform::discrete
{
/// How far a bonded element is loaded: 1 at its strength. The larger of the two
/// criteria decides how it would break:
///   sigma / sigma_b,   |tau| / (c - sigma tan(phi)).
struct LoadFactor
{
  double value = 0.; ///< [-]; infinity where no shear strength is left
  Bond mode = Bond::broken_in_tension;
};
LoadFactor load_factor(const BondedElement &element);

/// A bonded element that has reached a strength.
struct LoadedElement
{
  std::size_t joint = 0;
  int element = 0;
  LoadFactor factor;
  Vec2 place; ///< centre of its joint's branch [m]
};

/// All bonded elements of breakable flat joints that are at a strength or beyond, in
/// the order of joints and elements. Looks at the present displacements alone; nothing
/// but the memory of the kernels is changed, which search the intact joints. Throws
/// std::invalid_argument where a breakable joint is no flat joint.
std::vector<LoadedElement> overstressed_elements(const Grains &grains, Joints &joints);

/// For every bonded element of the breakable joints that nears a strength while the
/// grains move by their velocities per unit of load: the load step after which it is
/// reached, if its stresses go on as they do over the first @p probe of it. Unordered;
/// 0 for one that is there already. \param probe load step over which the rates of
/// deformation are taken, either sign;
///              steps have its sign and are given without it
std::vector<double>
steps_to_break(const Grains &grains, const Joints &joints, double probe);

/// The elements that break together: sorted by load factor, each is taken unless one
/// that was taken before lies within @p radius [m] of it.
std::vector<LoadedElement> local_maxima(std::vector<LoadedElement> elements,
                                        double radius);

/// Break @p elements where the grains stand, each in its mode; their energies go to the
/// fracture sink, and cracks are appended in the order given. Forces of the grains are
/// those from before until they are computed again.
void break_elements(const Grains &grains,
                    Joints &joints,
                    const std::vector<LoadedElement> &elements,
                    const StepTime &now,
                    std::vector<Crack> &cracks);
} // namespace antiform::discrete

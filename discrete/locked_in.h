#pragma once

#include "discrete/joints.h"
#include "discrete/walls.h"

#include <vector>

namespace antiform::discrete
{
/// Let the joints keep the contact forces in which the grains jammed within @p outline,
/// scaled to an isotropic stress of -@p pressure [Pa] in the mean: an initial gap of each
/// joint whose grains overlap. Grains that touch the outline are in equilibrium with its
/// pressure on them, which @p walls give where they stand; elsewhere they are released by
/// the first steps. Before anything has moved, with joints that are all bonded. Returns
/// false when no grains overlap: there are no forces to keep.
bool lock_in(const Grains &grains,
             const std::vector<Vec2> &outline,
             double pressure,
             Joints &joints,
             std::vector<Wall> &walls);
} // namespace antiform::discrete

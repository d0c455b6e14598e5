#pragma once

#include "discrete/relaxation.h"

namespace antiform::discrete
{
/// Figures of a packing in the vessel of @p area; bonds are pairs with at most @p gap.
/// Lengths in any one unit (the unbalanced ratio: stiffness drops out).
PackingQuality packing_quality(const std::vector<Disk> &disks,
                               const Confinement &confinement,
                               double area,
                               double gap);

/// Area that two disks share, their centres being @p distance apart.
double lens_area(double radius_1, double radius_2, double distance);
} // namespace antiform::discrete

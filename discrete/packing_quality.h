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

/// Standard deviation over mean of the pressure of touching disks of unit stiffness, in
/// circles of up to five diameters' radius side by side; 0 when fewer than three fit.
/// \param disks [m], \param outline of their region in mean diameters
double stress_variation(const std::vector<Disk> &disks,
                        const std::vector<Vec2> &outline,
                        double mean_diameter);

/// Solid area of jammed disks of radius ratio 1.66, lengths in mean diameters; an
/// estimate.
double jammed_solid_area(double area, double perimeter);

/// Area that two disks share, their centres being @p distance apart.
double lens_area(double radius_1, double radius_2, double distance);
} // namespace antiform::discrete

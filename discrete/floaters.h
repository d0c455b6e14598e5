#pragma once

#include "discrete/relaxation.h"

#include <vector>

namespace antiform::discrete
{
/// Disks with fewer than three neighbours within @p gap, ascending.
std::vector<std::int32_t>
floaters(const std::vector<Disk> &disks, const Vec2 &period, double gap);

/// What became of the floaters of one pass.
struct FloaterChange
{
  std::size_t grown = 0;   ///< to touch three neighbours; no contact has changed
  std::size_t swollen = 0; ///< in place: the packing must be relaxed
  std::size_t deleted = 0;
};

/// Give every floater the smallest circle around it that touches three of its neighbours
/// and overlaps nothing. Where there is none (a grain that a wall and two neighbours
/// hold), let it swell in place; a grain whose radius would exceed 1.5 times the original
/// one is deleted. One pass: other disks may have become floaters by it.
///
/// \param[in,out] growth per disk, radius over original radius so far
FloaterChange settle_floaters(std::vector<Disk> &disks,
                              std::vector<double> &growth,
                              const Confinement &confinement,
                              double gap);

/// The circles that touch @p a, @p b and @p c from outside: none, one or two.
std::vector<Disk> tangent_circles(const Disk &a, const Disk &b, const Disk &c);
} // namespace antiform::discrete

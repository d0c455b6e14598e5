#pragma once

#include "discrete/packing.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Two disks of a packing that are near each other. In a periodic packing the second one
/// is an image, and a disk may be paired with an image of itself.
struct DiskPair
{
  std::int32_t first, second;
  Vec2 shift; ///< added to the centre of the second disk
};

/// All pairs whose gap is at most @p reach, each once, sorted by first, second, shift.
/// @p period is {0, 0} when the packing does not repeat.
std::vector<DiskPair>
disk_pairs(const std::vector<Disk> &disks, const Vec2 &period, double reach);

/// From the first centre to the second, image shift included.
inline Vec2 branch(const std::vector<Disk> &disks, const DiskPair &pair)
{
  return disks[pair.second].centre + pair.shift - disks[pair.first].centre;
}

/// How often each disk occurs in @p pairs.
std::vector<int> pair_count(std::size_t n_disks, const std::vector<DiskPair> &pairs);
} // namespace antiform::discrete

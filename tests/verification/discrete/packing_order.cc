// The figures of a packing, and the pairs that will be bonded, do not depend on the order
// of its disks.
#include "discrete/packing_quality.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace antiform::discrete::test::packing_order_tests
{
TEST(PackingOrder, ChangesNoFigureAndNoBond)
{
  PackingParameters p;
  p.mean_diameter = 1.;
  p.seed = 9;
  const PeriodicTile tile = pack_periodic({14., 12.}, p);
  std::vector<std::size_t> number(tile.disks.size());
  std::iota(number.begin(), number.end(), std::size_t{0});
  Random random(10);
  for (std::size_t k = number.size(); k > 1; --k)
    std::swap(number[k - 1], number[random.index(k)]);
  std::vector<Disk> other(tile.disks.size());
  for (std::size_t i = 0; i < number.size(); ++i)
    other[number[i]] = tile.disks[i];

  const double area = tile.size.x * tile.size.y;
  const double gap = 0.5 * p.installation_gap_ratio;
  const PackingQuality a = packing_quality(tile.disks, {tile.size, nullptr}, area, gap);
  const PackingQuality b = packing_quality(other, {tile.size, nullptr}, area, gap);
  // Counts are the same; sums differ by the rounding of another order.
  EXPECT_EQ(a.floaters, b.floaters);
  EXPECT_EQ(a.coordination_number, b.coordination_number);
  EXPECT_EQ(a.touching_coordination, b.touching_coordination);
  EXPECT_EQ(a.largest_overlap, b.largest_overlap);
  EXPECT_NEAR(a.porosity, b.porosity, 1e-12);
  EXPECT_NEAR(a.mean_overlap, b.mean_overlap, 1e-12 * a.mean_overlap);
  EXPECT_NEAR(a.fabric_anisotropy, b.fabric_anisotropy, 1e-12);

  std::vector<std::pair<std::int32_t, std::int32_t>> bonds[2];
  for (const int which : {0, 1})
  {
    Grains grains;
    for (const Disk &disk : which == 0 ? tile.disks : other)
      grains.add(disk.centre, disk.radius, 1., 0);
    bonds[which] = pairs_within(grains, gap, 0, 0);
  }
  for (auto &[i, j] : bonds[0])
  {
    const auto m = static_cast<std::int32_t>(number[i]),
               n = static_cast<std::int32_t>(number[j]);
    i = std::min(m, n);
    j = std::max(m, n);
  }
  std::sort(bonds[0].begin(), bonds[0].end());
  EXPECT_EQ(bonds[0], bonds[1]);
  EXPECT_GT(bonds[0].size(), 2 * tile.disks.size());
}
} // namespace antiform::discrete::test::packing_order_tests

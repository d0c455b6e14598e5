#include "discrete/joints.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// Grains of like size in square cells; those of one cell are a linked list.
class Cells
{
public:
  /// @p members are put in so that the lists ascend.
  Cells(const Grains &grains,
        const std::vector<std::int32_t> &members,
        const double reach,
        const Vec2 &low,
        const Vec2 &high)
      : low_(low)
  {
    // No more than a few hundred thousand cells in all: a stray grain far away costs
    // nothing then.
    const Vec2 extent = high - low;
    cell_ = std::max(reach, std::sqrt((extent.x + reach) * (extent.y + reach) / 4e5));
    n_x_ = static_cast<std::int64_t>(extent.x / cell_) + 1;
    n_y_ = static_cast<std::int64_t>(extent.y / cell_) + 1;
    head_.assign(n_x_ * n_y_, -1);
    next_.assign(grains.size(), -1);
    for (auto i = members.rbegin(); i != members.rend(); ++i)
    {
      const Vec2 p = grains.position(*i);
      std::int32_t &head = head_[row(p.y) * n_x_ + column(p.x)];
      next_[*i] = head;
      head = *i;
    }
  }

  /// Call @p visit for the grains in the cell of @p p and in those around it.
  template <class Visit>
  void near(const Vec2 &p, const Visit &visit) const
  {
    const std::int64_t r0 = row(p.y), c0 = column(p.x);
    for (std::int64_t r = std::max<std::int64_t>(0, r0 - 1);
         r <= std::min(n_y_ - 1, r0 + 1); ++r)
      for (std::int64_t c = std::max<std::int64_t>(0, c0 - 1);
           c <= std::min(n_x_ - 1, c0 + 1); ++c)
        for (std::int32_t j = head_[r * n_x_ + c]; j >= 0; j = next_[j])
          visit(j);
  }

private:
  std::int64_t column(const double x) const
  {
    return static_cast<std::int64_t>((x - low_.x) / cell_);
  }
  std::int64_t row(const double y) const
  {
    return static_cast<std::int64_t>((y - low_.y) / cell_);
  }

  Vec2 low_;
  double cell_;
  std::int64_t n_x_, n_y_;
  std::vector<std::int32_t> head_, next_;
};
} // namespace

std::vector<std::pair<std::int32_t, std::int32_t>>
pairs_within(const Grains &grains,
             const double installation_gap,
             const int region_i,
             const int region_j)
{
  // Grains by size, level l holding the radii from 2^-l to 2^-(l+1) of the largest: cells
  // that suit the large ones would hold very many small ones.
  double largest = 0.;
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 p = grains.position(i);
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    largest = std::max(largest, grains.radius[i]);
  }
  std::vector<std::vector<std::int32_t>> levels;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (grains.region[i] != region_i && grains.region[i] != region_j)
      continue;
    const auto level = static_cast<std::size_t>(std::log2(largest / grains.radius[i]));
    if (level >= levels.size())
      levels.resize(level + 1);
    levels[level].push_back(static_cast<std::int32_t>(i));
  }

  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (std::size_t coarse = 0; coarse < levels.size(); ++coarse)
  {
    if (levels[coarse].empty())
      continue;
    double radius = 0.;
    for (const std::int32_t i : levels[coarse])
      radius = std::max(radius, grains.radius[i]);
    const Cells cells(grains, levels[coarse],
                      2. * radius + std::max(0., installation_gap), low, high);
    // A pair is found from its smaller grain.
    for (std::size_t fine = coarse; fine < levels.size(); ++fine)
      for (const std::int32_t i : levels[fine])
      {
        const Vec2 p = grains.position(i);
        const int wanted = grains.region[i] == region_i ? region_j : region_i;
        cells.near(p,
                   [&](const std::int32_t j)
                   {
                     if ((fine == coarse && j <= i) || grains.region[j] != wanted)
                       return;
                     const Vec2 branch = grains.position(j) - p;
                     const double limit =
                         grains.radius[i] + grains.radius[j] + installation_gap;
                     if (dot(branch, branch) <= limit * limit)
                       pairs.emplace_back(std::min(i, j), std::max(i, j));
                   });
      }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}
} // namespace antiform::discrete

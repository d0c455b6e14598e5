#include "discrete/disk_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace antiform::discrete
{
namespace
{
struct Image
{
  std::int32_t disk;
  Vec2 shift;
  Vec2 centre;
};

/// The disks themselves, first and in order, then those images that are within @p margin
/// of the tile.
std::vector<Image>
images(const std::vector<Disk> &disks, const Vec2 &period, const double margin)
{
  std::vector<Image> all;
  all.reserve(disks.size());
  for (std::size_t i = 0; i < disks.size(); ++i)
    all.push_back({static_cast<std::int32_t>(i), {0., 0.}, disks[i].centre});
  if (period.x <= 0. || disks.empty())
    return all;

  // Centres may have left the tile a little while they move: take their own bounds.
  Vec2 low = disks[0].centre, high = low;
  for (const Disk &d : disks)
  {
    low = {std::min(low.x, d.centre.x), std::min(low.y, d.centre.y)};
    high = {std::max(high.x, d.centre.x), std::max(high.y, d.centre.y)};
  }
  const int n_x = static_cast<int>(std::ceil((high.x - low.x + margin) / period.x));
  const int n_y = static_cast<int>(std::ceil((high.y - low.y + margin) / period.y));
  for (int a = -n_x; a <= n_x; ++a)
    for (int b = -n_y; b <= n_y; ++b)
      for (std::size_t i = 0; i < disks.size() && (a != 0 || b != 0); ++i)
      {
        const Vec2 shift = {a * period.x, b * period.y};
        const Vec2 c = disks[i].centre + shift;
        if (c.x >= low.x - margin && c.x <= high.x + margin && c.y >= low.y - margin &&
            c.y <= high.y + margin)
          all.push_back({static_cast<std::int32_t>(i), shift, c});
      }
  return all;
}

/// Square cells that list the points in them, in the order of the points.
class CellLists
{
public:
  CellLists(const std::vector<Image> &points, const double cell)
      : inverse_(1. / cell)
      , origin_(points[0].centre)
  {
    Vec2 high = origin_;
    for (const Image &p : points)
    {
      origin_ = {std::min(origin_.x, p.centre.x), std::min(origin_.y, p.centre.y)};
      high = {std::max(high.x, p.centre.x), std::max(high.y, p.centre.y)};
    }
    n_x_ = column(high.x) + 1;
    n_y_ = row(high.y) + 1;
    begin_.assign(static_cast<std::size_t>(n_x_ * n_y_ + 1), 0);
    for (const Image &p : points)
      ++begin_[row(p.centre.y) * n_x_ + column(p.centre.x) + 1];
    for (std::size_t c = 1; c < begin_.size(); ++c)
      begin_[c] += begin_[c - 1];
    point_.resize(points.size());
    std::vector<std::int64_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t k = 0; k < points.size(); ++k)
      point_[next[row(points[k].centre.y) * n_x_ + column(points[k].centre.x)]++] =
          static_cast<std::int32_t>(k);
  }

  /// Call @p use with every point in the nine cells around @p place.
  template <class Use>
  void visit(const Vec2 &place, const Use &use) const
  {
    const std::int64_t i = column(place.x), j = row(place.y);
    for (std::int64_t r = std::max<std::int64_t>(j - 1, 0); r <= j + 1 && r < n_y_; ++r)
    {
      const std::int64_t left = std::max<std::int64_t>(i - 1, 0);
      const std::int64_t right = std::min(i + 1, n_x_ - 1);
      for (std::int64_t k = begin_[r * n_x_ + left]; k < begin_[r * n_x_ + right + 1];
           ++k)
        use(point_[k]);
    }
  }

private:
  std::int64_t column(const double x) const
  {
    return static_cast<std::int64_t>((x - origin_.x) * inverse_);
  }
  std::int64_t row(const double y) const
  {
    return static_cast<std::int64_t>((y - origin_.y) * inverse_);
  }

  double inverse_;
  Vec2 origin_;
  std::int64_t n_x_ = 0, n_y_ = 0;
  std::vector<std::int64_t> begin_;
  std::vector<std::int32_t> point_;
};
} // namespace

std::vector<DiskPair>
disk_pairs(const std::vector<Disk> &disks, const Vec2 &period, const double reach)
{
  std::vector<DiskPair> pairs;
  if (disks.empty())
    return pairs;
  double largest = 0.;
  for (const Disk &d : disks)
    largest = std::max(largest, d.radius);

  const double cell = 2. * largest + reach;
  const std::vector<Image> points = images(disks, period, cell);
  const CellLists cells(points, cell);
  pairs.reserve(4 * disks.size());
  for (std::size_t i = 0; i < disks.size(); ++i)
  {
    const std::size_t begin = pairs.size();
    cells.visit(disks[i].centre,
                [&](const std::int32_t k)
                {
                  const Image &image = points[k];
                  const auto first = static_cast<std::int32_t>(i);
                  // Of the two ends of a pair, and of the two images of a disk paired
                  // with itself, one is taken.
                  const bool ahead =
                      image.shift.x > 0. || (image.shift.x == 0. && image.shift.y > 0.);
                  if (image.disk < first || (image.disk == first && !ahead))
                    return;
                  const Vec2 d = image.centre - disks[i].centre;
                  const double limit = disks[i].radius + disks[image.disk].radius + reach;
                  if (dot(d, d) <= limit * limit)
                    pairs.push_back({first, image.disk, image.shift});
                });
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.end(),
              [](const DiskPair &a, const DiskPair &b)
              {
                return std::tie(a.second, a.shift.x, a.shift.y) <
                       std::tie(b.second, b.shift.x, b.shift.y);
              });
  }
  return pairs;
}

std::vector<int> pair_count(const std::size_t n_disks, const std::vector<DiskPair> &pairs)
{
  std::vector<int> count(n_disks, 0);
  for (const DiskPair &p : pairs)
  {
    ++count[p.first];
    ++count[p.second];
  }
  return count;
}
} // namespace antiform::discrete

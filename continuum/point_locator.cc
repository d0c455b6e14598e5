#include "continuum/point_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace antiform::continuum
{
namespace
{
using dealii::Point;

constexpr double tolerance = 1e-8; // of a cell

/// Unit coordinates of @p point in a bilinear quadrilateral, by Newton's method; it
/// leaves the loop at round-off or, for points far outside, after the last iteration.
Point<2> unit_coordinates(const std::array<Point<2>, 4> &corners, const Point<2> &point)
{
  const dealii::Tensor<1, 2> a = corners[1] - corners[0], b = corners[2] - corners[0],
                             c = corners[3] - corners[1] - b;
  Point<2> unit(0.5, 0.5);
  for (unsigned int i = 0; i < 20; ++i)
  {
    const double s = unit[0], t = unit[1];
    const dealii::Tensor<1, 2> rest = point - corners[0] - s * a - t * b - s * t * c;
    const dealii::Tensor<1, 2> ds = a + t * c, dt = b + s * c;
    const double determinant = ds[0] * dt[1] - ds[1] * dt[0];
    if (determinant <= 0.) // only outside of a convex cell
      return Point<2>(2., 2.);
    const double step_s = (rest[0] * dt[1] - rest[1] * dt[0]) / determinant;
    const double step_t = (ds[0] * rest[1] - ds[1] * rest[0]) / determinant;
    unit += dealii::Tensor<1, 2>({step_s, step_t});
    if (std::abs(step_s) + std::abs(step_t) < 1e-15)
      break;
  }
  return unit;
}

double distance_outside(const Point<2> &unit)
{
  double outside = 0.;
  for (unsigned int d = 0; d < 2; ++d)
    outside = std::max({outside, -unit[d], unit[d] - 1.});
  return outside;
}
} // namespace

PointLocator::PointLocator(const dealii::Triangulation<2> &triangulation)
{
  constexpr double infinite = std::numeric_limits<double>::max();
  lower_ = Point<2>(infinite, infinite);
  upper_ = Point<2>(-infinite, -infinite);
  for (const auto &cell : triangulation.active_cell_iterators())
    if (!cell->is_artificial())
    {
      cells_.push_back(cell);
      corners_.push_back(
          {cell->vertex(0), cell->vertex(1), cell->vertex(2), cell->vertex(3)});
      for (const auto &corner : corners_.back())
        for (unsigned int d = 0; d < 2; ++d)
        {
          lower_[d] = std::min(lower_[d], corner[d]);
          upper_[d] = std::max(upper_[d], corner[d]);
        }
    }
  if (cells_.empty())
    return;

  // About one bucket a cell, squares in shape.
  const double width = upper_[0] - lower_[0], height = upper_[1] - lower_[1];
  const double size = std::sqrt(width * height / static_cast<double>(cells_.size()));
  n_buckets_ = {std::max(1, static_cast<int>(width / size)),
                std::max(1, static_cast<int>(height / size))};
  bucket_size_ = {width / n_buckets_[0], height / n_buckets_[1]};

  std::vector<std::vector<std::size_t>> lists(static_cast<std::size_t>(n_buckets_[0]) *
                                              n_buckets_[1]);
  for (std::size_t i = 0; i < cells_.size(); ++i)
  {
    Point<2> low = corners_[i][0], high = corners_[i][0];
    for (const auto &corner : corners_[i])
      for (unsigned int d = 0; d < 2; ++d)
      {
        low[d] = std::min(low[d], corner[d]);
        high[d] = std::max(high[d], corner[d]);
      }
    const dealii::Tensor<1, 2> margin = 2. * tolerance * (high - low);
    const auto first = bucket(low - margin), last = bucket(high + margin);
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        lists[y * n_buckets_[0] + x].push_back(i);
  }
  bucket_start_.push_back(0);
  for (const auto &list : lists)
  {
    members_.insert(members_.end(), list.begin(), list.end());
    bucket_start_.push_back(members_.size());
  }
}

std::array<int, 2> PointLocator::bucket(const Point<2> &point) const
{
  std::array<int, 2> result{};
  for (unsigned int d = 0; d < 2; ++d)
  {
    const double place = std::floor((point[d] - lower_[d]) / bucket_size_[d]);
    result[d] = static_cast<int>(std::clamp(place, 0., n_buckets_[d] - 1.));
  }
  return result;
}

PointLocator::Candidate PointLocator::nearest(const Point<2> &point) const
{
  Candidate best;
  best.outside = std::numeric_limits<double>::infinity();
  if (cells_.empty())
    return best;
  const auto place = bucket(point);
  const int b = place[1] * n_buckets_[0] + place[0];
  for (std::size_t m = bucket_start_[b]; m < bucket_start_[b + 1]; ++m)
  {
    const Point<2> unit = unit_coordinates(corners_[members_[m]], point);
    const double outside = distance_outside(unit);
    if (outside < best.outside)
      best = {members_[m], unit, outside};
    if (best.outside == 0.)
      break;
  }
  return best;
}

PointLocator::Place PointLocator::find(const Point<2> &point) const
{
  const Candidate best = nearest(point);
  if (!(best.outside <= tolerance))
    throw std::out_of_range("point (" + std::to_string(point[0]) + ", " +
                            std::to_string(point[1]) +
                            ") m lies outside the cells that this rank knows.");
  return {cells_[best.cell], best.unit};
}

bool PointLocator::contains(const Point<2> &point) const
{
  return nearest(point).outside <= tolerance;
}
} // namespace antiform::continuum

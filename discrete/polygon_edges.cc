#include "discrete/polygon_edges.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
PolygonEdges::PolygonEdges(const std::vector<Vec2> &polygon, const double reach)
    : reach_(reach)
    , cell_(reach)
{
  Vec2 low = polygon[0], high = polygon[0];
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    const double length = norm(b - a);
    const Vec2 along = (1. / length) * (b - a);
    edges_.push_back({a, along, perpendicular(along), length});
    low = {std::min(low.x, a.x), std::min(low.y, a.y)};
    high = {std::max(high.x, a.x), std::max(high.y, a.y)};
  }
  origin_ = low - Vec2{reach, reach};
  n_x_ = static_cast<std::int64_t>((high.x - low.x + 2. * reach) / cell_) + 1;
  n_y_ = static_cast<std::int64_t>((high.y - low.y + 2. * reach) / cell_) + 1;
  buckets_.resize(static_cast<std::size_t>(n_x_ * n_y_));

  // An edge goes to every cell that holds a point within reach of it: those whose centre
  // is within reach plus half a diagonal.
  const double limit = reach + 0.75 * cell_;
  for (std::size_t e = 0; e < edges_.size(); ++e)
  {
    const Vec2 a = edges_[e].start, b = a + edges_[e].length * edges_[e].along;
    const auto first = [&](const double from, const double low_corner)
    { return static_cast<std::int64_t>((from - limit - low_corner) / cell_); };
    const auto last = [&](const double to, const double low_corner, const std::int64_t n)
    {
      return std::min(n - 1,
                      static_cast<std::int64_t>((to + limit - low_corner) / cell_));
    };
    const std::int64_t right = last(std::max(a.x, b.x), origin_.x, n_x_);
    const std::int64_t top = last(std::max(a.y, b.y), origin_.y, n_y_);
    for (std::int64_t j = first(std::min(a.y, b.y), origin_.y); j <= top; ++j)
      for (std::int64_t i = first(std::min(a.x, b.x), origin_.x); i <= right; ++i)
      {
        const Vec2 centre = origin_ + cell_ * Vec2{static_cast<double>(i) + 0.5,
                                                   static_cast<double>(j) + 0.5};
        if (i >= 0 && j >= 0 &&
            nearest(static_cast<std::int32_t>(e), centre).distance <= limit)
          buckets_[j * n_x_ + i].push_back(static_cast<std::int32_t>(e));
      }
  }
}

std::int64_t PolygonEdges::bucket(const Vec2 &point) const
{
  const double i = std::floor((point.x - origin_.x) / cell_);
  const double j = std::floor((point.y - origin_.y) / cell_);
  if (i < 0. || j < 0. || i >= static_cast<double>(n_x_) ||
      j >= static_cast<double>(n_y_))
    return -1;
  return static_cast<std::int64_t>(j) * n_x_ + static_cast<std::int64_t>(i);
}

PolygonEdges::Nearest PolygonEdges::nearest(const std::int32_t edge,
                                            const Vec2 &point) const
{
  const Edge &e = edges_[edge];
  const Vec2 from_start = point - e.start;
  const double s = dot(from_start, e.along);
  if (s >= 0. && s <= e.length)
  {
    const double height = dot(from_start, e.inward);
    return {height * e.inward, std::abs(height), height >= 0.};
  }
  // An end is nearest: the sum of the normals of its two edges tells inside from outside.
  const auto n = static_cast<std::int32_t>(edges_.size());
  const Edge &other = edges_[s < 0. ? (edge + n - 1) % n : (edge + 1) % n];
  const Vec2 away = s < 0. ? from_start : from_start - e.length * e.along;
  return {away, norm(away), dot(away, e.inward + other.inward) >= 0.};
}

void PolygonEdges::append_near(const Vec2 &point,
                               const double distance,
                               std::vector<std::int32_t> &edges) const
{
  const std::int64_t b = bucket(point);
  if (b < 0)
    return;
  for (const std::int32_t e : buckets_[b])
    if (nearest(e, point).distance <= distance)
      edges.push_back(e);
}

void PolygonEdges::find_contacts(const Disk &disk,
                                 const std::int32_t *begin,
                                 const std::int32_t *end,
                                 std::vector<EdgeContact> &contacts) const
{
  contacts.clear();
  Nearest closest{{0., 0.}, reach_, true};
  for (const std::int32_t *e = begin; e != end; ++e)
  {
    const Nearest here = nearest(*e, disk.centre);
    if (here.distance < closest.distance)
      closest = here;
    // Summing over edges, corner regions included, keeps the force continuous along a
    // bent boundary; edges seen from behind belong to another side of the polygon.
    if (here.inside && here.distance < disk.radius && here.distance > 0.)
      contacts.push_back({(1. / here.distance) * here.away, disk.radius - here.distance});
  }
  if (!closest.inside && closest.distance > 0.)
    contacts.assign(
        1, {(-1. / closest.distance) * closest.away, disk.radius + closest.distance});
}

double PolygonEdges::depth(const Vec2 &point) const
{
  Nearest closest{{0., 0.}, reach_, true};
  const std::int64_t b = bucket(point);
  if (b < 0)
    return -reach_;
  for (const std::int32_t e : buckets_[b])
  {
    const Nearest here = nearest(e, point);
    if (here.distance < closest.distance)
      closest = here;
  }
  return closest.inside ? closest.distance : -closest.distance;
}

double PolygonEdges::perimeter() const
{
  double sum = 0.;
  for (const Edge &e : edges_)
    sum += e.length;
  return sum;
}
} // namespace antiform::discrete

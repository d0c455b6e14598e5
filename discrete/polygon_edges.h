#pragma once

#include "discrete/packing.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Where a disk presses on an edge of the polygon.
struct EdgeContact
{
  Vec2 normal; ///< unit, the way that the edge pushes the disk
  double overlap;
};

/// The edges of a counter-clockwise polygon as frictionless walls, found by buckets.
class PolygonEdges
{
public:
  /// @p reach: edges further than this from a point are of no interest to it.
  PolygonEdges(const std::vector<Vec2> &polygon, double reach);

  /// Append the edges that are at most @p distance (<= the reach) from @p point,
  /// ascending.
  void
  append_near(const Vec2 &point, double distance, std::vector<std::int32_t> &edges) const;

  /// Contacts of @p disk with the edges in [@p begin, @p end). A disk whose centre has
  /// left the polygon is pushed back over the nearest edge.
  void find_contacts(const Disk &disk,
                     const std::int32_t *begin,
                     const std::int32_t *end,
                     std::vector<EdgeContact> &contacts) const;

  /// Distance of @p point to the nearest edge, negative outside; the reach where no edge
  /// is as near as that.
  double depth(const Vec2 &point) const;

  double perimeter() const;

private:
  struct Edge
  {
    Vec2 start;
    Vec2 along;  ///< unit
    Vec2 inward; ///< unit normal
    double length;
  };
  struct Nearest
  {
    Vec2 away; ///< from the nearest point of the edge to the point
    double distance;
    bool inside;
  };
  Nearest nearest(std::int32_t edge, const Vec2 &point) const;
  /// The bucket of a point, or -1 outside of all.
  std::int64_t bucket(const Vec2 &point) const;

  double reach_;
  std::vector<Edge> edges_;
  Vec2 origin_;
  double cell_ = 0.;
  std::int64_t n_x_ = 0, n_y_ = 0;
  std::vector<std::vector<std::int32_t>> buckets_;
};
} // namespace antiform::discrete

#include "discrete/membrane.h"

#include <CGAL/Alpha_shape_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace antiform::discrete
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Info = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using Vertex = CGAL::Alpha_shape_vertex_base_2<Kernel, Info>;
using Face = CGAL::Alpha_shape_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
using AlphaShape = CGAL::Alpha_shape_2<Delaunay>;

/// Directed edges of the boundary, the body on their left, by their first grain.
std::multimap<std::int32_t, std::int32_t> boundary_edges(const AlphaShape &shape)
{
  std::multimap<std::int32_t, std::int32_t> edges;
  for (auto edge = shape.alpha_shape_edges_begin(); edge != shape.alpha_shape_edges_end();
       ++edge)
  {
    if (shape.classify(*edge) != AlphaShape::REGULAR)
      continue;
    auto face = edge->first;
    int i = edge->second;
    if (shape.classify(face) != AlphaShape::INTERIOR)
    {
      const auto other = face->neighbor(i);
      i = other->index(face);
      face = other;
    }
    edges.emplace(face->vertex(shape.ccw(i))->info(), face->vertex(shape.cw(i))->info());
  }
  return edges;
}

/// Where two boundaries touch in a grain, the next edge is that furthest to the right: it
/// keeps to the outside.
std::int32_t next_grain(const Grains &grains,
                        std::multimap<std::int32_t, std::int32_t> &edges,
                        const std::int32_t from,
                        const std::int32_t at)
{
  const auto range = edges.equal_range(at);
  auto best = range.first;
  const Vec2 along = grains.position(at) - grains.position(from);
  double rightmost = 4.;
  for (auto edge = range.first; edge != range.second; ++edge)
  {
    const Vec2 on = grains.position(edge->second) - grains.position(at);
    const double turn = std::atan2(cross(along, on), dot(along, on));
    if (turn < rightmost)
    {
      rightmost = turn;
      best = edge;
    }
  }
  const std::int32_t next = best->second;
  edges.erase(best);
  return next;
}
} // namespace

std::vector<std::int32_t> outer_ring(const Grains &grains, const double reach)
{
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> points;
  points.reserve(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 p = grains.position(i);
    points.emplace_back(Kernel::Point_2(p.x, p.y), static_cast<std::int32_t>(i));
  }
  Delaunay triangulation(points.begin(), points.end());
  const AlphaShape shape(triangulation, reach * reach, AlphaShape::REGULARIZED);
  std::multimap<std::int32_t, std::int32_t> edges = boundary_edges(shape);
  std::vector<std::int32_t> best;
  double largest = 0.;
  while (!edges.empty())
  {
    std::vector<std::int32_t> ring;
    const std::int32_t start = edges.begin()->first;
    std::int32_t from = start, at = edges.begin()->second;
    edges.erase(edges.begin());
    ring.push_back(start);
    while (at != start && edges.count(at) > 0)
    {
      ring.push_back(at);
      const std::int32_t next = next_grain(grains, edges, from, at);
      from = at;
      at = next;
    }
    double area = 0.;
    for (std::size_t k = 0; k < ring.size(); ++k)
      area += 0.5 * cross(grains.position(ring[k]),
                          grains.position(ring[(k + 1) % ring.size()]));
    if (area > largest)
    {
      largest = area;
      best = std::move(ring);
    }
  }
  if (best.size() < 3)
    throw std::invalid_argument("a membrane finds no body of grains: a ball of radius " +
                                std::to_string(reach) +
                                " m passes between all of them. Give a larger reach.");
  // From the lowest number on, so that the ring does not depend on where it was begun.
  std::rotate(best.begin(), std::min_element(best.begin(), best.end()), best.end());
  return best;
}
} // namespace antiform::discrete

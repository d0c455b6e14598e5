#include "discrete/packing.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_2_algorithms.h>

namespace antiform::discrete
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<Kernel::Point_2> points(const std::vector<Vec2> &polygon)
{
  std::vector<Kernel::Point_2> result;
  result.reserve(polygon.size());
  for (const Vec2 &p : polygon)
    result.emplace_back(p.x, p.y);
  return result;
}
} // namespace

bool is_simple(const std::vector<Vec2> &polygon)
{
  const auto p = points(polygon);
  return p.size() >= 3 && CGAL::is_simple_2(p.begin(), p.end(), Kernel());
}

bool contains(const std::vector<Vec2> &polygon, const Vec2 &point)
{
  const auto p = points(polygon);
  return CGAL::bounded_side_2(p.begin(), p.end(), Kernel::Point_2(point.x, point.y),
                              Kernel()) != CGAL::ON_UNBOUNDED_SIDE;
}

double area(const std::vector<Vec2> &polygon)
{
  const auto p = points(polygon);
  return CGAL::polygon_area_2(p.begin(), p.end(), Kernel());
}
} // namespace antiform::discrete

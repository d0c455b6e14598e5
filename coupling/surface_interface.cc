#include "coupling/surface_interface.h"

#include "continuum/require.h"
#include "discrete/bond_laws.h"
#include "discrete/membrane.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace antiform::coupling
{
std::vector<std::int32_t> outer_side(const discrete::Grains &grains,
                                     const std::vector<std::int32_t> &layer,
                                     const double reach,
                                     const Vec2 &towards)
{
  std::vector<std::int32_t> members = layer;
  if (members.empty())
  {
    members.resize(grains.size());
    std::iota(members.begin(), members.end(), 0);
  }
  discrete::Grains body;
  for (const std::int32_t i : members)
    body.add(grains.reference(i), grains.radius[i], 1., 0);
  const std::vector<std::int32_t> ring = discrete::outer_ring(body, reach);

  // The ring goes counter-clockwise: along the side, in the direction of this.
  const Vec2 along = perpendicular(towards);
  const auto corner = [&](const Vec2 &direction)
  {
    return std::max_element(ring.begin(), ring.end(),
                            [&](const std::int32_t a, const std::int32_t b) {
                              return dot(body.reference(a), direction) <
                                     dot(body.reference(b), direction);
                            }) -
           ring.begin();
  };
  const auto n = static_cast<std::ptrdiff_t>(ring.size());
  const std::ptrdiff_t first = corner(towards - along), last = corner(towards + along);
  std::vector<std::int32_t> side;
  for (std::ptrdiff_t k = first;; k = (k + 1) % n)
  {
    side.push_back(members[ring[k]]);
    if (k == last)
      break;
  }
  return side;
}

SurfaceInterface::SurfaceInterface(const discrete::Grains &grains,
                                   const std::vector<std::int32_t> &outer,
                                   const continuum::ElasticSolid &solid,
                                   const dealii::types::boundary_id edge)
    : edge_(solid, edge)
{
  for (const std::int32_t i : outer)
  {
    const EdgeCurve::Nearest seen = edge_.nearest(grains.reference(i), nullptr);
    const bool is_behind =
        cross(edge_.tangent(seen.place, nullptr),
              grains.reference(i) - seen.point) > 0.; // the body is on the left
    if (!seen.beyond)
      points_.push_back({i, seen.place, 0., is_behind ? -seen.distance : seen.distance});
  }
  if (points_.empty())
    throw std::invalid_argument(
        "surface interface: none of the layer's outer grains faces the mesh's edge.");
  const auto at = [&](const SurfacePoint &p) { return edge_.distance_along(p.place); };
  std::sort(points_.begin(), points_.end(),
            [&](const SurfacePoint &a, const SurfacePoint &b)
            { return at(a) != at(b) ? at(a) < at(b) : a.grain < b.grain; });
  const auto margin = [&](const SurfacePoint &point, const double rest)
  {
    const double radius = grains.radius[point.grain];
    return rest <= 2. * radius ? rest : radius;
  };
  margins_ = {margin(points_.front(), at(points_.front())),
              margin(points_.back(), edge_.length() - at(points_.back()))};
  const std::size_t n = points_.size();
  for (std::size_t k = 0; k < n; ++k)
  {
    const double here = at(points_[k]);
    points_[k].length = (k > 0 ? 0.5 * (here - at(points_[k - 1])) : margins_[0]) +
                        (k + 1 < n ? 0.5 * (at(points_[k + 1]) - here) : margins_[1]);
  }
}

continuum::ContactStiffness surface_stiffness(const SurfaceInterface &interface,
                                              const discrete::Joints &joints,
                                              const continuum::ElasticSolid &solid,
                                              const double ratio)
{
  continuum::require(ratio > 0., "surface interface: the ratio of stiffnesses", ratio, "",
                     "> 0");
  constexpr double infinite = std::numeric_limits<double>::infinity();
  continuum::ContactStiffness stiffness{infinite, infinite};
  for (const SurfacePoint &point : interface.points())
    for (std::int32_t k = joints.grain_begin[point.grain];
         k < joints.grain_begin[point.grain + 1]; ++k)
    {
      const std::int32_t j = joints.grain_joint[k];
      const double kappa = discrete::constants(joints.group_of(j).law).stiffness_ratio;
      stiffness.normal = std::min(stiffness.normal, joints.stiffness[j]);
      stiffness.shear = std::min(stiffness.shear, joints.stiffness[j] / kappa);
    }
  for (const EdgeCurve::Cell &cell : interface.edge().cells())
  {
    const auto &C = solid.materials()[cell.material].stiffness;
    stiffness.normal =
        std::min(stiffness.normal, ratio * std::max(C[0][0], C[1][1]) / cell.height);
    stiffness.shear = std::min(stiffness.shear, ratio * C[2][2] / cell.height);
  }
  return stiffness;
}
} // namespace antiform::coupling

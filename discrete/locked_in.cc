#include "discrete/locked_in.h"

#include "discrete/polygon_edges.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
double overlap(const Grains &grains, const Joints &joints, const std::size_t j)
{
  return std::max(0., grains.radius[joints.first[j]] + grains.radius[joints.second[j]] -
                          joints.length[j]);
}

/// Sum of overlap times distance from grain to edge: what the outline's contacts add to
/// twice the mean pressure times area.
double sum_over_outline(const Grains &grains, const std::vector<Vec2> &outline)
{
  const double largest = *std::max_element(grains.radius.begin(), grains.radius.end());
  const PolygonEdges edges(outline, 1.5 * largest);
  double sum = 0.;
  std::vector<std::int32_t> near;
  std::vector<EdgeContact> contacts;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    near.clear();
    edges.append_near(grains.reference(i), grains.radius[i], near);
    edges.find_contacts({grains.reference(i), grains.radius[i]}, near.data(),
                        near.data() + near.size(), contacts);
    for (const EdgeContact &c : contacts)
      sum += c.overlap * (grains.radius[i] - c.overlap);
  }
  return sum;
}
} // namespace

bool lock_in(const Grains &grains,
             const std::vector<Vec2> &outline,
             const double pressure,
             Joints &joints,
             std::vector<Wall> &walls)
{
  // Forces f = F overlap; 2 P A = sum of f times branch over pairs and the outline.
  double sum = sum_over_outline(grains, outline);
  for (std::size_t j = 0; j < joints.size(); ++j)
    sum += overlap(grains, joints, j) * joints.length[j];
  if (sum == 0.)
    return false;
  const double factor = 2. * pressure * std::abs(area(outline)) / sum;
  for (std::vector<double> *v :
       {&joints.initial_gap, &joints.initial_shear, &joints.initial_rotation})
    v->assign(joints.size(), 0.);
  for (std::size_t j = 0; j < joints.size(); ++j)
    joints.initial_gap[j] = -factor * overlap(grains, joints, j) /
                            (joints.stiffness[j] * 2. * joints.half_length[j]);
  for (Wall &wall : walls)
    for (WallContact &contact : wall.contacts)
      contact.initial_gap =
          std::min(0., factor * contact.reference_gap) / contact.stiffness;
  return true;
}
} // namespace antiform::discrete

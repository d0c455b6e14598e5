#pragma once

#include "discrete/vec2.h"

#include <algorithm>
#include <functional>

namespace antiform::coupling
{
/// Energy weights of the bridging domain (Arlequin): functions of the distance to the
/// core, the fully discrete part of the section. They add up to one up to the floor.
struct OverlapWeight
{
  std::function<double(const Vec2 &)> distance_to_core; ///< [m], 0 inside the core
  double width = 0.;                                    ///< w of the overlap [m]
  bool cubic = false;  ///< ramp 3 s^2 - 2 s^3 instead of s
  double floor = 1e-3; ///< eps: neither model vanishes where it has unknowns [-]

  double ramp(const Vec2 &x) const
  {
    const double s = std::clamp(distance_to_core(x) / width, 0., 1.);
    return cubic ? s * s * (3. - 2. * s) : s;
  }
  /// w_D, of joints at their contact point and of grains at their centre.
  double grains(const Vec2 &x) const { return std::max(1. - ramp(x), floor); }
  /// w_C, of the mesh at its quadrature points.
  double mesh(const Vec2 &x) const { return std::max(ramp(x), floor); }
  /// Grains exist up to the outer rim of the overlap, multipliers between the rims.
  bool holds_grains(const Vec2 &x) const { return distance_to_core(x) <= width; }
  bool in_overlap(const Vec2 &x) const
  {
    const double distance = distance_to_core(x);
    return distance > 0. && distance <= width;
  }
};
} // namespace antiform::coupling

#include "discrete/membrane.h"

namespace antiform::discrete
{
namespace
{
/// Calls @p act with the two grains of each loaded segment and the force on either [N].
template <class Act>
void for_each_segment(const Grains &grains,
                      const Membrane &membrane,
                      const double pressure,
                      const Act &act)
{
  const std::size_t n = membrane.ring.size();
  for (std::size_t k = 0; k < n; ++k)
  {
    if (membrane.loaded[k] == 0)
      continue;
    const std::int32_t i = membrane.ring[k], j = membrane.ring[(k + 1) % n];
    // The body is on the left of the way from i to j.
    const Vec2 inward = perpendicular(grains.position(j) - grains.position(i));
    act(i, j, (0.5 * pressure) * inward);
  }
}
} // namespace

double
add_membrane_forces(Grains &grains, const Membrane &membrane, const double pressure)
{
  double power = 0.;
  for_each_segment(grains, membrane, pressure,
                   [&](const std::int32_t i, const std::int32_t j, const Vec2 &force)
                   {
                     for (const std::int32_t grain : {i, j})
                     {
                       grains.force_x[grain] += force.x;
                       grains.force_y[grain] += force.y;
                       power += dot(force, grains.velocity(grain));
                     }
                   });
  return power;
}

double
membrane_power(const Grains &grains, const Membrane &membrane, const double pressure)
{
  double power = 0.;
  for_each_segment(
      grains, membrane, pressure,
      [&](const std::int32_t i, const std::int32_t j, const Vec2 &force)
      { power += dot(force, grains.velocity(i)) + dot(force, grains.velocity(j)); });
  return power;
}

double enclosed_area(const Grains &grains, const Membrane &membrane)
{
  double area = 0.;
  for (std::size_t k = 0; k < membrane.ring.size(); ++k)
    area +=
        0.5 * cross(grains.position(membrane.ring[k]),
                    grains.position(membrane.ring[(k + 1) % membrane.ring.size()]));
  return area;
}
} // namespace antiform::discrete

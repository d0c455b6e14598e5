#include "discrete/flat_joint.h"

#include <cmath>

namespace antiform::discrete
{
ElementResultant element_resultant(const double stiffness,
                                   const double gap,
                                   const double rotation,
                                   double a,
                                   double b,
                                   const bool bonded,
                                   const bool element_moment)
{
  if (!bonded)
  {
    const double gap_a = gap - rotation * a, gap_b = gap - rotation * b;
    if (gap_a >= 0. && gap_b >= 0.)
      return {};
    if (gap_a * gap_b < 0.) // cut where the gap changes sign, keep the closed side
      (gap_a < 0. ? b : a) = gap / rotation;
  }
  const double length = b - a, centre = 0.5 * (a + b);
  const double inertia = length * length * length / 12.;
  const double mean_gap = gap - rotation * centre;

  ElementResultant result;
  result.active_length = length;
  result.normal_force = stiffness * length * mean_gap;
  result.moment = centre * result.normal_force;
  result.strain_energy = 0.5 * stiffness * length * mean_gap * mean_gap;
  if (element_moment)
  {
    result.moment -= stiffness * rotation * inertia;
    result.strain_energy += 0.5 * stiffness * rotation * rotation * inertia;
  }
  return result;
}
} // namespace antiform::discrete

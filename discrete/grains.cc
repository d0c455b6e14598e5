#include "discrete/grains.h"

namespace antiform::discrete
{
void Grains::add(const Vec2 &centre,
                 const double grain_radius,
                 const double density,
                 const int grain_region)
{
  const double m = density * M_PI * grain_radius * grain_radius;
  const double j = 0.5 * m * grain_radius * grain_radius;
  reference_x.push_back(centre.x);
  reference_y.push_back(centre.y);
  radius.push_back(grain_radius);
  mass.push_back(m);
  inertia.push_back(j);
  region.push_back(grain_region);
  inverse_mass.push_back(1. / m);
  inverse_inertia.push_back(1. / j);
  for (std::vector<double> *zero :
       {&displacement_x, &displacement_y, &rotation, &velocity_x, &velocity_y, &spin,
        &force_x, &force_y, &torque})
    zero->push_back(0.);
}
} // namespace antiform::discrete

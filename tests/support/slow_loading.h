#pragma once
// The reference of the quasi-static driver: explicit damped motion at a constant rate.
#include "support/specimen_fixture.h"

#include "discrete/integrate.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling::test
{
/// Largest stress of @p specimen [Pa] when its shortening goes on at a constant rate:
/// @p transits times the way of a sound wave along its height for a shortening of
/// @p strain, at which it ends. Densities are scaled; damping is combined, 0.7, so that
/// the drift does not rub.
inline double slow_peak(Specimen &specimen, const double transits, const double strain)
{
  GrainBalance body(specimen.state, specimen.platens);
  discrete::Grains &grains = specimen.state.grains;
  const discrete::Joints &joints = specimen.state.joints;
  // Modulus by the elastic tangent.
  body.move(1e-6 * body.tangent());
  body.residual();
  const double modulus = specimen.stress(body.conjugate_force()) / 1e-6;
  body.move(-1e-6 * body.tangent());

  discrete::scale_density(grains, discrete::stiffness_sums(grains, joints, false), {},
                          1.);
  double mass = 0.;
  for (const double inverse : grains.inverse_mass)
    mass += 1. / inverse;
  const double speed = std::sqrt(modulus * specimen.width * specimen.height / mass);
  const double dt = 0.8 * discrete::stable_step(grains, joints) / std::sqrt(1.7);
  const double rate = strain / (transits * specimen.height / speed);
  for (const PrescribedMotion &platen : specimen.platens)
    (platen.component == 0 ? grains.velocity_x : grains.velocity_y)[platen.grain] =
        rate * platen.rate;

  discrete::GrainDamping damping;
  damping.coefficient = 0.7;
  damping.combined = true;
  double peak = 0.;
  const auto n = static_cast<std::uint64_t>(std::ceil(strain / (rate * dt)));
  for (std::uint64_t step = 0; step < n; ++step)
  {
    body.add_forces({step, static_cast<double>(step) * dt, dt}, &specimen.state.cracks,
                    false);
    peak = std::max(peak, specimen.stress(body.conjugate_force()));
    discrete::damped_kick(grains, dt, damping);
    discrete::drift(grains, dt);
  }
  return peak;
}
} // namespace antiform::coupling::test

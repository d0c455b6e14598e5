#pragma once
// The reference of the quasi-static driver: explicit damped motion at a constant rate.
#include "support/specimen_fixture.h"

#include "coupling/event_driver.h"
#include "discrete/integrate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <vector>

namespace antiform::coupling::test
{
/// Seconds of the processor that this process has used.
inline double processor_seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// What slow loading found, and what it took to the peak and to its end.
struct SlowLoading
{
  double peak = 0.;   ///< largest stress [Pa]
  double stress = 0.; ///< at the end [Pa]
  double peak_strain = 0.;
  std::uint64_t peak_steps = 0, steps = 0;
  double peak_seconds = 0., seconds = 0.; ///< of the processor
};

/// Transits up to the peak at which local damping rubs no more than 1 or 2 %.
constexpr double very_slow = 2000.;

/// Cundall's, 0.7: what a break sets free comes to rest soonest, but a body on the move
/// is rubbed (docs/theory/damping.md).
inline discrete::GrainDamping local_damping()
{
  discrete::GrainDamping damping;
  damping.coefficient = 0.7;
  return damping;
}
/// Leaves the drift alone, and damps what vibrates on it by half.
inline discrete::GrainDamping combined_damping()
{
  discrete::GrainDamping damping = local_damping();
  damping.combined = true;
  return damping;
}

/// Shorten @p specimen at a constant rate: @p transits times the way of a sound wave
/// along its height for a shortening of @p strain. It ends when bonds have broken and the
/// stress is @p stop_drop below the largest so far, 0: at @p strain. Densities are
/// scaled. Constant loads are in balance before. @p watch gets the stress [Pa] at every
/// step.
inline SlowLoading slow_loading(Specimen &specimen,
                                const double transits,
                                const double strain,
                                const double stop_drop = 0.,
                                const std::vector<GrainLoad> &loads = {},
                                const std::function<void(double)> &watch = {},
                                discrete::GrainDamping damping = combined_damping())
{
  GrainBalance body(specimen.state, specimen.platens, loads);
  discrete::Grains &grains = specimen.state.grains;
  const discrete::Joints &joints = specimen.state.joints;
  EventDriver(body, {}).run_to(0.);
  // Modulus by the elastic tangent.
  const double before = body.conjugate_force();
  body.move(1e-6 * body.tangent());
  body.residual();
  const double modulus = specimen.stress(body.conjugate_force() - before) / 1e-6;
  body.move(-1e-6 * body.tangent());

  discrete::scale_density(grains, discrete::stiffness_sums(grains, joints, false), {},
                          1.);
  double mass = 0.;
  for (const double inverse : grains.inverse_mass)
    mass += 1. / inverse;
  const double speed = std::sqrt(modulus * specimen.width * specimen.height / mass);
  const double dt = 0.8 * discrete::stable_step(grains, joints) /
                    std::sqrt(1. + damping.coefficient);
  const double rate = strain / (transits * specimen.height / speed);
  for (const PrescribedMotion &platen : specimen.platens)
    (platen.component == 0 ? grains.velocity_x : grains.velocity_y)[platen.grain] =
        rate * platen.rate;

  SlowLoading result;
  const double start = processor_seconds();
  const double most = stop_drop > 0. ? 10. * strain : strain;
  const auto n = static_cast<std::uint64_t>(std::ceil(most / (rate * dt)));
  for (; result.steps < n; ++result.steps)
  {
    const double time = static_cast<double>(result.steps) * dt;
    body.add_forces({result.steps, time, dt}, &specimen.state.cracks, false);
    result.stress = specimen.stress(body.conjugate_force());
    if (watch)
      watch(result.stress);
    if (result.stress > result.peak)
    {
      result.peak = result.stress;
      result.peak_strain = rate * time;
      result.peak_steps = result.steps;
      result.peak_seconds = processor_seconds() - start;
    }
    if (stop_drop > 0. && !specimen.state.cracks.empty() && // no wave of the start
        result.stress < (1. - stop_drop) * result.peak)
      break;
    discrete::damped_kick(grains, dt, damping);
    discrete::drift(grains, dt);
  }
  result.seconds = processor_seconds() - start;
  return result;
}
} // namespace antiform::coupling::test

// A scene of grains that is loaded from event to event.
#include "cases/scene_events.h"

#include "cases/predicted_course.h"
#include "cases/scene.h"
#include "cases/scene_components.h"

#include <cmath>

namespace antiform::cases
{
using namespace coupling;

namespace
{
/// Steps over the length in grains after which a motion that does not come to rest is
/// given up: 2000 transits of some four steps a grain, as of walls that step and relax.
constexpr double longest_settling = 8000.;
/// Those after which it is a collapse: 100 transits.
constexpr double patience_of_settling = 400.;

/// Load steps between two looks at a layer's stability: one costs about ten solves.
constexpr std::int64_t stability_interval = 10;

/// Of which the stiffness has those between a tenth and a half of the strain there.
constexpr int steps_to_first_break = 10;

/// Frictionless ends leave the section free to move along them: one grain at an end, near
/// the layer's axis, is kept from it. Nothing pushes it that way in balance.
std::int32_t guided_grain(const Scene &scene)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  std::int32_t nearest = 0;
  double least = HUGE_VAL;
  for (const discrete::WallContact &contact : scene.walls.front().contacts)
  {
    const Vec2 place = grains.reference(contact.grain);
    const double distance = std::abs(place.y - scene.geometry.axis(place.x));
    const auto &joints = scene.grains->state.joints.grain_begin;
    if (distance < least && joints[contact.grain] < joints[contact.grain + 1])
    {
      nearest = contact.grain;
      least = distance;
    }
  }
  return nearest;
}

/// Grips, base, or what keeps the section in its place.
std::vector<PrescribedMotion> held_motions(const Scene &scene, const double length)
{
  std::vector<PrescribedMotion> held;
  if (scene.pulls())
  {
    const auto grips = gripped_grains(scene);
    for (const int side : {0, 1})
      for (const std::int32_t grain : grips[side])
      {
        held.push_back({grain, 0, (side == 0 ? -0.5 : 0.5) * length});
        held.push_back({grain, 1, 0.});
        held.push_back({grain, 2, 0.});
      }
    return held;
  }
  const bool fixed = scene.parameters.matrix.base == "fixed";
  for (const GrainBase::Support &support : base_supports(scene))
  {
    held.push_back({support.grain, 1, 0.});
    if (fixed)
      held.push_back({support.grain, 0, 0.});
  }
  if (held.empty() && !scene.bridging) // else the mesh keeps it
    held.push_back({guided_grain(scene), 1, 0.});
  return held;
}
} // namespace

void add_event_loading(Scene &scene)
{
  const Parameters &p = scene.parameters;
  const double grips =
      scene.pulls() ? 2. * p.walls.grip_layers * scene.geometry.diameter() : 0.;
  EventLoading::Options options;
  const double tolerance = p.walls.balance_tolerance;
  DriverSettings &driver = options.driver;
  // The proportions of the driver's own defaults (docs/theory/quasi_static_driver.md).
  driver.limits = {tolerance, 100. * tolerance, 150. * tolerance};
  driver.settled_before_peak = 0.1 * tolerance;
  driver.settled_after_peak = tolerance;
  driver.largest_step = longest_load_step(p);
  driver.steps_to_first_break = steps_to_first_break;
  driver.dynamics.damping = p.damping.coefficient;
  const double grains_along = scene.geometry.length() / scene.geometry.diameter();
  driver.dynamics.most_steps = std::llround(longest_settling * grains_along);
  driver.dynamics.patience = std::llround(patience_of_settling * grains_along);
  driver.dynamics.collapsed = tolerance;
  driver.stop_drop = 0.; // the record decides
  options.target =
      p.run.end_shortening > 0. ? p.run.end_shortening : p.run.longest_shortening;
  options.pressure = p.confinement() != nullptr ? p.confinement()->pressure : 0.;
  options.height = scene.geometry.thickness();
  options.length = scene.geometry.length() - grips;
  options.reach = 0.5 * scene.geometry.diameter();
  options.modulus = scene.grains->modulus;
  options.stability_interval = p.is_specimen() ? 0 : stability_interval;
  scene.events = &scene.simulation->add(
      std::make_unique<EventLoading>(scene.grains->state, scene.walls, scene.side_walls,
                                     held_motions(scene, options.length),
                                     scene.mesh ? &*scene.mesh : nullptr,
                                     scene.bridging.get(), options),
      {Stage::forces}, 0, "event driver", reason_for(p, "event driver"));
  if (!scene.pulls())
    scene.wall_motion = &scene.events->walls();
}

void report_events(const Scene &scene, Summary &summary)
{
  if (scene.events == nullptr)
    return;
  const DriverReport &report = scene.events->report();
  const BalanceRatios &worst = scene.events->worst_ratios();
  auto &results = summary.results;
  const auto count = [&](const std::string &name, const std::int64_t n) {
    results[name] = {static_cast<double>(n), "-"};
  };
  count("load_steps", report.load_steps);
  count("solves", report.solves);
  count("force_evaluations", report.evaluations);
  count("batches", report.batches);
  count("breaks_in_batches", report.breaks);
  count("most_corrections", report.most_corrections);
  count("hand_overs", report.hand_overs);
  count("explicit_steps", report.explicit_steps);
  results["worst_mean_unbalanced"] = {worst.mean, "-"};
  results["worst_largest_unbalanced"] = {worst.largest, "-"};
  results["worst_unbalanced_over_strength"] = {worst.of_strength, "-"};
  if (const auto load = scene.events->unstable_from())
    results["unstable_from_shortening"] = {*load, "-"};
  summary.solves = report.solves;
}
} // namespace antiform::cases

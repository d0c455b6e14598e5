// Peaks of layers of grains with a mesh, driven from event to event, against slow motion.
#include "support/coupled_layer.h"
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::bridged_peaks_tests
{
namespace
{
/// Mean stress of the layer at its ends [Pa].
double layer_stress(const CoupledLayer &layer)
{
  double sum = 0.;
  for (const discrete::Wall &wall : layer.model.walls)
    sum += 0.5 * region_reaction(layer.model.state.grains, wall, 0);
  return sum / (2. * layer.shape.layer);
}

constexpr double far = 4e-3; ///< shortening, beyond all peaks
constexpr int n_samples = 200;

double peak_by_events(const CoupledShape &shape)
{
  CoupledLayer layer{shape};
  DriverSettings settings;
  settings.stop_drop = 0.;
  Driven run(layer, settings);
  double peak = 0., open = 0., open_at_peak = 0.;
  for (int k = 1; k <= n_samples; ++k)
  {
    run.driver.run_to(far * k / n_samples);
    open = std::max(open, open_share(books_of(run, layer)));
    if (layer_stress(layer) > peak)
    {
      peak = layer_stress(layer);
      open_at_peak = open;
    }
    EXPECT_LT(run.body.gap(), 1e-12 * largest_displacement(layer.model));
  }
  EXPECT_LT(open, 1e-3); // 1.1e-4 found
  const DriverReport &report = run.driver.report();
  std::printf("  seed %d: %zu grains, events: %.2f MPa; %d load steps, %d batches, %d "
              "solves, %d hand-overs; books open by %.1e, %.1e\n",
              static_cast<int>(shape.seed), layer.n_grains(), 1e-6 * peak,
              static_cast<int>(report.load_steps), static_cast<int>(report.batches),
              static_cast<int>(report.solves), static_cast<int>(report.hand_overs),
              open_at_peak, open);
  return peak;
}

/// By the program's loop, @p n_steps for the whole shortening.
double peak_in_time(const CoupledShape &shape, const std::int64_t n_steps)
{
  CoupledLayer layer{shape};
  Bridged &model = layer.model;
  scale_for_motion(model);
  const double dt = 0.8 * model.stable_step() / std::sqrt(1.7);
  const double speed =
      0.5 * far * layer.shape.length / (static_cast<double>(n_steps) * dt);
  Loop::Options options;
  options.damping = 0.7;
  options.combined = true;
  options.wall_speed = [=](double) { return speed; };
  Loop loop(model, dt, options);
  loop.add(std::make_unique<BrokenJoints>(model.state), {Stage::forces}, 10, "friction");
  double peak = 0.;
  for (std::int64_t step = 0; step < n_steps; ++step)
  {
    loop.advance(1);
    peak = std::max(peak, layer_stress(layer));
  }
  std::printf("  %d steps: %.2f MPa\n", static_cast<int>(n_steps), 1e-6 * peak);
  return peak;
}
} // namespace

// A peak is chaotic, as of grains alone: by their scatter one of 545 grains could be 12 %
// off. These packings are within 2 %, so that what is asked for, 8 % of each, is demanded;
// of the mean 2.5 %, twice the standard error of six that scatter by 3 %. 200 000 steps are
// some 2000 transits of a wave along the section.
TEST(BridgedPeaks, AreThoseOfSlowMotionInTheMeanLong)
{
  double ratio = 0.;
  constexpr int n = 6;
  for (int seed = 1; seed <= n; ++seed)
  {
    CoupledShape shape;
    shape.seed = static_cast<std::uint64_t>(seed);
    const double one = peak_by_events(shape) / peak_in_time(shape, 200000);
    EXPECT_NEAR(one, 1., 0.08) << "seed " << seed;
    ratio += one / n;
  }
  std::printf("  mean ratio %.4f\n", ratio);
  EXPECT_NEAR(ratio, 1., 0.025);
}
} // namespace antiform::coupling::test::bridged_peaks_tests

// Layers bent beforehand, loaded from event to event and slowly in time: peak, fold and
// where they fail.
#include "support/bent_layer.h"
#include "support/crack_zone.h"
#include "support/slow_loading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

namespace antiform::coupling::test::event_driver_layers_tests
{
namespace
{
constexpr double stop_drop = 0.3; ///< below the peak: well into the collapse

/// Through the peak, down by that share of it.
struct Folding
{
  std::vector<std::pair<double, double>> path; ///< stress [Pa], amplitude [m]
  double peak = 0.;                            ///< stress [Pa]
  double shortening = 0.;                      ///< there [-]
  double open = 0.;         ///< of the books at the peak, over their sum [-]
  double open_at_end = 0.;  ///< and after the collapse
  std::vector<double> zone; ///< density of the cracks at the end

  /// Amplitude when @p stress is first reached [m].
  double amplitude_at(const double stress) const
  {
    std::size_t k = 1;
    while (path.at(k).first < stress)
      ++k;
    const auto &[s0, a0] = path[k - 1];
    const auto &[s1, a1] = path[k];
    return a0 + (stress - s0) / (s1 - s0) * (a1 - a0);
  }
};

std::vector<double> zone_of(const BentLayer &layer)
{
  const double x = 0.5 * layer.height, y = 0.5 * (layer.width + BentLayer::initial_rise);
  return crack_density(layer.state.cracks, {-x, -y}, {x, y});
}

double open_share(const Energies &e)
{
  return std::abs(e.stored_and_spent() / e.boundary_work - 1.);
}

Folding fold_by_events(const int seed)
{
  BentLayer layer(static_cast<std::uint64_t>(seed));
  GrainBalance body(layer.state, layer.platens);
  DriverSettings settings;
  settings.largest_step = 1e-5; // a hundredth of the way to the peak
  settings.stop_drop = stop_drop;
  EventDriver driver(body, settings);
  Folding result;
  while (true)
  {
    const LoadRecord &record = driver.find_balance();
    const double stress = layer.stress(record.force);
    result.path.emplace_back(stress, layer.amplitude());
    if (stress > result.peak)
    {
      result.peak = stress;
      result.shortening = record.load;
      result.open = open_share(record.energies);
    }
    result.open_at_end = open_share(record.energies);
    if (stress < (1. - stop_drop) * result.peak)
      break;
    driver.step_towards(0.05);
  }
  result.zone = zone_of(layer);
  return result;
}

/// @p transits up to @p shortening.
Folding fold_in_time(const int seed, const double transits, const double shortening)
{
  BentLayer layer(static_cast<std::uint64_t>(seed));
  Folding result;
  int step = 0;
  const auto watch = [&](const double stress)
  {
    if (step++ % 50 == 0)
      result.path.emplace_back(stress, layer.amplitude());
  };
  const SlowLoading slow =
      slow_loading(layer, transits, shortening, stop_drop, {}, watch, local_damping());
  result.peak = slow.peak;
  result.shortening = slow.peak_strain;
  result.zone = zone_of(layer);
  return result;
}

/// Growth of the fold at 80 % of the lower peak, one over the other: before the collapse,
/// at one stress.
double growth_ratio(const Folding &one, const Folding &other)
{
  const double stress = 0.8 * std::min(one.peak, other.peak);
  return (one.amplitude_at(stress) - BentLayer::initial_rise) /
         (other.amplitude_at(stress) - BentLayer::initial_rise);
}

/// Packings, driven and slowly loaded: 60 periods of their slowest sway to the peak.
constexpr int n_packings = 10;

/// Means of the driver over slow loading.
struct Comparison
{
  double peak = 0., growth = 0., zone = 0., other_zone = 0.;
};

Comparison compare()
{
  Comparison mean;
  std::vector<std::vector<double>> with_zones, slow_zones;
  for (int seed = 1; seed <= n_packings; ++seed)
  {
    const Folding with = fold_by_events(seed),
                  slow = fold_in_time(seed, very_slow, with.shortening);
    const double peak = with.peak / slow.peak, growth = growth_ratio(with, slow),
                 zone = correlation(with.zone, slow.zone);
    std::printf("seed %2d: %.2f and %.2f MPa, %.3f; growth %.3f; zones %.2f; books open "
                "by %.1e, %.1e\n",
                seed, 1e-6 * with.peak, 1e-6 * slow.peak, peak, growth, zone, with.open,
                with.open_at_end);
    std::fflush(stdout);
    EXPECT_NEAR(peak, 1., 0.1) << "seed " << seed;
    EXPECT_NEAR(growth, 1., 0.06) << "seed " << seed;
    EXPECT_LT(with.open, 1e-3) << "seed " << seed;
    mean.peak += peak / n_packings;
    mean.growth += growth / n_packings;
    mean.zone += zone / n_packings;
    with_zones.push_back(with.zone);
    slow_zones.push_back(slow.zone);
  }
  for (int k = 0; k < n_packings; ++k) // each with the slow layer of the next packing
    mean.other_zone +=
        correlation(with_zones[k], slow_zones[(k + 1) % n_packings]) / n_packings;
  return mean;
}
} // namespace

// Slow loading with local damping, since under the combined form cracks run on that all
// other ways arrest (docs/theory/quasi_static_driver.md, 5), and slow enough that it does
// not rub. All layers have their hinges at the crest and at the ends, so that other
// packings are not as foreign as with specimens.
TEST(EventDriverLayers, FoldAndFailAsSlowlyLoadedOnesDoLong)
{
  const Comparison mean = compare();
  std::printf("means: peak %.4f; growth %.4f; zones %.3f, of other packings %.3f\n",
              mean.peak, mean.growth, mean.zone, mean.other_zone);
  EXPECT_NEAR(mean.peak, 1., 0.025);
  EXPECT_NEAR(mean.growth, 1., 0.03);
  EXPECT_GT(mean.zone, 0.7);
  EXPECT_LT(mean.other_zone, mean.zone - 0.25);
}

// Half the rate: the reference is slow enough.
TEST(EventDriverLayers, HaveAReferenceThatIsSlowEnoughLong)
{
  const double shortening = fold_by_events(1).shortening;
  const Folding one = fold_in_time(1, very_slow, shortening),
                slower = fold_in_time(1, 2. * very_slow, shortening);
  std::printf("%.2f and %.2f MPa, growth %.4f, zones %.3f\n", 1e-6 * one.peak,
              1e-6 * slower.peak, growth_ratio(one, slower),
              correlation(one.zone, slower.zone));
  EXPECT_NEAR(one.peak / slower.peak, 1., 0.01);
  EXPECT_NEAR(growth_ratio(one, slower), 1., 0.01);
  EXPECT_GT(correlation(one.zone, slower.zone), 0.9);
}
} // namespace antiform::coupling::test::event_driver_layers_tests

// Loading from event to event beside explicit loading at 300 wave transits to the same
// peak: seconds of one core, to the peak and through a stress drop of 10 %. Specimens of
// about 1000, 4000 and 15000 grains, one after the other in one run, each with both.
// Arguments: first and last seed (1 1), least and largest number of grains (0 20000),
// then settings of the driver as name=value, to see what they are worth, or
// transits=value, drop=share, side_load=value [N/m on a mean diameter], layers=1 for bent
// layers of some 1000 grains in place of specimens.
#include "support/bent_layer.h"
#include "support/slow_loading.h"
#include "support/specimen_fixture.h"

#include "discrete/joints.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

using namespace antiform::coupling;
using namespace antiform::coupling::test;

namespace
{
/// A run of the driver, as it was at its largest force and at its end.
struct Ascent
{
  LoadRecord peak;
  DriverReport at_peak, report;
  double peak_seconds = 0., seconds = 0.;
};

/// Set what "name=value" says; false where there is no such setting.
bool set(DriverSettings &settings, const std::string &text)
{
  const std::string name = text.substr(0, text.find('='));
  const double value = std::atof(text.substr(text.find('=') + 1).c_str());
  const std::map<std::string, double *> reals{
      {"mean", &settings.limits.mean},
      {"largest", &settings.limits.largest},
      {"of_strength", &settings.limits.of_strength},
      {"largest_step", &settings.largest_step},
      {"exclusion", &settings.exclusion},
      {"radius", &settings.local.radius},
      {"core", &settings.local.core},
      {"share", &settings.local.share},
      {"part_length", &settings.part_length},
      {"most_parts", &settings.most_parts},
      {"correction_cap", &settings.correction_cap},
      {"slack", &settings.slack},
      {"most_breaks", &settings.most_breaks},
      {"before_peak", &settings.settled_before_peak},
      {"after_peak", &settings.settled_after_peak},
      {"damping", &settings.dynamics.damping},
      {"drop", &settings.stop_drop}};
  const std::map<std::string, int *> numbers{
      {"events", &settings.events_per_step},
      {"most_corrections", &settings.most_corrections},
      {"accelerate_after", &settings.accelerate_after},
      {"local_corrections", &settings.local.most_corrections},
      {"local_breaks", &settings.local.most_breaks}};
  if (const auto real = reals.find(name); real != reals.end())
    *real->second = value;
  else if (const auto number = numbers.find(name); number != numbers.end())
    *number->second = static_cast<int>(value);
  else
    return false;
  return true;
}

Ascent climb(Specimen &specimen,
             const DriverSettings &settings,
             const std::vector<GrainLoad> &loads)
{
  Ascent ascent;
  const double start = processor_seconds();
  GrainBalance body(specimen.state, specimen.platens, loads);
  EventDriver driver(body, settings);
  while (true)
  {
    const LoadRecord &record = driver.find_balance();
    ascent.seconds = processor_seconds() - start;
    if (record.force > ascent.peak.force)
    {
      ascent.peak = record;
      ascent.at_peak = driver.report();
      ascent.peak_seconds = ascent.seconds;
    }
    if (record.force < (1. - settings.stop_drop) * driver.largest_force())
      break;
    driver.step_towards(0.1);
  }
  ascent.report = driver.report();
  return ascent;
}

void print(const char *what, const DriverReport &report, const double seconds)
{
  std::printf(
      "  driver to the %-9s %4ld load steps %6ld batches %6ld breaks %6ld patches "
      "%6ld local solves %6ld solves %6ld evaluations %2ld hand-overs %7ld steps "
      "%7.2f s\n",
      what, report.load_steps, report.batches, report.breaks, report.local_moves,
      report.local_corrections, report.solves, report.evaluations, report.hand_overs,
      report.explicit_steps, seconds);
}

/// Milliseconds of the processor that a correction takes, and an evaluation of the forces.
void print_unit_costs(Specimen &specimen)
{
  GrainBalance body(specimen.state, specimen.platens);
  constexpr int n = 50;
  Eigen::VectorXd r = body.correction(body.residual()); // chooses its precision
  const double start = processor_seconds();
  for (int k = 0; k < n; ++k)
    r = body.correction(body.tangent());
  const double solved = processor_seconds();
  for (int k = 0; k < n; ++k)
    body.residual();
  std::printf("  a correction %.3f ms, an evaluation %.3f ms (damaged body)\n",
              1e3 * (solved - start) / n, 1e3 * (processor_seconds() - solved) / n);
}

void compare(Specimen &one,
             Specimen &other,
             const std::uint64_t seed,
             const DriverSettings &settings,
             const double transits,
             const double side_load)
{
  const Ascent driver = climb(one, settings, side_loads(one, side_load));
  const SlowLoading slow = slow_loading(other, transits, driver.peak.load,
                                        settings.stop_drop, side_loads(other, side_load));
  std::printf("%zu grains, %zu joints, seed %lu\n", one.n_grains(),
              one.state.joints.size(), seed);
  print_unit_costs(one);
  print("peak:", driver.at_peak, driver.peak_seconds);
  print("drop:", driver.report, driver.seconds);
  std::printf(
      "  explicit to the peak %8lu steps %7.2f s, to the drop %8lu steps %7.2f s\n",
      slow.peak_steps, slow.peak_seconds, slow.steps, slow.seconds);
  std::printf("  peaks %.2f MPa at %.4g, explicit %.2f MPa at %.4g, ratio %.3f\n",
              1e-6 * one.stress(driver.peak.force), driver.peak.load, 1e-6 * slow.peak,
              slow.peak_strain, one.stress(driver.peak.force) / slow.peak);
  std::printf("  seconds over those of explicit loading: peak %.3f, drop %.3f\n",
              driver.peak_seconds / slow.peak_seconds, driver.seconds / slow.seconds);
  std::fflush(stdout);
}
} // namespace

int main(const int argc, char **argv)
{
  const int first = argc > 1 ? std::atoi(argv[1]) : 1,
            last = argc > 2 ? std::atoi(argv[2]) : first,
            least = argc > 3 ? std::atoi(argv[3]) : 0,
            most = argc > 4 ? std::atoi(argv[4]) : 20000;
  DriverSettings settings;
  double transits = 300., side_load = 0., layers = 0.;
  for (int k = 5; k < argc; ++k)
    if (std::sscanf(argv[k], "transits=%lf", &transits) != 1 &&
        std::sscanf(argv[k], "side_load=%lf", &side_load) != 1 &&
        std::sscanf(argv[k], "layers=%lf", &layers) != 1 && !set(settings, argv[k]))
    {
      std::fprintf(stderr, "no setting '%s'\n", argv[k]);
      return 1;
    }
  std::printf("kernel %s\n", antiform::discrete::joint_kernel_level().c_str());
  for (int number = first; number <= last; ++number)
  {
    const auto seed = static_cast<std::uint64_t>(number);
    if (layers > 0.)
    {
      settings.largest_step = 1e-5; // a hundredth of the way to the peak
      BentLayer one(seed), other(seed);
      compare(one, other, seed, settings, transits, 0.);
      continue;
    }
    for (const double width : {22., 44.5, 84.6})
      if (const double n = 2.1 * width * width; n > least && n < most)
      {
        Specimen one(width, seed), other(width, seed);
        compare(one, other, seed, settings, transits, side_load);
      }
  }
  return 0;
}

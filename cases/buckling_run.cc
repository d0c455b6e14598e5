#include "cases/buckling_run.h"

#include "cases/buckling_grains.h"
#include "cases/buckling_section.h"
#include "cases/interrupt.h"
#include "cases/mechanism.h"
#include "cases/solid_run.h"
#include "coupling/output/tables.h"
#include "coupling/output/vtu.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

namespace antiform::cases
{
namespace
{
/// Wavelength of the least load in a section without end: minimum of a m^2 + b + c / m (a
/// beam on a matrix) through the lowest mode and its two neighbours in number of half
/// waves; the lowest mode's own where these are not among the modes [m].
double dominant_wavelength(const std::vector<Mode> &modes, const double length)
{
  const Mode &lowest = modes.front();
  const double n = lowest.half_waves;
  const Mode *below = nullptr, *above = nullptr;
  for (const Mode &mode : modes)
  {
    if (mode.half_waves + 1 == lowest.half_waves && below == nullptr)
      below = &mode;
    if (mode.half_waves == lowest.half_waves + 1 && above == nullptr)
      above = &mode;
  }
  if (n == 0.)
    return 0.;
  if (n < 2. || below == nullptr || above == nullptr)
    return 2. * length / n;
  // Slopes between the three: a (m1 + m2) - c / (m1 m2).
  const double left = lowest.stress - below->stress,
               right = above->stress - lowest.stress;
  const double a = (right * (n + 1.) - left * (n - 1.)) /
                   ((2. * n + 1.) * (n + 1.) - (2. * n - 1.) * (n - 1.));
  const double c = (a * (2. * n - 1.) - left) * n * (n - 1.);
  return 2. * length / std::cbrt(c / (2. * a));
}

/// What a reader should know before he believes the figures.
std::vector<std::string> doubts(const StraightSection &section, const double last_change)
{
  const std::vector<Mode> &modes = section.modes();
  const int wanted = section.parameters().run.modes;
  std::vector<std::string> texts = section.doubts();
  char text[240];
  const Mode &lowest = modes.front();
  const bool refined = section.parameters().matrix.refinement_rounds > 0;
  // The accuracy that closed forms are met with. What is left is 0.1 to 2.2 times the change
  // (cases/burial-depth/accuracy.py).
  if (refined && std::abs(last_change) > 0.02)
  {
    std::snprintf(text, sizeof text,
                  "the last round of refinement changed the load by %.2g %%: give more "
                  "'Matrix/Refinement rounds', or smaller cells to begin with",
                  100. * last_change);
    texts.push_back(text);
  }
  if (lowest.half_waves < 3 && section.parameters().has("matrix"))
    texts.push_back("the section holds " + std::to_string(lowest.half_waves) +
                    " half waves only: its length decides how long they are. Give "
                    "'Layer/Length ratio' more");
  if (lowest.shortening > 0.02)
  {
    std::snprintf(text, sizeof text,
                  "buckling at a shortening of %.2g: the linear theory, of small strain "
                  "before it, is off by as much and more",
                  lowest.shortening);
    texts.push_back(text);
  }
  if (static_cast<int>(modes.size()) < wanted)
    texts.push_back(std::to_string(modes.size()) + " of " + std::to_string(wanted) +
                    " modes found");
  return texts;
}

/// The closed form for the same scene, if it has one.
std::optional<continuum::theory::CriticalState> theory_of(const Parameters &p)
{
  if (!(p.has("matrix") || p.has("foundation")) || p.has("beds"))
    return std::nullopt;
  return supported_layer(p).critical();
}

std::string percent(const double ratio)
{
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f %%", 100. * (ratio - 1.));
  return text;
}

/// Shapes as field files, and the table of loads.
void write_modes(const StraightSection &section, const std::string &directory)
{
  const std::vector<coupling::PvdEntry> fields = section.write_fields(directory);
  if (dealii::Utilities::MPI::this_mpi_process(section.communicator()) != 0)
    return;
  coupling::write_pvd(directory + "/fields.pvd", fields);
  coupling::Table table(
      directory + "/modes.csv",
      {"mode", "shortening", "layer_stress_Pa", "half_waves", "wavelength_m"});
  double number = 0.;
  for (const Mode &mode : section.modes())
  {
    const double n = mode.half_waves;
    table.append(
        std::vector<double>{++number, mode.shortening, mode.stress, n,
                            n > 0. ? 2. * section.geometry().length() / n : 0.});
  }
}

void log_modes(const std::vector<Mode> &modes, RunLog &log)
{
  for (std::size_t k = 0; k < modes.size(); ++k)
  {
    char row[128];
    std::snprintf(row, sizeof row,
                  "  mode %2zu: shortening %.5e, layer stress %.5e Pa, %u half waves",
                  k + 1, modes[k].shortening, modes[k].stress, modes[k].half_waves);
    log.line(row);
  }
}

/// Of grains: the closed form of a thick layer as stiff as they turn out to be, in as
/// many half waves. In words.
std::string compare_as_packed(const StraightSection &section,
                              std::map<std::string, Result> &results)
{
  const Parameters &p = section.parameters();
  const Mode &lowest = section.modes().front();
  const double modulus = section.plane_modulus();
  results["layer_plane_modulus"] = {modulus, "Pa"};
  if (!theory_of(p) || lowest.half_waves == 0)
    return "";
  continuum::theory::SupportedLayer packed = supported_layer(p);
  packed.layer.young_modulus *= modulus / packed.layer.plane_modulus();
  packed.thick = true;
  const double stress =
      packed.buckling_force(M_PI * lowest.half_waves / section.geometry().length()) /
      packed.layer.thickness;
  results["theory_stress_as_packed"] = {stress, "Pa"};
  return "; as stiff as the grains are (E' " + percent(modulus / p.plane_modulus()) +
         "), thick, in as many half waves: stress " + percent(lowest.stress / stress);
}

/// The summary's results, and in words what they are against the closed form.
std::string compare(const StraightSection &section,
                    std::map<std::string, Result> &results)
{
  const std::vector<Mode> &modes = section.modes();
  const Mode &lowest = modes.front();
  const double wavelength = dominant_wavelength(modes, section.geometry().length());
  results["critical_stress"] = {lowest.stress, "Pa"};
  results["critical_shortening"] = {lowest.shortening, "-"};
  results["half_waves"] = {static_cast<double>(lowest.half_waves), "-"};
  results["dominant_wavelength"] = {wavelength, "m"};
  char text[128];
  std::snprintf(text, sizeof text, "the layer buckles at %.4g Pa, wavelength %.4g m",
                lowest.stress, wavelength);
  const bool grains = section.parameters().layer.representation == "grains";
  const std::string packed = grains ? compare_as_packed(section, results) : "";
  const auto theory = theory_of(section.parameters());
  if (!theory)
    return text;
  results["theory_stress"] = {theory->stress, "Pa"};
  results["theory_wavelength"] = {theory->wavelength, "m"};
  return std::string(text) + " (closed form of a long layer: stress " +
         percent(lowest.stress / theory->stress) + ", wavelength " +
         percent(wavelength / theory->wavelength) + packed + ")";
}

/// Rounds of refinement, and what each was worth.
class RefinementRecord
{
public:
  RefinementRecord(const std::string &directory, const StraightSection &section)
      : section_(section)
  {
    if (section.parameters().matrix.refinement_rounds > 0 &&
        dealii::Utilities::MPI::this_mpi_process(section.communicator()) == 0)
      table_.emplace(directory + "/refinement.csv",
                     std::vector<std::string>{"round", "dofs", "critical_stress_Pa",
                                              "change", "error_indicator"});
  }

  void add(const int round, RunLog &log)
  {
    const double stress = section_.modes().front().stress,
                 change = stress_ > 0. ? stress / stress_ - 1. : 0.,
                 dofs = static_cast<double>(section_.sizes().at("dofs")),
                 estimate = section_.estimate();
    if (table_)
      table_->append(std::vector<double>{static_cast<double>(round), dofs, stress, change,
                                         estimate});
    stress_ = stress;
    char text[160];
    std::snprintf(text, sizeof text,
                  "  round %d: %.0f dofs, %.6e Pa, changed by %+.1e, indicator %.1e",
                  round, dofs, stress, change, estimate);
    log.line(text);
    last_change = change;
    last_estimate = estimate;
  }

  double last_change = 0., last_estimate = 0.;

private:
  const StraightSection &section_;
  std::optional<coupling::Table> table_;
  double stress_ = 0.;
};

/// Solve, and refine as often as the deck says; the number of solves. Throws
/// BucklingStopped.
int solve_in_rounds(StraightSection &section,
                    const std::function<bool()> &stop,
                    const std::string &directory,
                    RunLog &log,
                    std::map<std::string, Result> &results)
{
  const int n_rounds = section.parameters().matrix.refinement_rounds;
  section.solve(stop);
  if (n_rounds == 0)
    return 2; // the straight section, and one factor for all modes
  RefinementRecord record(directory, section);
  record.add(0, log);
  int round = 0;
  while (round < n_rounds && section.refine())
  {
    section.solve(stop);
    record.add(++round, log);
  }
  results["change_in_last_round"] = {record.last_change, "-"};
  results["error_indicator"] = {record.last_estimate, "-"};
  return 2 * (round + 1);
}
/// Built of what the deck says.
std::unique_ptr<StraightSection>
make_section(const Parameters &p, RunLog &log, const MPI_Comm communicator)
{
  if (p.layer.representation == "grains")
    return std::make_unique<BucklingGrains>(
        p, communicator, [&](const std::string &what) { log.line("  " + what); });
  log.line("  building the mesh");
  return std::make_unique<BucklingSection>(p, communicator);
}

std::string size_in_words(const StraightSection &section)
{
  const auto sizes = section.sizes();
  std::string text;
  for (const char *const what : {"grains", "dofs", "multipliers"})
    if (sizes.at(what) > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(sizes.at(what)) + " " + what;
  return text;
}
} // namespace

int run_buckling(const Parameters &p,
                 const RunOptions &options,
                 RunLog &log,
                 const MPI_Comm communicator)
{
  const auto begin = std::chrono::steady_clock::now();
  catch_interrupts();
  const std::unique_ptr<StraightSection> section = make_section(p, log, communicator);
  log.line("  " + size_in_words(*section) + ": straight section, then modes");
  std::string status = "completed", words;
  std::map<std::string, Result> results;
  int n_solves = 0;
  try
  {
    n_solves = solve_in_rounds(
        *section, [&] { return must_stop(begin, options.time_limit, communicator); },
        options.output, log, results);
  }
  catch (const continuum::BucklingStopped &)
  {
    status = "interrupted";
    words = "a buckling run keeps no checkpoint, run it again";
  }

  if (status == "completed")
  {
    write_modes(*section, options.output);
    words = compare(*section, results);
    log_modes(section->modes(), log);
  }
  Summary summary = summary_of_run(p, communicator, section->sizes(), begin);
  summary.status = status;
  summary.solves = n_solves;
  summary.results = results;
  if (status == "completed")
    summary.warnings = doubts(*section, results.count("change_in_last_round") > 0
                                            ? results.at("change_in_last_round").value
                                            : 0.);
  summarise_effects(p, summary.solves, summary);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    write_summary(options.output + "/summary.json", summary);
  for (const std::string &warning : summary.warnings)
    log.line("warning: " + warning);
  log.line(status + ": " + words);
  return status == "completed" ? 0 : 3;
}
} // namespace antiform::cases

#include "cases/rate_estimate.h"

#include "cases/predicted_course.h"
#include "cases/run_deck.h"
#include "cases/summary.h"
#include "coupling/output/whole_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace antiform::cases
{
namespace fs = std::filesystem;

std::string Halving::words() const
{
  return is_of_tolerance ? "half the load step and tolerance" : "half the rate";
}

std::string Halving::directory() const
{
  return is_of_tolerance ? "half-tolerance" : "half-rate";
}

void RateEstimate::fill(Summary &summary) const
{
  const bool of_tolerance = halving.is_of_tolerance;
  summary.results[of_tolerance ? "peak_stress_at_half_tolerance"
                               : "peak_stress_at_half_rate"] = {peak_at_half, "Pa"};
  summary.results[of_tolerance ? "tolerance_error" : "loading_rate_error"] = {change(),
                                                                              "-"};
}

Parameters at_half_rate(const Parameters &parameters)
{
  Parameters half = parameters;
  half.title += ", at " + Halving(parameters).words();
  half.run.estimate_rate_error = false;
  if (Halving(parameters).is_of_tolerance)
  {
    half.walls.load_step = half_load_step(parameters);
    half.walls.balance_tolerance *= 0.5;
  }
  else
  {
    half.walls.transits_per_millistrain *= 2.;
    half.output.samples_per_millistrain *= 2;
    half.walls.load_step *= 0.5;
    half.walls.relaxation_tolerance *= 0.5;
  }
  half.run.stress_ratio_of_peak = std::max(0.9, half.run.stress_ratio_of_peak);
  return half;
}

std::string StatesBeforePeak::file(const std::int64_t number) const
{
  return directory_ + "/before-peak-" + std::to_string(number) + ".h5";
}

void StatesBeforePeak::kept(const double stress)
{
  ++number_;
  stress_[0] = stress_[1];
  stress_[1] = stress;
  std::error_code error; // one that stays costs only its room
  fs::remove(file(number_ - 2), error);
}

double StatesBeforePeak::stress_before(const double peak) const
{
  return latest_is_before(peak) ? stress_[1] : stress_[0];
}

std::string StatesBeforePeak::file_before(const double peak) const
{
  return file(latest_is_before(peak) ? number_ : number_ - 1);
}

void StatesBeforePeak::remove_files() const
{
  std::error_code error;
  fs::remove(file(number_), error);
  fs::remove(file(number_ - 1), error);
}

void StatesBeforePeak::visit_state(coupling::StateArchive &archive)
{
  archive.value("before_peak/number", number_);
  archive.value("before_peak/stress_before", stress_[0]);
  archive.value("before_peak/stress", stress_[1]);
}

void begin_from(const std::string &state,
                const std::string &former,
                const Parameters &deck,
                const std::string &directory)
{
  std::ifstream image(state, std::ios::binary);
  if (!image)
    throw std::runtime_error("'" + state +
                             "', the state before the peak, cannot be read: run again "
                             "without 'Run/Estimate loading-rate error', or from the "
                             "beginning");
  const std::string bytes{std::istreambuf_iterator<char>(image), {}};
  fs::create_directories(directory + "/fields");
  RunDeck(deck).write(directory);
  for (const auto &entry : fs::directory_iterator(former))
    if (entry.path().extension() == ".csv" && entry.path().filename() != "fractures.csv")
      fs::copy_file(entry.path(), fs::path(directory) / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
  for (const auto &entry : fs::directory_iterator(former + "/fields"))
    fs::copy_file(entry.path(), fs::path(directory) / "fields" / entry.path().filename(),
                  fs::copy_options::overwrite_existing);
  coupling::replace_file(directory + "/state.h5", bytes);
}
} // namespace antiform::cases

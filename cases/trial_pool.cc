#include "cases/trial_pool.h"

#include "cases/declarations.h"
#include "cases/interrupt.h"
#include "coupling/output/whole_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;

std::string exact_columns(const MicroParameters &micro)
{
  std::string text;
  for (const MicroName &name : micro_names())
    text += "," + exact_text(micro.*name.value);
  return text;
}

std::string measured_text(const Trial &trial, const Measurement &m)
{
  char text[96];
  if (trial.test.kind == Test::Kind::elastic)
    std::snprintf(text, sizeof text, "E %.4g GPa", 1e-9 * m.young_modulus);
  else
    std::snprintf(text, sizeof text, "%.4g MPa, E %.4g GPa", 1e-6 * m.strength,
                  1e-9 * m.young_modulus);
  return text;
}
} // namespace

TrialPool::TrialPool(std::string directory,
                     Parameters calibration,
                     const int jobs,
                     std::function<void(const std::string &)> says)
    : directory_(std::move(directory))
    , calibration_(std::move(calibration))
    , jobs_(jobs)
    , says_(std::move(says))
{
  fs::create_directories(directory_ + "/trials");
  // Anew each time: a calibration that goes on asks for the same trials in the same
  // order.
  std::string header = "trial,test,confinement_Pa,seed";
  for (const MicroName &name : micro_names())
    header += "," + name.column;
  std::ofstream(directory_ + "/trials.csv")
      << header << ",young_modulus_Pa,strength_Pa,status,cpu_seconds\n";
}

void TrialPool::record(const Trial &trial,
                       const std::string &name,
                       const std::string &status,
                       const Measurement &m,
                       const double cpu_seconds)
{
  if (!recorded_.insert(name).second)
    return;
  std::ofstream(directory_ + "/trials.csv", std::ios::app)
      << name << ',' << trial.test.name() << ',' << exact_text(trial.test.confinement)
      << ',' << trial.seed << exact_columns(trial.micro) << ','
      << exact_text(m.young_modulus) << ',' << exact_text(m.strength) << ',' << status
      << ',' << exact_text(cpu_seconds) << '\n';
  cpu_seconds_ += cpu_seconds;
}

/// False when the trial has to be run (on).
bool TrialPool::read(const Trial &trial,
                     const std::string &name,
                     Measurement &measurement)
{
  double cpu_seconds = 0.;
  try
  {
    if (!read_measurement(trial, calibration_.run.longest_shortening, folder(name),
                          measurement, cpu_seconds))
      return false;
  }
  catch (const std::runtime_error &error)
  {
    record(trial, name, "failed", {}, cpu_seconds);
    throw TrialFailed("trial '" + folder(name) + "': " + error.what() +
                      ". Look at its log.txt and history.csv; other bounds of the free "
                      "parameters, or slower walls, may help.");
  }
  record(trial, name, "completed", measurement, cpu_seconds);
  return true;
}

void TrialPool::start(const Job &job, const Parameters &deck)
{
  const std::string out = folder(job.name);
  coupling::replace_file(out + ".prm", effective_deck(deck));
  try
  {
    children_.start(job.trial, out + ".prm", out, 1);
  }
  catch (const std::runtime_error &error)
  {
    throw InputError({"trial " + std::string(error.what()) +
                      ". Free memory or disk, or lower 'Calibration/Jobs'."});
  }
}

std::vector<Measurement> TrialPool::operator()(const std::vector<Trial> &trials)
{
  std::vector<Measurement> measurements(trials.size());
  std::vector<Job> waiting;
  std::map<std::string, std::size_t> first;
  std::vector<std::size_t> same_as(trials.size());
  for (std::size_t k = 0; k < trials.size(); ++k)
  {
    const Job job{k, trial_name(trials[k], deck_of(trials[k], calibration_))};
    same_as[k] = first.emplace(job.name, k).first->second;
    if (same_as[k] != k)
      continue;
    if (read(trials[k], job.name, measurements[k]))
      ++n_found_;
    else
      waiting.push_back(job);
  }
  // Last first: the dearest tests, those under confinement, stand at the end, and no core
  // should wait for one of them.
  std::size_t done = 0;
  const std::size_t all = waiting.size();
  try
  {
    while (!waiting.empty() || children_.size() > 0)
    {
      if (interrupt_signal() != 0)
        throw Interrupted();
      while (!waiting.empty() && children_.size() < static_cast<std::size_t>(jobs_))
      {
        start(waiting.back(), deck_of(trials[waiting.back().trial], calibration_));
        waiting.pop_back();
      }
      const auto ended = children_.poll();
      if (!ended)
        continue;
      const Trial &trial = trials[ended->key];
      if (ended->status == 3)
        throw Interrupted(); // someone has signalled the trial itself
      const Job job{ended->key, trial_name(trial, deck_of(trial, calibration_))};
      if (!read(trial, job.name, measurements[job.trial]))
      {
        record(trial, job.name, "failed", {}, 0.);
        throw TrialFailed(
            "trial '" + folder(job.name) +
            "' has ended without a result: " + last_line_of(folder(job.name) + ".out"));
      }
      ++n_run_;
      says_(trial.test.name() + ", seed " + std::to_string(trial.seed) + ": " +
            measured_text(trial, measurements[job.trial]) + " (" +
            std::to_string(++done) + " of " + std::to_string(all) + ")");
    }
  }
  catch (...)
  {
    children_.stop();
    throw;
  }
  for (std::size_t k = 0; k < trials.size(); ++k)
    measurements[k] = measurements[same_as[k]];
  return measurements;
}
} // namespace antiform::cases

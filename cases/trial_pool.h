#pragma once

#include "cases/child_runs.h"
#include "cases/trial.h"

#include <cstddef>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace antiform::cases
{
/// A signal has stopped the trials; each has left a checkpoint.
struct Interrupted
{
};

/// A trial has no result; the text says which and why.
struct TrialFailed : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Runs trials as processes of this program, a thread each, several at once, each in a
/// folder of its own: `trials/NAME`. A trial that has been there before is read, not run
/// again; one that was stopped goes on.
class TrialPool
{
public:
  /// \param says hears of each trial that ends, in words
  TrialPool(std::string directory,
            Parameters calibration,
            int jobs,
            std::function<void(const std::string &)> says);

  /// Throws Interrupted or TrialFailed; no trial is running then.
  std::vector<Measurement> operator()(const std::vector<Trial> &trials);

  int n_run() const { return n_run_; }                ///< trials that had to be run
  int n_found() const { return n_found_; }            ///< that had been there
  double cpu_seconds() const { return cpu_seconds_; } ///< of all that were asked for

private:
  struct Job
  {
    std::size_t trial = 0; ///< of those asked for
    std::string name;
  };
  std::string folder(const std::string &name) const
  {
    return directory_ + "/trials/" + name;
  }
  bool read(const Trial &trial, const std::string &name, Measurement &measurement);
  void start(const Job &job, const Parameters &deck);
  void record(const Trial &trial,
              const std::string &name,
              const std::string &status,
              const Measurement &measurement,
              double cpu_seconds);

  std::string directory_;
  Parameters calibration_;
  int jobs_;
  std::function<void(const std::string &)> says_;
  std::set<std::string> recorded_; ///< lines of trials.csv
  int n_run_ = 0, n_found_ = 0;
  double cpu_seconds_ = 0.;
  ChildRuns children_;
};
} // namespace antiform::cases

#pragma once

#include "cases/accuracy.h"

#include <mpi.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace antiform::cases
{
/// A number that a run answers with, and its unit ("-" for ratios and counts).
struct Result
{
  double value = 0.;
  std::string unit;
};

/// What became of one effect: calls and seconds are zero for an absent one.
struct EffectSummary
{
  bool active = false;
  std::string reason; ///< why it is there, or why not
  std::int64_t calls = 0;
  double seconds = 0.; ///< wall time
};

/// Contents of summary.json.
struct Summary
{
  std::string title;
  std::string version;
  std::string status; ///< completed | failed | interrupted
  std::vector<std::string> warnings;
  double wall_seconds = 0.;
  double cpu_seconds = 0.;      ///< all ranks and threads
  std::int64_t peak_memory = 0; ///< largest resident size, all ranks [bytes]
  int ranks = 1;
  int threads = 1;                           ///< a rank
  std::map<std::string, std::int64_t> sizes; ///< grains, joints, cells, dofs, multipliers
  std::int64_t steps = 0;
  std::int64_t solves = 0;
  std::map<std::string, Result> results;
  std::map<std::string, double> energy; ///< [J]
  std::map<std::string, EffectSummary> effects;
  AccuracyPlan accuracy; ///< where the deck asks for one
};

/// What the processes of all ranks have used so far.
struct Usage
{
  double cpu_seconds = 0.;
  std::int64_t peak_memory = 0; ///< largest resident sizes [bytes]
};
/// Collective.
Usage measure_usage(MPI_Comm communicator);

/// Write @p summary as JSON, whole or not at all. Numbers read back to the same bits.
/// Throws std::runtime_error naming the entry if a number is NaN or infinite (nothing is
/// written then; of a failed run such numbers are written as null), and naming the file if it cannot be written; std::logic_error for an
/// unknown status.
void write_summary(const std::string &path, const Summary &summary);
} // namespace antiform::cases

#pragma once

#include "cases/parameters.h"

#include <mpi.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What the command line asks of a run.
struct RunOptions
{
  std::string deck;
  std::string output; ///< directory; prepare_output_directory() fills an empty one
  std::vector<std::string> overrides; ///< "Section/Entry=value"
  int threads = 0;                    ///< of each rank; 0: OMP_NUM_THREADS decides
  bool resume = false;                ///< from state.h5 in the output directory
  double time_limit = 0.;             ///< wall time [s]; 0: none
};

/// Throws InputError when the scene has grains and there is more than one rank.
void demand_one_rank_of_grains(const Parameters &parameters, MPI_Comm communicator);

/// Build the scene and step it to its end. Returns the exit status of the program: 0
/// done, 1 the user's error, 2 the physics' error, 3 interrupted with a checkpoint.
/// Collective.
int run(const Parameters &parameters, const RunOptions &options, MPI_Comm communicator);

/// Print the composed scene, its effects and why, sizes, predicted time and memory.
/// Builds no packing. Returns the exit status. For one rank.
/// \param options deck, overrides and threads
int check(const Parameters &parameters,
          const RunOptions &options,
          bool json,
          std::ostream &out);

/// The same of a deck with a study: first what the study runs and what its members take,
/// then the scene that they change. Throws InputError.
int check_study(const RunOptions &options, bool json, std::ostream &out);
} // namespace antiform::cases

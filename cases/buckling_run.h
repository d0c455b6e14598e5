#pragma once

#include "cases/parameters.h"
#include "cases/program.h"
#include "cases/run_log.h"

#include <mpi.h>

namespace antiform::cases
{
/// Buckling driver: shortenings at which the straight section, of finite elements, grains
/// or both, has a bent equilibrium beside the straight one, and its shapes there, by the
/// linear theory of buckling. Writes modes.csv and field files of each mode. Finite
/// elements alone run on any number of ranks.
/// Returns the exit status; throws NumericalError where no load makes it buckle.
int run_buckling(const Parameters &parameters,
                 const RunOptions &options,
                 RunLog &log,
                 MPI_Comm communicator);
} // namespace antiform::cases

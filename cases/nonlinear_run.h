#pragma once

#include "cases/parameters.h"
#include "cases/program.h"
#include "cases/run_log.h"

#include <mpi.h>

namespace antiform::cases
{
/// Static driver of finite elements that yield, creep or strain much: the section is laid
/// down under its loads, then shortened in load steps, each an equilibrium by Newton's
/// method; steps that fail are halved. Runs on any number of ranks. Returns the exit
/// status: 2, with everything up to there written, where no equilibrium is found.
int run_nonlinear(const Parameters &parameters,
                  const RunOptions &options,
                  RunLog &log,
                  MPI_Comm communicator);
} // namespace antiform::cases

#pragma once

#include "cases/parameters.h"
#include "cases/program.h"
#include "cases/run_log.h"

#include <mpi.h>

namespace antiform::cases
{
/// Static driver: the section shortened in equal load steps, each an equilibrium of the
/// linear elastic mesh (layer and matrix continuum). Runs on any number of ranks. Returns
/// the exit status; throws InputError when the scene has grains.
int run_static(const Parameters &parameters,
               const RunOptions &options,
               RunLog &log,
               MPI_Comm communicator);
} // namespace antiform::cases

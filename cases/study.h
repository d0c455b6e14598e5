#pragma once

#include "cases/program.h"

namespace antiform::cases
{
/// Run every member of the deck's section Study, each in a directory of its own below
/// options.output, and write study.csv and study.json there. The same command goes on
/// where a former one was stopped, however that was. For one rank. Throws InputError
/// before any work.
/// \param options with the threads of each member; 0: the cores that @p jobs leave free,
/// no more than OMP_NUM_THREADS
/// \param jobs members at once; 0: as many as cores
/// \return exit status: 0 all members have come to their end, 2 some have failed,
/// 3 interrupted
int run_study(const RunOptions &options, int jobs);
} // namespace antiform::cases

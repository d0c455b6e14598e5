#pragma once

#include <mpi.h>

#include <chrono>

namespace antiform::cases
{
/// From now on SIGINT and SIGTERM only set a flag, which the stepping loop polls: it
/// writes a checkpoint and the run ends with exit status 3.
void catch_interrupts();

/// The signal that has come, or 0.
int interrupt_signal();

/// Whether a run that began then must stop: a signal has come to one of the ranks, or its
/// time is up on one. The same on all; collective. \param time_limit [s]; 0: none
bool must_stop(std::chrono::steady_clock::time_point begin,
               double time_limit,
               MPI_Comm communicator);
} // namespace antiform::cases

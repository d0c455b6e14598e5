#include "cases/interrupt.h"

#include <csignal>

#include <initializer_list>

namespace antiform::cases
{
namespace
{
volatile std::sig_atomic_t caught = 0;

extern "C" void remember_signal(const int signal)
{
  caught = signal;
}
} // namespace

void catch_interrupts()
{
  caught = 0;
  // The handler stays: mpirun passes the terminal's signal on, so a rank may get it
  // twice.
  for (const int signal : {SIGINT, SIGTERM})
  {
    struct sigaction action = {};
    action.sa_handler = remember_signal;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

int interrupt_signal()
{
  return caught;
}

bool must_stop(const std::chrono::steady_clock::time_point begin,
               const double time_limit,
               const MPI_Comm communicator)
{
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  const int mine =
      interrupt_signal() != 0 || (time_limit > 0. && elapsed.count() > time_limit) ? 1
                                                                                   : 0;
  int any = 0;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, communicator);
  return any != 0;
}
} // namespace antiform::cases

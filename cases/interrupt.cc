#include "cases/interrupt.h"

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
} // namespace antiform::cases

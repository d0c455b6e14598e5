#pragma once

#include <csignal>

namespace antiform::cases
{
/// From now on SIGINT and SIGTERM only set a flag, which the stepping loop polls: it
/// writes a checkpoint and the run ends with exit status 3.
void catch_interrupts();

/// The signal that has come, or 0.
int interrupt_signal();
} // namespace antiform::cases

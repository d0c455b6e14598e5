#pragma once

#include "cases/directory_lock.h"
#include "cases/program.h"

#include <memory>
#include <string>

namespace antiform::cases
{
/// Where a run writes, its own until this goes.
struct OutputDirectory
{
  std::string message; ///< what the user should know ("starts afresh"), or nothing
  std::unique_ptr<DirectoryLock> lock;
};

/// Settle where a run writes, before any work. An empty options.output becomes
/// DECK-output beside the deck; the directory is created and proven writable. With
/// --resume and no state.h5 in it, options.resume becomes false. Nothing that is there is
/// touched. Throws InputError when the directory holds another run and --resume was not
/// given, cannot be written to, or another run is at work in it. For one rank.
OutputDirectory prepare_output_directory(RunOptions &options);

/// DECK-output beside the deck.
std::string default_output(const std::string &deck);

/// Permission bits say little (root, read-only mounts, full quotas): write and see. Throws
/// InputError; leaves nothing in @p directory.
void prove_writable(const std::string &directory);
} // namespace antiform::cases

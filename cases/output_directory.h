#pragma once

#include "cases/program.h"

#include <string>

namespace antiform::cases
{
/// Settle where a run writes, before any work. An empty options.output becomes
/// DECK-output beside the deck; the directory is created and proven writable. With
/// --resume and no state.h5 in it, options.resume becomes false. Nothing that is there is
/// touched. Throws InputError when the directory holds another run and --resume was not
/// given, or cannot be written to. For one rank. \return what the user should know
/// ("starts afresh"), or nothing
std::string prepare_output_directory(RunOptions &options);
} // namespace antiform::cases

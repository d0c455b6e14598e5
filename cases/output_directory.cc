#include "cases/output_directory.h"

#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;

/// What stands where the run will write: a folder for a file, or the reverse.
void find_obstacles(const fs::path &directory)
{
  std::vector<std::string> problems;
  std::error_code error;
  const auto refuse = [&](const fs::path &path, const std::string &what)
  {
    problems.push_back("output directory '" + directory.string() + "': '" +
                       path.string() + "' " + what +
                       ". Move it away, or give another directory with -o DIR.");
  };
  for (const char *name : {"deck.prm", "log.txt", "history.csv", "cracks.csv",
                           "modes.csv", "fields.pvd", "state.h5", "summary.json"})
    if (fs::exists(directory / name, error) &&
        !fs::is_regular_file(directory / name, error))
      refuse(name, "is not a file, and the run writes one of that name");
  if (fs::exists(directory / "fields", error) &&
      !fs::is_directory(directory / "fields", error))
    refuse("fields", "is not a folder, and the run writes into one of that name");
  else if (fs::exists(directory / "fields", error))
    prove_writable((directory / "fields").string());
  if (!problems.empty())
    throw InputError(problems);
}
} // namespace

std::string default_output(const std::string &deck)
{
  const std::string extension = ".prm";
  const bool ends_in_it =
      deck.size() > extension.size() &&
      deck.compare(deck.size() - extension.size(), extension.size(), extension) == 0;
  return (ends_in_it ? deck.substr(0, deck.size() - extension.size()) : deck) + "-output";
}

void prove_writable(const std::string &directory)
{
  std::string name = directory + "/.antiform-XXXXXX";
  const int file = mkstemp(name.data());
  if (file < 0)
    throw InputError({"output directory '" + directory + "': cannot be written to (" +
                      std::strerror(errno) +
                      "). Change its permissions, or give another one with -o DIR."});
  close(file);
  unlink(name.c_str());
}

OutputDirectory prepare_output_directory(RunOptions &options)
{
  if (options.output.empty())
    options.output = default_output(options.deck);
  const fs::path directory(options.output);

  std::error_code error;
  if (fs::exists(directory, error) && !fs::is_directory(directory, error))
    throw InputError({"output directory '" + options.output +
                      "': is a file, not a directory. Give another one with -o DIR."});
  fs::create_directories(directory, error);
  if (error)
    throw InputError({"output directory '" + options.output + "': cannot be created (" +
                      error.message() +
                      "). Give one that can be written to with -o DIR."});
  OutputDirectory result;
  result.lock = std::make_unique<DirectoryLock>(options.output, "another run",
                                                DirectoryLock::Children::let_go);
  if (!result.lock->is_held())
    result.message = "The file system of '" + options.output +
                     "' knows no locks: see that no second run writes there.";
  // deck.prm and a summary alone are of a run that failed before its first step.
  const bool has_state = fs::exists(directory / "state.h5", error);
  for (const std::string table : {"history.csv", "modes.csv"})
    if (!has_state && fs::exists(directory / table, error))
      throw InputError({"output directory '" + options.output + "': holds results (" +
                        table +
                        "), but no state.h5 to go on from. Give another directory with "
                        "-o DIR, or remove this one."});
  if (has_state && !options.resume)
    throw InputError({"output directory '" + options.output +
                      "': holds another run (state.h5). Continue that run with --resume, "
                      "give another directory with -o DIR, or remove this one."});
  prove_writable(options.output);
  find_obstacles(directory);

  if (options.resume && !has_state)
  {
    options.resume = false;
    result.message += (result.message.empty() ? "" : "\n") +
                      ("There is no state.h5 in '" + options.output) +
                      "': the run starts afresh.";
  }
  return result;
}
} // namespace antiform::cases

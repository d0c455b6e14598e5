#include "cases/report.h"

#include "cases/program.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

extern char **environ;

namespace antiform::cases
{
namespace
{
// Debian's own, which has the packages that .ci/prepare installs.
const char *const python = "/usr/bin/python3";

/// Run a script of the directory cases, with what it is given, and wait for it.
/// \return its exit status
int run_script(const std::string &name, const std::vector<std::string> &given)
{
  const std::string script = std::string(ANTIFORM_CASES "/") + name;
  if (access(script.c_str(), R_OK) != 0)
    throw InputError({"'" + script +
                      "' is not there: the source was moved after the build. Build it "
                      "where it is now, or run its cases/" +
                      name + " by hand."});
  // -B: nothing is written beside the sources.
  std::vector<std::string> command{python, "-B", script};
  command.insert(command.end(), given.begin(), given.end());
  std::vector<char *> arguments;
  for (const std::string &argument : command)
    arguments.push_back(const_cast<char *>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error = posix_spawn(&process, arguments.front(), nullptr, nullptr,
                                arguments.data(), environ);
  if (error != 0)
    throw InputError({"'" + command.front() + "' does not start (" +
                      std::strerror(error) +
                      "). Pages are drawn by Python 3 with numpy and matplotlib; install "
                      "python3-numpy and python3-matplotlib."});
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR)
    ;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 2;
}
} // namespace

int write_report(const ReportOptions &options)
{
  std::vector<std::string> given{options.directory};
  const std::string study = options.directory + "/study.json";
  if (access(study.c_str(), F_OK) == 0)
  {
    if (!options.page.empty() || !options.steps.empty())
      throw InputError({"antiform report: '" + options.directory +
                        "' holds a study, whose page is study.html beside its table. "
                        "Leave out --output and --steps, or name a run in its members/."});
    // It asks the program for closed forms between the members.
    given.insert(given.end(),
                 {"--program", std::filesystem::read_symlink("/proc/self/exe")});
    return run_script("study_page.py", given);
  }
  if (!options.page.empty())
    given.insert(given.end(), {"--out", options.page});
  if (!options.steps.empty())
    given.insert(given.end(), {"--steps", options.steps});
  return run_script("report.py", given);
}

int compare_runs(const ComparisonOptions &options)
{
  std::vector<std::string> given = options.runs;
  if (!options.output.empty())
    given.insert(given.end(), {"--out", options.output});
  return run_script("compare.py", given);
}
} // namespace antiform::cases

#include "cases/report.h"

#include "cases/program.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

extern char **environ;

namespace antiform::cases
{
namespace
{
// Debian's own, which has the packages that .ci/prepare installs.
const char *const python = "/usr/bin/python3";
const std::string report_script = ANTIFORM_CASES "/report.py";

/// Run @p command and wait for it. \return its exit status
int wait_for(const std::vector<std::string> &command)
{
  std::vector<char *> arguments;
  for (const std::string &argument : command)
    arguments.push_back(const_cast<char *>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error = posix_spawn(&process, arguments.front(), nullptr, nullptr,
                                arguments.data(), environ);
  if (error != 0)
    throw InputError({"antiform report: '" + command.front() + "' does not start (" +
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
  if (access(report_script.c_str(), R_OK) != 0)
    throw InputError({"antiform report: '" + report_script +
                      "' is not there: the source was moved after the build. Build it "
                      "where it is now, or run its cases/report.py by hand."});
  // -B: nothing is written beside the sources.
  std::vector<std::string> command{python, "-B", report_script, options.directory};
  if (!options.page.empty())
    command.insert(command.end(), {"--out", options.page});
  if (!options.steps.empty())
    command.insert(command.end(), {"--steps", options.steps});
  return wait_for(command);
}
} // namespace antiform::cases

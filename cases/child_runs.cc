#include "cases/child_runs.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace antiform::cases
{
namespace
{
/// The environment of a process that is no part of an MPI job, whatever this one is: the
/// MPI library leaves its own variables in ours.
std::vector<std::string> environment_of_children(const int threads)
{
  std::vector<std::string> variables;
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    const auto begins = [&](const char *prefix) { return text.rfind(prefix, 0) == 0; };
    const bool is_of_job =
        begins("PMIX_") || begins("ORTE_") || begins("OPAL_") ||
        (begins("OMPI_") && !begins("OMPI_ALLOW_RUN_AS_ROOT") &&
         !begins("OMPI_MCA_rmaps_") && !begins("OMPI_MCA_mpi_yield")) ||
        begins("OMP_NUM_THREADS=");
    if (!is_of_job)
      variables.push_back(text);
  }
  variables.push_back("OMP_NUM_THREADS=" + std::to_string(threads));
  return variables;
}

std::vector<char *> pointers(std::vector<std::string> &words)
{
  std::vector<char *> result;
  for (std::string &word : words)
    result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

/// Only what is allowed between fork and exec. The process dies with this one, after a
/// checkpoint: whoever comes next must not meet it. A group of its own keeps the
/// terminal's interrupt from it, which this process passes on.
[[noreturn]] void become(char *const *arguments, char *const *variables, const int output)
{
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  setpgid(0, 0);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execve("/proc/self/exe", arguments, variables);
  _exit(127);
}
} // namespace

void ChildRuns::start(const std::size_t key,
                      const std::string &deck,
                      const std::string &directory,
                      const int threads)
{
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(directory + "/state.h5", error))
    fs::remove_all(directory, error);
  std::vector<std::string> arguments = {
      "antiform", "run", deck, "-o", directory, "--threads", std::to_string(threads)};
  if (fs::exists(directory, error))
    arguments.emplace_back("--resume");
  std::vector<std::string> variables = environment_of_children(threads);
  const std::vector<char *> argv = pointers(arguments), envp = pointers(variables);
  const int output =
      open((directory + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const pid_t process = output < 0 ? -1 : fork();
  if (process == 0)
    become(argv.data(), envp.data(), output);
  const int reason = errno;
  if (output >= 0)
    close(output);
  if (process < 0)
    throw std::runtime_error("'" + directory +
                             "' cannot be started: " + std::strerror(reason));
  running_.push_back({key, process});
}

std::optional<ChildRuns::Ended> ChildRuns::poll()
{
  int status = 0;
  const auto ended =
      std::find_if(running_.begin(), running_.end(),
                   [&](const Child &child)
                   { return waitpid(child.process, &status, WNOHANG) == child.process; });
  if (ended == running_.end())
  {
    const timespec pause{0, 20'000'000};
    nanosleep(&pause, nullptr);
    return std::nullopt;
  }
  const std::size_t key = ended->key;
  running_.erase(ended);
  return Ended{key, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status)};
}

void ChildRuns::stop()
{
  for (const Child &child : running_)
    kill(child.process, SIGINT);
  for (const Child &child : running_)
    while (waitpid(child.process, nullptr, 0) < 0 && errno == EINTR)
      ;
  running_.clear();
}

std::string last_line_of(const std::string &file)
{
  std::ifstream input(file);
  std::string line, last;
  while (std::getline(input, line))
    if (!line.empty())
      last = line;
  return last.empty() ? "nothing was printed" : last;
}
} // namespace antiform::cases

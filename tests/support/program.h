#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

/// The program `antiform` as its users meet it: arguments in; exit status, text and files
/// out.
namespace antiform::test
{
struct Outcome
{
  int status = -1;
  std::string output; ///< both streams
};

/// The environment is emptied first: within a test that mpiexec has started, its
/// variables would make the program a part of that job.
inline std::string clean_environment(const int n_threads = 1)
{
  return "env -i PATH=\"$PATH\" OMPI_ALLOW_RUN_AS_ROOT=1 "
         "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
         "OMPI_MCA_mpi_yield_when_idle=1 OPENBLAS_NUM_THREADS=1 OMP_WAIT_POLICY=passive "
         "OMP_NUM_THREADS=" +
         std::to_string(n_threads) + " ";
}

/// Run a command of the shell to its end.
inline Outcome run_command(const std::string &command)
{
  Outcome outcome;
  FILE *pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr)
    throw std::runtime_error("no process can be started for " + command);
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), buffer.size(), pipe) != nullptr)
    outcome.output += buffer.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// Run the program on @p n_ranks with @p n_threads each.
inline Outcome
run_program(const std::string &arguments, const int n_ranks = 1, const int n_threads = 1)
{
  std::string command = clean_environment(n_threads);
  if (n_ranks > 1)
    command += "mpirun -np " + std::to_string(n_ranks) + " ";
  return run_command(command + std::string(ANTIFORM_PROGRAM) + " " + arguments);
}

/// Let the program draw a page. \param matplotlib directory for matplotlib's cache of fonts
inline Outcome draw_page(const std::string &arguments, const std::string &matplotlib)
{
  return run_command(clean_environment() + "MPLCONFIGDIR=" + matplotlib + " " +
                     ANTIFORM_PROGRAM + " " + arguments);
}

/// The program at work beside the test, on one thread: to be signalled.
class RunningProgram
{
public:
  explicit RunningProgram(const std::string &arguments)
  {
    const std::string command = "exec " + clean_environment() +
                                std::string(ANTIFORM_PROGRAM) + " " + arguments +
                                " >/dev/null 2>&1";
    pid_ = fork();
    if (pid_ == 0)
    {
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    if (pid_ < 0)
      throw std::runtime_error("no process can be started for " + command);
  }
  RunningProgram(const RunningProgram &) = delete;
  RunningProgram &operator=(const RunningProgram &) = delete;
  ~RunningProgram()
  {
    if (is_running())
    {
      send(SIGKILL);
      wait();
    }
  }

  bool is_running()
  {
    if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_)
      ended_ = true;
    return !ended_;
  }
  void send(const int signal) const
  {
    if (!ended_)
      kill(pid_, signal);
  }
  /// Exit status, or minus the signal that ended it.
  int wait()
  {
    if (!ended_ && waitpid(pid_, &status_, 0) == pid_)
      ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }
  /// Wait until @p condition holds; false when the program has ended before.
  bool wait_until(const std::function<bool()> &condition)
  {
    while (is_running())
    {
      if (condition())
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

private:
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

inline std::size_t occurrences(const std::string &text, const std::string &part)
{
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1))
    ++n;
  return n;
}

/// The bytes of a file; throws if there is none.
inline std::string contents(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw std::runtime_error("there is no file '" + path + "'");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Every file below @p directory, by its path from there.
inline std::map<std::string, std::string> all_contents(const std::string &directory)
{
  namespace fs = std::filesystem;
  std::map<std::string, std::string> files;
  for (const auto &entry : fs::recursive_directory_iterator(directory))
    files[fs::relative(entry.path(), directory).string()] =
        entry.is_regular_file() ? contents(entry.path().string()) : "(a folder)";
  return files;
}

inline nlohmann::json summary_of(const std::string &directory)
{
  return nlohmann::json::parse(contents(directory + "/summary.json"));
}

inline double result(const nlohmann::json &summary, const std::string &name)
{
  return summary.at("results").at(name).at("value").get<double>();
}

/// A table of numbers with a line of names above it.
class CsvTable
{
public:
  explicit CsvTable(const std::string &path)
  {
    std::istringstream lines(contents(path));
    for (std::string line; std::getline(lines, line);)
    {
      std::istringstream cells(line);
      std::vector<std::string> row;
      for (std::string cell; std::getline(cells, cell, ',');)
        row.push_back(cell);
      if (names_.empty())
        names_ = row;
      else
        rows_.push_back(row);
    }
  }

  std::size_t size() const { return rows_.size(); }
  const std::vector<std::string> &names() const { return names_; }
  std::vector<double> column(const std::string &name) const
  {
    for (std::size_t c = 0; c < names_.size(); ++c)
      if (names_[c] == name)
      {
        std::vector<double> values;
        for (const std::vector<std::string> &row : rows_)
          values.push_back(std::stod(row.at(c)));
        return values;
      }
    throw std::runtime_error("there is no column " + name);
  }

private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};
} // namespace antiform::test

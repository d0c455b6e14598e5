#include "cases/trial_pool.h"

#include "cases/declarations.h"
#include "cases/interrupt.h"
#include "coupling/output/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;

/// The environment of a process that is no part of an MPI job, whatever this one is: the
/// MPI library leaves its own variables in ours.
std::vector<std::string> environment_of_trials()
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
  variables.emplace_back("OMP_NUM_THREADS=1");
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
/// checkpoint: a second calibration must not meet it. A group of its own keeps the
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

std::string exact_columns(const MicroParameters &micro)
{
  std::string text;
  for (const MicroName &name : micro_names())
    text += "," + exact_text(micro.*name.value);
  return text;
}

std::string measured_text(const Trial &trial, const Measurement &m)
{
  char text[96];
  if (trial.test.kind == Test::Kind::elastic)
    std::snprintf(text, sizeof text, "E %.4g GPa", 1e-9 * m.young_modulus);
  else
    std::snprintf(text, sizeof text, "%.4g MPa, E %.4g GPa", 1e-6 * m.strength,
                  1e-9 * m.young_modulus);
  return text;
}
} // namespace

TrialPool::TrialPool(std::string directory,
                     Parameters calibration,
                     const int jobs,
                     std::function<void(const std::string &)> says)
    : directory_(std::move(directory))
    , calibration_(std::move(calibration))
    , jobs_(jobs)
    , says_(std::move(says))
{
  fs::create_directories(directory_ + "/trials");
  // Anew each time: a calibration that goes on asks for the same trials in the same
  // order.
  std::string header = "trial,test,confinement_Pa,seed";
  for (const MicroName &name : micro_names())
    header += "," + name.column;
  std::ofstream(directory_ + "/trials.csv")
      << header << ",young_modulus_Pa,strength_Pa,status,cpu_seconds\n";
}

void TrialPool::record(const Trial &trial,
                       const std::string &name,
                       const std::string &status,
                       const Measurement &m,
                       const double cpu_seconds)
{
  if (!recorded_.insert(name).second)
    return;
  std::ofstream(directory_ + "/trials.csv", std::ios::app)
      << name << ',' << trial.test.name() << ',' << exact_text(trial.test.confinement)
      << ',' << trial.seed << exact_columns(trial.micro) << ','
      << exact_text(m.young_modulus) << ',' << exact_text(m.strength) << ',' << status
      << ',' << exact_text(cpu_seconds) << '\n';
  cpu_seconds_ += cpu_seconds;
}

/// False when the trial has to be run (on).
bool TrialPool::read(const Trial &trial,
                     const std::string &name,
                     Measurement &measurement)
{
  double cpu_seconds = 0.;
  try
  {
    if (!read_measurement(trial, calibration_.run.longest_shortening, folder(name),
                          measurement, cpu_seconds))
      return false;
  }
  catch (const std::runtime_error &error)
  {
    record(trial, name, "failed", {}, cpu_seconds);
    throw TrialFailed("trial '" + folder(name) + "': " + error.what() +
                      ". Look at its log.txt and history.csv; other bounds of the free "
                      "parameters, or slower walls, may help.");
  }
  record(trial, name, "completed", measurement, cpu_seconds);
  return true;
}

void TrialPool::start(Job &job, const Parameters &deck)
{
  std::error_code error;
  const std::string out = folder(job.name);
  // Without a state there is nothing to go on from, and a run refuses its own remains.
  if (!fs::exists(out + "/state.h5", error))
    fs::remove_all(out, error);
  const std::string deck_file = out + ".prm";
  coupling::replace_file(deck_file, effective_deck(deck));
  std::vector<std::string> arguments = {"antiform", "run",       deck_file, "-o",
                                        out,        "--threads", "1"};
  if (fs::exists(out, error))
    arguments.emplace_back("--resume");
  std::vector<std::string> variables = environment_of_trials();
  const std::vector<char *> argv = pointers(arguments), envp = pointers(variables);
  const int output =
      open((out + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  job.process = output < 0 ? -1 : fork();
  if (job.process == 0)
    become(argv.data(), envp.data(), output);
  const int reason = errno;
  if (output >= 0)
    close(output);
  if (job.process < 0)
    throw InputError({"trial '" + out + "' cannot be started: " + std::strerror(reason) +
                      ". Free memory or disk, or lower 'Calibration/Jobs'."});
}

/// Interrupt what runs and wait until it has written its checkpoints.
void TrialPool::stop(const std::vector<Job> &running) const
{
  for (const Job &job : running)
    kill(job.process, SIGINT);
  for (const Job &job : running)
    while (waitpid(job.process, nullptr, 0) < 0 && errno == EINTR)
      ;
}

std::vector<Measurement> TrialPool::operator()(const std::vector<Trial> &trials)
{
  std::vector<Measurement> measurements(trials.size());
  std::vector<Job> waiting, running;
  std::map<std::string, std::size_t> first;
  std::vector<std::size_t> same_as(trials.size());
  for (std::size_t k = 0; k < trials.size(); ++k)
  {
    Job job{k, trial_name(trials[k], deck_of(trials[k], calibration_)), -1};
    same_as[k] = first.emplace(job.name, k).first->second;
    if (same_as[k] != k)
      continue;
    if (read(trials[k], job.name, measurements[k]))
      ++n_found_;
    else
      waiting.push_back(job);
  }
  // Last first: the dearest tests, those under confinement, stand at the end, and no core
  // should wait for one of them.
  std::size_t done = 0;
  const std::size_t all = waiting.size();
  try
  {
    while (!waiting.empty() || !running.empty())
    {
      if (interrupt_signal() != 0)
        throw Interrupted();
      while (!waiting.empty() && running.size() < static_cast<std::size_t>(jobs_))
      {
        start(waiting.back(), deck_of(trials[waiting.back().trial], calibration_));
        running.push_back(waiting.back());
        waiting.pop_back();
      }
      int status = 0;
      const auto ended =
          std::find_if(running.begin(), running.end(),
                       [&](const Job &job)
                       { return waitpid(job.process, &status, WNOHANG) == job.process; });
      if (ended == running.end())
      {
        const timespec pause{0, 20'000'000};
        nanosleep(&pause, nullptr);
        continue;
      }
      const Job job = *ended;
      running.erase(ended);
      const Trial &trial = trials[job.trial];
      if (WIFEXITED(status) && WEXITSTATUS(status) == 3)
        throw Interrupted(); // someone has signalled the trial itself
      if (!read(trial, job.name, measurements[job.trial]))
      {
        record(trial, job.name, "failed", {}, 0.);
        throw TrialFailed(
            "trial '" + folder(job.name) +
            "' has ended without a result: " + last_line_of(folder(job.name) + ".out"));
      }
      ++n_run_;
      says_(trial.test.name() + ", seed " + std::to_string(trial.seed) + ": " +
            measured_text(trial, measurements[job.trial]) + " (" +
            std::to_string(++done) + " of " + std::to_string(all) + ")");
    }
  }
  catch (...)
  {
    stop(running);
    throw;
  }
  for (std::size_t k = 0; k < trials.size(); ++k)
    measurements[k] = measurements[same_as[k]];
  return measurements;
}
} // namespace antiform::cases

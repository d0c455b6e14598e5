#include "cases/calibrate.h"
#include "cases/command_line.h"
#include "cases/output_directory.h"
#include "cases/strength_envelope.h"
#include "cases/study.h"
#include "cases/study_decks.h"
#include "cases/theory.h"
#include "cases/theory_table.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>

namespace
{
using namespace antiform::cases;
namespace ranks = dealii::Utilities::MPI;

/// Do @p work on every rank, or fail with an InputError on every rank: a deck that one
/// machine cannot read must not leave the other ranks waiting.
void together(MPI_Comm communicator, const std::function<void()> &work)
{
  std::vector<std::string> problems;
  try
  {
    work();
  }
  catch (const InputError &error)
  {
    problems = error.problems();
  }
  const unsigned int n_ranks = ranks::n_mpi_processes(communicator);
  const unsigned int rank = ranks::this_mpi_process(communicator);
  const unsigned int first_failed =
      ranks::min(problems.empty() ? n_ranks : rank, communicator);
  if (first_failed < n_ranks)
    throw InputError(ranks::broadcast(communicator, problems, first_failed));
}

int run_deck(RunOptions options, MPI_Comm communicator)
{
  const bool is_first = ranks::this_mpi_process(communicator) == 0;
  Parameters parameters;
  together(communicator,
           [&] { parameters = read_deck(options.deck, options.overrides); });
  demand_calibration(parameters, false);
  demand_one_rank_of_grains(parameters, communicator); // the same on all of them
  OutputDirectory directory; // of the first rank
  together(communicator,
           [&]
           {
             if (!is_first)
               return;
             directory = prepare_output_directory(options);
             if (!directory.message.empty())
               std::cout << directory.message << std::endl;
           });
  options.output = ranks::broadcast(communicator, options.output, 0);
  options.resume = ranks::broadcast(communicator, options.resume, 0);
  return run(parameters, options, communicator);
}

int check_deck(const CommandLine &line)
{
  if (has_study(line.run.deck, line.run.overrides))
    return check_study(line.run, line.json, std::cout);
  const Parameters parameters = read_deck(line.run.deck, line.run.overrides);
  return parameters.has("calibration")
             ? check_cost_of_calibration(parameters, line.json, std::cout)
             : check(parameters, line.run, line.json, std::cout);
}

int theory_of_deck(const CommandLine &line)
{
  if (!line.theory.along.empty())
    return print_theory_table(line.run.deck, line.run.overrides, line.theory, std::cout);
  const Parameters parameters = read_deck(line.run.deck, line.run.overrides);
  demand_calibration(parameters, false);
  return print_theory(parameters, line.theory, std::cout);
}

int calibrate_deck(const CommandLine &line)
{
  const Parameters parameters = read_deck(line.run.deck, line.run.overrides);
  demand_calibration(parameters, true);
  return calibrate(parameters, line.run);
}

int execute(const CommandLine &line, MPI_Comm communicator)
{
  if (line.command == CommandLine::Command::run)
    return run_deck(line.run, communicator);

  const bool is_study = line.command == CommandLine::Command::study;
  if ((is_study || line.command == CommandLine::Command::calibrate) &&
      ranks::n_mpi_processes(communicator) > 1)
    throw InputError({std::string("antiform ") +
                      (is_study ? "study runs its members" : "calibrate runs its trials") +
                      " as processes of its own, as many at once as there are cores. "
                      "Start it without mpirun."});
  int status = 0;
  together(communicator,
           [&]
           {
             if (ranks::this_mpi_process(communicator) != 0)
               return;
             if (line.command == CommandLine::Command::help)
               std::cout << line.help_text;
             else if (line.command == CommandLine::Command::check)
               status = check_deck(line);
             else if (line.command == CommandLine::Command::theory)
               status = theory_of_deck(line);
             else if (line.command == CommandLine::Command::calibrate)
               status = calibrate_deck(line);
             else if (is_study)
               status = run_study(line.run, line.jobs);
             else if (line.command == CommandLine::Command::envelope)
               status = print_envelopes(line.sources, line.json, std::cout);
             else if (line.command == CommandLine::Command::report)
               status = write_report(line.report);
             else if (line.command == CommandLine::Command::compare)
               status = compare_runs(line.comparison);
             else
               std::cout << (line.markdown ? parameters_markdown()
                                           : describe_parameters(line.name));
           });
  return ranks::broadcast(communicator, status, 0);
}

void print(const InputError &error)
{
  const std::size_t n = error.problems().size();
  std::cerr << "antiform: " << n << (n == 1 ? " problem" : " problems") << '\n';
  for (const std::string &problem : error.problems())
    std::cerr << "  " << problem << '\n';
}

/// Threads wait for each other at every step, many times. By default they spin for a
/// tenth of a second, which is ten times slower as soon as another program wants a core;
/// asleep at once they take half of the speed on free cores. A few milliseconds outlast
/// the serial parts of a step and lose little where cores are shared. libgomp reads this
/// when a program is loaded, so the program starts itself anew, unless the user has
/// chosen.
void wait_politely(char **argv)
{
  if (getenv("OMP_WAIT_POLICY") != nullptr || getenv("GOMP_SPINCOUNT") != nullptr)
    return;
  setenv("GOMP_SPINCOUNT", "50000", 0);
  execv("/proc/self/exe", argv); // comes back only when it fails: then as it was
}
} // namespace

int main(int argc, char **argv)
{
  wait_politely(argv);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int rank = ranks::this_mpi_process(MPI_COMM_WORLD);
  try
  {
    return execute(parse_command_line({argv + 1, argv + argc}), MPI_COMM_WORLD);
  }
  catch (const InputError &error)
  {
    if (rank == 0)
      print(error);
    return 1;
  }
  catch (const antiform::NumericalError &error) // raised on all ranks together
  {
    if (rank == 0)
      std::cerr << "antiform: " << error.what() << std::endl;
    return 2;
  }
  catch (const std::exception &error) // perhaps on this rank alone: stop the others too
  {
    std::cerr << "antiform, rank " << rank << ": " << error.what() << std::endl;
    if (ranks::n_mpi_processes(MPI_COMM_WORLD) > 1)
      MPI_Abort(MPI_COMM_WORLD, 2);
    return 2;
  }
}

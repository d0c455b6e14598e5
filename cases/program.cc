#include "cases/buckling_run.h"
#include "cases/program.h"

#include "cases/deck_reader.h"
#include "cases/event_run.h"
#include "cases/idle_entries.h"
#include "cases/join_choice.h"
#include "cases/output_directory.h"
#include "cases/run_deck.h"
#include "cases/run_log.h"
#include "cases/static_run.h"
#include "cases/stepped_run.h"
#include "continuum/errors.h"
#include "discrete/packing_error.h"

#include <deal.II/base/mpi.h>

#include <omp.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

namespace antiform::cases
{
namespace
{
/// Beside other ranks of one machine a rank has one thread, unless told otherwise.
void choose_threads(const RunOptions &options, const MPI_Comm communicator)
{
  if (options.threads > 0)
    omp_set_num_threads(options.threads);
  else if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1 &&
           std::getenv("OMP_NUM_THREADS") == nullptr)
    omp_set_num_threads(1);
}
} // namespace

void demand_one_rank_of_grains(const Parameters &p, const MPI_Comm communicator)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  if (n_ranks == 1)
    return;
  if (p.layer.representation == "grains")
    throw InputError(
        {"'Layer/Representation' is grains on " + std::to_string(n_ranks) +
         " MPI ranks: grains run on one rank. Start without mpirun and use --threads, or "
         "set it to continuum, which runs on any number."});
}

int run(const Parameters &parameters,
        const RunOptions &options,
        const MPI_Comm communicator)
{
  choose_threads(options, communicator);
  const bool first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  std::optional<coupling::StateReader> state =
      open_state(parameters, options, communicator);
  std::string failure; // of the first rank, told on all
  if (first && !options.resume)
    try
    {
      RunDeck(parameters).write(options.output);
    }
    catch (const InputError &error)
    {
      failure = error.what();
    }
  failure = dealii::Utilities::MPI::broadcast(communicator, failure);
  if (!failure.empty())
    throw InputError({failure});
  std::filesystem::create_directories(options.output + "/fields");
  RunLog log(options.output + "/log.txt", first, options.resume);
  log.line("antiform " ANTIFORM_VERSION ": " + parameters.title);
  if (!parameters.matrix.why_join.empty())
    log.line("join of layer and matrix: " + join_in_words(parameters));
  for (const std::string &line : accuracy_in_words(parameters.accuracy))
    log.line(line);
  for (const std::string &line : idle_lines("", options.overrides, parameters))
    log.line("note: " + line);

  if (parameters.run.driver == "static")
    return run_static(parameters, options, log, communicator);
  if (parameters.run.driver == "buckling")
    return run_buckling(parameters, options, log, communicator);
  const std::unique_ptr<SteppedRun> stepped =
      parameters.follows_events()
          ? std::make_unique<EventRun>(parameters, options, log, communicator)
          : std::make_unique<SteppedRun>(parameters, options, log, communicator);
  try
  {
    return (*stepped)(state ? &*state : nullptr);
  }
  catch (const NumericalError &error)
  {
    return stepped->fail(error.what());
  }
  catch (const InputError &)
  {
    throw; // what only the packing could tell of the deck
  }
  catch (const std::exception &error)
  {
    return stepped->fail(error.what());
  }
}
} // namespace antiform::cases

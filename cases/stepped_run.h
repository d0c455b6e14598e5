#pragma once

#include "cases/program.h"
#include "cases/rate_estimate.h"
#include "cases/recorder.h"
#include "cases/run_log.h"
#include "cases/scene.h"
#include "cases/summary.h"
#include "coupling/state_file.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace antiform::cases
{
/// The checkpoint that a resumed run of @p parameters goes on from; nothing when the run
/// is not resumed. Opened before anything is built or written: a damaged one, or that of
/// another deck, costs nothing. Throws InputError.
std::optional<coupling::StateReader> open_state(const Parameters &parameters,
                                                const RunOptions &options,
                                                MPI_Comm communicator);

/// One stepped run from built scene to summary.
class SteppedRun
{
public:
  SteppedRun(const Parameters &parameters,
             const RunOptions &options,
             RunLog &log,
             MPI_Comm communicator);
  virtual ~SteppedRun() = default;
  SteppedRun(const SteppedRun &) = delete;
  SteppedRun &operator=(const SteppedRun &) = delete;

  /// Build the scene, load @p state unless null, step to the end, write the summary.
  /// \return exit status: 0 done, 3 interrupted with a checkpoint
  int operator()(coupling::StateReader *state);

  /// Summary of a run that the physics has stopped; the last checkpoint stays.
  /// \return exit status
  int fail(const std::string &reason);

protected:
  using Timer = std::chrono::steady_clock;
  enum class Pause
  {
    none,
    checkpoint,
    interrupted,
    out_of_time
  };

  /// One step of the simulation. \return none; or why it was given up, the checkpoint
  /// being written then
  virtual Pause advance();
  /// Steps between two looks at clocks and signals.
  virtual int steps_between_looks() const { return 64; }
  /// Of the loading, for the log.
  virtual std::string loading_in_words() const;
  /// A run of the same kind, for the estimate of its error.
  virtual std::unique_ptr<SteppedRun> another(const Parameters &parameters,
                                              const RunOptions &options) const;

  void visit_state(coupling::StateArchive &archive);
  Pause wish_of_this_rank(Timer::time_point last_checkpoint) const;
  void report_progress();

  const Parameters &parameters_;
  const RunOptions &options_;
  MPI_Comm communicator_;
  RunLog &log_;
  std::unique_ptr<Scene> scene_;

private:
  /// What a resumed run needs of the time before it.
  struct Past
  {
    double wall_seconds = 0., cpu_seconds = 0.;
  };
  /// All but the deck and what belongs to the estimate.
  void visit_physics(coupling::StateArchive &archive);
  double cpu_seconds() const; ///< since this run was begun
  void checkpoint();
  void keep_state_before_peak();
  void describe();
  /// The most urgent wish of any rank: signals and clocks reach them apart.
  Pause agree_on_pause(Timer::time_point last_checkpoint) const;
  int step_to_end();
  int pause(Pause reason) const; ///< \return exit status
  /// The last stretch before the peak at half the rate. \return exit status
  int estimate_rate_error();
  /// Sizes, and the calls that the loop has counted. Without a scene (its making failed)
  /// there are none.
  void describe_scene(Summary &summary) const;
  void finish(const std::string &status);
  void print_results(const Summary &summary);

  std::string deck_; ///< as the run began: the files that it names may change later
  Timer::time_point begin_;
  double cpu_before_; ///< of the process, when this run was begun [s]
  /// Where stepping began, for the progress.
  struct Beginning
  {
    Timer::time_point time;
    std::int64_t step = 0;
    double share = 0.;
  } beginning_;
  Recorder *recorder_ = nullptr;
  Past past_;
  std::optional<StatesBeforePeak> before_peak_; ///< only where the deck wants an estimate
  std::optional<RateEstimate> rate_estimate_;
  std::string no_estimate_; ///< why there is none, though the deck wants it
  std::string failure_;
};
} // namespace antiform::cases

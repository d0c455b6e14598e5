#include "cases/stepped_run.h"

#include "cases/circle_record.h"
#include "cases/deck_doubts.h"
#include "cases/deck_reader.h"
#include "cases/interrupt.h"
#include "cases/layer_packing.h"
#include "cases/run_deck.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace antiform::cases
{
namespace
{
double seconds_since(const std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
} // namespace

std::optional<coupling::StateReader> open_state(const Parameters &parameters,
                                                const RunOptions &options,
                                                const MPI_Comm communicator)
{
  if (!options.resume)
    return {};
  const std::string path = options.output + "/state.h5";
  try
  {
    std::optional<coupling::StateReader> state;
    state.emplace(path, communicator);
    std::string deck;
    state->text("deck", deck);
    if (const std::string asked = RunDeck(parameters).everything; deck != asked)
    {
      std::string problem =
          "'" + path +
          "' is the checkpoint of another deck. Resume with the same deck and the same "
          "--set, or choose another directory with -o. The checkpoint has:";
      for (const std::string &difference : deck_differences(deck, asked))
        problem += "\n    " + difference;
      throw InputError({problem});
    }
    return state;
  }
  catch (const InputError &)
  {
    throw;
  }
  catch (const std::runtime_error &error)
  {
    throw InputError({error.what()});
  }
}

SteppedRun::SteppedRun(const Parameters &parameters,
                       const RunOptions &options,
                       RunLog &log,
                       const MPI_Comm communicator)
    : parameters_(parameters)
    , options_(options)
    , communicator_(communicator)
    , log_(log)
    , deck_(RunDeck(parameters).everything)
    , begin_(Timer::now())
    , cpu_before_(measure_usage(communicator).cpu_seconds)
{
  if (parameters.run.estimate_rate_error)
    before_peak_.emplace(options.output);
}

int SteppedRun::operator()(coupling::StateReader *state)
{
  scene_ = build(parameters_, communicator_,
                 [this](const std::string &what) { log_.line("  " + what); });
  // The recorder is a component of the simulation but made apart: it watches all of it.
  auto recorder = std::make_unique<Recorder>(*scene_, options_.output, options_.resume);
  recorder_ = recorder.get();
  scene_->simulation->add(std::move(recorder), {coupling::Stage::sample}, 0, "record",
                          reason_for(parameters_, "record"));
  if (parameters_.has("measurement circles"))
    scene_->simulation->add(
        std::make_unique<CircleRecord>(*scene_, options_.output, options_.resume),
        {coupling::Stage::sample}, 1, "measurement circles",
        reason_for(parameters_, "measurement circles"));
  if (const coupling::StepAndRelax *const loading = scene_->load_steps)
    scene_->simulation->set_sampler([loading](const coupling::Clock &)
                                    { return loading->is_recording(); },
                                    [loading] { return loading->is_looking(); });
  else
    scene_->simulation->set_sampler([this](const coupling::Clock &clock)
                                    { return recorder_->is_due(clock); });
  if (state != nullptr)
  {
    visit_state(*state);
    state->expect_all_read();
    log_.line("resumed at step " + std::to_string(scene_->simulation->clock().step));
  }
  describe();
  int status = step_to_end();
  if (status == 0 && before_peak_)
    status = estimate_rate_error();
  finish(status == 0 ? "completed" : "interrupted");
  return status;
}

int SteppedRun::fail(const std::string &reason)
{
  log_.line("stopped: " + reason);
  failure_ = reason;
  finish("failed");
  return 2;
}

void SteppedRun::visit_state(coupling::StateArchive &archive)
{
  if (!archive.is_loading())
  {
    std::string deck = deck_;
    archive.text("deck", deck);
  }
  if (before_peak_)
    before_peak_->visit_state(archive);
  visit_physics(archive);
}

void SteppedRun::visit_physics(coupling::StateArchive &archive)
{
  double wall = past_.wall_seconds + seconds_since(begin_);
  double cpu = past_.cpu_seconds + cpu_seconds();
  archive.value("seconds/wall", wall);
  archive.value("seconds/cpu", cpu);
  if (archive.is_loading())
    past_ = {wall, cpu};
  scene_->visit_state(archive);
}

double SteppedRun::cpu_seconds() const
{
  return measure_usage(communicator_).cpu_seconds - cpu_before_;
}

void SteppedRun::checkpoint()
{
  coupling::StateWriter writer(communicator_);
  visit_state(writer);
  writer.commit(options_.output + "/state.h5");
}

void SteppedRun::keep_state_before_peak()
{
  const double stress = recorder_->peak_stress();
  // A body may break as a whole at its first crack: then its first load step counts.
  const bool is_first_load_step = scene_->events != nullptr &&
                                  scene_->events->load() > 0. &&
                                  before_peak_->is_empty();
  if (!before_peak_->wants(stress,
                           is_first_load_step || !scene_->grains->state.cracks.empty()))
    return;
  coupling::StateWriter writer(communicator_);
  std::string deck = RunDeck(at_half_rate(parameters_)).everything;
  writer.text("deck", deck);
  visit_physics(writer);
  writer.commit(before_peak_->next_file());
  before_peak_->kept(stress);
}

void SteppedRun::describe()
{
  const Scene &s = *scene_;
  if (s.grains)
    log_.line(std::to_string(s.grains->state.grains.size()) + " grains, " +
              std::to_string(s.grains->state.joints.size()) + " joints (kernel " +
              discrete::joint_kernel_level() + ")");
  if (s.grains)
    log_.line("packing of the layer: " + packing_text(s.grains->layer_quality));
  if (s.mesh)
    log_.line(std::to_string(s.triangulation->n_global_active_cells()) + " cells, " +
              std::to_string(s.solid->dof_handler().n_dofs()) + " degrees of freedom" +
              (s.n_multipliers() > 0
                   ? ", " + std::to_string(s.n_multipliers()) + " multipliers"
                   : ""));
  if (const std::string loading = loading_in_words(); !loading.empty())
    log_.line(loading);
}

std::string SteppedRun::loading_in_words() const
{
  const Scene &s = *scene_;
  const double dt = s.simulation->clock().dt;
  if (!(s.shortening_rate > 0.))
    return "";
  return "step " + coupling::shortest_text(dt) + " s, " +
         std::to_string(std::llround(s.transit_time / dt)) + " steps an axial transit, " +
         (s.load_steps != nullptr
              ? "walls that wait for balance after each load step"
          : parameters_.bends()
              ? std::to_string(
                    std::llround(M_PI / 180. * parameters_.strain_per_radian() /
                                 (s.shortening_rate * dt))) +
                    " steps a degree of the walls"
              : std::to_string(std::llround(1e-3 / (s.shortening_rate * dt))) +
                    " steps per 1e-3 of shortening");
}

SteppedRun::Pause
SteppedRun::wish_of_this_rank(const Timer::time_point last_checkpoint) const
{
  if (options_.time_limit > 0. && seconds_since(begin_) > options_.time_limit)
    return Pause::out_of_time;
  if (interrupt_signal() != 0)
    return Pause::interrupted;
  return seconds_since(last_checkpoint) > 60. * parameters_.output.checkpoint_minutes
             ? Pause::checkpoint
             : Pause::none;
}

SteppedRun::Pause
SteppedRun::agree_on_pause(const Timer::time_point last_checkpoint) const
{
  return static_cast<Pause>(dealii::Utilities::MPI::max(
      static_cast<int>(wish_of_this_rank(last_checkpoint)), communicator_));
}

void SteppedRun::report_progress()
{
  const coupling::Clock &clock = scene_->simulation->clock();
  const double elapsed = seconds_since(beginning_.time), share = recorder_->share_done();
  log_.progress(share, clock.step,
                share > beginning_.share && elapsed > 0.
                    ? elapsed * (1. - share) / (share - beginning_.share)
                    : -1.,
                scene_->grains ? scene_->grains->state.cracks.size() : 0,
                static_cast<double>(clock.step - beginning_.step) / elapsed);
}

std::unique_ptr<SteppedRun> SteppedRun::another(const Parameters &parameters,
                                                const RunOptions &options) const
{
  return std::make_unique<SteppedRun>(parameters, options, log_, communicator_);
}

int SteppedRun::estimate_rate_error()
{
  const double peak = recorder_->peak_stress();
  const double from = before_peak_->stress_before(peak);
  if (!recorder_->has_passed_peak() || !(from > 0.))
  {
    no_estimate_ =
        std::string("there is no estimate of the loading-rate error: ") +
        (recorder_->has_passed_peak()
             ? "the first crack came at 0.95 of the peak or later, and what to go on "
               "from is kept from there on. Run again as a whole at half the rate"
             : "the run has not passed a peak. Let it go on: raise 'Run/End shortening' "
               "or 'Run/Longest shortening'");
    return 0;
  }
  const Parameters deck = at_half_rate(parameters_);
  RunOptions options = options_;
  const Halving halving(parameters_);
  options.output += "/" + halving.directory();
  options.resume = true;
  if (options.time_limit > 0.)
    options.time_limit = std::max(1e-3, options.time_limit - seconds_since(begin_));
  log_.line("again at " + halving.words() + ", from " + coupling::shortest_text(from) + " Pa on");
  if (!std::filesystem::exists(options.output + "/state.h5"))
    begin_from(before_peak_->file_before(peak), options_.output, deck, options.output);
  std::optional<coupling::StateReader> state = open_state(deck, options, communicator_);
  const std::unique_ptr<SteppedRun> half = another(deck, options);
  try
  {
    if (const int status = (*half)(&*state); status != 0)
      return status;
  }
  catch (const NumericalError &error) // the run itself has ended well
  {
    half->fail(error.what());
    no_estimate_ =
        "there is no estimate of the loading-rate error, its run has failed: " +
        std::string(error.what());
    return 0;
  }
  rate_estimate_ = RateEstimate{halving, peak, half->recorder_->peak_stress()};
  before_peak_->remove_files();
  return 0;
}

int SteppedRun::step_to_end()
{
  if (recorder_->finished())
  {
    log_.line("the run had ended already, at " + recorder_->why_finished());
    return 0;
  }
  catch_interrupts(); // until now there was nothing that a signal could cost
  if (!options_.resume)
    checkpoint();
  coupling::Simulation &simulation = *scene_->simulation;
  beginning_ = {Timer::now(), simulation.clock().step, recorder_->share_done()};
  Timer::time_point last_checkpoint = Timer::now();
  while (!recorder_->finished())
  {
    if (const Pause reason = advance(); reason != Pause::none)
      return pause(reason);
    if (simulation.clock().step % steps_between_looks() != 0)
      continue;
    const Pause reason = agree_on_pause(last_checkpoint);
    if (reason != Pause::none)
    {
      checkpoint();
      last_checkpoint = Timer::now();
    }
    if (reason == Pause::interrupted || reason == Pause::out_of_time)
      return pause(reason);
    if (before_peak_)
      keep_state_before_peak();
    if (log_.is_due())
      report_progress();
  }
  recorder_->write_fields();
  checkpoint();
  log_.line("ended at " + recorder_->why_finished());
  return 0;
}

SteppedRun::Pause SteppedRun::advance()
{
  scene_->simulation->step();
  return Pause::none;
}

int SteppedRun::pause(const Pause reason) const
{
  log_.line(std::string(reason == Pause::out_of_time ? "time limit reached"
                                                     : "interrupted") +
            ": checkpoint written, continue with --resume");
  return 3;
}

void SteppedRun::describe_scene(Summary &summary) const
{
  const Scene &s = *scene_;
  auto &sizes = summary.sizes;
  sizes["grains"] =
      s.grains ? static_cast<std::int64_t>(s.grains->state.grains.size()) : 0;
  sizes["joints"] =
      s.grains ? static_cast<std::int64_t>(s.grains->state.joints.size()) : 0;
  sizes["cells"] =
      s.mesh ? static_cast<std::int64_t>(s.triangulation->n_global_active_cells()) : 0;
  sizes["dofs"] = s.mesh ? static_cast<std::int64_t>(s.solid->dof_handler().n_dofs()) : 0;
  sizes["multipliers"] = static_cast<std::int64_t>(s.n_multipliers());
  if (s.grains)
    report_packing(s.grains->layer_quality, summary.results);
  summary.steps = s.simulation->clock().step;
  for (const coupling::EffectCount &count : s.simulation->effects())
  {
    EffectSummary &entry = summary.effects[count.name];
    entry.active = true;
    entry.reason = count.reason;
    entry.calls = std::max(entry.calls, count.calls); // grains and mesh: one effect
    entry.seconds += count.seconds;
  }
}

void SteppedRun::finish(const std::string &status)
{
  Summary summary;
  summary.title = parameters_.title;
  summary.accuracy = parameters_.accuracy;
  summary.version = ANTIFORM_VERSION;
  summary.status = status;
  summary.wall_seconds = past_.wall_seconds + seconds_since(begin_);
  summary.cpu_seconds = past_.cpu_seconds + cpu_seconds();
  summary.peak_memory = measure_usage(communicator_).peak_memory;
  summary.ranks =
      static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(communicator_));
  summary.threads = omp_get_max_threads();
  for (const Effect &effect : list_effects(parameters_))
    summary.effects[effect.name] = {effect.state == Effect::State::present, effect.reason,
                                    0, 0.};
  if (scene_)
    describe_scene(summary);
  summary.warnings = doubts_of(parameters_, SectionGeometry(parameters_));
  if (recorder_ != nullptr)
    recorder_->fill(summary);
  if (rate_estimate_)
    rate_estimate_->fill(summary);
  if (!no_estimate_.empty())
    summary.warnings.push_back(no_estimate_);
  if (!failure_.empty())
    summary.warnings.push_back(failure_);
  if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
    write_summary(options_.output + "/summary.json", summary);
  print_results(summary);
}

void SteppedRun::print_results(const Summary &summary)
{
  for (const auto &[name, result] : summary.results)
  {
    char text[128];
    std::snprintf(text, sizeof text, "  %-34s %14.6g %s", name.c_str(), result.value,
                  result.unit.c_str());
    log_.line(text);
  }
  for (const std::string &warning : summary.warnings)
    log_.line("warning: " + warning);
  if (recorder_ == nullptr)
    return; // stopped before the first step
  char text[160];
  std::snprintf(text, sizeof text,
                "%s: %lld steps in %.1f s, energy ledger closed to %.2g",
                summary.status.c_str(), static_cast<long long>(summary.steps),
                summary.wall_seconds, summary.energy.at("closure_error"));
  log_.line(text);
}
} // namespace antiform::cases

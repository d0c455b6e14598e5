#include "cases/nonlinear_run.h"

#include "cases/interrupt.h"
#include "cases/nonlinear_section.h"
#include "cases/small_strain.h"
#include "cases/solid_run.h"
#include "continuum/arc_length.h"
#include "continuum/errors.h"
#include "continuum/newton_solver.h"
#include "coupling/output/mesh_vtu.h"
#include "coupling/output/tables.h"
#include "coupling/output/vtu.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

namespace antiform::cases
{
namespace
{
using continuum::Vector;

/// Table, field files and the peak.
class NonlinearRecord
{
public:
  NonlinearRecord(const Parameters &p,
                  const std::string &directory,
                  const MPI_Comm communicator)
      : directory_(directory)
      , lifts_off_(p.has("foundation") && p.foundation.lifts_off)
      , has_interface_(p.has_mesh_contact())
  {
    std::vector<std::string> columns = {
        "step",         "shortening",       "axial_stress_Pa",
        "wall_force_N", "fold_amplitude_m", "plastic_share",
        "newton_iterations"};
    if (lifts_off_)
      columns.insert(columns.end(), {"crest_height_m", "lifted_length_m"});
    if (has_interface_)
      columns.insert(columns.end(), {"open_length_m", "relative_slip"});
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      history_.emplace(directory + "/history.csv", columns);
  }

  void add(const int step,
           const double shortening,
           const Reading &reading,
           const std::size_t iterations,
           const continuum::NonlinearSolid &solid,
           const Vector &displacement)
  {
    std::vector<double> line = {static_cast<double>(step), shortening,
                                reading.axial_stress,      reading.wall_force,
                                reading.fold_amplitude,    reading.plastic_share,
                                static_cast<double>(iterations)};
    if (lifts_off_)
      line.insert(line.end(), {reading.crest_height, reading.lifted_length});
    if (has_interface_)
      line.insert(line.end(), {reading.open_length, reading.relative_slip});
    if (history_)
      history_->append(line);
    char file[64];
    std::snprintf(file, sizeof file, "fields/continuum_%04d.vtu", step);
    coupling::write_mesh_vtu(directory_ + "/" + file, solid, displacement);
    fields_.push_back({shortening, "continuum", file});
    if (history_)
      coupling::write_pvd(directory_ + "/fields.pvd", fields_);
    if (reading.axial_stress > peak.axial_stress)
    {
      peak = reading;
      strain_at_peak = shortening;
    }
    last = reading;
    reached = shortening;
  }

  std::int64_t n_states() const { return static_cast<std::int64_t>(fields_.size()); }

  Reading peak, last;
  double strain_at_peak = 0., reached = 0.;

private:
  std::string directory_;
  bool lifts_off_, has_interface_;
  std::optional<coupling::Table> history_;
  std::vector<coupling::PvdEntry> fields_;
};

std::map<std::string, Result> results_of(const Parameters &p,
                                         const NonlinearRecord &record,
                                         const std::size_t iterations,
                                         const bool shortened)
{
  std::map<std::string, Result> results = {
      {"shortening", {record.reached, "-"}},
      {"wall_force", {record.last.wall_force, "N"}},
      {"fold_amplitude", {record.last.fold_amplitude, "m"}},
      {"plastic_share", {record.last.plastic_share, "-"}},
      {"solver_iterations", {static_cast<double>(iterations), "-"}}};
  if (p.has("foundation") && p.foundation.lifts_off)
  {
    results["crest_height"] = {record.last.crest_height, "m"};
    results["lifted_length"] = {record.last.lifted_length, "m"};
  }
  if (p.has_mesh_contact())
  {
    results["open_length"] = {record.last.open_length, "m"};
    results["relative_slip"] = {record.last.relative_slip, "-"};
  }
  if (shortened)
  {
    results["peak_stress"] = {record.peak.axial_stress, "Pa"};
    results["strain_at_peak"] = {record.strain_at_peak, "-"};
    results["fold_amplitude_at_peak"] = {record.peak.fold_amplitude, "m"};
    results["plastic_share_at_peak"] = {record.peak.plastic_share, "-"};
  }
  return results;
}

/// How a run went.
struct Course
{
  SmallStrainWatch watch; ///< where strain is small by 'Run/Strain'
  std::string status = "completed", failure;
  std::size_t iterations = 0; ///< of Newton's method
  std::size_t solves = 0;     ///< equilibria, those within a load step too

  int exit_status() const
  {
    return status == "completed" ? 0 : status == "failed" ? 2 : 3;
  }
};

/// One load step from an equilibrium; the first is that of the loads alone. What went
/// wrong, or nothing.
std::string take_step(const int step,
                      const int n_steps,
                      const double time_step,
                      continuum::NewtonSolver &newton,
                      Vector &displacement)
{
  try // raised on all ranks together
  {
    if (step == 0)
      newton.solve(0., 0., displacement);
    else
      newton.advance((step - 1.) / n_steps, static_cast<double>(step) / n_steps, 1,
                     displacement, time_step);
  }
  catch (const NumericalError &error)
  {
    return (step == 0 ? std::string("before any shortening the section finds no "
                                    "equilibrium: it does not bear its loads, or nothing "
                                    "holds it. Give stronger materials ('Matrix "
                                    "material', 'Layer material'), less load or a "
                                    "support. ")
                      : std::string()) +
           error.what();
  }
  return "";
}

void log_reading(const int step, const double shortening, const Reading &r, RunLog &log)
{
  char text[160];
  std::snprintf(text, sizeof text,
                "  step %d: shortening %.4e, axial stress %.4e Pa, amplitude %.4g m", step,
                shortening, r.axial_stress, r.fold_amplitude);
  log.line(text);
}

/// Watches strains that are small by the deck; false, with the reason, where they are not.
bool is_small_enough(const Parameters &p,
                     NonlinearSection &section,
                     const Vector &displacement,
                     const long step,
                     Course &course)
{
  if (p.run.strain != "small")
    return true;
  try // raised on all ranks together
  {
    course.watch.look(section.solid(), displacement, step);
  }
  catch (const NumericalError &error)
  {
    course.failure = error.what();
    return false;
  }
  return true;
}

/// Load steps to the end, or to where there is no equilibrium any more: the state is then
/// that of the last good part of the step.
Course shorten(const Parameters &p,
               const std::function<bool()> &must_stop_now,
               NonlinearSection &section,
               continuum::NewtonSolver &newton,
               NonlinearRecord &record,
               RunLog &log)
{
  const int n_steps = section.end_shortening() > 0. ? p.run.load_steps : 0;
  const double time_step = n_steps > 0 ? p.run.duration / n_steps : 0.;
  Vector u = section.solid().make_vector();
  Course course;
  for (int step = 0; step <= n_steps && course.status == "completed"; ++step)
  {
    if (must_stop_now())
    {
      course.status = "interrupted";
      break;
    }
    course.failure = take_step(step, n_steps, time_step, newton, u);
    const double reached = newton.steps().empty() ? 0. : newton.steps().back().factor;
    if (!course.failure.empty())
    {
      course.status = "failed";
      if (step == 0 || reached <= (step - 1.) / n_steps)
        break;
      section.loaded().assemble(u, reached, 0., nullptr); // its reactions
    }
    std::size_t iterations = 0;
    for (const continuum::NewtonSolver::Step &done : newton.steps())
      iterations += done.residuals.size() - 1;
    const Reading reading = section.read(u);
    record.add(step, reached * section.end_shortening(), reading,
               iterations - course.iterations, section.solid(), u);
    course.iterations = iterations;
    log_reading(step, record.reached, reading, log);
    if (course.failure.empty() && !is_small_enough(p, section, u, step, course))
      course.status = "failed";
  }
  course.solves = newton.steps().size();
  if (!course.failure.empty() && record.n_states() > 0 && p.run.strain == "finite")
    course.failure += ". 'Run/Path' = 'arc length' follows a path past a limit point";
  return course;
}

/// Along the path by arc length to the end shortening, through limit points, or to where
/// it cannot be followed any more.
Course follow(const Parameters &p,
              const std::function<bool()> &must_stop_now,
              NonlinearSection &section,
              continuum::NewtonSolver &newton,
              NonlinearRecord &record,
              RunLog &log)
{
  Vector u = section.solid().make_vector();
  Course course;
  course.failure = take_step(0, 1, 0., newton, u);
  int step = 0;
  const auto note =
      [&](const Vector &displacement, const continuum::ArcLength::Point &point)
  {
    const Reading reading = section.read(displacement);
    record.add(step, point.factor * section.end_shortening(), reading, point.iterations,
               section.solid(), displacement);
    course.iterations += point.iterations;
    log_reading(step, record.reached, reading, log);
    if (!is_small_enough(p, section, displacement, step, course))
      course.status = "failed";
    else if (must_stop_now())
      course.status = "interrupted";
    ++step;
    ++course.solves;
    return course.status == "completed";
  };
  const auto first = [&]
  { return static_cast<unsigned int>(newton.steps().back().residuals.size() - 1); };
  if (!course.failure.empty() || !note(u, {0., 0., first()}) ||
      section.end_shortening() == 0.)
  {
    course.status = course.failure.empty() ? course.status : "failed";
    return course;
  }
  continuum::ArcLength::Options options;
  // Root mean square of a uniform shortening that moves both ends in.
  options.first_length = section.end_shortening() / p.run.load_steps *
                         section.geometry().length() / std::sqrt(24.);
  options.observe = note;
  options.max_steps = std::max(500u, 20 * static_cast<unsigned int>(p.run.load_steps));
  continuum::ArcLength path(section.loaded(), options);
  double factor = 0.;
  try // raised on all ranks together
  {
    path.follow(
        u, factor, [](const Vector &, const double reached) { return reached; }, 1.);
  }
  catch (const NumericalError &error)
  {
    course.status = "failed";
    course.failure = error.what();
  }
  return course;
}
} // namespace

int run_nonlinear(const Parameters &p,
                  const RunOptions &options,
                  RunLog &log,
                  const MPI_Comm communicator)
{
  const auto begin = std::chrono::steady_clock::now();
  catch_interrupts();
  log.line("  building the mesh");
  NonlinearSection section(p, communicator);
  continuum::NewtonSolver newton(section.loaded(), {});
  NonlinearRecord record(p, options.output, communicator);
  const Course course = (p.run.path == "arc length" ? follow : shorten)(
      p, [&] { return must_stop(begin, options.time_limit, communicator); }, section,
      newton, record, log);

  Summary summary = summary_of_solid(p, section.solid(), begin);
  summary.status = course.status;
  for (const std::string &warning : course.watch.warnings())
    summary.warnings.push_back(warning);
  if (!course.failure.empty())
    summary.warnings.push_back(course.failure);
  summary.steps = record.n_states();
  summary.solves = static_cast<std::int64_t>(course.solves);
  if (record.last.relative_slip > 0.3)
    summary.warnings.push_back(
        "layer and matrix have slipped on one another by " +
        coupling::shortest_text(record.last.relative_slip) +
        " of a cell, and pairs of faces stay as they were: pressures along the interface "
        "err by as much of their change from cell to cell. Give 'Matrix/Cell aspect "
        "ratio' more, or end sooner");
  summary.results =
      results_of(p, record, course.iterations, section.end_shortening() > 0.);
  summarise_effects(p, summary.solves, summary);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    write_summary(options.output + "/summary.json", summary);
  for (const std::string &warning : summary.warnings)
    log.line("warning: " + warning);
  char text[160];
  std::snprintf(text, sizeof text,
                "%s: %zu equilibria, %zu Newton iterations, peak %.4g Pa at %.4g",
                course.status.c_str(), course.solves, course.iterations,
                record.peak.axial_stress, record.strain_at_peak);
  log.line(std::string(text) + (course.status == "interrupted"
                                    ? "; a static run keeps no checkpoint, run it again "
                                      "into another directory"
                                    : ""));
  return course.exit_status();
}
} // namespace antiform::cases

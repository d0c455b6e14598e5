#include "cases/nonlinear_run.h"

#include "cases/interrupt.h"
#include "cases/mesh_strips.h"
#include "cases/solid_laws.h"
#include "cases/solid_run.h"
#include "continuum/errors.h"
#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "continuum/newton_solver.h"
#include "continuum/section_mesh.h"
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
using dealii::Point;

constexpr double solid_fraction = 0.84; // of the grains that the densities are of

/// What the run says of one equilibrium.
struct Reading
{
  double wall_force = 0.; ///< on layer and matrix [N]
  /// Of the layer, compression > 0 [Pa]: the walls' force over its thickness; in a matrix
  /// the mean of Cauchy's stress in the cells beside a wall.
  double axial_stress = 0.;
  double fold_amplitude = 0.; ///< crest over troughs [m]
  double plastic_share = 0.;  ///< of the layer's area that has yielded [-]
};

/// The body of a deck under its loads.
class Section
{
public:
  Section(const Parameters &p, const MPI_Comm communicator)
      : p_(p)
      , geometry_(p)
      , mesh_(make_mesh(p, geometry_, communicator))
      , solid_(*mesh_, solid_laws(p), options())
  {
    if (p.has("foundation"))
      solid_.add_springs(continuum::winkler_foundation(
          solid_, {continuum::boundary::bottom},
          p.foundation.stiffness_ratio * p.matrix_modulus() / p.layer.thickness));
    loaded_.emplace(solid_, constant_loads(), shortening_to(end_shortening()));
  }

  continuum::NonlinearSolid &solid() { return solid_; }
  continuum::LoadedSolid &loaded() { return *loaded_; }
  /// At load factor 1; without walls the sides are held.
  double end_shortening() const { return p_.has("walls") ? p_.run.end_shortening : 0.; }

  Reading read(const Vector &displacement) const;

private:
  /// Pressure under which the section was laid down, at a height [Pa].
  double pressure_at(const double y) const
  {
    return surface_pressure() +
           (p_.has("gravity") ? solid_fraction * p_.matrix.grain_density *
                                    p_.gravity.acceleration * (geometry_.surface() - y)
                              : 0.);
  }
  double surface_pressure() const
  {
    return p_.has("surface pressure") ? p_.surface_pressure.pressure : 0.;
  }
  bool is_in_layer(const Point<2> &x, const double slack) const
  {
    return x[1] < geometry_.core_top(x[0]) + slack &&
           x[1] > geometry_.core_bottom(x[0]) - slack;
  }

  continuum::NonlinearSolid::Options options() const
  {
    continuum::NonlinearSolid::Options options;
    options.degree = static_cast<unsigned int>(p_.matrix.element_degree);
    if (p_.has("gravity") || p_.has("surface pressure"))
      options.initial_stress = [this](const Point<2> &x)
      {
        const double P = pressure_at(x[1]);
        return continuum::PointStress{-P, -P, -P, 0.};
      };
    return options;
  }

  continuum::Loads constant_loads() const
  {
    continuum::Loads loads;
    loads.displacements = section_supports(p_, geometry_, solid_, 0.);
    if (p_.has("gravity"))
      loads.dead = continuum::body_force(
          solid_,
          [this](const Point<2> &x)
          {
            const double density =
                is_in_layer(x, 0.) ? p_.layer.grain_density : p_.matrix.grain_density;
            return dealii::Tensor<1, 2>(
                {0., -solid_fraction * density * p_.gravity.acceleration});
          });
    if (!p_.has("surface pressure"))
      return loads;
    if (p_.run.strain == "finite")
      loads.pressures.emplace_back(
          solid_, continuum::BoundaryIds{continuum::boundary::top}, surface_pressure());
    else
    {
      Vector force =
          continuum::pressure(solid_, {continuum::boundary::top}, surface_pressure());
      if (loads.dead)
        *loads.dead += force;
      else
        loads.dead = force;
    }
    return loads;
  }

  continuum::Loads shortening_to(const double shortening) const
  {
    continuum::Loads loads;
    loads.displacements = section_supports(p_, geometry_, solid_, shortening);
    return loads;
  }

  /// Mean rise of the layer in a column's width about @p x [m].
  double rise(const Vector &displacement, double x) const;

  const Parameters &p_;
  SectionGeometry geometry_;
  std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> mesh_;
  continuum::NonlinearSolid solid_;
  std::optional<continuum::LoadedSolid> loaded_;
};

double Section::rise(const Vector &displacement, const double x) const
{
  const double reach =
      0.5 * geometry_.length() / geometry_.n_columns() + 1e-9 * geometry_.length();
  double sum = 0., n = 0.;
  for (const auto dof : solid_.locally_owned())
    if (solid_.component(dof) == 1)
      if (const Point<2> place = solid_.support_point(dof);
          std::abs(place[0] - x) <= reach && is_in_layer(place, 1e-9))
      {
        sum += displacement(dof);
        n += 1.;
      }
  const MPI_Comm communicator = mesh_->get_communicator();
  return dealii::Utilities::MPI::sum(sum, communicator) /
         dealii::Utilities::MPI::sum(n, communicator);
}

Reading Section::read(const Vector &displacement) const
{
  const MPI_Comm communicator = mesh_->get_communicator();
  const double small = 1e-9 * geometry_.length();
  const Vector &reactions = loaded_->reactions();
  double force = 0.;
  for (const auto dof : solid_.locally_owned())
    if (solid_.component(dof) == 0 &&
        solid_.support_point(dof)[0] < geometry_.x_min() + small)
      force += reactions(dof);
  double yielded = 0., area = 0., pressed = 0., beside_wall = 0.;
  const double first_column =
      geometry_.x_min() + geometry_.length() / geometry_.n_columns();
  for (const auto &point : solid_.point_states(displacement))
    if (point.material == layer_material_id)
    {
      yielded += point.plastic_strain > 0. ? point.area : 0.;
      area += point.area;
      const double of_wall = point.place[0] < first_column ? point.area : 0.;
      pressed -= of_wall * point.stress.xx;
      beside_wall += of_wall;
    }
  Reading reading;
  reading.wall_force = dealii::Utilities::MPI::sum(force, communicator);
  // Nodes between layer and matrix react for both; without a matrix the force is exact.
  pressed = dealii::Utilities::MPI::sum(pressed, communicator) /
            dealii::Utilities::MPI::sum(beside_wall, communicator);
  reading.axial_stress =
      p_.has("matrix") ? pressed : reading.wall_force / geometry_.thickness();
  const double half = 0.5 * geometry_.wavelength();
  reading.fold_amplitude = geometry_.amplitude() + rise(displacement, 0.) -
                           0.5 * (rise(displacement, -half) + rise(displacement, half));
  reading.plastic_share = dealii::Utilities::MPI::sum(yielded, communicator) /
                          dealii::Utilities::MPI::sum(area, communicator);
  return reading;
}

/// Table, field files and the peak.
class NonlinearRecord
{
public:
  NonlinearRecord(const std::string &directory, const MPI_Comm communicator)
      : directory_(directory)
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      history_.emplace(directory + "/history.csv",
                       std::vector<std::string>{"step", "shortening", "axial_stress_Pa",
                                                "wall_force_N", "fold_amplitude_m",
                                                "plastic_share", "newton_iterations"});
  }

  void add(const int step,
           const double shortening,
           const Reading &reading,
           const std::size_t iterations,
           const continuum::NonlinearSolid &solid,
           const Vector &displacement)
  {
    if (history_)
      history_->append(std::vector<double>{static_cast<double>(step), shortening,
                                           reading.axial_stress, reading.wall_force,
                                           reading.fold_amplitude, reading.plastic_share,
                                           static_cast<double>(iterations)});
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

  Reading peak, last;
  double strain_at_peak = 0., reached = 0.;

private:
  std::string directory_;
  std::optional<coupling::Table> history_;
  std::vector<coupling::PvdEntry> fields_;
};

std::map<std::string, Result> results_of(const NonlinearRecord &record,
                                         const std::size_t iterations,
                                         const bool shortened)
{
  std::map<std::string, Result> results = {
      {"shortening", {record.reached, "-"}},
      {"wall_force", {record.last.wall_force, "N"}},
      {"fold_amplitude", {record.last.fold_amplitude, "m"}},
      {"plastic_share", {record.last.plastic_share, "-"}},
      {"solver_iterations", {static_cast<double>(iterations), "-"}}};
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
  std::string status = "completed", failure;
  std::size_t iterations = 0; ///< of Newton's method

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
    return error.what();
  }
  return "";
}

/// Load steps to the end, or to where there is no equilibrium any more: the state is then
/// that of the last good part of the step.
Course shorten(const Parameters &p,
               const std::function<bool()> &must_stop_now,
               Section &section,
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
    char text[160];
    std::snprintf(text, sizeof text,
                  "  step %d: shortening %.4e, axial stress %.4e Pa, amplitude %.4g m",
                  step, record.reached, reading.axial_stress, reading.fold_amplitude);
    log.line(text);
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
  Section section(p, communicator);
  continuum::NewtonSolver newton(section.loaded(), {});
  NonlinearRecord record(options.output, communicator);
  const Course course = shorten(
      p, [&] { return must_stop(begin, options.time_limit, communicator); }, section,
      newton, record, log);

  Summary summary = summary_of_solid(p, section.solid(), begin);
  summary.status = course.status;
  if (!course.failure.empty())
    summary.warnings.push_back(course.failure);
  summary.steps = summary.solves = static_cast<std::int64_t>(newton.steps().size());
  summary.results = results_of(record, course.iterations, section.end_shortening() > 0.);
  summarise_effects(p, summary.solves, summary);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    write_summary(options.output + "/summary.json", summary);
  for (const std::string &warning : summary.warnings)
    log.line("warning: " + warning);
  char text[160];
  std::snprintf(text, sizeof text,
                "%s: %zu equilibria, %zu Newton iterations, peak %.4g Pa at %.4g",
                course.status.c_str(), newton.steps().size(), course.iterations,
                record.peak.axial_stress, record.strain_at_peak);
  log.line(std::string(text) + (course.status == "interrupted"
                                    ? "; a static run keeps no checkpoint, run it again "
                                      "into another directory"
                                    : ""));
  return course.exit_status();
}
} // namespace antiform::cases

#include "cases/static_run.h"

#include "cases/interrupt.h"
#include "cases/nonlinear_run.h"
#include "cases/prestress.h"
#include "cases/scene.h"
#include "cases/section_foundation.h"
#include "cases/small_strain.h"
#include "cases/solid_run.h"
#include "cases/summary.h"
#include "continuum/errors.h"
#include "continuum/loads.h"
#include "continuum/section_mesh.h"
#include "continuum/static_solver.h"
#include "coupling/output/mesh_vtu.h"
#include "coupling/output/tables.h"
#include "coupling/output/vtu.h"

#include <deal.II/base/mpi.h>

#include <omp.h>

#include <chrono>
#include <cmath>
#include <cstdio>

namespace antiform::cases
{
int run_static(const Parameters &p,
               const RunOptions &options,
               RunLog &log,
               const MPI_Comm communicator)
{
  if (p.is_nonlinear())
    return run_nonlinear(p, options, log, communicator);
  const auto begin = std::chrono::steady_clock::now();
  const std::unique_ptr<Scene> scene =
      build(p, communicator, [&](const std::string &what) { log.line("  " + what); });
  continuum::ElasticSolid &solid = *scene->solid;
  continuum::Vector load = solid.make_vector();
  if (p.has("gravity"))
  {
    dealii::Tensor<1, 2> down;
    down[1] = -p.gravity.acceleration;
    load += continuum::gravity(solid, down);
  }
  if (p.has("surface pressure"))
    load += continuum::pressure(solid, {continuum::boundary::top},
                                p.pressure_on_top());
  if (p.has("foundation"))
    solid.add_to_stiffness(section_foundation(p, solid));

  if (p.has("gravity") || p.has("surface pressure"))
    load += install_prestress(*scene, load).mesh_force;

  const bool first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  std::optional<coupling::Table> history;
  if (first)
    history.emplace(options.output + "/history.csv",
                    std::vector<std::string>{"step", "shortening", "wall_force_N",
                                             "strain_continuum_J"});
  // Without walls the sides are held, and one solve gives the answer to the loads.
  const double end = p.has("walls") ? p.run.end_shortening : 0.;
  const int n_steps = p.has("walls") ? p.run.load_steps : 1;
  const continuum::StaticSolver::Options solver_options;
  continuum::StaticSolver solver(solid, solid.stiffness(),
                                 section_supports(p, scene->geometry, solid, 0.),
                                 solver_options);
  continuum::Vector &u = scene->mesh->displacement;
  unsigned int iterations = 0;
  double force = 0., energy = 0., reached = 0.;
  double force_at_rest = 0.; // of the loads under which the section was laid down
  for (const auto &[dof, value] : section_supports(p, scene->geometry, solid, 0.))
    if (solid.locally_owned().is_element(dof) && solid.component(dof) == 0 &&
        solid.support_point(dof)[0] < scene->geometry.x_min() + 1e-6)
      force_at_rest -= load(dof);
  force_at_rest = dealii::Utilities::MPI::sum(force_at_rest, communicator);
  std::vector<coupling::PvdEntry> fields;
  SmallStrainWatch watch;
  std::string status = "completed", failure;
  int step = 0;
  catch_interrupts();
  while (step < n_steps)
  {
    if (must_stop(begin, options.time_limit, communicator))
    {
      status = "interrupted";
      break;
    }
    ++step;
    const double shortening = end * step / n_steps;
    const continuum::DirichletValues values =
        section_supports(p, scene->geometry, solid, shortening);
    solver.set_values(values);
    iterations += solver.solve(load, u);
    // Reaction of the left wall: K u - f on its dofs.
    continuum::Vector residual = solid.make_vector();
    solid.add_internal_force(u, residual);
    residual += load;
    double reaction = 0.;
    for (const auto &[dof, value] : values)
      if (solid.locally_owned().is_element(dof) && solid.component(dof) == 0 &&
          solid.support_point(dof)[0] < scene->geometry.x_min() + 1e-6)
        reaction -= residual(dof);
    force = dealii::Utilities::MPI::sum(reaction, communicator);
    energy = solid.strain_energy(u);
    if (first)
      history->append(
          std::vector<double>{static_cast<double>(step), shortening, force, energy});
    char file[64];
    std::snprintf(file, sizeof file, "fields/continuum_%04d.vtu", step);
    coupling::write_mesh_vtu(options.output + "/" + file, solid, u);
    fields.push_back({shortening, "continuum", file});
    if (first)
      coupling::write_pvd(options.output + "/fields.pvd", fields);
    reached = shortening;
    try
    {
      watch.look(solid, u, step);
    }
    catch (const NumericalError &error) // raised on all ranks together
    {
      status = "failed";
      failure = error.what();
      break;
    }
  }

  Summary summary = summary_of_solid(p, solid, begin);
  summary.status = status;
  summary.warnings = watch.warnings();
  if (!failure.empty())
    summary.warnings.push_back(failure);
  summary.steps = summary.solves = step;
  const double height = scene->geometry.surface() - scene->geometry.base();
  summary.results = {{"shortening", {reached, "-"}},
                     {"wall_force", {force, "N"}},
                     {"solver_iterations", {static_cast<double>(iterations), "-"}}};
  if (reached > 0.)
    summary.results["section_stiffness"] = {(force - force_at_rest) / reached / height, "Pa"};
  summary.energy = {{"strain_continuum", energy}};
  summarise_effects(p, step, summary);
  if (first)
    write_summary(options.output + "/summary.json", summary);
  for (const std::string &warning : summary.warnings)
    log.line("warning: " + warning);
  log.line(status + ": " + std::to_string(step) + " solves, wall force " +
           coupling::shortest_text(force) + " N" +
           (status == "interrupted" ? "; a static run keeps no checkpoint, run it again "
                                      "into another directory"
                                    : ""));
  return status == "completed" ? 0 : status == "failed" ? 2 : 3;
}
} // namespace antiform::cases

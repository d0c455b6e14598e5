#include "cases/solid_run.h"

#include "cases/effects.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>

#include <omp.h>

namespace antiform::cases
{
continuum::DirichletValues section_supports(const Parameters &p,
                                            const SectionGeometry &g,
                                            const continuum::DisplacementSpace &solid,
                                            const double shortening)
{
  const double move = 0.5 * shortening * g.length();
  const auto constant = [](const double value)
  { return [value](const dealii::Point<2> &) { return value; }; };
  continuum::DirichletValues values;
  if (!p.has("matrix") && !p.has_foundation_under("base"))
  { // a bare layer is free to fold: one corner keeps it in place
    const double small = 1e-9 * g.length();
    for (const auto dof : solid.locally_owned())
      if (const dealii::Point<2> x = solid.support_point(dof);
          solid.component(dof) == 1 && x[0] < g.x_min() + small &&
          x[1] < g.layer_bottom(g.x_min()) + small)
        values[dof] = 0.;
  }
  else if (p.has("matrix") && !p.has_foundation_under("base"))
  {
    continuum::prescribe(solid, continuum::boundary::bottom, 1, constant(0.), values);
    if (p.matrix.base == "fixed")
      continuum::prescribe(solid, continuum::boundary::bottom, 0, constant(0.), values);
  }
  continuum::prescribe(solid, continuum::boundary::left, 0, constant(move), values);
  continuum::prescribe(solid, continuum::boundary::right, 0, constant(-move), values);
  return values;
}

std::map<std::string, std::int64_t> sizes_of_solid(const continuum::DisplacementSpace &solid)
{
  return {{"grains", 0},
          {"joints", 0},
          {"cells", static_cast<std::int64_t>(
                        solid.dof_handler().get_triangulation().n_global_active_cells())},
          {"dofs", static_cast<std::int64_t>(solid.dof_handler().n_dofs())},
          {"multipliers", 0}};
}

Summary summary_of_run(const Parameters &p,
                       const MPI_Comm communicator,
                       const std::map<std::string, std::int64_t> &sizes,
                       const std::chrono::steady_clock::time_point begin)
{
  Summary summary;
  summary.title = p.title;
  summary.accuracy = p.accuracy;
  summary.version = ANTIFORM_VERSION;
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const Usage usage = measure_usage(communicator);
  summary.peak_memory = usage.peak_memory;
  summary.cpu_seconds = usage.cpu_seconds;
  summary.ranks = static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(communicator));
  summary.threads = omp_get_max_threads();
  summary.sizes = sizes;
  return summary;
}

Summary summary_of_solid(const Parameters &p,
                         const continuum::DisplacementSpace &solid,
                         const std::chrono::steady_clock::time_point begin)
{
  return summary_of_run(p, solid.dof_handler().get_communicator(), sizes_of_solid(solid),
                        begin);
}

void summarise_effects(const Parameters &p, const std::int64_t solves, Summary &summary)
{
  for (const Effect &effect : list_effects(p))
  {
    const bool active = effect.state == Effect::State::present && effect.name != "damping";
    const bool is_solved = effect.name == "mesh" || effect.name == "bonds" ||
                           effect.name == "bridging domain" ||
                           effect.name == "surface interface";
    summary.effects[effect.name] = {active, effect.reason,
                                    active && is_solved ? solves : 0, 0.};
  }
}
} // namespace antiform::cases

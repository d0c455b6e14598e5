#include "cases/buckling_run.h"

#include "cases/interrupt.h"
#include "cases/mechanism.h"
#include "cases/mesh_strips.h"
#include "cases/scene.h"
#include "cases/solid_run.h"
#include "continuum/foundation.h"
#include "continuum/linear_buckling.h"
#include "continuum/section_mesh.h"
#include "continuum/sliding_interface.h"
#include "coupling/output/mesh_vtu.h"
#include "coupling/output/tables.h"
#include "coupling/output/vtu.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

namespace antiform::cases
{
namespace
{
/// Mean compression along the layer [Pa], tension negative.
double layer_stress(const Scene &scene, const continuum::Vector &displacement)
{
  double force = 0., area = 0.;
  for (const auto &cell : scene.solid->cell_states(displacement))
    if (cell.material == layer_material_id)
    {
      force -= cell.stress[0] * cell.area;
      area += cell.area;
    }
  return dealii::Utilities::MPI::sum(force, scene.communicator()) /
         dealii::Utilities::MPI::sum(area, scene.communicator());
}

/// Half waves of a shape: changes of sign, from column to column, of what the layer moves
/// across. Columns that hardly move do not count.
unsigned int half_waves(const Scene &scene, const continuum::Vector &shape)
{
  const continuum::ElasticSolid &solid = *scene.solid;
  const SectionGeometry &g = scene.geometry;
  std::vector<double> across(g.n_columns());
  std::vector<dealii::types::global_dof_index> dofs(solid.fe().n_dofs_per_cell());
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned() && cell->material_id() == layer_material_id)
    {
      const double column =
          std::floor((cell->center()[0] - g.x_min()) / g.length() * g.n_columns());
      cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < dofs.size(); ++i)
        if (solid.fe().system_to_component_index(i).first == 1)
          across[static_cast<std::size_t>(column)] += shape(dofs[i]);
    }
  dealii::Utilities::MPI::sum(across, scene.communicator(), across);
  double mean = 0., largest = 0., last = 0.; // a bare layer is held at one corner
  for (const double u : across)
    mean += u / static_cast<double>(across.size());
  for (double &u : across)
  {
    u -= mean;
    largest = std::max(largest, std::abs(u));
  }
  unsigned int n = 0;
  for (const double u : across)
    if (std::abs(u) > 1e-3 * largest)
    {
      n += last * u < 0. ? 1 : 0;
      last = u;
    }
  return n;
}

struct Mode
{
  double shortening;       ///< [-]
  double stress;           ///< of the layer [Pa]
  unsigned int half_waves; ///< along the section
};

/// Wavelength of the least load in a section without end: minimum of a m^2 + b + c / m (a
/// beam on a matrix) through the lowest mode and its two neighbours in number of half
/// waves; the lowest mode's own where these are not among the modes [m].
double dominant_wavelength(const std::vector<Mode> &modes, const double length)
{
  const Mode &lowest = modes.front();
  const double n = lowest.half_waves;
  const Mode *below = nullptr, *above = nullptr;
  for (const Mode &mode : modes)
  {
    if (mode.half_waves + 1 == lowest.half_waves && below == nullptr)
      below = &mode;
    if (mode.half_waves == lowest.half_waves + 1 && above == nullptr)
      above = &mode;
  }
  if (n == 0.)
    return 0.;
  if (n < 2. || below == nullptr || above == nullptr)
    return 2. * length / n;
  // Slopes between the three: a (m1 + m2) - c / (m1 m2).
  const double left = lowest.stress - below->stress,
               right = above->stress - lowest.stress;
  const double a = (right * (n + 1.) - left * (n - 1.)) /
                   ((2. * n + 1.) * (n + 1.) - (2. * n - 1.) * (n - 1.));
  const double c = (a * (2. * n - 1.) - left) * n * (n - 1.);
  return 2. * length / std::cbrt(c / (2. * a));
}

/// What a reader should know before he believes the figures.
std::vector<std::string>
doubts(const Scene &scene, const std::vector<Mode> &modes, const int wanted)
{
  std::vector<std::string> texts;
  char text[240];
  const Mode &lowest = modes.front();
  const double columns = scene.geometry.n_columns();
  if (lowest.half_waves == 0 || columns < 6. * lowest.half_waves)
  {
    std::snprintf(text, sizeof text,
                  "%.3g columns of cells a half wave: too few for a load to trust. Give "
                  "'Matrix/Cell aspect ratio' less, for 8 or more",
                  lowest.half_waves == 0 ? columns : columns / lowest.half_waves);
    texts.push_back(text);
  }
  if (lowest.half_waves < 3 && scene.parameters.has("matrix"))
    texts.push_back("the section holds " + std::to_string(lowest.half_waves) +
                    " half waves only: its length decides how long they are. Give "
                    "'Layer/Length ratio' more");
  if (lowest.shortening > 0.02)
  {
    std::snprintf(text, sizeof text,
                  "buckling at a shortening of %.2g: the linear theory, of small strain "
                  "before it, is off by as much and more",
                  lowest.shortening);
    texts.push_back(text);
  }
  if (static_cast<int>(modes.size()) < wanted)
    texts.push_back(std::to_string(modes.size()) + " of " + std::to_string(wanted) +
                    " modes found");
  return texts;
}

/// The closed form for the same scene, if it has one.
std::optional<continuum::theory::CriticalState> theory_of(const Parameters &p)
{
  if (!p.has("matrix") || p.has("beds"))
    return std::nullopt;
  continuum::theory::SupportedLayer layer{layer_of(p), matrix_sides(p)};
  layer.bonded = p.matrix.interface == "cemented";
  return layer.critical();
}

std::string percent(const double ratio)
{
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f %%", 100. * (ratio - 1.));
  return text;
}

/// Shapes as field files, and the table of loads.
void write_modes(const Scene &scene,
                 const std::vector<continuum::BucklingMode> &shapes,
                 const std::vector<Mode> &modes,
                 const std::string &directory)
{
  const bool first = dealii::Utilities::MPI::this_mpi_process(scene.communicator()) == 0;
  std::optional<coupling::Table> table;
  if (first)
    table.emplace(directory + "/modes.csv",
                  std::vector<std::string>{"mode", "shortening", "layer_stress_Pa",
                                           "half_waves", "wavelength_m"});
  std::vector<coupling::PvdEntry> fields;
  for (std::size_t k = 0; k < modes.size(); ++k)
  {
    const double n = modes[k].half_waves;
    if (first)
      table->append(std::vector<double>{k + 1., modes[k].shortening, modes[k].stress, n,
                                        n > 0. ? 2. * scene.geometry.length() / n : 0.});
    char file[64];
    std::snprintf(file, sizeof file, "fields/mode_%04zu.vtu", k + 1);
    coupling::write_mesh_vtu(directory + "/" + file, *scene.solid, shapes[k].shape);
    fields.push_back({k + 1., "continuum", file});
  }
  if (first)
    coupling::write_pvd(directory + "/fields.pvd", fields);
}

/// Loads and shapes of the scene's straight section. Throws BucklingStopped.
std::vector<Mode> find_modes(const Scene &scene,
                             const std::function<bool()> &stop,
                             std::vector<continuum::BucklingMode> &shapes)
{
  const Parameters &p = scene.parameters;
  const continuum::ElasticSolid &solid = *scene.solid;
  constexpr double shortening = 1e-6; // any: linear
  const std::vector<continuum::Tie> ties =
      p.has("matrix") && p.matrix.interface == "sliding"
          ? continuum::sliding_interfaces(solid)
          : std::vector<continuum::Tie>();
  const continuum::DofReduction reduction(
      solid, section_supports(p, scene.geometry, solid, shortening), ties);
  const continuum::Vector straight =
      continuum::solve_reduced(solid, reduction, solid.make_vector());
  const double stress = layer_stress(scene, straight);
  shapes = continuum::lowest_buckling_modes(
      solid, solid.geometric_stiffness(straight), reduction,
      {static_cast<unsigned int>(p.run.modes), 1e-9, 200, stop});
  std::vector<Mode> modes;
  for (const continuum::BucklingMode &shape : shapes)
    modes.push_back({shape.load_factor * shortening, shape.load_factor * stress,
                     half_waves(scene, shape.shape)});
  return modes;
}

void log_modes(const std::vector<Mode> &modes, RunLog &log)
{
  for (std::size_t k = 0; k < modes.size(); ++k)
  {
    char row[128];
    std::snprintf(row, sizeof row,
                  "  mode %2zu: shortening %.5e, layer stress %.5e Pa, %u half waves",
                  k + 1, modes[k].shortening, modes[k].stress, modes[k].half_waves);
    log.line(row);
  }
}

/// The summary's results, and in words what they are against the closed form.
std::string compare(const Scene &scene,
                    const std::vector<Mode> &modes,
                    std::map<std::string, Result> &results)
{
  const Mode &lowest = modes.front();
  const double wavelength = dominant_wavelength(modes, scene.geometry.length());
  results = {{"critical_stress", {lowest.stress, "Pa"}},
             {"critical_shortening", {lowest.shortening, "-"}},
             {"half_waves", {static_cast<double>(lowest.half_waves), "-"}},
             {"dominant_wavelength", {wavelength, "m"}}};
  char text[128];
  std::snprintf(text, sizeof text, "the layer buckles at %.4g Pa, wavelength %.4g m",
                lowest.stress, wavelength);
  const auto theory = theory_of(scene.parameters);
  if (!theory)
    return text;
  results["theory_stress"] = {theory->stress, "Pa"};
  results["theory_wavelength"] = {theory->wavelength, "m"};
  return std::string(text) + " (closed form of a long layer: stress " +
         percent(lowest.stress / theory->stress) + ", wavelength " +
         percent(wavelength / theory->wavelength) + ")";
}
} // namespace

int run_buckling(const Parameters &p,
                 const RunOptions &options,
                 RunLog &log,
                 const MPI_Comm communicator)
{
  const auto begin = std::chrono::steady_clock::now();
  catch_interrupts();
  const std::unique_ptr<Scene> scene =
      build(p, communicator, [&](const std::string &what) { log.line("  " + what); });
  continuum::ElasticSolid &solid = *scene->solid;
  if (p.has("foundation"))
    solid.add_to_stiffness(continuum::winkler_foundation(
        solid, {continuum::boundary::bottom},
        p.foundation.stiffness_ratio * p.matrix_modulus() / p.layer.thickness));

  log.line("  " + std::to_string(solid.dof_handler().n_dofs()) +
           " dofs: straight section, then modes");
  std::vector<continuum::BucklingMode> shapes;
  std::vector<Mode> modes;
  std::string status = "completed", words;
  try
  {
    modes = find_modes(
        *scene, [&] { return must_stop(begin, options.time_limit, communicator); },
        shapes);
  }
  catch (const continuum::BucklingStopped &)
  {
    status = "interrupted";
    words = "a buckling run keeps no checkpoint, run it again";
  }

  Summary summary = summary_of_solid(p, solid, begin);
  summary.status = status;
  summary.solves = 2; // straight section, and one factor for all modes
  if (status == "completed")
  {
    write_modes(*scene, shapes, modes, options.output);
    words = compare(*scene, modes, summary.results);
    summary.warnings = doubts(*scene, modes, p.run.modes);
    log_modes(modes, log);
  }
  summarise_effects(p, summary.solves, summary);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    write_summary(options.output + "/summary.json", summary);
  for (const std::string &warning : summary.warnings)
    log.line("warning: " + warning);
  log.line(status + ": " + words);
  return status == "completed" ? 0 : 3;
}
} // namespace antiform::cases

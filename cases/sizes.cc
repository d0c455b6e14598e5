#include "cases/sizes.h"

#include "cases/mesh_strips.h"

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace antiform::cases
{
namespace
{
// Grains per d^2: solid fraction 0.845 over pi/4 <d^2>/<d>^2 (radius ratio 1.66: 1.02).
constexpr double grains_per_square_diameter = 0.845 / (0.25 * M_PI * 1.02);

double height_of_grains(const Parameters &p, const SectionGeometry &g)
{
  if (!p.has("matrix"))
    return g.thickness();
  if (p.matrix.representation == "grains")
    return g.surface() - g.base();
  if (p.has_surface_interface())
    return g.thickness();
  const double beside = (p.bridging.overlap + p.bridging.buffer) * g.diameter();
  const double layer = g.thickness(), cover = p.matrix.burial_depth_ratio * layer;
  // The bent axis takes half of its amplitude from a cover that is flat above.
  const double mean_axis = 0.5 * g.amplitude() * g.wavelength() / g.length();
  return layer + std::min(p.matrix.base_depth_ratio * layer, beside) +
         (p.has_grain_cover() ? cover + g.amplitude() - mean_axis
                              : std::min(cover, beside));
}

/// Half of the bonds of a grain: as the deck wants it, or by the gap that is bonded. A
/// jammed packing's 4.2 without any gap, measured 5.2 at 0.3 mean radii, 6 at most.
double joints_per_grain(const LayerParameters &layer)
{
  const double coordination = layer.coordination_number > 0.
                                  ? layer.coordination_number
                                  : std::min(6., 4.2 + 3.3 * layer.installation_gap);
  return 0.5 * coordination;
}

double rows_of_cells(const Parameters &p, const SectionGeometry &g)
{
  const double cell = p.matrix.cell_size * g.diameter();
  const double rows_at_most = (g.surface() - g.base()) / cell;
  if (rows_at_most > 1e5) // beyond any machine: no need to lay them out
    return rows_at_most;
  double rows = 0.;
  for (const continuum::Strip &strip : mesh_strips(p, g))
    rows += static_cast<double>(strip.rows.size()) - 1.;
  return rows;
}

/// Two for each vertex in the overlap above and below, or for each grain there.
double predict_multipliers(const Parameters &p, const SectionGeometry &g)
{
  if (p.has_surface_tie())
    return 2. * 2. * (g.n_columns() + 1.);
  if (!p.is_bridged())
    return 0.;
  if (p.bridging.multipliers == "per grain")
    return 2. * 2. * p.bridging.overlap * grains_per_square_diameter * g.length() /
           g.diameter();
  const double cell = p.bridging.multipliers == "coarsened"
                          ? std::max(2., p.matrix.cell_size)
                          : p.matrix.cell_size;
  const double finer = p.matrix.cell_size / cell;
  return 2. * 2. * (g.n_columns() * finer + 1.) *
         (std::round(p.bridging.overlap / cell) + 1.);
}

// Of a grain with its joints, of which a part is broken: measured on 15,000 and 28,000.
constexpr double bytes_per_grain = 2e3, bytes_per_grain_factored = 2.4e3;
constexpr double bytes_per_dof = 2e3;

/// Buckling keeps factors: 3.7 to 4.9 kB of finite elements, on 15,000 to 140,000 dofs.
constexpr double bytes_per_dof_solved = 4e3;

/// Buckling of grains: factors of the saddle point, four or five of them, measured on 700
/// to 15,000 grains. Two dofs of the mesh cost what two of a grain's three do.
constexpr double bytes_per_grain_solved = 2.5e4;

/// Buffers of libraries, of the output and its tables; measured on small scenes.
constexpr double bytes_of_any_scene = 12e6;

double predict_memory(const Parameters &p, const Sizes &sizes)
{
  const double alone = program_memory + bytes_of_any_scene;
  if (p.run.driver == "buckling" && p.layer.representation == "grains")
    return bytes_per_grain_solved * (sizes.grains + sizes.dofs / 3.) + alone;
  // A supernodal factor of bonded grains takes 2.4 GB for a million: of the tile, of
  // events, of the balance under loads that the section was laid down under.
  double factored = sizes.tile_grains;
  if (p.follows_events() || p.has("gravity") || p.has("surface pressure"))
    factored += sizes.grains;
  const double per_dof =
      p.run.driver == "buckling" ? bytes_per_dof_solved : bytes_per_dof;
  return bytes_per_grain * (sizes.grains + sizes.tile_grains) +
         bytes_per_grain_factored * factored + per_dof * sizes.dofs + alone;
}
} // namespace

double largest_mesh(const Parameters &p)
{
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGESIZE));
  return 0.5 * memory /
         (bytes_per_dof * 2. * p.matrix.element_degree * p.matrix.element_degree);
}

// All cells, or those few that hold a share of the error: of 0.8 by 1.2 to 1.5, measured
// on cases/burial-depth.
double growth_by_refinement(const Parameters &p)
{
  return p.matrix.refinement_rounds > 0
             ? 1. + 3. * std::pow(p.matrix.refinement_share, 8.)
             : 1.;
}

Sizes predict_sizes(const Parameters &p, const SectionGeometry &g)
{
  Sizes sizes;
  const double d = g.diameter();
  if (p.layer.representation == "grains")
  {
    const double per_height = grains_per_square_diameter * g.length() / (d * d);
    sizes.layer_grains = g.thickness() * per_height;
    sizes.grains = height_of_grains(p, g) * per_height;
    sizes.joints = joints_per_grain(p.layer) * sizes.grains;
    if (p.has("matrix") && !p.has_surface_interface())
      sizes.tile_grains =
          grains_per_square_diameter * p.matrix.tile_size * p.matrix.tile_size;
  }
  if (p.layer.representation == "continuum" || p.joins_grains_and_mesh())
  {
    const double degree = p.matrix.element_degree;
    sizes.columns = g.n_columns();
    sizes.rows = rows_of_cells(p, g);
    sizes.cells = sizes.columns * sizes.rows;
    // A bridged mesh has two edges more, where it ends in the overlap.
    const double edges = p.joins_grains_and_mesh() ? 2. : 1.;
    sizes.dofs =
        2. * (degree * sizes.columns + 1.) * (degree * sizes.rows + edges);
    if (p.run.driver == "buckling")
    {
      const double growth =
          std::pow(growth_by_refinement(p), p.matrix.refinement_rounds);
      sizes.cells *= growth;
      sizes.dofs *= growth;
    }
    sizes.multipliers = predict_multipliers(p, g);
  }
  sizes.memory = predict_memory(p, sizes);
  return sizes;
}
} // namespace antiform::cases

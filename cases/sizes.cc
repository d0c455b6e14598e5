#include "cases/sizes.h"

#include "cases/mechanism.h"
#include "cases/mesh_strips.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
namespace
{
// Speed of one core, from tests/benchmark and whole runs; predictions hold within a
// factor of two or so on a machine of the same years.
constexpr double grain_steps_per_second = 9e6;
constexpr double dof_steps_per_second = 18e6;

// Grains per d^2: solid fraction 0.845 over pi/4 <d^2>/<d>^2 (radius ratio 1.66: 1.02).
constexpr double grains_per_square_diameter = 0.845 / (0.25 * M_PI * 1.02);
constexpr double joints_per_grain = 2.5;

double height_of_grains(const Parameters &p, const SectionGeometry &g)
{
  if (!p.has("matrix"))
    return g.thickness();
  if (p.matrix.representation == "grains")
    return g.surface() - g.base();
  const double beside = (p.bridging.overlap + p.bridging.buffer) * g.diameter();
  return g.thickness() + std::min(p.matrix.burial_depth_ratio * g.thickness(), beside) +
         std::min(p.matrix.base_depth_ratio * g.thickness(), beside);
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

/// At which a run ends, roughly [-].
double predict_shortening(const Parameters &p, const SectionGeometry &g)
{
  if (p.run.end_shortening > 0.)
    return p.run.end_shortening;
  if (p.confinement() != nullptr) // goes on well beyond the strain that breaks it bare
    return std::min(5e-3, p.run.longest_shortening);
  const double crushing = p.layer.compressive_strength / p.layer.young_modulus;
  // Rocks break in tension at a tenth of the strain; a bent layer folds, if it can.
  const double share = p.walls.action == "pull" ? 0.1
                       : g.amplitude() > 0. ? expect_mechanism(p, g).relative_strength()
                                            : 1.;
  return std::min(p.run.strain_multiple_of_peak * share * crushing,
                  p.run.longest_shortening);
}

double predict_memory(const Parameters &p, const Sizes &sizes)
{
  // Bytes: 600 a grain, 150 a joint; a supernodal factor of the bonded assembly takes
  // 2.4 GB for a million grains; the mesh needs 2000 a degree of freedom.
  const double factor = p.run.driver == "dynamic" ? 0. : 2400.;
  return (sizes.grains + sizes.tile_grains) * (600. + joints_per_grain * 150. + factor) +
         2e3 * sizes.dofs + 120e6;
}
} // namespace

Sizes predict_sizes(const Parameters &p, const SectionGeometry &g)
{
  Sizes sizes;
  const double d = g.diameter();
  if (p.layer.representation == "grains")
  {
    const double per_height = grains_per_square_diameter * g.length() / (d * d);
    sizes.layer_grains = g.thickness() * per_height;
    sizes.grains = height_of_grains(p, g) * per_height;
    sizes.joints = joints_per_grain * sizes.grains;
    if (p.has("matrix"))
      sizes.tile_grains =
          grains_per_square_diameter * p.matrix.tile_size * p.matrix.tile_size;
  }
  if (p.layer.representation == "continuum" || p.is_bridged())
  {
    sizes.cells = g.n_columns() * rows_of_cells(p, g);
    sizes.dofs = 2. * sizes.cells * p.matrix.element_degree * p.matrix.element_degree;
  }
  if (p.has("walls") && p.run.steps_in_time())
  {
    // Steps in which a wave passes a mean grain, of a packing with this spread of sizes.
    const double steps_per_grain =
        1.6 * std::sqrt(1. + (p.has("damping") ? p.damping.coefficient : 0.)) /
        p.run.safety;
    const double transit = steps_per_grain * g.length() / d;
    const double millistrain = 1e3 * predict_shortening(p, g);
    sizes.steps = transit * p.walls.transits_per_millistrain * millistrain;
    if (p.confinement() != nullptr)
      sizes.steps += 2. * transit * p.confinement()->ramp;
    sizes.core_seconds = sizes.steps * (sizes.grains / grain_steps_per_second +
                                        sizes.dofs / dof_steps_per_second);
  }
  sizes.memory = predict_memory(p, sizes);
  return sizes;
}
} // namespace antiform::cases

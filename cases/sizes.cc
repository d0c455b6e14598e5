#include "cases/sizes.h"

#include "cases/mechanism.h"
#include "cases/mesh_strips.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unistd.h>

namespace antiform::cases
{
namespace
{
/// Of walls that step and relax, measured on specimens up to the peak; a collapse takes
/// more.
constexpr double transits_per_load_step = 4.;

// Speed of one core, from tests/benchmark and whole runs; predictions hold within a
// factor of two or so on a machine of the same years.
constexpr double grain_steps_per_second = 9e6;
constexpr double dof_steps_per_second = 18e6;
/// Of the event driver through the peak, over the number of grains to the power 3/2.
constexpr double seconds_of_events = 6e-5;

// Grains per d^2: solid fraction 0.845 over pi/4 <d^2>/<d>^2 (radius ratio 1.66: 1.02).
constexpr double grains_per_square_diameter = 0.845 / (0.25 * M_PI * 1.02);
constexpr double joints_per_grain = 2.5;

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

/// Modulus of one layer of one rock that bends like the beds: as one when cemented, each
/// on its own when they slide [Pa].
double bending_modulus(const Parameters &p)
{
  const bool slide = p.has("beds") && p.beds.interface == "frictional";
  double stretching = 0., moment = 0., bending = 0., below = 0.;
  for (int bed = 0; bed < p.n_beds(); ++bed)
  {
    const double modulus = p.bed(bed).young_modulus, share = p.bed_share(bed);
    const double lever = slide ? 0. : below + 0.5 * share;
    stretching += modulus * share;
    moment += modulus * share * lever;
    bending += modulus * share * (share * share / 12. + lever * lever);
    below += share;
  }
  return 12. * (bending - moment * moment / stretching);
}

/// Strain at which a layer or specimen fails, roughly [-].
double predict_strain_at_peak(const Parameters &p, const SectionGeometry &g)
{
  // Between platens all beds have one strain, and the weakest breaks first; in tension at
  // three quarters of its bonds' strength, as specimens of rock 1 do.
  double crushing = std::numeric_limits<double>::infinity(), parting = crushing,
         thickest = 0.;
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &bed = p.bed(k);
    crushing = std::min(crushing, bed.compressive_strength / bed.young_modulus);
    parting = std::min(parting, 0.75 * discrete::constants(bed.law()).tensile_strength /
                                    bed.young_modulus);
    thickest = std::max(thickest, p.bed_share(k) * g.thickness());
  }
  if (p.walls.action == "pull")
    return parting;
  if (g.amplitude() == 0.)
    return crushing;
  // A bent layer folds, if it can; or a force N and its moment N a0/2, which alone crush
  // at N_0 and N_0 h/4, crush it together.
  Parameters one = p;
  one.layer.young_modulus = bending_modulus(p);
  one.layer.compressive_strength = crushing * p.young_modulus();
  const bool slide = p.has("beds") && p.beds.interface == "frictional";
  const double h = slide ? thickest : g.thickness();
  return crushing *
         std::min(expect_mechanism(one, g).pinned, 1. / (1. + 2. * g.amplitude() / h));
}

/// At which a run ends, roughly [-].
double predict_shortening(const Parameters &p, const SectionGeometry &g)
{
  if (p.run.end_shortening > 0.)
    return p.run.end_shortening;
  if (p.confinement() != nullptr) // goes on well beyond the strain that breaks it bare
    return std::min(5e-3, p.run.longest_shortening);
  // The stress falls to its share somewhere on the way to the multiple.
  const double multiple = p.run.stress_ratio_of_peak > 0.
                              ? 0.5 * (1. + p.run.strain_multiple_of_peak)
                              : p.run.strain_multiple_of_peak;
  return std::min(multiple * predict_strain_at_peak(p, g), p.run.longest_shortening);
}

/// By how much a round of refinement grows the mesh, roughly: all cells, or those few
/// that hold a share of the error (0.8: by 1.3 to 2.0, measured).
double growth_by_refinement(const Parameters &p)
{
  return p.matrix.refinement_rounds > 0
             ? 1. + 3. * std::pow(p.matrix.refinement_share, 6.)
             : 1.;
}

constexpr double bytes_per_dof = 2e3;

/// Buckling of grains: factors of the saddle point, four or five of them, measured on 700
/// to 15,000 grains. Two dofs of the mesh cost what two of a grain's three do.
constexpr double seconds_per_grain_solved = 4e-4, bytes_per_grain_solved = 2.5e4;

double grains_solved(const Sizes &sizes)
{
  return sizes.grains + sizes.dofs / 3.;
}

/// Of the implicit drivers: direct factors of plane meshes and what is done with them,
/// measured on meshes of 5e3 to 2e5 dofs [s].
double predict_solves(const Parameters &p, const Sizes &sizes)
{
  const double dofs = sizes.dofs;
  if (p.run.driver == "buckling" && p.layer.representation == "grains")
    return 0.5 + seconds_per_grain_solved * grains_solved(sizes);
  if (p.run.driver == "buckling")
  {
    const double growth = growth_by_refinement(p), n = p.matrix.refinement_rounds + 1.;
    // dofs are those of the last round.
    const double all =
        growth > 1. ? dofs * (1. - std::pow(growth, -n)) / (1. - 1. / growth) : dofs;
    return 0.5 + all * (8e-5 + 1.5e-5 * (p.run.modes - 1.));
  }
  const double steps = p.has("walls") ? p.run.load_steps : 1.;
  return p.is_nonlinear() ? 0.2 + 3. * steps * 5e-5 * dofs
                          : 0.2 + dofs * (4e-5 + 2e-5 * steps);
}

double predict_memory(const Parameters &p, const Sizes &sizes)
{
  if (p.run.driver == "buckling" && p.layer.representation == "grains")
    return bytes_per_grain_solved * grains_solved(sizes) + 120e6;
  // Bytes: 600 a grain, 150 a joint; a supernodal factor of the bonded assembly takes
  // 2.4 GB for a million grains; the mesh needs 2000 a degree of freedom.
  const double factor = p.run.driver == "dynamic" ? 0. : 2400.;
  return (sizes.grains + sizes.tile_grains) * (600. + joints_per_grain * 150. + factor) +
         bytes_per_dof * sizes.dofs + 120e6;
}
} // namespace

double largest_mesh(const Parameters &p)
{
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGESIZE));
  return 0.5 * memory /
         (bytes_per_dof * 2. * p.matrix.element_degree * p.matrix.element_degree);
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
    sizes.joints = joints_per_grain * sizes.grains;
    if (p.has("matrix") && !p.has_surface_interface())
      sizes.tile_grains =
          grains_per_square_diameter * p.matrix.tile_size * p.matrix.tile_size;
  }
  if (p.layer.representation == "continuum" || p.joins_grains_and_mesh())
  {
    sizes.cells = g.n_columns() * rows_of_cells(p, g);
    if (p.run.driver == "buckling")
      sizes.cells *= std::pow(growth_by_refinement(p), p.matrix.refinement_rounds);
    sizes.dofs = 2. * sizes.cells * p.matrix.element_degree * p.matrix.element_degree;
  }
  if (p.follows_events())
  {
    sizes.steps = predict_shortening(p, g) / (0.6 * p.walls.load_step);
    sizes.core_seconds = seconds_of_events * std::pow(sizes.grains, 1.5);
  }
  else if (p.has("walls") && p.run.steps_in_time())
  {
    // Steps in which a wave passes a mean grain, of packings with this spread of sizes,
    // measured: scaled to the least step of a matrix, to the mean of a bare layer. Smooth
    // joints count as isotropic springs, which takes another tenth.
    const double undamped =
        (p.has("matrix") ? 1.6 : 1.8) * (p.has_smooth_joints() ? 1.1 : 1.);
    const double steps_per_grain =
        undamped * std::sqrt(1. + (p.has("damping") ? p.damping.coefficient : 0.)) /
        p.run.safety;
    const double transit = steps_per_grain * g.length() / d;
    const double millistrain = 1e3 * predict_shortening(p, g);
    const double transits_per_millistrain =
        p.walls.steps_and_relaxes() ? transits_per_load_step * 1e-3 / p.walls.load_step
                                    : p.walls.transits_per_millistrain;
    sizes.steps = transit * transits_per_millistrain * millistrain;
    if (p.confinement() != nullptr)
      sizes.steps += 2. * transit * p.confinement()->ramp;
    sizes.core_seconds = sizes.steps * (sizes.grains / grain_steps_per_second +
                                        sizes.dofs / dof_steps_per_second);
  }
  else if (!p.run.steps_in_time())
  {
    sizes.steps = p.run.driver == "static" && p.has("walls") ? p.run.load_steps : 1.;
    sizes.core_seconds = predict_solves(p, sizes);
  }
  sizes.memory = predict_memory(p, sizes);
  return sizes;
}
} // namespace antiform::cases

#include "cases/overlap.h"

#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/inertia.h"
#include "cases/scene.h"

#include "coupling/subcycled_mesh.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
using namespace coupling;

BridgingOptions bridging_options(const Scene &scene, const OverlapWeight &weight)
{
  const BridgingParameters &bridging = scene.parameters.bridging;
  const GrainState &state = scene.grains->state;
  BridgingOptions options;
  if (bridging.multipliers == "coarsened")
    options.multipliers = MultiplierSpace::coarsened;
  else if (bridging.multipliers == "per grain")
    options.multipliers = MultiplierSpace::per_grain;
  if (bridging.constraint) // else nothing follows the mesh
    options.tied_grains = unsupported_grains(state.grains, state.joints, weight);
  return options;
}

double overlap_damping_rate(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  if (!scene.bridging || p.bridging.damping == 0.)
    return 0.;
  const MatrixRock &rock = *scene.grains->matrix;
  const auto &C = rock.response.stiffness;
  const double speed = std::sqrt(std::max(C[0][0], C[1][1]) / rock.bulk_density);
  return p.bridging.damping * speed / scene.geometry.diameter();
}

double overlap_damping_factor(const Scene &scene, const double step)
{
  const double z = 0.25 * overlap_damping_rate(scene) * step; // rate / (2 omega)
  return std::sqrt(1. + z * z) - z;
}

std::unique_ptr<MeshMotion> make_mesh_motion(Scene &scene)
{
  const std::int64_t interval =
      scene.bridging ? scene.parameters.bridging.sub_cycles : 1;
  if (interval == 1)
    return std::make_unique<MeshMotion>(*scene.mesh, scene.walls);
  const double dt = scene.simulation->clock().dt, step = mesh_stable_step(scene);
  const auto possible = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(SubcycledMesh::largest_share * step / dt));
  if (interval > possible)
    throw InputError(
        {"'Bridging domain/Sub-cycles' is " + std::to_string(interval) +
         ": the mesh's waves would resonate with impulses that come more seldom than "
         "every 0.3 of its stable step of " +
         short_text(step) + " s, and a step of the grains is " + short_text(dt) +
         " s. Give " + std::to_string(possible) + (possible > 1 ? " or less" : "") +
         ", or larger cells by 'Matrix/Cell size ratio'."});
  return std::make_unique<SubcycledMesh>(*scene.mesh, scene.walls, interval, dt, step);
}
} // namespace antiform::cases

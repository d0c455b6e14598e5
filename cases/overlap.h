#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/mesh_components.h"

#include <memory>

namespace antiform::cases
{
struct Scene;

/// The deck's choices of multipliers, and the grains of the overlap that nothing else
/// holds, which are tied to the mesh. \pre joints have their weights
coupling::BridgingOptions bridging_options(const Scene &scene,
                                           const coupling::OverlapWeight &weight);

/// Rate at which motion relative to the mesh dies out in the overlap; 0: not damped
/// [1/s].
double overlap_damping_rate(const Scene &scene);
/// What that leaves of a stable step @p step [s] without it [-].
double overlap_damping_factor(const Scene &scene, double step);

/// What moves the mesh in every step, or is kicked by its forces every few steps. Throws
/// InputError where these come too seldom.
std::unique_ptr<coupling::MeshMotion> make_mesh_motion(Scene &scene);
} // namespace antiform::cases

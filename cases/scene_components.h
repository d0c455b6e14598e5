#pragma once

#include "coupling/grain_components.h"
#include "coupling/mesh_components.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace antiform::cases
{
struct Scene;

/// What holds the grains of the base: springs of the foundation, or a rigid base
/// (infinity). Empty where the base is no grains.
std::vector<coupling::GrainBase::Support> base_supports(const Scene &scene);

/// Grains of the left and of the right grip.
std::array<std::vector<std::int32_t>, 2> gripped_grains(const Scene &scene);

/// Bonds, contacts and supports of the grains.
void add_grain_components(Scene &scene);
/// Gravity and surface pressure, and the prestress under which they are in equilibrium.
void add_loads(Scene &scene);
void add_foundation(Scene &scene, std::unique_ptr<coupling::MeshFoundation> foundation);
/// Damping, motion, walls and constraint: what both sides share.
void add_common_components(Scene &scene);
} // namespace antiform::cases

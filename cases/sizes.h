#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"

namespace antiform::cases
{
/// Size of a scene, predicted from its geometry; no packing is made. Counts are numbers
/// without unit.
struct Sizes
{
  double layer_grains = 0., grains = 0., joints = 0., cells = 0., dofs = 0.;
  double tile_grains = 0.;        ///< of the matrix tile, which is homogenised
  double columns = 0., rows = 0.; ///< of the mesh, before it is refined
  double multipliers = 0.;        ///< that join grains and mesh
  double memory = 0.;             ///< of the program with its scene [bytes]
};

/// Cells whose mesh would fill half of this machine's memory: refinement ends there.
double largest_mesh(const Parameters &parameters);

/// By how much a round of refinement grows the mesh, roughly [-].
double growth_by_refinement(const Parameters &parameters);

/// Of the program alone, before it has a scene: its libraries [bytes].
constexpr double program_memory = 165e6;

Sizes predict_sizes(const Parameters &parameters, const SectionGeometry &geometry);
} // namespace antiform::cases

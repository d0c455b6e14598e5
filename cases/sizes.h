#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"

namespace antiform::cases
{
/// Size and cost of a scene, predicted from its geometry; no packing is made. Counts are
/// numbers without unit.
struct Sizes
{
  double layer_grains = 0., grains = 0., joints = 0., cells = 0., dofs = 0.;
  double tile_grains = 0.; ///< of the matrix tile, which is homogenised
  double steps = 0.;
  double core_seconds = 0.;
  double memory = 0.; ///< [bytes]
};

/// Cells whose mesh would fill half of this machine's memory: refinement ends there.
double largest_mesh(const Parameters &parameters);

Sizes predict_sizes(const Parameters &parameters, const SectionGeometry &geometry);
} // namespace antiform::cases

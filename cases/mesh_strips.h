#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "continuum/section_mesh.h"

#include <vector>

namespace antiform::cases
{
/// Strips of the mesh from the base up: matrix, layer where it is continuum, cover. They
/// refer to @p geometry.
std::vector<continuum::Strip> mesh_strips(const Parameters &parameters,
                                          const SectionGeometry &geometry);
} // namespace antiform::cases

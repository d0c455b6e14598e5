#pragma once

#include "cases/parameters.h"
#include "continuum/elastic_solid.h"

#include <vector>

namespace antiform::cases
{
/// Elastic matrix and layer of a deck without grains beside the mesh, by material id.
std::vector<continuum::ElasticMaterial> mesh_materials(const Parameters &parameters);
} // namespace antiform::cases

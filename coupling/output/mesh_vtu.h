#pragma once

#include "continuum/elastic_solid.h"
#include "continuum/nonlinear_solid.h"

#include <string>

namespace antiform::coupling
{
/// The mesh as VTU (undeformed, with the displacement to warp by): displacement [m], and
/// per cell stress [Pa] (prestress not included), strain, weight_C. Collective; one file
/// for any number of ranks. Throws std::runtime_error naming the file when it cannot be
/// written.
void write_mesh_vtu(const std::string &path,
                    const continuum::ElasticSolid &solid,
                    const continuum::Vector &displacement);
/// The same of a body of laws: means over the cells of Cauchy's stress (the initial one
/// included), the laws' strain and the equivalent plastic strain.
void write_mesh_vtu(const std::string &path,
                    const continuum::NonlinearSolid &solid,
                    const continuum::Vector &displacement);
} // namespace antiform::coupling

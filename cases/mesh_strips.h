#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "continuum/section_mesh.h"

#include <mpi.h>

#include <memory>
#include <vector>

namespace antiform::cases
{
/// Strips of the mesh from the base up: matrix, layer where it is continuum, cover. They
/// refer to @p geometry.
std::vector<continuum::Strip> mesh_strips(const Parameters &parameters,
                                          const SectionGeometry &geometry);

/// Material ids of the cells.
constexpr unsigned int matrix_material_id = 0, layer_material_id = 1;

/// The section in cells. Collective.
std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> make_mesh(
    const Parameters &parameters, const SectionGeometry &geometry, MPI_Comm communicator);
} // namespace antiform::cases

#pragma once

#include "cases/parameters.h"
#include "continuum/displacement_space.h"
#include "continuum/loads.h"

namespace antiform::cases
{
/// The faces of the section that the deck's foundation carries, and those that let waves
/// out.
continuum::BoundaryIds foundation_faces(const Parameters &parameters);
continuum::BoundaryIds absorbing_faces(const Parameters &parameters);

/// Springs of the deck's foundation on the faces that it carries, of the form of
/// DisplacementSpace::make_matrix() [N/m]. \pre the deck has one. Collective.
dealii::TrilinosWrappers::SparseMatrix
section_foundation(const Parameters &parameters,
                   const continuum::DisplacementSpace &solid);
} // namespace antiform::cases

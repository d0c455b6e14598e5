#pragma once

#include "cases/parameters.h"
#include "continuum/nonlinear_solid.h"

namespace antiform::cases
{
/// Laws of the deck's finite elements by material id (mesh_strips.h).
continuum::NonlinearSolid::Laws solid_laws(const Parameters &parameters);
} // namespace antiform::cases

#pragma once

#include "continuum/dof_reduction.h"

#include <vector>

namespace antiform::continuum
{
/// Smooth contact in both directions of the strips whose faces lie on one another without
/// being joined (section_mesh.h): they keep together across the interface and slide
/// freely along it, without shear (the theory's smooth contact). Nodes of the two faces
/// lie at the same places. Of each pair the upper node's y follows:
///   u_y(upper) = u_y(lower) + n_x / n_y (u_x(lower) - u_x(upper)),
/// n being the mean normal of the faces at the node.
/// \return ties of the upper nodes that this rank owns. Throws std::invalid_argument on
/// all
///         ranks where an inner face has no partner. Collective.
std::vector<Tie> sliding_interfaces(const DisplacementSpace &solid);
} // namespace antiform::continuum

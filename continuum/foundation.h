#pragma once

#include "continuum/displacement_space.h"

#include <set>

namespace antiform::continuum
{
/// Winkler foundation: springs along the normal of the reference boundary, which pull and
/// push with the traction -k_n (u.n) n and carry no shear.
/// \param boundaries       boundary ids of the faces on springs
/// \param normal_stiffness k_n [Pa/m], not below 0
/// \return integral k_n N_a n n^T N_b over those faces [N/m], exact on straight faces; of
///         the form of make_matrix(), for ElasticSolid::add_to_stiffness() or
///         NonlinearSolid::add_springs(). Not weighted by w_C: a bridged body ends before
///         its foundation. Collective.
dealii::TrilinosWrappers::SparseMatrix
winkler_foundation(const DisplacementSpace &solid,
                   const std::set<dealii::types::boundary_id> &boundaries,
                   double normal_stiffness);
} // namespace antiform::continuum

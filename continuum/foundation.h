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

/// Shear layer of a Pasternak foundation (Pasternak 1954; Kerr 1964): a layer along the
/// boundary that resists its slope, with the energy 1/2 integral G_p (n . du/ds)^2 ds.
/// Together with winkler_foundation() of the same faces it is the whole foundation,
/// whose pressure on a flat boundary is k_n w - G_p w''.
///
/// The slope is that of the boundary, n . du/ds: moving a curved boundary as a rigid body
/// strains nothing, turning it by theta costs 1/2 G_p theta^2 per length as on a flat
/// one. (The other reading, d(u.n)/ds, differs by u.t over the radius.) The layer ends
/// with the faces: there nothing holds its force G_p n . du/ds.
/// \param boundaries      boundary ids of the faces on the layer
/// \param shear_stiffness G_p, shear force per slope and metre of thickness [N/m], not
///                        below 0
/// \return integral G_p (n . dN_a/ds)(n . dN_b/ds) over those faces [N/m], as the
///         matrix of winkler_foundation(); both throw std::invalid_argument
dealii::TrilinosWrappers::SparseMatrix
pasternak_foundation(const DisplacementSpace &solid,
                     const std::set<dealii::types::boundary_id> &boundaries,
                     double shear_stiffness);
} // namespace antiform::continuum

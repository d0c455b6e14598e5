#pragma once

#include "continuum/elastic_solid.h"

#include <cstdint>
#include <set>
#include <vector>

namespace antiform::continuum
{
/// Dashpot between a node and the ground: force -C v on the node.
struct NodalDashpot
{
  std::uint32_t dof_x, dof_y; ///< local indices, owned by this rank
  double xx, xy, yy;          ///< C, symmetric and positive [N s/m per metre]
};

/// Quiet boundary of Lysmer & Kuhlemeyer (1969): dashpots that let waves out of far
/// faces, with the traction -Z v. Z = rho (Gamma / rho)^(1/2) is the impedance of plane
/// waves along the normal n in the material of the cell behind the face, Gamma_ik = n_j
/// C_ijkl n_l; of an isotropic one rho c_p along the normal and rho c_s along the face.
///
/// It takes P and S waves along the normal whole, others in part: with a Poisson's ratio
/// of 0.25 it sends back 0.03 % of the energy of P waves 30 degrees off the normal, 4 %
/// at 60, a third at 80, all near 90. Dashpots creep under a load that lasts: where the
/// face bears one (weight, initial stress), give it the reaction as a traction.
/// \param boundaries boundary ids of the faces
/// \return integral of Z over the faces, lumped to their nodes (Gauss-Lobatto points), of
///         this rank's nodes in ascending order; nodes of two faces (corners) have the
///         sum of both. Not weighted by w_C: a bridged body ends outside of its overlap.
/// Throws std::invalid_argument on all ranks where a material behind the faces has no
/// density, or no face has one of these ids. Collective.
std::vector<NodalDashpot>
absorbing_dashpots(const ElasticSolid &solid,
                   const std::set<dealii::types::boundary_id> &boundaries);
} // namespace antiform::continuum

#pragma once

#include "coupling/static_system.h"

namespace antiform::coupling
{
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Strain to which the stress of the mesh belongs when it turns and stretches: it decides
/// by how much the tangent differs from the small-strain one, to first order in stress.
enum class StrainMeasure
{
  /// Green's, S = C E: integral w_C S : grad u^T grad u, as continuum/linear_buckling.
  green,
  /// Biot's, U - 1, which is what corotated joints of grains answer to: less the part
  /// integral w_C S : e e, with e the symmetric part of grad u.
  biot
};

/// Geometric stiffness, by the unknowns of @p system [N/m], of the forces that the linear
/// static state @p prestress makes in the joints, where they were installed, and in the
/// weighted mesh. Symmetric; linear in the prestress. Forces of springs do not turn, nor
/// do multipliers: the constraint is linear.
/// Throws std::invalid_argument where a joint is damaged.
SparseMatrix geometric_stiffness(const StaticSystem &system,
                                 const StaticSolution &prestress,
                                 StrainMeasure measure = StrainMeasure::biot);

/// What to add to the system's stiffness for the tangent at the present state: of the
/// joints exactly, at the displacements of the system's grains (the derivative of the
/// kernel's forces), of the mesh to first order in the stress of @p mesh_displacement
/// (ghosts set; null: the mesh has none, as in a run, where its strain is small).
/// Damaged joints: as discrete::tangent_stiffness(), what is closed sticks.
/// \param kept_share of its intact stiffness that a damaged joint keeps, so that loose
///                   fragments do not make the section singular; 0: nothing [-]
SparseMatrix present_geometric_stiffness(const StaticSystem &system,
                                         const continuum::Vector *mesh_displacement,
                                         StrainMeasure measure = StrainMeasure::biot,
                                         double kept_share = 0.);
} // namespace antiform::coupling

#pragma once

#include "continuum/dof_reduction.h"

#include <vector>

namespace antiform::continuum
{
/// A shape in which a loaded body is in equilibrium beside the straight one.
struct BucklingMode
{
  double load_factor; ///< of the prestress, > 0 [-]
  Vector shape;       ///< largest displacement 1; ghosts are set
};

struct BucklingOptions
{
  unsigned int n_modes = 4;
  double tolerance = 1e-8; ///< residual over the eigenvalue
  unsigned int max_restarts = 200;
};

/// Lowest positive load factors of (K + factor G) u = 0 and their shapes: linear buckling
/// of a body whose prestress grows in proportion. Krylov-Schur (Anasazi), twice: roughly
/// on -K^-1 G, then shifted to just below the lowest load so found, in the inner product
/// of K. \param geometric G, geometric stiffness of the prestress at factor 1 \param
/// reduction supports and ties; prescribed displacements count as 0 \return ascending, at
/// most n_modes; fewer where there are not so many Throws NumericalError on all ranks
/// where K is singular, where the eigenvalues do not converge, and where no factor above
/// 0 exists (nothing is in compression). Collective.
std::vector<BucklingMode>
lowest_buckling_modes(const ElasticSolid &solid,
                      const dealii::TrilinosWrappers::SparseMatrix &geometric,
                      const DofReduction &reduction,
                      const BucklingOptions &options);
} // namespace antiform::continuum

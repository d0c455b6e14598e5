#pragma once

#include "continuum/dof_reduction.h"

#include <functional>
#include <stdexcept>
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
  std::function<bool()> stop =
      {}; ///< asked between solves, alike on all ranks; may be empty
};

/// Thrown on all ranks where BucklingOptions::stop said so.
struct BucklingStopped : std::runtime_error
{
  BucklingStopped()
      : std::runtime_error("linear buckling: stopped")
  {
  }
};

/// Lowest positive load factors of (K + factor G) u = 0 and their shapes: linear buckling
/// of a body whose prestress grows in proportion. Krylov-Schur (Anasazi), twice: roughly
/// on -K^-1 G, then shifted to just below the lowest load so found, in the inner product
/// of K.
/// \param geometric G, geometric stiffness of the prestress at factor 1
/// \param reduction supports and ties; prescribed displacements count as 0
/// \return ascending, at most n_modes; fewer where there are not so many, or where some
///         did not converge
/// Throws NumericalError on all ranks where K is singular, where no eigenvalue converges,
/// and where no factor above 0 exists (nothing is in compression). Collective.
std::vector<BucklingMode>
lowest_buckling_modes(const ElasticSolid &solid,
                      const dealii::TrilinosWrappers::SparseMatrix &geometric,
                      const DofReduction &reduction,
                      const BucklingOptions &options);
} // namespace antiform::continuum

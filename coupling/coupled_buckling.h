#pragma once

#include "coupling/geometric_stiffness.h"
#include "coupling/static_system.h"

#include <functional>
#include <vector>

namespace antiform::coupling
{
/// A shape in which a loaded section is in equilibrium beside the one it has.
struct CoupledMode
{
  double load_factor;   ///< of the prestress, > 0 [-]
  StaticSolution shape; ///< largest displacement 1; keeps the constraint and supports
  double residual; ///< energy norm of (1 + factor K^-1 G) shape over that of the shape
  double gap;      ///< largest displacement gap |C shape| [-]
};

struct CoupledBucklingOptions
{
  unsigned int n_modes = 2;
  double tolerance = 1e-8; ///< residual over the eigenvalue
  unsigned int max_restarts = 200;
  /// Asked before every solve; true ends the search by continuum::BucklingStopped.
  std::function<bool()> stop = {};
};

/// Lowest positive load factors of (K + factor G) u = 0 on the displacements that keep
/// the bridging constraint C u = 0 and the supports of @p system, and their shapes.
/// Krylov-Schur (Anasazi) on saddle-point solves (MUMPS), shifted to just below the
/// lowest load, in the inner product of K; a few steps of Lanczos on -K^-1 G tell where
/// that is. The inertia of one more factor proves that no lower one was missed.
/// \param geometric G at factor 1, symmetric: geometric_stiffness()
/// \return ascending, at most n_modes
/// Throws NumericalError where K is singular, where nothing converges, where a lower mode
/// is missing, and where no factor above 0 exists.
std::vector<CoupledMode> lowest_coupled_modes(const StaticSystem &system,
                                              const SparseMatrix &geometric,
                                              const CoupledBucklingOptions &options = {});

/// Number of independent directions, constraint and supports kept, in which the section
/// is unstable: negative eigenvalues of K + factor G there, by the inertia of the saddle
/// point less its multipliers. With G of a prestress that grows in proportion: the number
/// of load factors below @p factor. With present_geometric_stiffness() and factor 1: the
/// stability of the present state; 0 is stable.
/// Throws NumericalError where the matrix is singular to round-off: at a critical load,
/// or a part is loose.
int n_unstable_directions(const StaticSystem &system,
                          const SparseMatrix &geometric,
                          double factor = 1.);
} // namespace antiform::coupling

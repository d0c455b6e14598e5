#pragma once

#include "continuum/displacement_space.h"

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>

namespace antiform::continuum
{
/// Factor of a matrix that does not change, which may be indefinite: KLU for small
/// problems on one rank, else MUMPS.
class DirectSolver
{
public:
  /// Factors @p matrix, of which it keeps no reference. Throws NumericalError on all
  /// ranks where it is singular. Collective, as solve().
  explicit DirectSolver(const dealii::TrilinosWrappers::SparseMatrix &matrix);

  /// Throws NumericalError where the factor breaks down; whether the equations hold, the
  /// caller asks.
  void solve(const Vector &rhs, Vector &solution) const;

  /// \param value backward error or not a number, \param limit of it
  [[noreturn]] static void refuse_singular(double value, double limit);

private:
  mutable dealii::SolverControl control_;
  mutable dealii::TrilinosWrappers::SolverDirect solver_;
};
} // namespace antiform::continuum

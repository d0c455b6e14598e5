#include "continuum/direct_solver.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <limits>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
// KLU, which works on one rank, beats MUMPS below about this size and loses above it.
constexpr types::global_dof_index largest_klu_problem = 20000;

const char *solver_name(const TrilinosWrappers::SparseMatrix &matrix)
{
  const bool alone = Utilities::MPI::n_mpi_processes(matrix.get_mpi_communicator()) == 1;
  return alone && matrix.m() <= largest_klu_problem ? "Amesos_Klu" : "Amesos_Mumps";
}
} // namespace

DirectSolver::DirectSolver(const TrilinosWrappers::SparseMatrix &matrix)
    : solver_(control_,
              TrilinosWrappers::SolverDirect::AdditionalData(false, solver_name(matrix)))
{
  try
  {
    solver_.initialize(matrix);
  }
  catch (const ExceptionBase &)
  {
    refuse_singular(std::numeric_limits<double>::quiet_NaN(), 0.);
  }
}

void DirectSolver::solve(const Vector &rhs, Vector &solution) const
{
  try
  {
    solver_.solve(solution, rhs);
  }
  catch (const ExceptionBase &)
  {
    refuse_singular(std::numeric_limits<double>::quiet_NaN(), 0.);
  }
}

void DirectSolver::refuse_singular(const double value, const double limit)
{
  throw NumericalError("static solver",
                       "the equations have no solution; is a part of the body without "
                       "support, or the load at the buckling load? Backward error",
                       value, limit);
}
} // namespace antiform::continuum

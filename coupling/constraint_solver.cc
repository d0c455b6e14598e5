#include "coupling/constraint_solver.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <Eigen/SparseCholesky>

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>
#include <Epetra_SerialComm.h>

#include <algorithm>
#include <cstdint>
#include <functional>

namespace antiform::coupling
{
/// One connected part of S with everything that a solve touches, so that parts share
/// nothing and may be solved at the same time.
struct ConstraintSolver::Part
{
  std::vector<int> rows; ///< of the whole system
  Epetra_SerialComm comm;
  std::unique_ptr<Epetra_Map> map;
  std::unique_ptr<Epetra_CrsMatrix> matrix;
  std::unique_ptr<Epetra_MultiVector> right, left;
  std::unique_ptr<Epetra_LinearProblem> problem;
  std::unique_ptr<Amesos_BaseSolver> solver;
};

namespace
{
/// Rows of each connected part, ascending.
std::vector<std::vector<int>> connected_parts(const Eigen::SparseMatrix<double> &matrix)
{
  const int n = static_cast<int>(matrix.rows());
  std::vector<int> part(n, -1);
  std::vector<std::vector<int>> parts;
  for (int seed = 0; seed < n; ++seed)
  {
    if (part[seed] >= 0)
      continue;
    std::vector<int> open{seed};
    part[seed] = static_cast<int>(parts.size());
    while (!open.empty())
    {
      const int row = open.back();
      open.pop_back();
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, row); it; ++it)
        if (it.value() != 0. && part[it.row()] < 0)
        {
          part[it.row()] = part[seed];
          open.push_back(static_cast<int>(it.row()));
        }
    }
    parts.emplace_back();
  }
  for (int row = 0; row < n; ++row)
    parts[part[row]].push_back(row);
  return parts;
}

struct Pivot
{
  Eigen::Index row = 0;
  double ratio = 0.; ///< to the mean; not positive without factors
};

/// The smallest pivot.
Pivot least_pivot(const Eigen::SparseMatrix<double> &matrix)
{
  // The shift, far below the limit, keeps a pivot from being exactly 0, which would end
  // the factorisation before the other pivots are known.
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  factor.setShift(1e-13 * matrix.diagonal().mean());
  factor.compute(matrix);
  const Eigen::VectorXd pivots = factor.vectorD();
  Eigen::Index smallest = 0;
  const double least = pivots.minCoeff(&smallest), mean = pivots.mean();
  const double ratio = factor.info() == Eigen::Success ? least / mean
                                                       : std::min(0., least / mean);
  return {factor.permutationPinv().indices()[smallest], ratio};
}
} // namespace

void demand_regular(const Eigen::SparseMatrix<double> &matrix,
                    const std::function<std::string(Eigen::Index)> &name_of_row,
                    const MPI_Comm communicator)
{
  Pivot found;
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    found = least_pivot(matrix);
  found = dealii::Utilities::MPI::broadcast(communicator, found);
  if (found.ratio > 1e-10)
    return;
  throw NumericalError(
      "bridging domain",
      "multiplier space too rich at " + name_of_row(found.row) +
          ": the constraint matrix is singular there. Use larger cells "
          "(Matrix / Cell size ratio), a wider overlap or coarsened multipliers; "
          "smallest pivot over the mean",
      found.ratio, 1e-10);
}

ConstraintSolver::ConstraintSolver(
    const Eigen::SparseMatrix<double> &matrix,
    const std::function<std::string(Eigen::Index)> &name_of_row)
{
  demand_regular(matrix, name_of_row, MPI_COMM_SELF);
  std::vector<int> local(matrix.rows(), -1);
  for (const std::vector<int> &rows : connected_parts(matrix))
  {
    auto part = std::make_unique<Part>();
    part->rows = rows;
    const int n = static_cast<int>(rows.size());
    for (int k = 0; k < n; ++k)
      local[rows[k]] = k;
    part->map = std::make_unique<Epetra_Map>(n, 0, part->comm);
    part->matrix = std::make_unique<Epetra_CrsMatrix>(Copy, *part->map, 0);
    for (int k = 0; k < n; ++k)
    {
      std::vector<double> values;
      std::vector<int> columns;
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, rows[k]); it; ++it)
        if (it.value() != 0.)
        {
          columns.push_back(local[it.row()]);
          values.push_back(it.value());
        }
      part->matrix->InsertGlobalValues(k, static_cast<int>(values.size()), values.data(),
                                       columns.data());
    }
    part->matrix->FillComplete();
    part->right = std::make_unique<Epetra_MultiVector>(*part->map, 1);
    part->left = std::make_unique<Epetra_MultiVector>(*part->map, 1);
    part->problem = std::make_unique<Epetra_LinearProblem>(
        part->matrix.get(), part->left.get(), part->right.get());
    part->solver.reset(Amesos().Create("Amesos_Klu", *part->problem));
    if (part->solver->SymbolicFactorization() != 0 ||
        part->solver->NumericFactorization() != 0)
      throw NumericalError("bridging domain",
                           "factorisation of the constraint matrix failed", n, 0.);
    parts_.push_back(std::move(part));
  }
}

ConstraintSolver::~ConstraintSolver() = default;
ConstraintSolver::ConstraintSolver(ConstraintSolver &&) noexcept = default;
ConstraintSolver &ConstraintSolver::operator=(ConstraintSolver &&) noexcept = default;

std::size_t ConstraintSolver::n_parts() const
{
  return parts_.size();
}

void ConstraintSolver::solve(std::vector<double> &b) const
{
  const auto n = static_cast<std::int64_t>(parts_.size());
#pragma omp parallel for schedule(static, 1)
  for (std::int64_t p = 0; p < n; ++p)
  {
    Part &part = *parts_[p];
    double *const right = (*part.right)[0];
    for (std::size_t k = 0; k < part.rows.size(); ++k)
      right[k] = b[part.rows[k]];
    part.solver->Solve();
    const double *const left = (*part.left)[0];
    for (std::size_t k = 0; k < part.rows.size(); ++k)
      b[part.rows[k]] = left[k];
  }
}
} // namespace antiform::coupling

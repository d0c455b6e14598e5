#pragma once

#include <Eigen/SparseCore>

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Throws NumericalError naming the offending row when the smallest pivot of S is below
/// 1e-10 of the mean: the multiplier space is too rich. Collective: S is looked at on the
/// first rank, what the others give is not.
void demand_regular(const Eigen::SparseMatrix<double> &matrix,
                    const std::function<std::string(Eigen::Index)> &name_of_row,
                    MPI_Comm communicator);

/// Solves S L = b for the symmetric positive definite constraint matrix, factorised once
/// by Trilinos (Amesos, KLU), on one rank. Parts of S without connection (the overlaps
/// above and below the layer, x and y) are factorised apart and solved by different
/// threads; every part is solved by one thread, so the result has the same bits for any
/// number of threads.
class ConstraintSolver
{
public:
  /// Throws as demand_regular().
  ConstraintSolver(const Eigen::SparseMatrix<double> &matrix,
                   const std::function<std::string(Eigen::Index)> &name_of_row);
  ~ConstraintSolver();
  ConstraintSolver(ConstraintSolver &&) noexcept;
  ConstraintSolver &operator=(ConstraintSolver &&) noexcept;

  /// Overwrite @p b by the solution.
  void solve(std::vector<double> &b) const;

  std::size_t n_parts() const;

private:
  struct Part;
  std::vector<std::unique_ptr<Part>> parts_;
};
} // namespace antiform::coupling

#pragma once

#include <Eigen/SparseCore>

#include <mpi.h>

#include <memory>
#include <vector>

namespace antiform::coupling
{
/// A square sparse system of several ranks. Every rank gives a share of the matrix and of
/// the right-hand side, in any rows, and owns some rows; the shares are summed by their
/// owners and the matrix is factorised by all ranks together (Trilinos: Epetra, Amesos,
/// MUMPS). Everything is collective.
class DistributedSystem
{
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// \param share    of this rank; the matrix is the sum over ranks
  /// \param own_rows a row is one rank's
  DistributedSystem(const Matrix &share,
                    const std::vector<int> &own_rows,
                    MPI_Comm communicator);
  ~DistributedSystem();

  /// \return whether MUMPS has factors
  bool factorise();
  /// \param b this rank's share of the right-hand side; becomes the solution, the same
  ///          bits on every rank
  /// \return whether MUMPS has succeeded
  bool solve(double *b) const;

  /// Largest column sum of absolute entries.
  double norm_one() const;
  /// The matrix, on the first rank; without entries on the others.
  Eigen::SparseMatrix<double> on_first_rank() const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};
} // namespace antiform::coupling

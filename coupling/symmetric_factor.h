#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace antiform::coupling
{
/// L D L^T of a symmetric indefinite matrix, by MUMPS on one rank, with its inertia: by
/// Sylvester's law D has as many negative eigenvalues as the matrix.
class SymmetricFactor
{
public:
  /// \param matrix of which the lower triangle counts
  /// Throws NumericalError where it cannot be factored.
  explicit SymmetricFactor(const Eigen::SparseMatrix<double, Eigen::RowMajor> &matrix);
  ~SymmetricFactor();
  SymmetricFactor(SymmetricFactor &&) noexcept;

  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;

  int n_negative() const;
  /// Pivots of round-off: directions in which the matrix is singular.
  int n_null() const;

private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
};
} // namespace antiform::coupling

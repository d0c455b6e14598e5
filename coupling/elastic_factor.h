#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace antiform::coupling
{
/// Cholesky factor of a symmetric positive definite matrix, for many solves: CHOLMOD's
/// supernodal factor, and a solve of our own over its panels, which for one right side
/// are too narrow for calls of BLAS. One rank, one thread.
class ElasticFactor
{
public:
  /// \param matrix n x n, both triangles or the lower one alone. Throws NumericalError
  ///               where a pivot is not positive: a part of the body can move without
  ///               resistance.
  explicit ElasticFactor(const Eigen::SparseMatrix<double> &matrix);
  ~ElasticFactor();
  ElasticFactor(ElasticFactor &&) noexcept;
  ElasticFactor &operator=(ElasticFactor &&) noexcept;

  /// x = A^-1 b, n entries.
  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;
  Eigen::Index size() const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};
} // namespace antiform::coupling

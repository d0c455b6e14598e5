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

  /// x = A^-1 b, n entries, in the precision of A.
  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;

  /// Let correction() work in single precision, that is, on half the bytes, if that
  /// leaves at most @p most_left of the worst error that twelve rounds from noise find,
  /// in the norm of energy; the softest motions decide. Where it leaves more,
  /// correction() remains solve(). \param matrix the one factorised
  void round_for_corrections(const Eigen::SparseMatrix<double> &matrix, double most_left);
  /// x = A^-1 b, or nearly: see round_for_corrections().
  Eigen::VectorXd correction(const Eigen::VectorXd &right) const;
  Eigen::Index size() const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};
} // namespace antiform::coupling

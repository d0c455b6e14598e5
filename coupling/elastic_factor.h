#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace antiform::coupling
{
/// Cholesky factor of a symmetric positive definite matrix, for many solves (CHOLMOD,
/// simplicial, minimum-degree order: on bodies of some thousand grains a solve takes
/// 0.6 of that with a supernodal one). One rank, one thread.
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

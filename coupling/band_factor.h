#pragma once

#include <Eigen/Core>

namespace antiform::coupling
{
/// Cholesky factor of a small symmetric positive definite matrix with a narrow band, for
/// the few solves between two changes of it. Column j of the storage has the entries
/// (j, j) to (j + band, j).
class BandFactor
{
public:
  /// Forget what was there: @p n unknowns, @p band entries below the diagonal, all 0.
  void reset(Eigen::Index n, Eigen::Index band);
  /// Entry of the lower triangle. \pre 0 <= row - column <= band
  double &entry(const Eigen::Index row, const Eigen::Index column)
  {
    return columns_(row - column, column);
  }
  /// \return false where a pivot is not positive; the factor is of no use then
  bool factorise();
  /// x = A^-1 b.
  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;

private:
  Eigen::MatrixXd columns_;
};
} // namespace antiform::coupling

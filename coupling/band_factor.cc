#include "coupling/band_factor.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling
{
void BandFactor::reset(const Eigen::Index n, const Eigen::Index band)
{
  columns_.setZero(band + 1, n);
}

bool BandFactor::factorise()
{
  const Eigen::Index n = columns_.cols();
  for (Eigen::Index j = 0; j < n; ++j)
  {
    if (!(columns_(0, j) > 0.))
      return false;
    const Eigen::Index below = std::min(columns_.rows() - 1, n - 1 - j);
    columns_.col(j).head(below + 1) /= std::sqrt(columns_(0, j));
    for (Eigen::Index k = 1; k <= below; ++k)
      columns_.col(j + k).head(below - k + 1) -=
          columns_(k, j) * columns_.col(j).segment(k, below - k + 1);
  }
  return true;
}

Eigen::VectorXd BandFactor::solve(const Eigen::VectorXd &right) const
{
  Eigen::VectorXd x = right;
  const Eigen::Index n = columns_.cols();
  for (Eigen::Index j = 0; j < n; ++j)
  {
    const Eigen::Index below = std::min(columns_.rows() - 1, n - 1 - j);
    x[j] /= columns_(0, j);
    x.segment(j + 1, below) -= x[j] * columns_.col(j).segment(1, below);
  }
  for (Eigen::Index j = n - 1; j >= 0; --j)
  {
    const Eigen::Index below = std::min(columns_.rows() - 1, n - 1 - j);
    x[j] -= columns_.col(j).segment(1, below).dot(x.segment(j + 1, below));
    x[j] /= columns_(0, j);
  }
  return x;
}
} // namespace antiform::coupling

#include "coupling/anderson.h"

#include <Eigen/QR>

namespace antiform::coupling
{
Eigen::VectorXd Anderson::increment(const Eigen::VectorXd &g)
{
  if (last_g_.size() == g.size())
  {
    change_of_g_.emplace_back(g - last_g_);
    change_of_u_.push_back(last_increment_);
    if (change_of_g_.size() > depth_)
    {
      change_of_g_.pop_front();
      change_of_u_.pop_front();
    }
  }
  Eigen::VectorXd step = g;
  const auto n = static_cast<Eigen::Index>(change_of_g_.size());
  if (n > 0)
  {
    Eigen::MatrixXd changes(g.size(), n);
    for (Eigen::Index k = 0; k < n; ++k)
      changes.col(k) = change_of_g_[static_cast<std::size_t>(k)];
    // Rank revealing: changes of an iteration that has settled are nearly parallel.
    const Eigen::VectorXd share = changes.colPivHouseholderQr().solve(g);
    for (Eigen::Index k = 0; k < n; ++k)
      step -= share[k] * (change_of_u_[static_cast<std::size_t>(k)] + changes.col(k));
  }
  last_g_ = g;
  last_increment_ = step;
  return step;
}

void Anderson::reset()
{
  last_g_.resize(0);
  change_of_g_.clear();
  change_of_u_.clear();
}
} // namespace antiform::coupling

#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <deque>

namespace antiform::coupling
{
/// Anderson acceleration of a fixed-point iteration u <- u + g(u): the next increment
/// is that of the combination of the last states whose g is smallest in the mean square
/// (Walker & Ni 2011, with full steps).
class Anderson
{
public:
  /// \param depth states remembered beside the present one
  explicit Anderson(const std::size_t depth)
      : depth_(depth)
  {
  }
  /// Increment of the iterate whose plain increment is @p g, in units in which all
  /// entries compare. Whoever calls it must add just this, or reset().
  Eigen::VectorXd increment(const Eigen::VectorXd &g);
  void reset();

private:
  std::size_t depth_;
  Eigen::VectorXd last_g_, last_increment_;
  std::deque<Eigen::VectorXd> change_of_g_, change_of_u_;
};
} // namespace antiform::coupling

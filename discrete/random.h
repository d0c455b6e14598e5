#pragma once

#include <cmath>
#include <cstdint>

namespace antiform::discrete
{
/// Counter-based random numbers (splitmix64, Steele et al. 2014): the same bits on every
/// compiler, unlike the standard library's distributions.
class Random
{
public:
  /// @p stream keeps the uses of one seed apart.
  Random(const std::uint64_t seed, const std::uint64_t stream)
      : key_(mixed(mixed(seed) + stream))
  {
  }

  /// Next number, uniform in [0, 1).
  double uniform()
  {
    return static_cast<double>(mixed(key_ + increment * ++counter_) >> 11) * 0x1p-53;
  }

  /// Next number, of the standard normal distribution (Box and Muller: two uniform ones).
  double normal()
  {
    const double u = 1. - uniform(), v = uniform(); // 1 - u is never 0
    return std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * v);
  }

private:
  static constexpr std::uint64_t increment = 0x9e3779b97f4a7c15ULL;

  static std::uint64_t mixed(std::uint64_t z)
  {
    z += increment;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};
} // namespace antiform::discrete

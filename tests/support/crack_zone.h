#pragma once
// Where a body has failed: the density of its cracks as a field, and how alike two are.
#include "discrete/joints.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace antiform::coupling::test
{
/// Density of @p cracks at the centres of squares of 1 m between two corners, each crack
/// spread as a Gaussian of a standard deviation of two mean grain diameters of 1 m: paths
/// that run a grain apart are the same, bands that run apart are not.
inline std::vector<double> crack_density(const std::vector<discrete::Crack> &cracks,
                                         const Vec2 &lower,
                                         const Vec2 &upper)
{
  constexpr double spread = 2.;
  std::vector<double> density;
  for (double x = lower.x + 0.5; x < upper.x; x += 1.)
    for (double y = lower.y + 0.5; y < upper.y; y += 1.)
    {
      double sum = 0.;
      for (const discrete::Crack &crack : cracks)
      {
        const double dx = crack.reference_place.x - x, dy = crack.reference_place.y - y;
        sum += std::exp(-(dx * dx + dy * dy) / (2. * spread * spread));
      }
      density.push_back(sum / (2. * M_PI * spread * spread));
    }
  return density;
}

/// 1: proportional up to a constant, 0: nothing in common.
inline double correlation(const std::vector<double> &a, const std::vector<double> &b)
{
  double mean_a = 0., mean_b = 0.;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    mean_a += a[k] / static_cast<double>(a.size());
    mean_b += b[k] / static_cast<double>(a.size());
  }
  double ab = 0., aa = 0., bb = 0.;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    ab += (a[k] - mean_a) * (b[k] - mean_b);
    aa += (a[k] - mean_a) * (a[k] - mean_a);
    bb += (b[k] - mean_b) * (b[k] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}
} // namespace antiform::coupling::test

#pragma once

#include "continuum/material_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

// One point of a material: paths through its law, derivatives, turned axes.
namespace antiform::test
{
using continuum::MaterialLaw;
using continuum::PlaneVector;
using continuum::PointInput;
using continuum::PointResponse;
using continuum::PointStress;

/// A point with its strain and history, moved by increments.
struct MaterialPoint
{
  const MaterialLaw &law;
  PointInput input{};
  std::vector<double> history = std::vector<double>(law.n_history(), 0.);

  explicit MaterialPoint(const MaterialLaw &law)
      : law(law)
  {
  }

  PointResponse move(const PlaneVector &increment, const double time_step = 0.)
  {
    for (int i = 0; i < 3; ++i)
      input.strain[i] += increment[i];
    input.time_step = time_step;
    std::vector<double> end(history.size());
    const PointResponse response = law.respond(input, history.data(), end.data());
    history = end;
    return response;
  }

  /// Strain xx by @p increment while stress yy stays at @p stress_yy, to 1e-12 of
  /// @p scale: Newton's method with the law's tangent, halving where that leads away (at
  /// a corner of a yield surface the tangent is 0).
  PointResponse
  move_xx_at_stress_yy(const double increment, const double stress_yy, const double scale)
  {
    input.strain[0] += increment;
    double &e = input.strain[1];
    double low = e - 100. * std::abs(increment), high = e + 100. * std::abs(increment);
    std::vector<double> end(history.size());
    for (int iteration = 0; iteration < 100; ++iteration)
    {
      const PointResponse response = law.respond(input, history.data(), end.data());
      const double residual = response.stress.yy - stress_yy;
      if (std::abs(residual) < 1e-12 * scale)
      {
        history = end;
        return response;
      }
      (residual > 0. ? high : low) = e;
      const double next = e - residual / response.tangent[1][1];
      e = next > low && next < high ? next : 0.5 * (low + high);
    }
    throw std::runtime_error("the strain that holds the lateral stress was not found");
  }
};

/// Greatest difference of the tangent from central differences of width @p h, over
/// @p stiffness.
inline double tangent_error(const MaterialLaw &law,
                            const PointInput &input,
                            const std::vector<double> &history,
                            const double h,
                            const double stiffness)
{
  std::vector<double> end(history.size());
  const PointResponse response = law.respond(input, history.data(), end.data());
  double worst = 0.;
  for (int j = 0; j < 3; ++j)
  {
    PointInput above = input, below = input;
    above.strain[j] += h;
    below.strain[j] -= h;
    const double width = above.strain[j] - below.strain[j];
    const PointStress a = law.respond(above, history.data(), end.data()).stress;
    const PointStress b = law.respond(below, history.data(), end.data()).stress;
    const std::array<double, 3> difference{a.xx - b.xx, a.yy - b.yy, a.xy - b.xy};
    for (int i = 0; i < 3; ++i)
      worst = std::max(worst, std::abs(response.tangent[i][j] - difference[i] / width));
  }
  return worst / stiffness;
}

/// Components in axes turned by @p angle.
inline PointStress turned(const PointStress &s, const double angle)
{
  const double c = std::cos(angle), n = std::sin(angle);
  return {c * c * s.xx + n * n * s.yy + 2. * c * n * s.xy,
          n * n * s.xx + c * c * s.yy - 2. * c * n * s.xy, s.zz,
          c * n * (s.yy - s.xx) + (c * c - n * n) * s.xy};
}
inline PlaneVector turned(const PlaneVector &strain, const double angle)
{
  const PointStress t =
      turned(PointStress{strain[0], strain[1], 0., strain[2] / 2.}, angle);
  return {t.xx, t.yy, 2. * t.xy};
}

inline double distance(const PointStress &a, const PointStress &b)
{
  return std::max({std::abs(a.xx - b.xx), std::abs(a.yy - b.yy), std::abs(a.zz - b.zz),
                   std::abs(a.xy - b.xy)});
}

/// Principal stresses, greatest first.
inline std::array<double, 3> principal(const PointStress &s)
{
  const double mean = (s.xx + s.yy) / 2.;
  const double radius = std::sqrt(std::pow((s.xx - s.yy) / 2., 2) + s.xy * s.xy);
  std::array<double, 3> values{mean + radius, mean - radius, s.zz};
  std::sort(values.rbegin(), values.rend());
  return values;
}

/// The same numbers on every rank and machine.
class Dice
{
public:
  explicit Dice(const unsigned int seed)
      : generator_(seed)
  {
  }
  /// Even between @p low and @p high.
  double operator()(const double low, const double high)
  {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }

private:
  std::mt19937_64 generator_;
};
} // namespace antiform::test

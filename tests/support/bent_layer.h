#pragma once
// A layer of packed disks, bent beforehand, between platens that hold the grains of its
// ends: a specimen along x.
#include "support/specimen_fixture.h"

#include <cmath>

namespace antiform::coupling::test
{
/// One wave between the platens, crest at x = 0. `width` is the thickness and `height`
/// the length of a specimen.
struct BentLayer : Specimen
{
  static constexpr double initial_rise = 4.; ///< of the crest above the troughs [m]

  /// 15 times as long as thick: some 1000 grains.
  explicit BentLayer(const std::uint64_t seed)
  {
    constexpr double thickness = 8., length = 120.;
    width = thickness;
    height = length - 1.; // between rows of mean grains
    discrete::PackingParameters packing;
    packing.seed = seed;
    std::vector<Vec2> outline;
    constexpr int n = 120;
    const auto axis = [&](const double x)
    { return 0.5 * initial_rise * std::cos(2. * M_PI * x / length); };
    for (int k = 0; k <= n; ++k)
    {
      const double x = length * (static_cast<double>(k) / n - 0.5);
      outline.push_back({x, axis(x) - 0.5 * thickness});
    }
    for (int k = n; k >= 0; --k)
    {
      const double x = length * (static_cast<double>(k) / n - 0.5);
      outline.push_back({x, axis(x) + 0.5 * thickness});
    }
    fill(outline, packing, rock_law());
    add_end_platens(0.5 * length);
  }

  /// Crest over troughs now, from windows of a mean thickness [m].
  double amplitude() const
  {
    const double trough = 0.5 * height;
    return initial_rise + uplift(0.) - 0.5 * (uplift(-trough) + uplift(trough));
  }

private:
  void add_end_platens(const double end)
  {
    const discrete::Grains &grains = state.grains;
    bool is_first = true;
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const auto number = static_cast<std::int32_t>(i);
      const double x = grains.reference_x[i], r = grains.radius[i];
      if (x - r < 0.1 - end)
      {
        platens.push_back({number, 0, 0.5 * height});
        if (is_first)
          platens.push_back({number, 1, 0.});
        is_first = false;
      }
      else if (x + r > end - 0.1)
        platens.push_back({number, 0, -0.5 * height});
    }
  }

  /// Mean way up of the grains within half a thickness of @p x [m].
  double uplift(const double x) const
  {
    const discrete::Grains &grains = state.grains;
    double sum = 0., n = 0.;
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (std::abs(grains.reference_x[i] - x) < 0.5 * width)
      {
        sum += grains.displacement_y[i];
        n += 1.;
      }
    return sum / n;
  }
};
} // namespace antiform::coupling::test

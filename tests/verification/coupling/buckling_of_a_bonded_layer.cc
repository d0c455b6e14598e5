// Linear buckling of a bonded layer in a soft matrix: grains and mesh against grains
// alone.
#include "support/layered_section.h"

#include <gtest/gtest.h>

#include <chrono>

namespace antiform::coupling::test::buckling_of_a_bonded_layer_tests
{
namespace
{
struct Compared
{
  std::array<double, 2> strain, waves; ///< of grains alone; difference of the coupled
  std::array<double, 2> error;
  double share_of_grains = 0.;
};

void explore(const LayerShape &shape)
{
  using Clock = std::chrono::steady_clock;
  for (const bool coupled : {false, true})
  {
    const auto begin = Clock::now();
    const LayeredSection section(shape, coupled);
    for (const StrainMeasure measure : {StrainMeasure::biot, StrainMeasure::green})
    {
      const auto modes = section.modes(3, measure);
      std::printf("  %s %s: %zu grains,", coupled ? "coupled" : "grains",
                  measure == StrainMeasure::biot ? "biot" : "green", section.n_grains());
      for (const CoupledMode &m : modes)
        std::printf(" %.6f (m %d, %.2f)", m.load_factor, section.half_waves(m).first,
                    section.half_waves(m).second);
      std::printf("; residual %.1e gap %.1e, %.1f s\n", modes[0].residual, modes[0].gap,
                  std::chrono::duration<double>(Clock::now() - begin).count());
      if (!coupled)
        break;
    }
  }
}
} // namespace

TEST(BondedLayer, Explore)
{
  for (const double contrast : {20., 100.})
    for (const int cover : {5, 25})
    {
      LayerShape shape;
      shape.contrast = contrast;
      shape.cover_rows = cover;
      shape.length = contrast > 50. ? 140 : 120;
      std::printf("contrast %g, cover %d rows\n", contrast, cover);
      explore(shape);
    }
}
} // namespace antiform::coupling::test::buckling_of_a_bonded_layer_tests

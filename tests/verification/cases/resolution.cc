// Case 31 of docs/validation.md: what 10, 20 and 40 grains across the layer make of it.
#include "support/tiny_run.h"

#include <array>
#include <cmath>

namespace resolution_tests
{
using namespace antiform::test;

namespace
{
struct Elastic
{
  double modulus, bending; ///< stiffness of the section [Pa]; load over growth [Pa/m]
};
/// A layer, bent beforehand, under a small load.
Elastic elastic_layer(const int grains_across, const std::string &directory)
{
  const Outcome outcome = run_program(
      "run " ANTIFORM_SOURCE_DIR "/cases/shortening/single-layer.prm -o " + directory +
      set({"Layer/Grains across=" + std::to_string(grains_across),
           "Layer/Length ratio=12", "Layer/Breakable=false",
           "Walls/Transits per millistrain=1000", "Run/End shortening=1e-4",
           "Output/Samples per millistrain=1000"}));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const CsvTable history(directory + "/history.csv");
  const std::vector<double> amplitude = history.column("fold_amplitude_m"),
                            stress = history.column("axial_stress_Pa");
  const double growth = amplitude.back() - amplitude.front();
  return {result(summary_of(directory), "section_stiffness"), stress.back() / growth};
}
} // namespace

// Grains touch a rim with their edges, and half of an outer grain has no joint: a section of
// n grains has at most one grain less that carries, in bending its cube. Moduli of single
// packings scatter by some 2 %. Measured with one packing: -6.2 and -3.3 % of the section's stiffness, -9.3
// and -5.8 % of the buckling load, with 10 and 20 grains against 40 (wanted: 3 and 5 %).
TEST(Resolution, CostsALayerAtMostHalfAGrainOnEitherSideLong)
{
  const TemporaryFolder folder;
  std::array<Elastic, 3> layers{};
  double n = 10.;
  for (Elastic &layer : layers)
  {
    layer = elastic_layer(static_cast<int>(n), folder.path(std::to_string(n)));
    std::printf("%.0f grains across: %.4g GPa, %.4g MPa/m\n", n, 1e-9 * layer.modulus,
                1e-6 * layer.bending);
    n *= 2.;
  }
  constexpr double scatter = 0.02;
  for (const std::size_t k : {0, 1})
  {
    const double across = k == 0 ? 10. : 20.;
    const double carries = (1. - 1. / across) / (1. - 1. / 40.);
    EXPECT_GT(layers[k].modulus / layers[2].modulus, carries - scatter) << across;
    EXPECT_LT(layers[k].modulus / layers[2].modulus, 1. + scatter) << across;
    // The buckling load is the load over the growth, times a0.
    EXPECT_GT(layers[k].bending / layers[2].bending, std::pow(carries, 3) - 3. * scatter);
    EXPECT_LT(layers[k].bending / layers[2].bending, 1. + 3. * scatter);
  }
}
} // namespace resolution_tests

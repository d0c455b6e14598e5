// Case 31 of the verification list: what 10, 20 and 40 grains across the layer make of it.
#include "support/tiny_run.h"

#include <array>
#include <cmath>

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

TEST(Resolution, OfTenGrainsAcrossGivesModulusAndBucklingLoadLong)
{
  const TemporaryFolder folder;
  std::array<Elastic, 3> layers{};
  int n = 10;
  for (Elastic &layer : layers)
  {
    layer = elastic_layer(n, folder.path(std::to_string(n)));
    std::printf("%d grains across: %.4g GPa, %.4g MPa/m\n", n, 1e-9 * layer.modulus,
                1e-6 * layer.bending);
    n *= 2;
  }
  // The buckling load is the load over the growth, times a0. Converged within 3 % and 5 %
  // from 20 on. The outer half of the rim's grains carries little: of n grains across, the
  // cube of 1 - 1/(4 n) on either side is lost to bending at the most, 15 % at n = 10
  // against 4 % at n = 40.
  EXPECT_NEAR(layers[0].modulus / layers[2].modulus, 1., 0.03);
  EXPECT_NEAR(layers[1].modulus / layers[2].modulus, 1., 0.03);
  EXPECT_NEAR(layers[1].bending / layers[2].bending, 1., 0.05);
  EXPECT_LT(layers[0].bending / layers[2].bending, 1.03);
  EXPECT_GT(layers[0].bending / layers[2].bending, 0.89);
}

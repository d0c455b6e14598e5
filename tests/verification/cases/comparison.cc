// May the coupled model be trusted? One scene with grains everywhere, and with grains in
// and beside the layer only. cases/burial-depth/comparison.prm at its full size; the bent
// variants are unbreakable and end at a shortening of 1e-3. On one core of 2020 a run
// takes 20 to 45 s.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>

namespace comparison_tests
{
using namespace antiform::test;

namespace
{
const std::vector<std::string> pure_grains{"Matrix/Representation=grains"};
const std::vector<std::string> without_constraint{"Bridging domain/Constraint=false"};
const std::vector<std::string> soft_mesh{"Matrix/Mesh modulus ratio=0.5"};

/// Run the comparison's deck; two scenes that differ in @p entries.
void run_comparison(const std::string &directory,
                    const std::vector<std::string> &scene,
                    const std::vector<std::string> &entries = {})
{
  const Outcome outcome =
      run_program("run " ANTIFORM_SOURCE_DIR "/cases/burial-depth/comparison.prm -o " +
                  directory + set(scene) + set(entries));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(directory);
  std::printf("%-40s %6lld grains, %5.1f s\n", directory.c_str(),
              summary.at("sizes").at("grains").get<long long>(),
              summary.at("wall_seconds").get<double>());
}

double difference(const std::string &name,
                  const std::string &directory,
                  const std::string &reference)
{
  const double a = result(summary_of(directory), name),
               b = result(summary_of(reference), name);
  std::printf("  %-24s %12.5g, reference %12.5g: %+.2f %%\n", name.c_str(), a, b,
              100. * (a / b - 1.));
  return std::abs(a / b - 1.);
}

/// How far @p column has grown when the axial stress first reaches @p stress [m].
double
growth_at(const double stress, const std::string &column, const std::string &directory)
{
  const CsvTable history(directory + "/history.csv");
  const std::vector<double> stresses = history.column("axial_stress_Pa"),
                            values = history.column(column);
  for (std::size_t k = 1; k < stresses.size(); ++k)
    if (stresses[k] >= stress)
    {
      const double s = (stress - stresses[k - 1]) / (stresses[k] - stresses[k - 1]);
      return values[k - 1] + s * (values[k] - values[k - 1]) - values.front();
    }
  throw std::runtime_error(directory + " does not reach that stress");
}

/// Largest relative difference of the growth of @p column at a half, three quarters and
/// nine tenths of the stress that both runs reach.
double growth_difference(const std::string &column,
                         const std::string &directory,
                         const std::string &reference)
{
  const double reached = std::min(result(summary_of(directory), "peak_stress"),
                                  result(summary_of(reference), "peak_stress"));
  double largest = 0.;
  for (const double share : {0.5, 0.75, 0.9})
  {
    const double a = growth_at(share * reached, column, directory),
                 b = growth_at(share * reached, column, reference);
    std::printf("  %-16s at %5.1f MPa %12.5g, reference %12.5g: %+.2f %%\n",
                column.c_str(), 1e-6 * share * reached, a, b, 100. * (a / b - 1.));
    largest = std::max(largest, std::abs(a / b - 1.));
  }
  return largest;
}

// A straight layer and its matrix are shortened side by side: joined or not makes next to
// no difference to stiffness, peak or share. Bent, the layer leans on the matrix.
const std::vector<std::string> bent{"Layer/Shape=cosine", "Layer/Breakable=false",
                                    "Run/End shortening=1e-3"};
// In a matrix of next to no stiffness a short layer does not feel it, a slender one does:
// at L/h = 34 the cover and the base carry a third of what its bending does.
const std::vector<std::string> slender{
    "Layer/Shape=cosine",      "Layer/Breakable=false",        "Run/End shortening=1e-3",
    "Layer/Length ratio=34",   "Layer/Grains across=6",
    "Matrix/Stiffness contrast=1e4"};

// The homogenised stiffness of a tile is that of a section within 1 to 2 %, its scatter
// from packing to packing. After the first break a peak differs with every detail; the
// scatter of the strength from packing to packing is about 10 %.
constexpr double elastic_tolerance = 0.03, strength_tolerance = 0.1;
// Growth amplifies a difference of stiffness by 1/(1 - P/P_cr), and the surface sums up
// the Poisson expansion of all that lies below it.
constexpr double growth_tolerance = 0.05;
} // namespace

TEST(Comparison, OfAStraightLayerInAStiffMatrixLong)
{
  const TemporaryFolder folder;
  const std::string coupled = folder.path("coupled"), grains = folder.path("grains");
  run_comparison(coupled, {});
  run_comparison(grains, {}, pure_grains);
  EXPECT_LT(difference("section_stiffness", coupled, grains), elastic_tolerance);
  EXPECT_LT(difference("peak_stress", coupled, grains), strength_tolerance);
  EXPECT_LT(difference("matrix_share_at_peak", coupled, grains), strength_tolerance);
  EXPECT_LE(summary_of(coupled).at("sizes").at("grains").get<double>(),
            0.5 * summary_of(grains).at("sizes").at("grains").get<double>());
}

TEST(Comparison, OfABentLayerInAStiffMatrixNoticesErrorsLong)
{
  const TemporaryFolder folder;
  const std::string coupled = folder.path("coupled"), grains = folder.path("grains"),
                    soft = folder.path("soft_mesh"), apart = folder.path("not_joined");
  run_comparison(coupled, bent);
  run_comparison(grains, bent, pure_grains);
  run_comparison(soft, bent, soft_mesh);
  run_comparison(apart, bent, without_constraint);
  EXPECT_LT(difference("section_stiffness", coupled, grains), elastic_tolerance);
  EXPECT_LT(difference("peak_stress", coupled, grains), strength_tolerance);
  EXPECT_LT(difference("matrix_share_at_peak", coupled, grains), strength_tolerance);
  EXPECT_LT(growth_difference("fold_amplitude_m", coupled, grains), growth_tolerance);
  EXPECT_LT(growth_difference("surface_uplift_m", coupled, grains), growth_tolerance);

  for (const std::string &wrong : {soft, apart})
  {
    EXPECT_GT(difference("section_stiffness", wrong, grains), 2. * elastic_tolerance);
    EXPECT_GT(growth_difference("fold_amplitude_m", wrong, grains),
              2. * growth_tolerance);
  }
  EXPECT_GT(difference("matrix_share_at_peak", soft, grains), 2. * strength_tolerance);
}

TEST(Comparison, OfASlenderLayerInASoftMatrixNoticesErrorsLong)
{
  const TemporaryFolder folder;
  const std::string coupled = folder.path("coupled"), grains = folder.path("grains"),
                    soft = folder.path("soft_mesh"), apart = folder.path("not_joined");
  run_comparison(coupled, slender);
  run_comparison(grains, slender, pure_grains);
  run_comparison(soft, slender, soft_mesh);
  run_comparison(apart, slender, without_constraint);
  EXPECT_LT(growth_difference("fold_amplitude_m", coupled, grains), growth_tolerance);
  EXPECT_LT(growth_difference("surface_uplift_m", coupled, grains), growth_tolerance);
  EXPECT_LT(difference("section_stiffness", coupled, grains), elastic_tolerance);
  // Three thousandths of the force, and a check of its own.
  EXPECT_LT(difference("matrix_share_at_peak", coupled, grains), strength_tolerance);

  for (const std::string &wrong : {soft, apart})
    EXPECT_GT(growth_difference("fold_amplitude_m", wrong, grains),
              4. * growth_tolerance);
}
} // namespace comparison_tests

// Case 32 of the verification list: walls at half the speed leave the strength as it is.
#include "support/tiny_run.h"

#include <cmath>

namespace loading_rate_tests
{
using namespace antiform::test;

// A stout specimen at the laboratory's speed and at half of it. Which bond breaks first
// hangs on the least difference: single packings move by up to 6 %, the mean of 16 by
// -0.6 +- 0.5 %, that of eight by some 0.7 %. (Slender layers do depend on the speed:
// cases/shortening.)
TEST(LoadingRate, LeavesTheStrengthOfASpecimenAsItIsLong)
{
  const TemporaryFolder folder;
  constexpr int n_packings = 8;
  double change = 0.;
  for (int seed = 1; seed <= n_packings; ++seed)
  {
    double strength[2];
    for (const int k : {0, 1})
    {
      const std::string directory =
          folder.path(std::to_string(seed) + (k == 0 ? "-300" : "-600"));
      const Outcome outcome = run_program(
          "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " + directory +
          set({"Layer/Grains across=20", "Layer/Seed=" + std::to_string(seed),
               k == 0 ? "Walls/Transits per millistrain=300"
                      : "Walls/Transits per millistrain=600"}));
      ASSERT_EQ(outcome.status, 0) << outcome.output;
      strength[k] = result(summary_of(directory), "peak_stress");
    }
    std::printf("seed %d: %.2f MPa, %.2f MPa at half the speed\n", seed,
                1e-6 * strength[0], 1e-6 * strength[1]);
    EXPECT_NEAR(strength[1] / strength[0], 1., 0.1) << seed;
    change += (strength[1] / strength[0] - 1.) / n_packings;
  }
  EXPECT_LT(std::abs(change), 0.02);
}
} // namespace loading_rate_tests

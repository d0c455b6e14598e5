// The crack list of a rock that is compressed past its peak does not depend on the step:
// breaks are placed where the load within a step reaches the strength.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::step_halving_tests
{
namespace
{
struct Compressed
{
  std::size_t cracks = 0, tensile = 0;
  double peak = 0., last = 0.; ///< mean reaction of the walls [N]
  double peak_time = 0.;
};
/// Some three hundred grains between two walls that close in until @p end.
Compressed compress(const double step, const double end)
{
  const Threads threads(1);
  FlatJoint law = strong_law();
  law.tensile_strength = 4.;
  law.cohesion = 12.;
  law.residual_friction = 0.5;
  Sample sample;
  sample.grains = random_pack(12, 24, 91);
  bond_all(sample, law);
  ExplicitRun run(sample);
  const Grains &g = run.sample.grains;
  double low = 1e300, high = -1e300;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    low = std::min(low, g.reference_y[i] - g.radius[i]);
    high = std::max(high, g.reference_y[i] + g.radius[i]);
  }
  for (const double side : {1., -1.})
  {
    Wall wall;
    wall.point = {0., side > 0. ? low : high};
    wall.normal = {0., side};
    wall.velocity = 0.02;
    install_wall_contacts(g, wall, 0.6, 0.25, {1e3});
    run.walls.push_back(wall);
  }
  run.damping.coefficient = 0.7;
  run.has_contacts = true;
  run.contacts.margin = 0.2;
  LinearContact touching;
  touching.effective_modulus = 1e3;
  run.contacts.groups.push_back({0, 0, touching});
  const double dt = step * stable_step(g, run.sample.joints);
  Compressed result;
  while (run.time < end)
  {
    run.advance(dt);
    result.last = 0.5 * (run.walls[0].reaction + run.walls[1].reaction);
    if (result.last > result.peak)
    {
      result.peak = result.last;
      result.peak_time = run.time;
    }
  }
  result.cracks = run.sample.cracks.size();
  for (const Crack &crack : run.sample.cracks)
    result.tensile += crack.mode == Bond::broken_in_tension ? 1 : 0;
  return result;
}
} // namespace

TEST(StepHalving, ChangesTheCrackListByLessThanATenth)
{
  const double end = 21.;
  const Compressed coarse = compress(0.5, end), fine = compress(0.25, end);
  std::printf("cracks %zu (%zu tensile) and %zu (%zu); peaks %.4g at %.3g, %.4g at %.3g; "
              "at the end %.3g and %.3g\n",
              coarse.cracks, coarse.tensile, fine.cracks, fine.tensile, coarse.peak,
              coarse.peak_time, fine.peak, fine.peak_time, coarse.last, fine.last);
  EXPECT_LT(coarse.last, 0.8 * coarse.peak); // past the peak
  EXPECT_GT(coarse.cracks, 100u);
  const auto ratio = [](const auto a, const auto b)
  { return static_cast<double>(a) / static_cast<double>(b); };
  EXPECT_NEAR(ratio(fine.cracks, coarse.cracks), 1., 0.1);
  EXPECT_NEAR(ratio(fine.tensile, coarse.tensile), 1., 0.1);
  EXPECT_NEAR(fine.peak / coarse.peak, 1., 0.02);
}
} // namespace antiform::discrete::test::step_halving_tests

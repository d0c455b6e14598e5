// A brittle burst: a stretched rock in which every bond bears its load at first, until
// the unloading waves from its free rims pass.
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::discrete::test::avalanche_tests
{
namespace
{
struct Burst
{
  std::size_t bonds = 0;   ///< elements
  std::size_t cracks = 0;  ///< at the end
  std::size_t at_once = 0; ///< in the first step
  std::size_t fastest = 0; ///< most cracks in any 100 steps of the longer step
  double closure = 0.;     ///< of the energy, as in docs/theory
  bool finite = true;
};

/// A pack that is stretched along y as a whole and let go, at @p step times the stable
/// step. \param window steps in which cracks are counted together
Burst burst(const double step, const int n_steps, const int window)
{
  const Threads threads(1);
  FlatJoint law = strong_law();
  law.tensile_strength = 8.;
  law.cohesion = 20.;
  law.residual_friction = 0.5;
  Sample sample;
  sample.grains = random_pack(14, 20, 81);
  bond_all(sample, law);
  // A bond along y carries E* times this, 8: just what it bears.
  const double strain = 8e-3;
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
    sample.grains.displacement_y[i] = strain * sample.grains.reference_y[i];

  ExplicitRun run(sample);
  run.damping.coefficient = 0.1;
  run.has_contacts = true;
  run.contacts.margin = 0.2;
  LinearContact touching;
  touching.effective_modulus = 1e3;
  run.contacts.groups.push_back({0, 0, touching});
  const double dt = step * stable_step(run.sample.grains, run.sample.joints);

  Burst result;
  result.bonds = 3 * run.sample.joints.size();
  double first = 0., worst = 0., scale = 0.;
  std::vector<std::size_t> count;
  // The elastic energy of the stretched state, before anything breaks.
  compute_joint_forces(run.sample.grains, run.sample.joints, {}, nullptr);
  first = joint_energies(run.sample.grains, run.sample.joints).strain;
  for (int i = 0; i < n_steps; ++i)
  {
    run.first_half(dt);
    const EnergyTerms e = run.energies();
    const double sum = e.kinetic + e.strain + e.slip + e.damping + e.dashpot + e.fracture;
    worst = std::max(worst, std::abs(sum - first));
    scale = std::max(scale, sum);
    run.second_half(dt);
    count.push_back(run.sample.cracks.size());
    const std::size_t before =
        i >= window ? count[static_cast<std::size_t>(i - window)] : 0;
    result.fastest = std::max(result.fastest, count.back() - before);
    for (std::size_t k = 0; k < run.sample.grains.size() && i % 100 == 0; ++k)
      result.finite = result.finite && std::isfinite(run.sample.grains.velocity_x[k]) &&
                      std::isfinite(run.sample.grains.rotation[k]);
  }
  result.cracks = run.sample.cracks.size();
  result.at_once = count.front();
  result.closure = worst / scale;
  return result;
}
} // namespace

TEST(Avalanche, KeepsItsEnergyAndDoesNotDependOnTheStep)
{
  const Burst coarse = burst(0.4, 4000, 100), fine = burst(0.2, 8000, 200);
  std::printf("cracks %zu and %zu of %zu, %zu in 100 steps; closure %.2g and %.2g\n",
              coarse.cracks, fine.cracks, coarse.bonds, coarse.fastest, coarse.closure,
              fine.closure);
  EXPECT_TRUE(coarse.finite && fine.finite);
  EXPECT_EQ(coarse.at_once, 0u); // the load falls on them, they are not made to break
  EXPECT_GE(coarse.fastest, coarse.bonds / 20); // 5 % of the bonds: it is a burst
  EXPECT_LT(coarse.cracks, 0.8 * static_cast<double>(coarse.bonds)); // and not dust
  EXPECT_LT(coarse.closure, 1e-2);
  EXPECT_LT(fine.closure, 1e-2);
  EXPECT_NEAR(static_cast<double>(fine.cracks) / static_cast<double>(coarse.cracks), 1.,
              0.1);
}
} // namespace antiform::discrete::test::avalanche_tests

#include "support/highest_mode.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::stable_step_tests
{
namespace
{
Sample bonded_lattice()
{
  Sample sample;
  sample.grains = lattice(7, 8);
  bond_all(sample, strong_law(), 1e-9);
  return sample;
}

double largest_motion(const Grains &g)
{
  double largest = 0.;
  for (std::size_t i = 0; i < g.size(); ++i)
    largest = std::max({largest, std::abs(g.displacement_x[i]),
                        std::abs(g.displacement_y[i]), std::abs(g.rotation[i])});
  return largest;
}

/// Largest motion over @p steps steps of @p share of the limit, started along the mode
/// with amplitude @p start; ends early when it has grown a millionfold.
struct Growth
{
  double largest = 0.;
  int steps = 0;
};
Growth
grow(const Sample &sample, const Mode &mode, const double share, const double start)
{
  const Threads threads(1);
  ExplicitRun run(sample);
  Grains &g = run.sample.grains;
  double norm_of_mode = 0.;
  for (const double m : mode.motion)
    norm_of_mode = std::max(norm_of_mode, std::abs(m));
  for (std::size_t i = 0; i < mode.motion.size(); ++i)
    freedom(g, static_cast<Eigen::Index>(i)) = start * mode.motion[i] / norm_of_mode;
  const double dt = share * 2. / mode.omega;
  Growth growth;
  while (growth.steps < 10000 && growth.largest < 1e6 * start)
  {
    run.advance(dt);
    growth.largest = std::max(growth.largest, largest_motion(g));
    ++growth.steps;
  }
  return growth;
}
} // namespace

TEST(Leapfrog, IsBoundedJustBelowItsLimit)
{
  const Sample sample = bonded_lattice();
  const Growth growth = grow(sample, highest_mode(sample), 0.99, 1e-9);
  EXPECT_EQ(growth.steps, 10000);
  // Released at rest, a mode with w dt = 1.98 swings by 1 / cos(theta / 2), where
  // cos(theta) = 1 - (w dt)^2 / 2: 7.09 times. The mode's error adds others a little.
  EXPECT_NEAR(growth.largest / 1e-9, 7.09, 0.15);
}

TEST(Leapfrog, GrowsJustAboveItsLimit)
{
  const Sample sample = bonded_lattice();
  const Growth growth = grow(sample, highest_mode(sample), 1.01, 1e-9);
  // cosh(mu) = (w dt)^2 / 2 - 1 with w dt = 2.02. Started at rest, the growing part is
  // (1 + e^mu) / (2 sinh(mu)) e^(mu n) of the start. Whole steps.
  const double mu = std::acosh(0.5 * 2.02 * 2.02 - 1.);
  const double growing = (1. + std::exp(mu)) / (2. * std::sinh(mu));
  EXPECT_NEAR(growth.steps, std::log(1e6 / growing) / mu, 1.);
}

TEST(StableStep, IsALowerBoundOnLatticesAndRandomPacks)
{
  const auto ratio = [](const Sample &sample)
  { return stable_step(sample.grains, sample.joints) * highest_mode(sample).omega / 2.; };
  const double of_lattice = ratio(bonded_lattice());
  EXPECT_LE(of_lattice, 1.);
  EXPECT_GT(of_lattice, 0.6); // measured 0.67: what Irons' bound costs on six joints
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6})
  {
    Sample sample;
    sample.grains = random_pack(6, 7, seed);
    FlatJoint law = strong_law();
    law.stiffness_ratio = 0.5 + static_cast<double>(seed);
    bond_all(sample, law, 0.2);
    const double of_pack = ratio(sample);
    EXPECT_LE(of_pack, 1.) << seed;
    EXPECT_GT(of_pack, 0.6) << seed;
  }
}

TEST(StableStep, StaysABoundWithWeightsAndScaledDensity)
{
  Random random(40);
  for (const std::uint64_t seed : {11, 12, 13, 14})
    for (const bool scaled : {false, true})
    {
      Sample sample;
      sample.grains = random_pack(6, 6, seed);
      bond_all(sample, strong_law());
      const auto weight = [&] { return std::pow(10., random(-3., 0.)); };
      for (std::size_t j = 0; j < sample.joints.size(); ++j)
        sample.joints.weight.push_back(weight());
      std::vector<double> mass_weight;
      for (std::size_t i = 0; i < sample.grains.size(); ++i)
        mass_weight.push_back(weight());
      // Half of the grains are heavier than the scaling asks for, half are not.
      const double dt0 = scaled ? 0.01 : 0.;
      const StiffnessSums sums = stiffness_sums(sample.grains, sample.joints, false);
      scale_density(sample.grains, sums, mass_weight, dt0);
      EXPECT_LE(stable_step(sample.grains, sample.joints) * highest_mode(sample).omega,
                2.)
          << seed << scaled;
    }
}

TEST(StableStep, IsReachedByDensityScaling)
{
  // m* >= k dt0^2, J* >= 1.5 k dt0^2 with k the sums over the joints of a grain:
  // omega^2 dt0^2 <= 2 k_s / (k_n + k_s) + 4/3 < 4 in the element-wise bound.
  Sample sample;
  sample.grains = random_pack(6, 6, 15);
  bond_all(sample, strong_law());
  const double natural = stable_step(sample.grains, sample.joints);
  const StiffnessSums sums = stiffness_sums(sample.grains, sample.joints, false);
  for (const double factor : {1., 10., 1000.})
  {
    const double dt0 = factor * natural;
    scale_density(sample.grains, sums, {}, dt0);
    const double step = stable_step(sample.grains, sample.joints);
    EXPECT_GE(step, dt0);
    EXPECT_LE(step, 2. * dt0);
  }
}

TEST(StableStep, KnowsPrescribedGrainsAndSpringsToTheGround)
{
  // One grain between a held one and the ground: omega^2 = (K_n + k) / m along the bond.
  Sample pair = bonded_pair(strong_law());
  hold(pair.grains, 0);
  const double k = 5e3, m = pair.grains.mass[1];
  const double step = stable_step(pair.grains, pair.joints, {0., k});
  EXPECT_LE(step, 2. / std::sqrt((1e3 + k) / m));
  EXPECT_GT(step, 0.8 * 2. / std::sqrt((1e3 + k) / m));
  EXPECT_LT(step, stable_step(pair.grains, pair.joints));
}
} // namespace antiform::discrete::test::stable_step_tests

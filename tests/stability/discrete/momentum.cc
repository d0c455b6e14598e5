#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::momentum_tests
{
namespace
{
struct Momentum
{
  Vec2 linear;
  double angular = 0.;
  double linear_scale = 0., angular_scale = 0.; ///< sums of moduli
};
/// Between a drift and the next kick: drift leaves x cross v as it is.
Momentum momentum(const Grains &g)
{
  Momentum sum;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 p = (1. / g.inverse_mass[i]) * g.velocity(i), x = g.position(i);
    const double spin = g.spin[i] / g.inverse_inertia[i];
    sum.linear += p;
    sum.angular += cross(x, p) + spin;
    sum.linear_scale += norm(p);
    sum.angular_scale += norm(x) * norm(p) + std::abs(spin);
  }
  return sum;
}
} // namespace

TEST(Momentum, OfABreakingCloudIsKeptForAHundredThousandSteps)
{
  const Threads threads(1);
  FlatJoint law = strong_law();
  law.tensile_strength = 12.;
  law.cohesion = 8.;
  Sample sample;
  sample.grains = random_pack(7, 7, 17);
  bond_all(sample, law);
  const std::size_t n_joints = sample.joints.size();
  shake(sample.grains, 0.5, 0.5, 18);
  ExplicitRun run(sample);
  run.has_contacts = true;
  run.contacts.margin = 0.2;
  LinearContact touching;
  touching.effective_modulus = 1e3;
  run.contacts.groups.push_back({0, 0, touching});

  const double dt = 0.2 * stable_step(run.sample.grains, run.sample.joints);
  const Momentum start = momentum(run.sample.grains);
  double worst_linear = 0., worst_angular = 0., scale = start.angular_scale;
  for (int step = 1; step <= 100000; ++step)
  {
    run.advance(dt);
    if (step % 1000 != 0)
      continue;
    const Momentum now = momentum(run.sample.grains);
    worst_linear = std::max(worst_linear, norm(now.linear - start.linear));
    worst_angular = std::max(worst_angular, std::abs(now.angular - start.angular));
    scale = std::max(scale, now.angular_scale);
  }
  // A random walk of roundings: 1e-16 an addition, sqrt(1e5) of them, is 3e-14.
  EXPECT_LT(worst_linear, 1e-12 * start.linear_scale);
  EXPECT_LT(worst_angular, 1e-12 * scale);
  // Something has happened: bonds broke, in both modes, and many did not.
  EXPECT_GT(run.sample.cracks.size(), 50u);
  EXPECT_LT(run.sample.cracks.size(), 3 * n_joints - 20);
  int shear_cracks = 0;
  for (const Crack &crack : run.sample.cracks)
    shear_cracks += crack.mode == Bond::broken_in_shear ? 1 : 0;
  EXPECT_GT(shear_cracks, 5);
  EXPECT_LT(shear_cracks, static_cast<int>(run.sample.cracks.size()) - 5);
}
} // namespace antiform::discrete::test::momentum_tests

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace antiform::discrete::test::energy_balance_tests
{
namespace
{
using Terms = std::array<double, 6>; // kinetic, strain, slip, damping, dashpot, fracture
constexpr std::array<const char *, 6> term_name{"kinetic", "strain",  "slip",
                                                "damping", "dashpot", "fracture"};

struct EnergySample
{
  double work;
  Terms terms;
};

/// Largest |work - sum of the terms| over the largest sum of |terms|; @p omitted: one
/// term to leave out of the sum, or -1.
double closure_error(const std::vector<EnergySample> &samples, const int omitted = -1)
{
  double worst = 0., scale = 0.;
  for (const EnergySample &sample : samples)
  {
    double sum = 0., moduli = 0.;
    for (int t = 0; t < 6; ++t)
    {
      const double change = sample.terms[t] - samples.front().terms[t];
      moduli += std::abs(sample.terms[t]);
      if (t != omitted)
        sum += change;
    }
    worst = std::max(worst, std::abs(sample.work - samples.front().work - sum));
    scale = std::max(scale, moduli);
  }
  return worst / scale;
}

EnergySample sample_of(const ExplicitRun &run)
{
  const EnergyTerms e = run.energies();
  return {e.work, {e.kinetic, e.strain, e.slip, e.damping, e.dashpot, e.fracture}};
}

std::vector<EnergySample>
record(ExplicitRun &run, const double dt, const int steps, const int interval)
{
  std::vector<EnergySample> samples;
  for (int step = 0; step < steps; ++step)
  {
    run.first_half(dt);
    if (step % interval == 0)
      samples.push_back(sample_of(run));
    run.second_half(dt);
  }
  return samples;
}

/// A rock of some hundred grains between two walls that close in, with everything in the
/// ledger: bonds that break, friction in joints and in new contacts, dashpots there,
/// local damping.
struct Compression
{
  ExplicitRun run;
  double dt = 0.;

  explicit Compression(const double speed, const double alpha)
      : run(rock())
  {
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
      wall.velocity = speed;
      install_wall_contacts(g, wall, 0.6, 0.25, {1e3});
      run.walls.push_back(wall);
    }
    run.damping.coefficient = alpha;
    run.has_contacts = true;
    run.contacts.margin = 0.2;
    LinearContact touching;
    touching.effective_modulus = 1e3;
    touching.normal_dashpot = touching.shear_dashpot = 0.1;
    run.contacts.groups.push_back({0, 0, touching});
    dt = 0.2 * stable_step(g, run.sample.joints);
  }

  static Sample rock()
  {
    FlatJoint law = strong_law();
    law.tensile_strength = 4.;
    law.cohesion = 12.;
    law.residual_friction = 0.5;
    Sample sample;
    sample.grains = random_pack(10, 20, 51);
    bond_all(sample, law);
    return sample;
  }
};
} // namespace

TEST(EnergyBalance, ClosesThroughACompressionWithBreaksAndFriction)
{
  const Threads threads(1);
  Compression test(0.05, 0.3);
  const std::vector<EnergySample> samples = record(test.run, test.dt, 25000, 50);
  EXPECT_GT(test.run.sample.cracks.size(), 500u);
  int removed = 0;
  for (std::size_t k = 0; k < test.run.sample.joints.damaged.size(); ++k)
    removed += test.run.sample.joints.damaged.removed[k];
  EXPECT_GT(removed, 50);
  // The policy's limit for runs with breaks. What remains is of first order in the step:
  // the dashpots' velocity, half a step late, and limits that are passed within a step.
  EXPECT_LT(closure_error(samples), 1e-3);
  for (int t = 0; t < 6; ++t)
    EXPECT_GT(closure_error(samples, t), 1e-3) << "without " << term_name[t];
}

TEST(EnergyBalance, ClosesThroughAnUndampedElasticRun)
{
  const Threads threads(1);
  Sample sample;
  sample.grains = random_pack(6, 6, 52);
  bond_all(sample, strong_law());
  shake(sample.grains, 0.005, 0.005, 53); // strains of some 1e-4
  ExplicitRun run(sample);
  const double dt = 0.2 * stable_step(run.sample.grains, run.sample.joints);
  const std::vector<EnergySample> samples = record(run, dt, 100000, 97);
  // The policy's limit for elastic runs. Leapfrog keeps the energy of a linear system to
  // round-off in this form; the geometric part is of the order of strain times (w dt)^2.
  EXPECT_LT(closure_error(samples), 1e-5);
  EXPECT_GT(closure_error(samples, 0), 0.1); // half of the energy is kinetic,
  EXPECT_GT(closure_error(samples, 1), 0.1); // half elastic
}
} // namespace antiform::discrete::test::energy_balance_tests

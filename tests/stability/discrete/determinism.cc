#include "discrete/threading.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace antiform::discrete::test::determinism_tests
{
namespace
{
FlatJoint breaking_law()
{
  FlatJoint law = strong_law();
  law.tensile_strength = 9.;
  law.cohesion = 10.;
  return law;
}

Contacts touching()
{
  Contacts contacts;
  contacts.margin = 0.2;
  LinearContact law;
  law.effective_modulus = 1e3;
  contacts.groups.push_back({0, 0, law});
  return contacts;
}

ExplicitRun breaking_run(const int threads, const int steps)
{
  const Threads scope(threads);
  Sample sample;
  sample.grains = random_pack(48, 48, 61); // enough for threads
  bond_all(sample, breaking_law());
  shake(sample.grains, 0.6, 0.6, 62);
  ExplicitRun run(sample);
  run.damping.coefficient = 0.1;
  run.has_contacts = true;
  run.contacts = touching();
  const double dt = 0.3 * stable_step(run.sample.grains, run.sample.joints);
  for (int step = 0; step < steps; ++step)
    run.advance(dt);
  return run;
}

bool same_bits(const std::vector<double> &a, const std::vector<double> &b)
{
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Same physical sample under other numbers: grain i of the first is number[i] of the
/// second, and every joint is seen from its other end.
Sample renumbered(const Sample &sample, const std::vector<std::size_t> &number)
{
  std::vector<std::size_t> old(number.size());
  for (std::size_t i = 0; i < number.size(); ++i)
    old[number[i]] = i;
  Sample other;
  const Grains &g = sample.grains;
  for (const std::size_t i : old)
  {
    other.grains.add(g.reference(i), g.radius[i], 1., g.region[i]);
    other.grains.displacement_x.back() = g.displacement_x[i];
    other.grains.displacement_y.back() = g.displacement_y[i];
    other.grains.rotation.back() = g.rotation[i];
    other.grains.velocity_x.back() = g.velocity_x[i];
    other.grains.velocity_y.back() = g.velocity_y[i];
    other.grains.spin.back() = g.spin[i];
  }
  Grains at_reference = other.grains; // joints are installed before anything moves
  at_reference.displacement_x.assign(g.size(), 0.);
  at_reference.displacement_y.assign(g.size(), 0.);
  const FlatJoint law = sample.joints.groups[0].flat();
  other.joints.begin_group(law, 0, "rock");
  std::vector<std::size_t> order(sample.joints.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(64);
  for (std::size_t k = order.size(); k > 1; --k)
    std::swap(order[k - 1], order[random.index(k)]);
  for (const std::size_t j : order)
    other.joints.add(at_reference,
                     static_cast<std::int32_t>(number[sample.joints.second[j]]),
                     static_cast<std::int32_t>(number[sample.joints.first[j]]),
                     law.effective_modulus, law.effective_modulus);
  other.joints.finish(g.size());
  return other;
}

std::vector<std::size_t> shuffled(const std::size_t n, const std::uint64_t seed)
{
  std::vector<std::size_t> number(n);
  std::iota(number.begin(), number.end(), std::size_t{0});
  Random random(seed);
  for (std::size_t k = n; k > 1; --k)
    std::swap(number[k - 1], number[random.index(k)]);
  return number;
}

std::vector<Crack> by_place(std::vector<Crack> cracks)
{
  std::sort(cracks.begin(), cracks.end(),
            [](const Crack &a, const Crack &b)
            {
              // Places are grain radii / 3 apart, well above the rounding of either run.
              if (std::abs(a.reference_place.x - b.reference_place.x) > 1e-9)
                return a.reference_place.x < b.reference_place.x;
              return a.reference_place.y < b.reference_place.y;
            });
  return cracks;
}
} // namespace

namespace
{
void expect_same_bits(const ExplicitRun &one, const ExplicitRun &two)
{
  const Grains &a = one.sample.grains, &b = two.sample.grains;
  EXPECT_TRUE(same_bits(a.displacement_x, b.displacement_x));
  EXPECT_TRUE(same_bits(a.displacement_y, b.displacement_y));
  EXPECT_TRUE(same_bits(a.rotation, b.rotation));
  EXPECT_TRUE(same_bits(a.velocity_x, b.velocity_x));
  EXPECT_TRUE(same_bits(a.spin, b.spin));
  EXPECT_TRUE(same_bits(one.damping.energy, two.damping.energy));
  ASSERT_GT(one.sample.cracks.size(), 200u);
  ASSERT_EQ(one.sample.cracks.size(), two.sample.cracks.size());
  for (std::size_t c = 0; c < one.sample.cracks.size(); ++c)
  {
    const Crack &p = one.sample.cracks[c], &q = two.sample.cracks[c];
    EXPECT_EQ(p.step, q.step);
    EXPECT_EQ(p.joint, q.joint);
    EXPECT_EQ(p.element, q.element);
    EXPECT_EQ(p.mode, q.mode);
    EXPECT_EQ(p.place.x, q.place.x);
    EXPECT_EQ(p.place.y, q.place.y);
    EXPECT_EQ(p.orientation, q.orientation);
  }
  const JointEnergies e = joint_energies(a, one.sample.joints),
                      f = joint_energies(b, two.sample.joints);
  EXPECT_EQ(e.strain, f.strain);
  EXPECT_EQ(e.slip, f.slip);
  EXPECT_EQ(e.fracture, f.fracture);
}
} // namespace

TEST(Determinism, AnyNumberOfThreadsGivesTheSameBits)
{
  static_assert(48 * 48 >= threads_from_grains, "the sample is too small for threads");
  const ExplicitRun one = breaking_run(1, 600);
  for (const int n_threads : {2, 4, 16})
  {
    SCOPED_TRACE(n_threads);
    expect_same_bits(one, breaking_run(n_threads, 600));
  }
}

TEST(Numbering, IntactForcesDoNotDependOnIt)
{
  Sample sample;
  sample.grains = random_pack(15, 15, 63);
  bond_all(sample, strong_law());
  Random random(65);
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    sample.grains.displacement_x[i] = random(-0.01, 0.01);
    sample.grains.displacement_y[i] = random(-0.01, 0.01);
    sample.grains.rotation[i] = random(-1., 1.);
  }
  const std::vector<std::size_t> number = shuffled(sample.grains.size(), 66);
  Sample other = renumbered(sample, number);
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  compute_joint_forces(other.grains, other.joints, {}, nullptr);
  double scale = 0.;
  for (const double f : sample.grains.force_x)
    scale = std::max(scale, std::abs(f));
  for (std::size_t i = 0; i < number.size(); ++i)
  {
    // Another order of summation, another sign of the tangent: round-off.
    EXPECT_NEAR(sample.grains.force_x[i], other.grains.force_x[number[i]], 1e-12 * scale);
    EXPECT_NEAR(sample.grains.force_y[i], other.grains.force_y[number[i]], 1e-12 * scale);
    EXPECT_NEAR(sample.grains.torque[i], other.grains.torque[number[i]], 1e-12 * scale);
  }
  EXPECT_NEAR(joint_energies(other.grains, other.joints).strain /
                  joint_energies(sample.grains, sample.joints).strain,
              1., 1e-12);
}

TEST(Numbering, CracksDoNotDependOnIt)
{
  Sample sample;
  sample.grains = random_pack(15, 15, 67);
  bond_all(sample, breaking_law());
  shake(sample.grains, 0.4, 0.4, 68);
  const Sample other = renumbered(sample, shuffled(sample.grains.size(), 69));
  std::vector<Crack> cracks[2];
  for (const int which : {0, 1})
  {
    ExplicitRun run(which == 0 ? sample : other);
    const double dt = 0.3 * stable_step(run.sample.grains, run.sample.joints);
    for (int step = 0; step < 400; ++step)
      run.advance(dt);
    cracks[which] = by_place(run.sample.cracks);
  }
  ASSERT_GT(cracks[0].size(), 50u);
  ASSERT_EQ(cracks[0].size(), cracks[1].size());
  for (std::size_t c = 0; c < cracks[0].size(); ++c)
  {
    const Crack &a = cracks[0][c], &b = cracks[1][c];
    EXPECT_EQ(a.step, b.step) << c;
    EXPECT_EQ(a.mode, b.mode) << c;
    EXPECT_EQ(a.layer, b.layer) << c;
    // Round-off of 400 steps of a chaotic but short run.
    EXPECT_NEAR(norm(a.place - b.place), 0., 1e-9) << c;
    EXPECT_NEAR(norm(a.reference_place - b.reference_place), 0., 1e-12) << c;
    EXPECT_NEAR(std::sin(a.orientation - b.orientation), 0., 1e-9) << c;
  }
}
} // namespace antiform::discrete::test::determinism_tests

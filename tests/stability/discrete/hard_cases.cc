// What a scene should never hold, and may: grains of very different size, grains on top
// of each other, layers one grain thick.
#include "discrete/packing.h"
#include "discrete/packing_error.h"

#include "support/highest_mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace antiform::discrete::test::hard_cases_tests
{
namespace
{
/// A boulder of radius 1 in a collar of grains of radius 0.01 along @p arc of its rim,
/// two rows deep, all bonded where they touch.
Sample collar(const double arc)
{
  const double small = 0.01;
  Sample sample;
  sample.grains.add({0., 0.}, 1., 1., 0);
  for (const int row : {0, 1})
  {
    // Neighbours in the inner row touch; the outer row sits in its hollows.
    const double pitch = 2. * std::asin(small / (1. + small));
    const double out = (1. + small) * std::cos(0.5 * pitch) + std::sqrt(3.) * small;
    const double distance = row == 0 ? 1. + small : out;
    const int n = static_cast<int>(arc / pitch) - row;
    for (int i = 0; i < n; ++i)
      sample.grains.add(rotated({distance, 0.}, (i + 0.5 * row) * pitch), small, 1., 0);
  }
  bond_all(sample, strong_law(), 0.02 * small);
  return sample;
}

std::string message_of(const std::function<void()> &action)
{
  try
  {
    action();
  }
  catch (const std::exception &error)
  {
    return error.what();
  }
  return "";
}

bool all_finite(const Grains &g)
{
  for (const std::vector<double> *v :
       {&g.displacement_x, &g.displacement_y, &g.rotation, &g.velocity_x, &g.spin})
    for (const double x : *v)
      if (!std::isfinite(x))
        return false;
  return true;
}
} // namespace

TEST(RadiusRatioOfHundred, StableStepIsThatOfTheSmallGrains)
{
  const Sample sample = collar(0.4); // 20 + 19 small grains: a dense eigenproblem
  ASSERT_GT(sample.joints.size(), 70u);
  const double step = stable_step(sample.grains, sample.joints);
  const double ratio = 0.5 * step * highest_mode(sample).omega;
  EXPECT_LE(ratio, 1.);
  EXPECT_GT(ratio, 0.5);
  // A small grain alone among its kind sets it, the boulder does not: k is E t for equal
  // disks of any size and m goes with R^2.
  Sample equal;
  equal.grains = lattice(6, 6, 0.01);
  bond_all(equal, strong_law(), 1e-4);
  const double of_equal = stable_step(equal.grains, equal.joints);
  EXPECT_GT(step, 0.7 * of_equal);
  EXPECT_LT(step, 1.5 * of_equal);
}

TEST(RadiusRatioOfHundred, ClusterIsBoundedAtTheStableStep)
{
  const Threads threads(1);
  Sample sample = collar(2. * M_PI);
  ASSERT_GT(sample.grains.size(), 600u);
  for (std::size_t i = 1; i < sample.grains.size(); ++i)
  {
    const double turn = static_cast<double>(i);
    sample.grains.velocity_x[i] = 1e-5 * std::sin(7.1 * turn);
    sample.grains.velocity_y[i] = 1e-5 * std::cos(3.3 * turn);
  }
  ExplicitRun run(sample);
  const double dt = 0.99 * stable_step(run.sample.grains, run.sample.joints);
  run.first_half(dt);
  const EnergyTerms start = run.energies();
  run.second_half(dt);
  double largest = 0.;
  for (int step = 0; step < 10000; ++step)
  {
    run.first_half(dt);
    if (step % 100 == 0)
    {
      const EnergyTerms e = run.energies();
      largest = std::max(largest, e.kinetic + e.strain);
    }
    run.second_half(dt);
  }
  // Leapfrog keeps this form of the energy of a linear system at any stable step; what is
  // left is the strain of 1e-5 squared.
  EXPECT_NEAR(largest / (start.kinetic + start.strain), 1., 1e-3);
}

TEST(RadiusRatioOfHundred, SearchFindsWhatTheFullDoubleLoopFinds)
{
  Random random(71);
  Grains grains;
  for (int i = 0; i < 2000; ++i)
  {
    const double radius = std::pow(10., random(-2., 0.)) * (i % 50 == 0 ? 1. : 0.1);
    grains.add({random(0., 10.), random(0., 10.)}, radius, 1., i % 3 == 0 ? 1 : 0);
  }
  for (const double gap : {0., 0.05, -0.002})
    for (const auto &[a, b] : {std::make_pair(0, 0), std::make_pair(0, 1)})
    {
      std::vector<std::pair<std::int32_t, std::int32_t>> expected;
      for (std::int32_t i = 0; i < 2000; ++i)
        for (std::int32_t j = i + 1; j < 2000; ++j)
        {
          const double limit = grains.radius[i] + grains.radius[j] + gap;
          const Vec2 branch = grains.position(j) - grains.position(i);
          const bool belong = (grains.region[i] == a && grains.region[j] == b) ||
                              (grains.region[i] == b && grains.region[j] == a);
          if (belong && dot(branch, branch) <= limit * limit)
            expected.emplace_back(i, j);
        }
      ASSERT_GT(expected.size(), 100u);
      EXPECT_EQ(pairs_within(grains, gap, a, b), expected) << gap << a << b;
    }
}

TEST(RadiusRatioOfHundred, SearchDoesNotGoThroughAllSmallGrainsForEach)
{
  // 40000 small grains and one a hundred times as large: nine cells of its size hold them
  // all, and 1.6e9 pairs would be compared; in cells of their own it is some ten a grain.
  // The answer is known: the bonds of a lattice.
  Grains grains = lattice(200, 200, 0.01);
  grains.add({-2., 2.}, 1., 1., 0); // beside it
  const auto pairs = pairs_within(grains, 1e-9, 0, 0);
  EXPECT_EQ(pairs.size(), 200u * 199u + 199u * (200u + 199u));
}

TEST(CoincidentGrains, AreRefusedByJointsWithTheirNumbers)
{
  Sample sample;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.grains.add({3., 4.}, 0.5, 1., 0);
  sample.grains.add({3., 4.}, 0.5, 1., 0);
  const std::string message = message_of([&] { bond_all(sample, strong_law()); });
  EXPECT_NE(message.find("grains 1 and 2 coincide"), std::string::npos) << message;
  EXPECT_NE(message.find("3."), std::string::npos) << message;
}

TEST(CoincidentGrains, AreRefusedByContactsWithTheirNumbers)
{
  Sample sample;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.joints.finish(2);
  Contacts contacts;
  contacts.margin = 0.1;
  contacts.groups.push_back({0, 0, {}});
  const std::string message =
      message_of([&] { search_contacts(sample.grains, sample.joints, contacts); });
  EXPECT_NE(message.find("grains 0 and 1 coincide"), std::string::npos) << message;
}

TEST(CoincidentGrains, NearlySoArePushedApart)
{
  // A contact knows its direction however short the branch: they part along it, with the
  // energy of the overlap.
  Sample sample;
  const double short_branch = 1e-12;
  sample.grains.add({0., 0.}, 0.5, 1., 0);
  sample.grains.add({0.6 * short_branch, 0.8 * short_branch}, 0.5, 1., 0);
  sample.joints.begin_group(strong_law(), 0, "none");
  sample.joints.finish(2);
  ExplicitRun run(sample);
  run.has_contacts = true;
  run.contacts.margin = 0.1;
  LinearContact law;
  law.effective_modulus = 1e3;
  run.contacts.groups.push_back({0, 0, law});
  for (int i = 0; i < 4000; ++i)
    run.advance(1e-4);
  const Grains &g = run.sample.grains;
  ASSERT_TRUE(all_finite(g));
  // Overlap of 1: v = sqrt(k / m) / sqrt(2) each.
  const double speed = std::sqrt(0.5 * 1e3 / g.mass[0]);
  EXPECT_NEAR(g.velocity_x[1] / (0.6 * speed), 1., 1e-3);
  EXPECT_NEAR(g.velocity_y[1] / (0.8 * speed), 1., 1e-3);
  EXPECT_NEAR(g.velocity_x[0] / (-0.6 * speed), 1., 1e-3);
}

TEST(ThinLayer, OneGrainThickIsPackedOrRefusedWithTheReason)
{
  // One, one and a bit, and two diameters thick, 40 long; floaters are grains with fewer
  // than three bonds, and a chain has two each.
  for (const double thickness : {0.5, 1., 1.1, 1.3, 2., 3.})
  {
    PackingParameters p;
    p.mean_diameter = 1.;
    p.seed = 3;
    std::size_t packed = 0;
    const std::string message = message_of(
        [&]
        {
          const Packing packing =
              pack_polygon({{0., 0.}, {40., 0.}, {40., thickness}, {0., thickness}}, p);
          packed = packing.quality.grains;
          EXPECT_EQ(packing.quality.floaters, 0u) << thickness;
          EXPECT_LT(packing.quality.largest_overlap, 0.01) << thickness;
          for (const Disk &disk : packing.disks)
          {
            EXPECT_GT(disk.centre.y, disk.radius - 0.02) << thickness;
            EXPECT_LT(disk.centre.y, thickness - disk.radius + 0.02) << thickness;
          }
        });
    std::printf("thickness %g: %zu grains; %s\n", thickness, packed, message.c_str());
    if (packed == 0)
    {
      EXPECT_EQ(message.rfind("Packing: ", 0) == 0 || message.rfind("packing: ", 0) == 0,
                true)
          << message;
      EXPECT_NE(message.find("give"), std::string::npos) << message; // a remedy
    }
  }
}

TEST(ThinLayer, ChainOfSingleGrainsSwingsWithoutGainingEnergy)
{
  // Needle: 100 grains in a row, one end held, let go from a bend of many radii.
  const Threads threads(1);
  Sample sample;
  for (int i = 0; i < 100; ++i)
    sample.grains.add({static_cast<double>(i), 0.}, 0.5, 1., 0);
  bond_all(sample, strong_law(), 1e-9);
  ASSERT_EQ(sample.joints.size(), 99u);
  hold(sample.grains, 0);
  for (std::size_t i = 1; i < 100; ++i)
    sample.grains.velocity_y[i] = 1e-3 * static_cast<double>(i);
  ExplicitRun run(sample);
  const double dt = 0.5 * stable_step(run.sample.grains, run.sample.joints);
  double first = 0., worst = 0., sweep = 0.;
  for (int step = 0; step < 40000; ++step)
  {
    run.first_half(dt);
    if (step % 50 == 0)
    {
      const EnergyTerms e = run.energies();
      if (step == 0)
        first = e.kinetic + e.strain;
      worst = std::max(worst, std::abs((e.kinetic + e.strain) / first - 1.));
      sweep = std::max(sweep, std::abs(run.sample.grains.displacement_y[99]));
    }
    run.second_half(dt);
  }
  EXPECT_GT(sweep, 1.); // more than a diameter
  // Finite rotation at w dt = 1 of the stiffest mode: strain times (w dt)^2.
  EXPECT_LT(worst, 1e-3);
}
} // namespace antiform::discrete::test::hard_cases_tests

// Case 23 of docs/validation.md: the quality of a packing, and what it is asked for.
#include "discrete/locked_in.h"
#include "discrete/measurement_circles.h"
#include "discrete/packing.h"

#include "support/files.h"
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace packing_quality_tests
{
using namespace antiform;
using namespace antiform::discrete;
using namespace antiform::discrete::test;

namespace
{
constexpr double d = 0.002; // mean diameter [m]

PackingParameters parameters(const double porosity, const std::uint64_t seed = 1)
{
  PackingParameters p;
  p.mean_diameter = d;
  p.porosity = porosity;
  p.seed = seed;
  return p;
}

/// A specimen of @p width x @p height mean diameters about the origin.
std::vector<Vec2> specimen(const double width, const double height)
{
  const double x = 0.5 * width * d, y = 0.5 * height * d;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

double mean_diameter(const std::vector<Disk> &disks)
{
  double sum = 0.;
  for (const Disk &disk : disks)
    sum += 2. * disk.radius;
  return sum / static_cast<double>(disks.size());
}

/// Disks as bonded grains, between four walls.
struct Specimen
{
  Sample sample;
  std::vector<Wall> walls;
  std::vector<Vec2> outline;

  Specimen(const double width, const double height, const std::uint64_t seed)
      : outline(specimen(width, height))
  {
    for (const Disk &disk : pack_polygon(outline, parameters(0., seed)).disks)
      sample.grains.add(disk.centre, disk.radius, 2500., 0);
    FlatJoint law;
    bond_all(sample, law, 0.15 * d);
    for (const Vec2 &normal : {Vec2{1., 0.}, Vec2{-1., 0.}, Vec2{0., 1.}, Vec2{0., -1.}})
    {
      Wall wall;
      wall.normal = normal;
      wall.point = {-0.5 * width * d * normal.x, -0.5 * height * d * normal.y};
      walls.push_back(wall);
      install_wall_contacts(sample.grains, walls.back(), d, 0.3 * d,
                            {law.effective_modulus});
    }
  }
};
} // namespace

TEST(PackingQuality, ReachesTheWantedPorosity)
{
  // Jammed between these walls, disks have 0.18.
  for (const double porosity : {0.19, 0.22, 0.25})
    for (const std::uint64_t seed : {1, 2})
    {
      SCOPED_TRACE(std::to_string(porosity) + ", seed " + std::to_string(seed));
      const Packing packing =
          pack_polygon(specimen(24., 16.), parameters(porosity, seed));
      // 0.005 is the check list's; floaters and isotropy are those of any packing.
      EXPECT_NEAR(packing.quality.porosity, porosity, 0.005);
      EXPECT_EQ(packing.quality.floaters, 0U);
      EXPECT_LT(packing.quality.fabric_anisotropy, 0.05);
      EXPECT_LT(packing.quality.largest_overlap, 0.01);
      EXPECT_NEAR(mean_diameter(packing.disks), d, 0.02 * d); // what packings promise
    }
}

TEST(PackingQuality, RefusesPorositiesOutOfReachByTheirRange)
{
  using antiform::test::message_of;
  const std::string dense = message_of<std::invalid_argument>(
      [] { pack_polygon(specimen(12., 8.), parameters(0.1)); });
  EXPECT_NE(dense.find("jam at a porosity of 0.1"), std::string::npos) << dense;
  const std::string loose = message_of<std::invalid_argument>(
      [] { pack_polygon(specimen(12., 8.), parameters(0.5)); });
  EXPECT_NE(loose.find("reaches porosities of"), std::string::npos) << loose;
}

TEST(PackingQuality, GapGivesTheWantedCoordination)
{
  const Packing packing = pack_polygon(specimen(24., 16.), parameters(0.));
  const auto n = static_cast<double>(packing.disks.size());
  for (const double wanted : {4.2, 4.7, 5.2})
  {
    const double gap = gap_for_coordination(packing.disks, wanted, 0.5 * d);
    const PackingQuality q = polygon_quality(packing.disks, specimen(24., 16.), d, gap);
    EXPECT_NEAR(q.coordination_number, wanted, 1. / n + 1e-12); // half a pair, rounded
    EXPECT_GT(gap, 0.);
    EXPECT_LE(gap, 0.5 * d);
  }
  const std::string text = antiform::test::message_of<std::invalid_argument>(
      [&] { gap_for_coordination(packing.disks, 9., 0.5 * d); });
  EXPECT_NE(text.find("reaches coordination numbers of"), std::string::npos) << text;
}

TEST(PackingQuality, StressIsHomogeneous)
{
  // The check list's 20 %, in circles of ten diameters.
  for (const std::uint64_t seed : {1, 2, 3})
  {
    const Packing packing = pack_polygon(specimen(48., 32.), parameters(0., seed));
    EXPECT_LT(packing.quality.stress_variation, 0.2);
    EXPECT_GT(packing.quality.stress_variation, 0.);
  }
}

TEST(PackingQuality, LockedInStressIsTheWantedOneAndAtRest)
{
  const double pressure = 2e6;
  Specimen s(48., 24., 1);
  ASSERT_TRUE(lock_in(s.sample.grains, s.outline, pressure, s.sample.joints, s.walls));
  Grains &grains = s.sample.grains;
  compute_joint_forces(grains, s.sample.joints, {}, nullptr);
  for (Wall &wall : s.walls)
    add_wall_forces(grains, wall);
  // At rest: as well as the packing was relaxed, 1e-6 of the contact forces.
  double unbalanced = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
    unbalanced += std::hypot(grains.force_x[i], grains.force_y[i]) /
                  static_cast<double>(grains.size());
  EXPECT_LT(unbalanced, 3e-6 * pressure * d);

  // The circle around the whole specimen holds all forces: its mean stress by the area of
  // the specimen is exact in the trace, and isotropic within the 5 % asked for.
  const double radius = 60. * d, share = M_PI * radius * radius / (48. * 24. * d * d);
  const ForceCarriers carriers{&s.sample.joints, nullptr, {&s.walls}};
  const PlaneTensor all = measure(grains, carriers, {{0., 0.}, radius}).stress;
  EXPECT_NEAR(-0.5 * share * (all.xx + all.yy) / pressure, 1., 1e-5);
  EXPECT_NEAR(-share * all.xx / pressure, 1., 0.05);
  EXPECT_NEAR(-share * all.yy / pressure, 1., 0.05);
  EXPECT_NEAR(share * all.xy / pressure, 0., 0.05);
  // The walls of the vessel feel it, and so does a circle well within the specimen, by
  // the scatter that the check list allows a circle.
  EXPECT_NEAR(s.walls[0].reaction / (24. * d * pressure), 1., 0.05);
  EXPECT_NEAR(s.walls[2].reaction / (48. * d * pressure), 1., 0.05);
  const PlaneTensor inside = measure(grains, carriers, {{0., 0.}, 10. * d}).stress;
  EXPECT_NEAR(-0.5 * (inside.xx + inside.yy) / pressure, 1., 0.2);
}

TEST(PackingQuality, GrainsThatDoNotTouchHaveNoForcesToKeep)
{
  Sample sample;
  sample.grains = lattice(4, 4, 0.5);
  for (double &radius : sample.grains.radius)
    radius = 0.48;
  bond_all(sample, strong_law());
  std::vector<Wall> none;
  EXPECT_FALSE(lock_in(sample.grains, {{-1., -1.}, {5., -1.}, {5., 5.}, {-1., 5.}}, 1.,
                       sample.joints, none));
  EXPECT_TRUE(sample.joints.initial_gap.empty());
}
} // namespace packing_quality_tests

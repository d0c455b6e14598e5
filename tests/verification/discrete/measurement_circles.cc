// Averages in measurement circles against closed forms.
#include "discrete/measurement_circles.h"

#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

namespace measurement_circles_tests
{
using namespace antiform;
using namespace antiform::discrete;
using namespace antiform::discrete::test;

namespace
{
constexpr double xx = 1e-5, yy = -4e-6, xy = 3e-6; // strain of the patches

/// A bonded lattice of @p n columns in the uniform strain of the patches. On a lattice
/// uniform motion is equilibrium, and its moduli are exact.
Sample strained_lattice(const int n)
{
  Sample sample;
  sample.grains = lattice(n, n);
  bond_all(sample, strong_law());
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    const Vec2 x = sample.grains.reference(i);
    sample.grains.displacement_x[i] = xx * x.x + xy * x.y;
    sample.grains.displacement_y[i] = xy * x.x + yy * x.y;
    sample.grains.velocity_x[i] = 2. * sample.grains.displacement_x[i];
    sample.grains.velocity_y[i] = 2. * sample.grains.displacement_y[i];
  }
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  return sample;
}

/// Stress of that lattice: E = 2 sqrt(3) E* (k + 1) / (3 k + 1), nu = (k - 1) / (3 k + 1)
/// in the plane, isotropic.
PlaneTensor lattice_stress()
{
  const double k = strong_law().stiffness_ratio, modulus = strong_law().effective_modulus;
  const double e = 2. * std::sqrt(3.) * modulus * (k + 1.) / (3. * k + 1.),
               nu = (k - 1.) / (3. * k + 1.), c = e / (1. - nu * nu);
  return {c * (xx + nu * yy), c * (yy + nu * xx), e / (1. + nu) * xy};
}

Vec2 middle(const Grains &grains)
{
  // Half of a row beyond the begin of the middle row.
  const auto columns = static_cast<std::size_t>(std::lround(std::sqrt(grains.size())));
  return grains.reference(grains.size() / 2 + columns / 2);
}

/// Mean over centres that cover a cell of the lattice evenly.
CircleMeasure mean_over_a_cell(const Sample &sample, const double radius, const int n)
{
  CircleMeasure mean;
  const double share = 1. / (n * n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
    {
      const Vec2 shift{(a + 0.5) / n + 0.5 * (b + 0.5) / n,
                       0.5 * std::sqrt(3.) * (b + 0.5) / n};
      const CircleMeasure m = measure(sample.grains, {&sample.joints, nullptr, {}},
                                      {middle(sample.grains) + shift, radius});
      mean.stress.xx += share * m.stress.xx;
      mean.stress.yy += share * m.stress.yy;
      mean.stress.xy += share * m.stress.xy;
      mean.porosity += share * m.porosity;
    }
  return mean;
}
} // namespace

TEST(MeasurementCircle, StressOfALatticeIsTheAppliedOneInTheMeanOverItsPlace)
{
  const Sample sample = strained_lattice(24);
  const PlaneTensor exact = lattice_stress();
  // The mean over all places in a cell is exact for any radius; 6 x 6 places leave the
  // harmonics of the cell beyond the sixth, which fall off as the power -3/2 of their
  // number and of the radius: 1 / (6 x 8)^(3/2).
  const CircleMeasure mean = mean_over_a_cell(sample, 8., 6);
  const double tolerance = std::pow(48., -1.5) * exact.xx;
  EXPECT_NEAR(mean.stress.xx, exact.xx, tolerance);
  EXPECT_NEAR(mean.stress.yy, exact.yy, tolerance);
  EXPECT_NEAR(mean.stress.xy, exact.xy, tolerance);
  EXPECT_GT(exact.xx, 0.); // tension is positive
  EXPECT_NEAR(mean.porosity, 1. - M_PI / std::sqrt(12.), std::pow(48., -1.5));
}

TEST(MeasurementCircle, ScatterOfTheStressFallsWithTheRadius)
{
  const Sample sample = strained_lattice(64);
  const PlaneTensor exact = lattice_stress();
  const auto scatter = [&](const double radius)
  {
    // Over places and radii within half a diameter: the error of one radius fluctuates.
    double sum = 0.;
    for (int k = 0; k < 256; ++k)
    {
      const Vec2 shift{std::fmod(0.618034 * k, 1.), std::fmod(0.754878 * k, 1.)};
      const double r = radius - 0.5 + std::fmod(0.569840 * k, 1.);
      const CircleMeasure m = measure(sample.grains, {&sample.joints, nullptr, {}},
                                      {middle(sample.grains) + shift, r});
      sum += std::pow(m.stress.xx / exact.xx - 1., 2);
    }
    return std::sqrt(sum / 256.);
  };
  // The rim cuts branches at random places: relative error of the power -3/2, as in
  // the circle problem; PFC advises ten grains across.
  const double five = scatter(5.), twenty = scatter(20.);
  EXPECT_LT(five, 0.03);
  EXPECT_NEAR(std::log(five / twenty) / std::log(4.), 1.5, 0.4);
}

TEST(MeasurementCircle, AroundAWholeBodyIsTheMeanOfItsBoundaryForces)
{
  // Stress times area of the circle is the sum of x times force over external forces,
  // for any body in equilibrium (divergence theorem): no packing is needed.
  Sample sample;
  sample.grains = random_pack(6, 5, 3);
  bond_all(sample, strong_law());
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    const Vec2 x = sample.grains.reference(i);
    sample.grains.displacement_x[i] = 1e-4 * std::sin(3. * x.x + x.y);
    sample.grains.displacement_y[i] = 1e-4 * std::cos(2. * x.x - x.y);
    sample.grains.rotation[i] = 1e-4 * std::sin(x.y);
  }
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  double fx_x = 0., fy_y = 0., shear = 0., largest = 0.;
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
  {
    const Vec2 x = sample.grains.position(i);
    const double fx = -sample.grains.force_x[i], fy = -sample.grains.force_y[i];
    fx_x += x.x * fx;
    fy_y += x.y * fy;
    shear += 0.5 * (x.x * fy + x.y * fx);
    largest += std::abs(x.x * fx);
  }
  const MeasurementCircle circle{{3., 2.}, 20.};
  const double area = M_PI * 400.;
  const CircleMeasure m = measure(sample.grains, {&sample.joints, nullptr, {}}, circle);
  const double tolerance = 1e-12 * largest / area; // sums of 80 forces
  EXPECT_NEAR(m.stress.xx, fx_x / area, tolerance);
  EXPECT_NEAR(m.stress.yy, fy_y / area, tolerance);
  EXPECT_NEAR(m.stress.xy, shear / area, tolerance);
  EXPECT_EQ(m.grains, sample.grains.size());
  EXPECT_NEAR(m.coordination_number,
              2. * static_cast<double>(sample.joints.size()) /
                  static_cast<double>(sample.grains.size()),
              1e-12);
}

TEST(MeasurementCircle, CountsContactsAndWallsLikeJoints)
{
  // Three disks in a column, squeezed between two walls by 1 % of their diameter in all:
  // the same force everywhere.
  Grains grains;
  for (int k = 0; k < 3; ++k)
    grains.add({0., 0.5 + k}, 0.5, 1., 0);
  Contacts contacts;
  contacts.margin = 0.1;
  ContactGroup group;
  group.law.effective_modulus = 1e3;
  contacts.groups.push_back(group);
  std::vector<Wall> walls(2);
  walls[0].point = {0., 0.};
  walls[0].normal = {0., 1.};
  walls[1].point = {0., 3.};
  walls[1].normal = {0., -1.};
  for (Wall &wall : walls)
    install_wall_contacts(grains, wall, 0.1, 0.1, {1e3});
  // Stiffness of a pair: 2 R E / (2 R) = 1e3; of a wall 2 E = 2e3.
  const double force = 2., pair = force / 1e3, wall = force / 2e3;
  for (int k = 0; k < 3; ++k)
    grains.displacement_y[k] = -wall - k * pair;
  walls[1].displacement = 2. * wall + 2. * pair;
  search_contacts(grains, Joints{}, contacts);
  grains.force_x.assign(3, 0.);
  grains.force_y.assign(3, 0.);
  add_contact_forces(grains, contacts, 1.);
  for (Wall &one : walls)
    add_wall_forces(grains, one);
  for (const double f : grains.force_y)
    ASSERT_NEAR(f, 0., 1e-11); // rest
  const MeasurementCircle circle{{0., 1.5}, 2.};
  const CircleMeasure m = measure(grains, {nullptr, &contacts, {&walls}}, circle);
  const double height = 3. - 2. * wall - 2. * pair;
  EXPECT_NEAR(m.stress.yy, -force * height / (4. * M_PI), 1e-12);
  EXPECT_NEAR(m.stress.xx, 0., 1e-15);
  EXPECT_NEAR(m.coordination_number, 4. / 3., 1e-15);
  const double lenses = 2. * common_area({{{0., 0.}, 0.5}, {{0., 1. - pair}, 0.5}});
  EXPECT_NEAR(m.porosity, 1. - (0.75 * M_PI - lenses) / (4. * M_PI), 1e-14);
}

TEST(MeasurementCircle, StrainIsThatOfAUniformField)
{
  const Sample sample = strained_lattice(24);
  const CircleMeasure m = measure(sample.grains, {&sample.joints, nullptr, {}},
                                  {middle(sample.grains) + Vec2{0.3, 0.1}, 5.});
  // Least squares reproduce a linear field to round-off of its sums.
  EXPECT_NEAR(m.strain.xx, xx, 1e-12 * xx);
  EXPECT_NEAR(m.strain.yy, yy, 1e-12 * xx);
  EXPECT_NEAR(m.strain.xy, xy, 1e-12 * xx);
  // The rate refers to where the grains are now: of the order of the strain off.
  EXPECT_NEAR(m.strain_rate.xx, 2. * xx, 2. * xx * xx * 2.);
  EXPECT_NEAR(m.strain_rate.xy, 2. * xy, 2. * xx * xx * 2.);
}

TEST(MeasurementCircle, AreasOfOverlapAreExact)
{
  // Two disks: the lens. Three unit disks at the corners of a unit triangle: the
  // Reuleaux triangle, (pi - sqrt(3)) / 2.
  const std::vector<Disk> corners{
      {{5., 7.}, 1.}, {{6., 7.}, 1.}, {{5.5, 7. + 0.5 * std::sqrt(3.)}, 1.}};
  EXPECT_NEAR(common_area({corners[0], corners[1]}), 2. * M_PI / 3. - 0.5 * std::sqrt(3.),
              1e-14);
  EXPECT_NEAR(common_area(corners), 0.5 * (M_PI - std::sqrt(3.)), 1e-14);
  EXPECT_NEAR(common_area({{{0., 0.}, 2.}, {{0.5, 0.}, 1.}}), M_PI, 1e-14);
  EXPECT_EQ(common_area({{{0., 0.}, 1.}, {{3., 0.}, 1.}}), 0.);
}

TEST(MeasurementCircle, TakesTheShareOfABranchThatLiesInside)
{
  const MeasurementCircle circle{{0., 0.}, 1.};
  EXPECT_DOUBLE_EQ(share_inside({-0.5, 0.}, {0.5, 0.}, circle), 1.);
  EXPECT_DOUBLE_EQ(share_inside({-2., 0.}, {2., 0.}, circle), 0.5);
  EXPECT_DOUBLE_EQ(share_inside({0., 0.}, {0., 4.}, circle), 0.25);
  EXPECT_EQ(share_inside({2., 0.}, {3., 0.}, circle), 0.);
  EXPECT_EQ(share_inside({-2., 1.5}, {2., 1.5}, circle), 0.);
}

TEST(MeasurementCircle, FollowsTheRock)
{
  Sample sample = strained_lattice(12);
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
    sample.grains.displacement_x[i] = 0.25, sample.grains.displacement_y[i] = -0.5;
  const MeasurementCircle moved = follow(sample.grains, {{6., 5.}, 3.});
  EXPECT_DOUBLE_EQ(moved.centre.x, 6.25);
  EXPECT_DOUBLE_EQ(moved.centre.y, 4.5);
  const MeasurementCircle empty = follow(sample.grains, {{100., 5.}, 3.});
  EXPECT_EQ(empty.centre.x, 100.);
}
} // namespace measurement_circles_tests

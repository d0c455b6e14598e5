#include "discrete/homogenise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace homogenise_tests
{
using namespace antiform;
using namespace antiform::discrete;

namespace
{
constexpr double d = 0.002;      // mean diameter [m]
constexpr double gap = 0.15 * d; // installation gap: 0.3 mean radii

const PeriodicTile &random_tile()
{
  static const PeriodicTile tile = []
  {
    PackingParameters p;
    p.mean_diameter = d;
    p.seed = 4;
    return pack_periodic({16. * d, 14. * d}, p);
  }();
  return tile;
}

/// Installed geometry and stiffness of a joint, written down a second time.
struct Plain
{
  Vec2 n, t, branch;
  double r1, r2;
  double normal, shear, moment; ///< stiffnesses

  Plain(const PeriodicTile &tile, const TileJoint &joint, const FlatJoint &law)
  {
    const Disk &a = tile.disks[joint.first], &b = tile.disks[joint.second];
    branch = b.centre + joint.shift - a.centre;
    n = (1. / norm(branch)) * branch;
    t = {-n.y, n.x};
    const double g0 = norm(branch) - a.radius - b.radius;
    r1 = a.radius + 0.5 * g0;
    r2 = b.radius + 0.5 * g0;
    const double k = law.effective_modulus / (a.radius + b.radius);
    const double width = 2. * law.radius_multiplier * std::min(a.radius, b.radius);
    normal = k * width;
    shear = normal / law.stiffness_ratio;
    moment = k * std::pow(width, 3) / 12.;
  }
};
} // namespace

TEST(Homogenise, EveryGrainIsBalancedInEveryCorrector)
{
  const FlatJoint law;
  const PeriodicTile &tile = random_tile();
  const TileResponse r = homogenise(tile, gap, law);
  for (int k = 0; k < 3; ++k)
  {
    std::vector<Vec2> force(tile.disks.size());
    std::vector<double> torque(tile.disks.size(), 0.);
    double scale = 0.;
    for (std::size_t j = 0; j < r.joints.size(); ++j)
    {
      const Plain p(tile, r.joints[j], law);
      const auto &[opening, slide, turn] = r.deformation[j][k];
      const double f_n = p.normal * opening, f_s = p.shear * slide, m = p.moment * turn;
      // The joint pulls the second grain back; shear acts on the faces, not the centres.
      const Vec2 on_first = f_n * p.n + f_s * p.t;
      force[r.joints[j].first] += on_first;
      force[r.joints[j].second] += -on_first;
      torque[r.joints[j].first] += p.r1 * f_s + m;
      torque[r.joints[j].second] += p.r2 * f_s - m;
      scale += norm(on_first) / static_cast<double>(r.joints.size());
    }
    for (std::size_t i = 0; i < tile.disks.size(); ++i)
    {
      EXPECT_LE(norm(force[i]), 1e-10 * scale) << "grain " << i << ", strain " << k;
      EXPECT_LE(std::abs(torque[i]), 1e-10 * scale * d) << "grain " << i;
    }
  }
}

TEST(Homogenise, MeanStressOfTheJointsIsTheStiffness)
{
  // Stress as the mean of force times branch: another way to the same numbers.
  const FlatJoint law;
  const PeriodicTile &tile = random_tile();
  const TileResponse r = homogenise(tile, gap, law);
  const double tile_area = tile.size.x * tile.size.y;
  for (int k = 0; k < 3; ++k)
  {
    double xx = 0., yy = 0., xy = 0., yx = 0.;
    for (std::size_t j = 0; j < r.joints.size(); ++j)
    {
      const Plain p(tile, r.joints[j], law);
      const Vec2 f = (p.normal * r.deformation[j][k][0]) * p.n +
                     (p.shear * r.deformation[j][k][1]) * p.t;
      xx += f.x * p.branch.x / tile_area;
      yy += f.y * p.branch.y / tile_area;
      xy += f.x * p.branch.y / tile_area;
      yx += f.y * p.branch.x / tile_area;
    }
    const double scale = r.stiffness[0][0];
    EXPECT_NEAR(xx, r.stiffness[k][0], 1e-10 * scale);
    EXPECT_NEAR(yy, r.stiffness[k][1], 1e-10 * scale);
    EXPECT_NEAR(xy, r.stiffness[k][2], 1e-10 * scale);
    EXPECT_NEAR(yx, r.stiffness[k][2], 1e-10 * scale); // balance of torque
  }
}

TEST(Homogenise, StiffnessIsSymmetricIsotropicAndBelowTheAffineBound)
{
  const FlatJoint law;
  const PeriodicTile &tile = random_tile();
  const TileResponse r = homogenise(tile, gap, law);
  const auto &c = r.stiffness;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l)
      EXPECT_NEAR(c[k][l], c[l][k], 1e-12 * c[0][0]);
  // 200 grains: anisotropy of a few per cent.
  EXPECT_NEAR(c[0][0], c[1][1], 0.15 * c[0][0]);
  EXPECT_NEAR(c[2][2], 0.5 * (c[0][0] - c[0][1]), 0.15 * c[2][2]);

  // Affine motion without rotation is one admissible state: its energy is no less.
  std::array<double, 3> affine{};
  for (const TileJoint &joint : r.joints)
  {
    const Plain p(tile, joint, law);
    const Vec2 l = p.branch;
    const std::array<Vec2, 3> u = {Vec2{l.x, 0.}, Vec2{0., l.y},
                                   Vec2{0.5 * l.y, 0.5 * l.x}};
    for (int k = 0; k < 3; ++k)
      affine[k] += (p.normal * std::pow(dot(p.n, u[k]), 2) +
                    p.shear * std::pow(dot(p.t, u[k]), 2)) /
                   (tile.size.x * tile.size.y);
  }
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_LT(c[k][k], affine[k]);
    EXPECT_GT(c[k][k], 0.5 * affine[k]);
  }

  // Closed form of that bound: E / E* = 2 z s (kappa + 1) / (pi (3 kappa + 1)).
  const double kappa = law.stiffness_ratio;
  const double bound = 2. * tile.quality.coordination_number * r.density_factor / M_PI *
                       (kappa + 1.) / (3. * kappa + 1.);
  const double e_2d = r.young_modulus / (1. - r.poisson_ratio * r.poisson_ratio);
  EXPECT_LT(e_2d / law.effective_modulus, bound);
}

TEST(Homogenise, ElementsOfConstantStressAreSofter)
{
  FlatJoint law;
  const double linear = homogenise(random_tile(), gap, law).young_modulus;
  law.element_moment = false;
  const double three = homogenise(random_tile(), gap, law).young_modulus;
  law.n_elements = 1000;
  const double many = homogenise(random_tile(), gap, law).young_modulus;
  EXPECT_LT(three, linear);
  EXPECT_NEAR(many, linear, 1e-5 * linear); // 1 / N^2
}

TEST(Homogenise, RefusesATileWithAMechanism)
{
  PeriodicTile tile;
  tile.size = {4., 4.};
  tile.disks = {{{1., 1.}, 0.5}, {{2., 1.}, 0.5}, {{1., 3.}, 0.5}};
  EXPECT_THROW(homogenise(tile, 0.1, FlatJoint{}), std::runtime_error);
  tile.disks.clear();
  EXPECT_THROW(homogenise(tile, 0.1, FlatJoint{}), std::invalid_argument);
}

TEST(MatchModuli, ReachesTheModuliAskedFor)
{
  FlatJoint law;
  law.effective_modulus = 1e9;
  law.cohesion = 7e6;
  for (const double nu : {0.05, 0.1, 0.2, 0.25})
  {
    const FlatJoint matched = match_moduli(random_tile(), gap, law, 5e6, nu);
    const TileResponse r = homogenise(random_tile(), gap, matched);
    EXPECT_NEAR(r.young_modulus, 5e6, 1e-3 * 5e6);
    EXPECT_NEAR(r.poisson_ratio, nu, 1e-3 * nu);
    EXPECT_EQ(matched.cohesion, law.cohesion);
  }
}

TEST(MatchModuli, NamesTheReachableRange)
{
  FlatJoint law;
  law.stiffness_ratio = 1.;
  const double low = homogenise(random_tile(), gap, law).poisson_ratio;
  law.stiffness_ratio = 50.;
  const double high = homogenise(random_tile(), gap, law).poisson_ratio;
  for (const double nu : {0.45, 0.})
    try
    {
      match_moduli(random_tile(), gap, law, 5e6, nu);
      ADD_FAILURE() << "nu = " << nu << " was not refused";
    }
    catch (const std::invalid_argument &error)
    {
      const std::string text = error.what();
      for (const double bound : {low, high})
      {
        char number[32];
        std::snprintf(number, sizeof number, "%.4g", bound);
        EXPECT_NE(text.find(number), std::string::npos) << text;
      }
    }
}
} // namespace homogenise_tests

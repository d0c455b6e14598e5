#include "discrete/fractures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace antiform::discrete::test::fractures_tests
{
namespace
{
const std::vector<Vec2> square = {{0., 0.}, {20., 0.}, {20., 20.}, {0., 20.}};
/// An L: what is inside of a segment may be in two pieces.
const std::vector<Vec2> bent = {{0., 0.}, {20., 0.}, {20., 5.}, {5., 5.}, {5., 20.},
                                {0., 20.}};
} // namespace

TEST(Fractures, CrossBranchesBetweenTheirTipsOnly)
{
  const Fracture fracture{{0., 0.}, {2., 0.}, {}};
  EXPECT_TRUE(crosses(fracture, {1., -1.}, {1., 1.}));
  EXPECT_TRUE(crosses(fracture, {1., 1.}, {1.5, -1.}));
  EXPECT_FALSE(crosses(fracture, {3., -1.}, {3., 1.}));
  EXPECT_FALSE(crosses(fracture, {1., 1.}, {1., 2.}));
  EXPECT_TRUE(crosses(fracture, {1., -1.}, {1., 0.})); // on it: the left side
  EXPECT_FALSE(crosses(fracture, {1., 1.}, {1., 0.}));
}

TEST(Fractures, LengthInsideAPolygonIsThatOfItsPieces)
{
  EXPECT_NEAR(length_inside(square, {-5., 10.}, {25., 10.}), 20., 1e-12);
  EXPECT_NEAR(length_inside(square, {5., 5.}, {8., 9.}), 5., 1e-12);
  EXPECT_EQ(length_inside(square, {25., 5.}, {30., 9.}), 0.);
  // From one arm of the L across the outside to the other: x + y = 12.
  EXPECT_NEAR(length_inside(bent, {12., 0.}, {0., 12.}), 10. * std::sqrt(2.), 1e-12);
}

TEST(Fractures, ParallelSetsLieAtTheirSpacingAndHaveOneOverItAsIntensity)
{
  for (const double angle : {0., 0.5 * M_PI})
  {
    const std::vector<Fracture> set =
        parallel_fractures(square, {angle, 2., 0.5, {}});
    ASSERT_EQ(set.size(), 10u);
    for (const Fracture &f : set)
      EXPECT_NEAR(f.length(), 20., 1e-12);
  }
  // Oblique: the traces' lengths times the spacing are the square's area by the midpoint
  // rule, whose error for the lengths' four kinks of slope is spacing^2 / 8 of each.
  for (const double phase : {0., 0.3, 0.5})
  {
    const double angle = M_PI / 6., spacing = 2.;
    const std::vector<Fracture> set =
        parallel_fractures(square, {angle, spacing, phase, {}});
    const double slope = 1. / (std::sin(angle) * std::cos(angle));
    double length = 0.;
    for (std::size_t k = 0; k < set.size(); ++k)
    {
      length += set[k].length();
      const Vec2 along = set[k].end - set[k].begin;
      EXPECT_NEAR(std::atan2(along.y, along.x), angle, 1e-12);
      if (k > 0)
      {
        EXPECT_NEAR(cross(along, set[k].begin - set[k - 1].begin) / norm(along), spacing,
                    1e-12);
      }
      // Of the origin, the square's corner: a whole number of spacings and the phase.
      const double from = cross(along, set[k].begin) / norm(along) / spacing - phase;
      EXPECT_NEAR(from, std::round(from), 1e-12);
    }
    EXPECT_NEAR(spacing * length, 400., 4. * slope * spacing * spacing / 8.);
  }
}

TEST(Fractures, ATraceThatLeavesTheRegionAndReturnsIsInPieces)
{
  // x + y = 12 and 24, of an L with the width 5; x + y = 0 but touches a corner.
  const std::vector<Fracture> set =
      parallel_fractures(bent, {0.75 * M_PI, 12. / std::sqrt(2.), 0., {}});
  ASSERT_EQ(set.size(), 4u);
  double sum = 0.;
  for (const Fracture &f : set)
    sum += f.length();
  EXPECT_NEAR(sum, (5. + 5. + 1. + 1.) * std::sqrt(2.), 1e-12);
  // x + y = 10 touches the inner corner and goes on.
  const std::vector<Fracture> touching =
      parallel_fractures(bent, {0.75 * M_PI, 10. / std::sqrt(2.), 0., {}});
  ASSERT_GE(touching.size(), 1u);
  EXPECT_NEAR(touching.back().length(), 10. * std::sqrt(2.), 1e-12);
}

TEST(Fractures, NetworkHasTheIntensityAskedFor)
{
  using Form = LengthDistribution::Form;
  for (const Form form :
       {Form::constant, Form::exponential, Form::lognormal, Form::power_law})
    for (const auto &[region, area] : {std::pair{square, 400.}, std::pair{bent, 175.}})
    {
      FractureSet set;
      set.intensity = 0.8;
      set.orientation = 0.5;
      set.angle_deviation = 0.1;
      set.length.form = form;
      set.length.mean = 3.;
      set.length.deviation = 1.;
      set.length.least = 0.5;
      set.length.largest = 12.;
      const std::vector<Fracture> drawn = draw_fractures(region, set, 7);
      double inside = 0.;
      for (const Fracture &f : drawn)
        inside += length_inside(region, f.begin, f.end);
      EXPECT_NEAR(inside, 0.8 * area, 1e-9);
      const std::vector<Fracture> again = draw_fractures(region, set, 7);
      ASSERT_EQ(again.size(), drawn.size());
      for (std::size_t k = 0; k < drawn.size(); ++k)
        EXPECT_EQ(again[k].end.x, drawn[k].end.x);
    }
}

TEST(Fractures, OrientationsAndLengthsFollowTheirDistributions)
{
  FractureSet set;
  set.intensity = 30.;
  set.orientation = 0.7;
  set.angle_deviation = 0.2;
  set.length.form = LengthDistribution::Form::power_law;
  set.length.exponent = 2.5;
  set.length.least = 1.;
  set.length.largest = 4.;
  const std::vector<Fracture> drawn = draw_fractures(square, set, 3);
  double sum = 0., squares = 0., shorter = 0., count = 0.;
  for (const Fracture &f : drawn)
  {
    // Only those wholly inside: the chance to meet the square grows with the length.
    const double angle = std::atan2(f.end.y - f.begin.y, f.end.x - f.begin.x);
    sum += angle;
    squares += angle * angle;
    const Vec2 centre = 0.5 * (f.begin + f.end);
    if (centre.x > 2. && centre.x < 18. && centre.y > 2. && centre.y < 18.)
    {
      shorter += f.length() < 2. ? 1. : 0.;
      count += 1.;
    }
  }
  const auto n = static_cast<double>(drawn.size());
  ASSERT_GT(n, 3000.);
  const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
  EXPECT_NEAR(mean, 0.7, 4. * 0.2 / std::sqrt(n)); // four standard errors
  EXPECT_NEAR(deviation, 0.2, 4. * 0.2 / std::sqrt(2. * n));
  // P(l < 2) = (1 - 2^-1.5) / (1 - 4^-1.5)
  const double p = (1. - std::pow(2., -1.5)) / (1. - std::pow(4., -1.5));
  EXPECT_NEAR(shorter / count, p, 4. * std::sqrt(p * (1. - p) / count));
}

TEST(Fractures, ImpossibleDistributionsAreRefused)
{
  FractureSet set;
  set.intensity = 1.;
  set.length.form = LengthDistribution::Form::power_law;
  EXPECT_THROW(draw_fractures(square, set, 1), std::invalid_argument); // no bounds
  set.length.form = LengthDistribution::Form::exponential;
  set.length.mean = 1.;
  set.length.least = 100.;
  set.length.largest = 101.;
  EXPECT_THROW(draw_fractures(square, set, 1), std::invalid_argument);
}
} // namespace antiform::discrete::test::fractures_tests

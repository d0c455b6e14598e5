// Long paths of strain through the plastic laws: on or within the yield surface, and
// the flow never gives work back.
#include "continuum/plastic_laws.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace plastic_paths_tests
{
using namespace antiform::continuum;
using namespace antiform::test;
using Match = DruckerPragerParameters::Match;

namespace
{
constexpr double c = 10e6, phi = 0.6;
const auto rock = LameConstants::from_young_poisson(20e9, 0.25);

using YieldFunction = std::function<double(const PointStress &)>;

/// By its definition, from the principal stresses.
YieldFunction mohr_coulomb(const double cutoff)
{
  return [cutoff](const PointStress &stress)
  {
    const auto s = principal(stress);
    return std::max(0.5 * (s[0] - s[2]) + 0.5 * (s[0] + s[2]) * std::sin(phi) -
                        c * std::cos(phi),
                    s[0] - cutoff);
  };
}

YieldFunction drucker_prager(const double alpha, const double k)
{
  return [=](const PointStress &stress)
  {
    const auto s = principal(stress);
    const double J2 =
        (std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2)) /
        6.;
    return alpha * (s[0] + s[1] + s[2]) + std::sqrt(J2) - k;
  };
}

struct Worst
{
  double outside = 0.; ///< of the yield surface [Pa]
  double work = 0.;    ///< least work of the flow in a step, of stress x whole strain
  double plastic = 0.; ///< sum of all plastic strain
  int n_elastic = 0, n_plastic = 0;
};

/// @p n_steps of random direction, of lengths from 1e-7 to 3e-2, with a stretch without
/// which dilation would press the stress far from the tip of the surface.
Worst random_walk(const MaterialLaw &law, const YieldFunction &yield, const int n_steps)
{
  Dice dice(52);
  MaterialPoint point(law);
  point.input.initial = {-8e6, -5e6, -6e6, 1e6};
  Worst worst;
  for (int n = 0; n < n_steps; ++n)
  {
    const double length = std::pow(10., dice(-7., -1.5)), stretch = 0.2 * length;
    const std::vector<double> before = point.history;
    const PlaneVector step{stretch + length * dice(-1., 1.),
                           stretch + length * dice(-1., 1.), length * dice(-2., 2.)};
    const PointStress s = point.move(step).stress;
    worst.outside = std::max(worst.outside, yield(s));
    double flow[4], size = 0.;
    for (int i = 0; i < 4; ++i)
    {
      flow[i] = point.history[i] - before[i];
      size += std::abs(flow[i]);
    }
    ++(size > 0. ? worst.n_plastic : worst.n_elastic);
    worst.plastic += size;
    const double work = s.xx * flow[0] + s.yy * flow[1] + s.zz * flow[2] + s.xy * flow[3];
    const double whole = std::abs(point.history[0]) + std::abs(point.history[1]) +
                         std::abs(point.history[2]) + std::abs(point.history[3]);
    if (work < 0.)
      worst.work = std::min(worst.work, work / (whole * distance(s, {})));
  }
  return worst;
}

void expect_sound(const MaterialLaw &law, const YieldFunction &yield)
{
  const Worst worst = random_walk(law, yield, 100000);
  EXPECT_LT(worst.outside, 1e-10 * c);
  EXPECT_GE(worst.work, -1e-15); // round-off of the plastic strain at the end
  EXPECT_GT(worst.plastic, 1.);
  EXPECT_GT(worst.n_elastic, 10000);
  EXPECT_GT(worst.n_plastic, 10000);
  ::testing::Test::RecordProperty("outside_of_1e-16_c",
                                  static_cast<int>(worst.outside / c * 1e16));
}
} // namespace

TEST(PlasticPaths, MohrCoulombAssociated)
{
  expect_sound(MohrCoulomb(rock, {c, phi, phi, {}}), mohr_coulomb(INFINITY));
}

TEST(PlasticPaths, MohrCoulombIsochoric)
{
  expect_sound(MohrCoulomb(rock, {c, phi, 0., {}}), mohr_coulomb(INFINITY));
}

TEST(PlasticPaths, MohrCoulombWithTensionCutoff)
{
  expect_sound(MohrCoulomb(rock, {c, phi, 0.2, 2e6}), mohr_coulomb(2e6));
  expect_sound(MohrCoulomb(rock, {c, phi, 0., 0.}), mohr_coulomb(0.));
}

TEST(PlasticPaths, DruckerPragerOfEachMatch)
{
  for (const Match match : {Match::outer, Match::inner, Match::plane_strain_associated,
                            Match::plane_strain_isochoric})
    for (const double psi : {0., phi})
    {
      const DruckerPrager law(rock, {c, phi, psi, match});
      expect_sound(law, drucker_prager(law.friction_slope(), law.shear_strength()));
    }
}

TEST(PlasticPaths, AssociatedAnswersNeverSpread)
{
  // Two points on one path with different stresses at the start come nearer in the norm
  // of elastic energy at each step (Simo & Hughes 1998, contractivity).
  const MohrCoulomb cut(rock, {c, phi, phi, 3e6}), whole(rock, {c, phi, phi, {}});
  const DruckerPrager cone(rock, {c, phi, phi, Match::outer});
  for (const MaterialLaw *law :
       std::initializer_list<const MaterialLaw *>{&cut, &whole, &cone})
  {
    Dice dice(7);
    MaterialPoint a(*law), b(*law);
    a.input.initial = {-9e6, -5e6, -6e6, 1e6};
    b.input.initial = {-3e6, -7e6, -9e6, -2e6};
    double last = INFINITY;
    for (int n = 0; n < 2000; ++n)
    {
      const PlaneVector step{dice(-5e-4, 5e-4), dice(-5e-4, 5e-4), dice(-1e-3, 1e-3)};
      const PointStress s = a.move(step).stress, t = b.move(step).stress;
      const PointStress d{s.xx - t.xx, s.yy - t.yy, s.zz - t.zz, s.xy - t.xy};
      const PointStrain e = rock.strain(d);
      const double energy = d.xx * e[0] + d.yy * e[1] + d.zz * e[2] + d.xy * e[3];
      EXPECT_LE(energy, last + 1e-8 * std::min(last, 1.) + 1e-9);
      last = energy;
    }
  }
}
} // namespace plastic_paths_tests

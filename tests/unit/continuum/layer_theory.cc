#include "continuum/layer_theory.h"
#include "support/airy_solution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace layer_theory_tests
{
namespace theory = antiform::continuum::theory;
using theory::Side;

namespace
{
const theory::Layer layer{56e9, 0.25, 1.};
} // namespace

TEST(LayerTheory, SideStiffnessSolvesTheAiryEquations)
{
  using FarFace = Side::FarFace;
  for (const double nu : {0., 0.2, 0.45})
    for (const double H : {0.3, 1., 3.})
      for (const double k : {0.4, 0.7, 2.})
        for (const auto far_face : {FarFace::free, FarFace::smooth_rigid,
                                    FarFace::rough_rigid, FarFace::spring})
        {
          const double E = 3., spring = far_face == FarFace::spring ? 0.8 : 0.;
          const Side side{E, nu, H, far_face, spring};
          const double expected = antiform::test::AirySolution(side, k).smooth();
          // sinh^2 - chi^2 loses two digits at 0.12.
          EXPECT_NEAR(side.stiffness(k), expected, 1e-12 * expected)
              << "nu " << nu << ", H " << H << ", k " << k;
        }
}

TEST(LayerTheory, PhiHasTheLimitsOfThinAndDeepMatrix)
{
  // Thin: a slipping beam; a column; an oedometer. The next terms are of order chi^2.
  const double chi = 1e-4, nu = 0.3;
  EXPECT_NEAR(theory::phi_free(chi) / (chi * chi * chi / 6.), 1., chi * chi);
  EXPECT_NEAR(theory::phi_smooth_rigid(chi) * chi / 2., 1., chi * chi);
  const double oedometer =
      theory::oedometer_modulus(1., nu) / theory::plane_modulus(1., nu);
  EXPECT_NEAR(theory::phi_rough_rigid(chi, nu) * chi / 2., oedometer, 10. * chi * chi);
  for (const double deep : {30., 40., 1e5}) // chi^2 exp(-2 chi) is round-off
  {
    EXPECT_NEAR(theory::phi_free(deep), 1., 1e-13);
    EXPECT_NEAR(theory::phi_smooth_rigid(deep), 1., 1e-13);
    EXPECT_NEAR(theory::phi_rough_rigid(deep, nu), 1., 1e-13);
  }
  // Within 1 % of the half-space from these depths on.
  EXPECT_NEAR(theory::phi_free(4.64), 0.99, 1e-3);
  EXPECT_NEAR(theory::phi_smooth_rigid(3.72), 1.01, 1e-3);
}

TEST(LayerTheory, SeriesOfAThinFreeLayerJoinsTheClosedForm)
{
  // The series leaves out 4 chi^6 / 945 = 7e-11; the closed form cancels to 1e-12. The
  // function itself changes by 3e-12 over the two points.
  const double below = theory::phi_free(0.05 * (1. - 1e-12)),
               above = theory::phi_free(0.05 * (1. + 1e-12));
  EXPECT_NEAR(below, above, 1e-10 * above);
}

TEST(LayerTheory, FarSpringLiesBetweenFreeAndRigid)
{
  const double k = 0.5, E = 1e9, nu = 0.25, H = 2.;
  const auto stiffness = [&](const Side::FarFace far_face, const double spring) {
    return Side{E, nu, H, far_face, spring}.stiffness(k);
  };
  const double free = stiffness(Side::FarFace::free, 0.),
               rigid = stiffness(Side::FarFace::smooth_rigid, 0.);
  EXPECT_DOUBLE_EQ(stiffness(Side::FarFace::spring, 0.), free);
  EXPECT_NEAR(stiffness(Side::FarFace::spring, 1e25), rigid, 1e-12 * rigid);
  EXPECT_GT(stiffness(Side::FarFace::spring, 1e8), free);
  EXPECT_LT(stiffness(Side::FarFace::spring, 1e8), rigid);
  // Long waves: the layer is a rigid block on the spring.
  EXPECT_NEAR((Side{E, nu, H, Side::FarFace::spring, 1e3}.stiffness(1e-4)), 1e3, 1e-2);
}

TEST(LayerTheory, StrutBucklesAsItCrushesAtTheCriticalSlenderness)
{
  const double E = 56e9, UCS = 162e6, h = 10.;
  const double length = theory::critical_slenderness(E, UCS) * h / std::sqrt(12.);
  EXPECT_NEAR(theory::slenderness_ratio(E, UCS, length, h), 1., 1e-14);
  EXPECT_NEAR(theory::euler_stress_pinned(E, length, h), UCS, 1e-14 * UCS);
  EXPECT_NEAR(theory::euler_stress_guided(E, length, h), 4. * UCS, 1e-13 * UCS);
  EXPECT_DOUBLE_EQ(theory::stress_ratio_at_buckling(2.), 0.25);
  EXPECT_NEAR(theory::critical_slenderness(56e9, 161.7e6), 58.5, 0.05); // printed digits
  EXPECT_NEAR(theory::critical_slenderness(21.9e9, 50e6), 65.7, 0.06);
}

TEST(LayerTheory, PinnedEulerStressIsThatOfOneHalfWave)
{
  const theory::SupportedLayer strut{layer, {}};
  const double expected = theory::euler_stress_pinned(layer.plane_modulus(), 30., 1.);
  EXPECT_NEAR(strut.buckling_force(M_PI / 30.), expected * 1., 1e-13 * expected);
  EXPECT_EQ(strut.critical_mode(30.).half_waves, 1u);
  EXPECT_FALSE(strut.critical().has_value()); // the longest wave governs
  EXPECT_FALSE(strut.stress_ratio_at_buckling(162e6).has_value());
}

TEST(LayerTheory, MinimumOverWavesIsTheDeepLimit)
{
  const double E0 = 56e6, plane = theory::plane_modulus(E0, 0.3);
  const Side half_space{E0, 0.3, 0.};
  for (const bool both : {true, false})
  {
    theory::SupportedLayer buried{layer, {half_space}};
    if (both)
      buried.sides.push_back(half_space);
    const auto limit = theory::deep_limit(layer, plane, both);
    const auto found = buried.critical();
    EXPECT_TRUE(found.has_value());
    if (!found)
      continue;
    EXPECT_NEAR(found->stress, limit.stress, 1e-12 * limit.stress);
    // A minimum is flat: its place is known to the root of round-off only.
    EXPECT_NEAR(found->wavelength, limit.wavelength, 1e-7 * limit.wavelength);
    const double scale = std::cbrt(layer.plane_modulus() * plane * plane);
    EXPECT_NEAR(limit.stress / scale, both ? 0.8255 : 0.5200, 1e-4); // printed digits
  }
}

TEST(LayerTheory, CoverFollowsTheMasterCurve)
{
  // Scaled critical stress by Theta, free cover on a half-space: tabulated to four
  // digits.
  const double curve[][2] = {{0.3, 0.52449}, {0.464, 0.5354}, {0.8, 0.5829},
                             {1., 0.6240},   {1.6, 0.7632},   {3., 0.8247}};
  for (const double contrast : {1e-3, 1e-5})
    for (const auto &[variable, expected] : curve)
    {
      const double E0 = layer.young_modulus * contrast;
      const double plane = theory::plane_modulus(E0, layer.poisson_ratio);
      const double H = variable / std::cbrt(plane / layer.plane_modulus());
      EXPECT_NEAR(theory::cover_variable(H, layer.plane_modulus(), plane), variable,
                  1e-12);
      const theory::SupportedLayer buried{
          layer, {{E0, 0.25, H, Side::FarFace::free}, {E0, 0.25, 0.}}};
      const auto state = buried.critical();
      EXPECT_TRUE(state.has_value());
      if (!state)
        continue;
      EXPECT_NEAR(state->stress / std::cbrt(layer.plane_modulus() * plane * plane),
                  expected, 1e-4);
      EXPECT_NEAR(*buried.stress_ratio_at_buckling(1e6), state->stress / 1e6, 1e-12);
    }
}

TEST(LayerTheory, WinklerLayerHasTheForceOfItsSprings)
{
  theory::SupportedLayer on_springs{layer, {}, 3e6};
  const double expected = theory::winkler_critical_force(layer.bending_stiffness(), 3e6);
  const auto state = on_springs.critical();
  EXPECT_TRUE(state.has_value());
  EXPECT_NEAR(state.value_or(theory::CriticalState{}).force, expected, 1e-12 * expected);
  // The general search over half waves and the closed form pick the same mode.
  for (const double length : {10., 100., 333., 1000.})
  {
    const auto mode = on_springs.critical_mode(length),
               closed =
                   theory::winkler_critical_mode(layer.bending_stiffness(), 3e6, length);
    EXPECT_EQ(mode.half_waves, closed.half_waves);
    EXPECT_NEAR(mode.force, closed.force, 1e-12 * closed.force);
  }
}

TEST(LayerTheory, ModesChangeWhereTwoForcesAreEqual)
{
  // k_w L^4 / (pi^4 D) = m^2 (m + 1)^2.
  for (unsigned int m = 1; m < 5; ++m)
  {
    const double limit = std::pow(M_PI, 4) * m * m * (m + 1.) * (m + 1.);
    EXPECT_EQ(theory::winkler_critical_mode(1., 0.999 * limit, 1.).half_waves, m);
    EXPECT_EQ(theory::winkler_critical_mode(1., 1.001 * limit, 1.).half_waves, m + 1);
    EXPECT_NEAR(theory::winkler_mode_force(1., limit, 1., m),
                theory::winkler_mode_force(1., limit, 1., m + 1), 1e-12 * limit);
  }
}

TEST(LayerTheory, ThickLayerIsSofterByShearAndTurning)
{
  const double k = 1e-3, thin = layer.bending_stiffness() * k * k; // k h = 1e-3
  const double G = layer.young_modulus / 2.5;
  const double correction = (layer.plane_modulus() / G / 10. + 1. / 12.) * k * k;
  EXPECT_NEAR(thin / layer.thick_bending_force(k) - 1., correction, 1e-6 * correction);
}

TEST(LayerTheory, AmplificationHasNoEquilibriumAtTheBucklingForce)
{
  EXPECT_DOUBLE_EQ(theory::amplification(0.5, 1.), 2.);
  EXPECT_THROW(theory::amplification(1., 1.), std::domain_error);
}
} // namespace layer_theory_tests

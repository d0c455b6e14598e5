// Case 52: strengths of Mohr-Coulomb and Drucker-Prager points against closed forms.
#include "continuum/plastic_laws.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

#include <memory>

namespace yield_limits_tests
{
using namespace antiform::continuum;
using namespace antiform::test;
using Match = DruckerPragerParameters::Match;

namespace
{
constexpr double c = 10e6, phi = 0.6;
const double sine = std::sin(phi), cosine = std::cos(phi);
const double N_phi = (1. + sine) / (1. - sine);
const auto rock = LameConstants::from_young_poisson(20e9, 0.25);

/// Stress at the end of @p strain_xx put on in @p n_steps with a constant stress yy.
PointStress biaxial_test(const MaterialLaw &law,
                         const double strain_xx,
                         const double stress_yy,
                         const int n_steps)
{
  MaterialPoint point(law);
  point.input.initial = {stress_yy, stress_yy, stress_yy, 0.};
  PointStress stress{};
  for (int n = 0; n < n_steps; ++n)
    stress = point.move_xx_at_stress_yy(strain_xx / n_steps, stress_yy, c).stress;
  return stress;
}

double in_plane_mean(const PointStress &s)
{
  return 0.5 * (s.xx + s.yy);
}
double in_plane_radius(const PointStress &s)
{
  return std::hypot(0.5 * (s.xx - s.yy), s.xy);
}
} // namespace

TEST(YieldLimits, UniaxialCompressionOfMohrCoulomb)
{
  // 2 c sqrt(N_phi), whatever the dilation; zz lies between and has no say.
  for (const double psi : {0., 0.3, phi})
    for (const int n_steps : {1, 10, 200})
    {
      const MohrCoulomb law(rock, {c, phi, psi, {}});
      const PointStress s = biaxial_test(law, -1e-2, 0., n_steps);
      EXPECT_NEAR(s.xx / (-2. * c * std::sqrt(N_phi)), 1., 1e-12) << psi;
      EXPECT_NEAR(s.xx / (-2. * c * cosine / (1. - sine)), 1., 1e-12);
      EXPECT_LT(s.zz, s.yy);
      EXPECT_GT(s.zz, s.xx);
    }
}

TEST(YieldLimits, BiaxialCompressionOfMohrCoulomb)
{
  // sigma_1 = UCS + N_phi p, with the cut-off or without.
  for (const double pressure : {1e6, 10e6, 100e6})
    for (const std::optional<double> cutoff : {std::optional<double>{}, {1e6}})
    {
      const MohrCoulomb law(rock, {c, phi, 0.1, cutoff});
      const double expected = 2. * c * std::sqrt(N_phi) + N_phi * pressure;
      EXPECT_NEAR(biaxial_test(law, -4e-2, -pressure, 40).xx / -expected, 1., 1e-12);
    }
}

TEST(YieldLimits, UniaxialTensionOfMohrCoulomb)
{
  // 2 c / sqrt(N_phi), or the cut-off if it comes first.
  const double strength = 2. * c / std::sqrt(N_phi);
  for (const double psi : {0., 0.3, phi})
  {
    const auto measured = [&](const std::optional<double> cutoff) {
      return biaxial_test(MohrCoulomb(rock, {c, phi, psi, cutoff}), 1e-2, 0., 200).xx;
    };
    EXPECT_NEAR(measured({}) / strength, 1., 1e-12);
    for (const double share : {0.1, 0.5, 0.99})
      EXPECT_NEAR(measured(share * strength) / (share * strength), 1., 1e-12);
    EXPECT_NEAR(measured(1.01 * strength) / strength, 1., 1e-12);
  }
}

TEST(YieldLimits, PureShearOfMohrCoulomb)
{
  // Isochoric flow leaves the mean stress alone: c cos phi - p_m sin phi.
  for (const double mean : {0., -20e6, 5e6})
  {
    const MohrCoulomb law(rock, {c, phi, 0., {}});
    MaterialPoint point(law);
    point.input.initial = {mean, mean, mean, 0.};
    PointStress s{};
    for (int n = 0; n < 10; ++n)
      s = point.move({0., 0., 1e-3}).stress;
    EXPECT_NEAR(s.xy / (c * cosine - mean * sine), 1., 1e-12);
    EXPECT_NEAR(s.xx, mean, 1e-12 * c);
    EXPECT_NEAR(s.yy, mean, 1e-12 * c);
    EXPECT_NEAR(s.zz, mean, 1e-12 * c);
  }
}

TEST(YieldLimits, DilationUnderConstantVolumePressesTheBody)
{
  // Plane flow dilates by sin psi of the shear; where there is no room the mean stress
  // falls by (lambda + mu) sin psi per plastic shear, and the strength rises with it.
  const double psi = 0.2, shear = 5e-3;
  const MohrCoulomb law(rock, {c, phi, psi, {}});
  MaterialPoint point(law);
  const PointStress s = point.move({0., 0., shear}).stress;
  // radius = mu (g - g_p), mean = -(lambda + mu) sin psi g_p, radius + mean sin phi = c
  // cos.
  const double stiffness = rock.lambda + rock.mu, dilation = std::sin(psi);
  const double plastic =
      (rock.mu * shear - c * cosine) / (rock.mu + stiffness * dilation * sine);
  EXPECT_NEAR(s.xy / (rock.mu * (shear - plastic)), 1., 1e-12);
  EXPECT_NEAR(s.xx / (-stiffness * dilation * plastic), 1., 1e-12);
  EXPECT_NEAR(s.zz / (-rock.lambda * dilation * plastic), 1., 1e-12);
}

TEST(YieldLimits, StretchInAllDirectionsEndsAtTheApex)
{
  const double apex = c / std::tan(phi);
  for (const double psi : {0., 0.3, phi})
  {
    std::vector<std::unique_ptr<MaterialLaw>> laws;
    laws.push_back(
        std::make_unique<MohrCoulomb>(rock, MohrCoulombParameters{c, phi, psi, {}}));
    for (const Match match : {Match::outer, Match::inner, Match::plane_strain_associated,
                              Match::plane_strain_isochoric})
      laws.push_back(std::make_unique<DruckerPrager>(
          rock, DruckerPragerParameters{c, phi, psi, match}));
    for (const auto &law : laws)
    {
      MaterialPoint point(*law);
      PointStress s{};
      // zz cannot be stretched, it follows by the flow: many steps.
      for (int n = 0; n < 200; ++n)
        s = point.move({1e-2, 0.8e-2, 0.1e-2}).stress;
      EXPECT_LT(distance(s, {apex, apex, apex, 0.}), 1e-8 * c) << psi;
    }
  }
}

TEST(YieldLimits, StretchInThePlaneOpensBothDirectionsAtTheCutoff)
{
  // Both stresses of the plane are cut off; zz, which is not stretched, has 2 nu of them.
  for (const double psi : {0., 0.3, phi})
  {
    const MohrCoulomb law(rock, {c, phi, psi, 3e6});
    MaterialPoint point(law);
    PointStress s{};
    for (int n = 0; n < 20; ++n)
      s = point.move({1e-3, 0.8e-3, 0.1e-3}).stress;
    EXPECT_LT(distance(s, {3e6, 3e6, 2. * 0.25 * 3e6, 0.}), 1e-12 * c);
    EXPECT_NEAR(point.history[2], 0., 1e-17);
  }
}

TEST(YieldLimits, DruckerPragerMatchesTheEdges)
{
  // Triaxial compression along zz, s_III = -(UCS + N_phi p), and extension, in which
  // zz = -p is the greatest and N_phi p + UCS the pressure around: a stress short of it
  // stays, one beyond it does not.
  const double UCS = 2. * c * std::sqrt(N_phi);
  for (const double pressure : {0., 5e6, 50e6})
    for (const auto &[match, compression] :
         {std::pair{Match::outer, true}, {Match::inner, false}})
    {
      const DruckerPrager law(rock, {c, phi, 0., match});
      const double high = -(UCS + N_phi * pressure), low = -pressure;
      const auto moved = [&](const double share)
      {
        const double pressed = low + share * (high - low);
        MaterialPoint point(law);
        point.input.initial = compression ? PointStress{low, low, pressed, 0.}
                                          : PointStress{pressed, pressed, low, 0.};
        return distance(point.move({}).stress, point.input.initial);
      };
      EXPECT_EQ(moved(1. - 1e-12), 0.);
      EXPECT_GT(moved(1. + 1e-12), 0.);
    }
}

TEST(YieldLimits, DruckerPragerCollapsesInPlaneStrainAtMohrCoulombsLoad)
{
  // Steady flow, stress at rest: the strain grows by the flow of Mohr-Coulomb in plane
  // strain, sin psi of dilation per shear. Then zz does not flow, and the strength is
  // c cos phi - p_m sin phi with the mean stress of the plane.
  for (const auto &[match, psi] : {std::pair{Match::plane_strain_associated, phi},
                                   {Match::plane_strain_isochoric, 0.}})
    for (const double mean : {-50e6, -5e6, 0., 3e6})
      for (const double angle : {0., 0.4, M_PI / 4., 1.3})
      {
        const DruckerPrager law(rock, {c, phi, psi, match});
        MaterialPoint point(law);
        point.input.initial = {mean, mean, mean, 0.};
        const double shear = 5e-3, dilation = std::sin(psi) * shear;
        const PlaneVector step = turned(
            PlaneVector{0.5 * (dilation + shear), 0.5 * (dilation - shear), 0.}, angle);
        PointStress s{};
        for (int n = 0; n < 60; ++n)
          s = point.move(step).stress;
        const double strength = c * cosine - in_plane_mean(s) * sine;
        EXPECT_NEAR(in_plane_radius(s) / strength, 1., 1e-8) << mean;
        const PointStress next = point.move(step).stress;
        EXPECT_LT(distance(next, s), 1e-8 * c) << "not yet at rest";
      }
}

TEST(YieldLimits, DruckerPragerFailsInTheBiaxialTestAtMohrCoulombsLoad)
{
  // The same with the stress yy prescribed: sigma_1 = UCS + N_phi p.
  for (const auto &[match, psi] : {std::pair{Match::plane_strain_associated, phi},
                                   {Match::plane_strain_isochoric, 0.}})
    for (const double pressure : {0., 10e6, 50e6})
    {
      const DruckerPrager law(rock, {c, phi, psi, match});
      const double expected = 2. * c * std::sqrt(N_phi) + N_phi * pressure;
      EXPECT_NEAR(biaxial_test(law, -1., -pressure, 200).xx / -expected, 1., 1e-8);
    }
}

TEST(YieldLimits, DruckerPragerConesDifferInPlaneStrainAsTheyShould)
{
  // Steady plane flow of any cone: s_zz = -2 a_psi sqrt(J_2), which leaves
  // radius = sqrt(1 - 3 a_psi^2) / (1 - 3 a a_psi) (k - 3 a p_m).
  for (const Match match : {Match::outer, Match::inner})
    for (const double psi : {0., 0.3, phi})
    {
      const DruckerPrager law(rock, {c, phi, psi, match});
      const double a = law.friction_slope(), a_psi = law.dilation_slope();
      const PointStress s = biaxial_test(law, -1., -5e6, 200);
      const double expected = std::sqrt(1. - 3. * a_psi * a_psi) / (1. - 3. * a * a_psi) *
                              (law.shear_strength() - 3. * a * in_plane_mean(s));
      EXPECT_NEAR(in_plane_radius(s) / expected, 1., 1e-8);
    }
}
} // namespace yield_limits_tests

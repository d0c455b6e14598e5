#include "continuum/bonded_theory.h"
#include "support/airy_solution.h"
#include "support/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonded_theory_tests
{
namespace theory = antiform::continuum::theory;
using antiform::test::AirySolution;
using antiform::test::half_digit;
using theory::Side;
using FarFace = Side::FarFace;

namespace
{
const std::vector<FarFace> far_faces = {FarFace::free, FarFace::rough_rigid,
                                        FarFace::smooth_rigid, FarFace::spring};

/// A side of E0 = 3, k = 0.7 and the thickness that gives @p chi.
Side side_of(const FarFace far_face, const double nu, const double chi)
{
  return {3., nu, chi / 0.7, far_face, far_face == FarFace::spring ? 0.8 : 0.};
}

/// Cover with a free top on a half-space of the same rock, all in units of E = h = 1.
theory::SupportedLayer covered(const double contrast, const double H, const bool bonded)
{
  theory::SupportedLayer buried{
      {1., 0.25, 1.},
      {{contrast, 0.25, H, FarFace::free}, {contrast, 0.25, 0., FarFace::half_space}}};
  buried.bonded = bonded;
  return buried;
}
} // namespace

TEST(BondedTheory, FaceStiffnessSolvesTheAiryEquations)
{
  double worst = 0.;
  for (const FarFace far_face : far_faces)
    for (const double nu : {0., 0.1, 0.25, 0.4, 0.49, 0.4999})
      for (const double chi : {1e-5, 1e-3, 0.02, 0.1, 0.5, 0.9, 1.1, 3., 8., 20., 34.9})
      {
        const Side side = side_of(far_face, nu, chi);
        const theory::FaceStiffness face = theory::bonded_stiffness(side, 0.7);
        const AirySolution twin(side, 0.7);
        const auto by_normal = twin.bonded(1., 0.), by_tangent = twin.bonded(0., 1.);
        // The twin's own symmetry: Betti.
        EXPECT_NEAR(by_normal[1], by_tangent[0], 1e-25 + 1e-14 * std::abs(by_normal[1]));
        // The coupling changes sign with chi and nu: relative to the geometric mean.
        const double mixed = std::sqrt(by_normal[0] * by_tangent[1]);
        const double error = std::max({std::abs(face.normal / by_normal[0] - 1.),
                                       std::abs(face.shear / by_tangent[1] - 1.),
                                       std::abs(face.coupling - by_normal[1]) / mixed});
        worst = std::max(worst, error);
        // Round-off of some ten operations. Springs take phi_rough_rigid(), which loses
        // 1 / (1 - 2 nu) where it is thin.
        EXPECT_LT(error, far_face == FarFace::spring ? 1e-12 : 1e-13)
            << static_cast<int>(far_face) << ", nu " << nu << ", chi " << chi;
      }
  RecordProperty("worst", testing::PrintToString(worst));
}

TEST(BondedTheory, FaceStiffnessIsPositiveDefinite)
{
  for (const FarFace far_face : far_faces)
    for (const double nu : {0., 0.25, 0.49, 0.4999})
      for (double chi = 1e-6; chi < 1e6; chi *= 1.7)
      {
        const theory::FaceStiffness face =
            theory::bonded_stiffness(side_of(far_face, nu, chi), 0.7);
        EXPECT_GT(face.normal, 0.) << chi;
        EXPECT_GT(face.shear, 0.) << chi;
        EXPECT_GT(face.normal * face.shear, face.coupling * face.coupling)
            << static_cast<int>(far_face) << ", nu " << nu << ", chi " << chi;
      }
}

TEST(BondedTheory, DeepSideIsAHalfSpaceAndNeverOverflows)
{
  const double nu = 0.3, G = 3. / 2.6, k = 0.7, kappa = 3. - 4. * nu;
  const double face = 4. * G * (1. - nu) * k / kappa,
               coupling = 2. * G * (1. - 2. * nu) * k / kappa;
  for (const FarFace far_face :
       {FarFace::free, FarFace::rough_rigid, FarFace::smooth_rigid, FarFace::spring,
        FarFace::half_space})
    for (const double chi : {34., 36., 400., 1e5, 1e300})
    {
      const theory::FaceStiffness deep =
          theory::bonded_stiffness(side_of(far_face, nu, chi), k);
      EXPECT_NEAR(deep.normal, face, 1e-14 * face); // chi^2 exp(-2 chi) < 1e-26
      EXPECT_NEAR(deep.shear, face, 1e-14 * face);
      EXPECT_NEAR(deep.coupling, coupling, 1e-14 * face);
    }
  // A matrix that cannot be compressed does not pull along: the smooth value.
  const Side soft{3., 0.5, 0.};
  EXPECT_NEAR(theory::bonded_stiffness(soft, k).normal, soft.stiffness(k), 1e-15);
  EXPECT_EQ(theory::bonded_stiffness(soft, k).coupling, 0.);
  EXPECT_EQ((theory::bonded_stiffness(Side{0., 0.3, 1.}, k).normal), 0.);
}

TEST(BondedTheory, ThinSideIsAPlateAPadAndAColumn)
{
  // Leading terms for H -> 0; the next are of order chi^2, with factors below 10.
  const double nu = 0.3, E = 3., k = 0.7, chi = 1e-4, H = chi / k;
  const double plane = theory::plane_modulus(E, nu), G = E / (2. * (1. + nu));
  const double oedometer = theory::oedometer_modulus(E, nu);
  const auto face = [&](const FarFace far_face) {
    return theory::bonded_stiffness(Side{E, nu, H, far_face}, k);
  };
  // Stretched as a plate of its face: E' H k^2 U, with the lever H/2 of its axis.
  const theory::FaceStiffness free = face(FarFace::free);
  EXPECT_NEAR(free.shear / (plane * H * k * k), 1., 10. * chi * chi);
  EXPECT_NEAR(free.coupling / (0.5 * plane * H * H * k * k * k), 1., 10. * chi * chi);
  EXPECT_NEAR(free.normal / (plane * H * H * H / 3. * std::pow(k, 4)), 1.,
              10. * chi * chi);
  EXPECT_NEAR(face(FarFace::rough_rigid).normal * H / oedometer, 1., 10. * chi * chi);
  EXPECT_NEAR(face(FarFace::rough_rigid).shear * H / G, 1., 10. * chi * chi);
  EXPECT_NEAR(face(FarFace::smooth_rigid).normal * H / oedometer, 1., 10. * chi * chi);
  EXPECT_NEAR(face(FarFace::smooth_rigid).shear / (oedometer * H * k * k), 1.,
              10. * chi * chi);
}

TEST(BondedTheory, SidesWithoutStiffnessLeaveTheStrut)
{
  const theory::Layer layer{56e9, 0.2, 1.};
  EXPECT_EQ(theory::bonded_support_stiffness(layer, {}, 0.3), 0.);
  EXPECT_EQ(theory::bonded_support_stiffness(layer, {Side{0., 0.2, 1.}}, 0.3), 0.);
}

TEST(BondedTheory, EqualSidesLeaveTheAxisAtRest)
{
  // Both pull the axis by as much: K = 2 (K_yy + kh K_yx + (kh)^2/4 K_xx).
  const theory::Layer layer{56e9, 0.2, 2.};
  const Side side{1e9, 0.3, 3., FarFace::free};
  const double k = 0.4, kh = k * layer.thickness;
  const theory::FaceStiffness face = theory::bonded_stiffness(side, k);
  const double expected =
      2. * (face.normal + kh * face.coupling + 0.25 * kh * kh * face.shear);
  EXPECT_NEAR(theory::bonded_support_stiffness(layer, {side, side}, k), expected,
              1e-14 * expected);
}

TEST(BondedTheory, ABondedPlateOnOneSideIsATwoLayerBeam)
{
  // A thin free cover of the layer's own rock: D of the thickness h + H. Thin plates, so
  // up to (k (h + H))^2 with a factor of order 1.
  const theory::Layer layer{56e9, 0.2, 1.};
  const double k = 1e-3, H = 0.6, whole = 1. + H;
  const theory::SupportedLayer covered{
      layer, {{layer.young_modulus, 0.2, H, FarFace::free}}, 0., false, true};
  const double expected = layer.plane_modulus() * whole * whole * whole / 12. * k * k;
  EXPECT_NEAR(covered.buckling_force(k) / expected, 1., k * k * whole * whole);
}

TEST(BondedTheory, CriticalStressUnderACoverIsThatOfTheTable)
{
  double worst_stress = 0., worst_wave = 0.;
  unsigned int n_bonded = 0, n_smooth = 0;
  for (const auto &row : antiform::test::table("critical_stress_vs_cover.csv"))
  {
    const bool bonded = row[0] == "bonded";
    ++(bonded ? n_bonded : n_smooth);
    const double H = std::stod(row[2]);
    const theory::SupportedLayer buried = covered(std::stod(row[1]), H, bonded);
    const auto state = buried.critical();
    ASSERT_TRUE(state.has_value()) << row[0] << " " << row[1] << " " << row[2];
    const double stress = state->stress / buried.layer.plane_modulus();
    const double expected = std::stod(row[3]), wave = std::stod(row[4]);
    worst_stress = std::max(worst_stress, std::abs(stress / expected - 1.));
    worst_wave = std::max(worst_wave, std::abs(state->wavelength / wave - 1.));
    // Half of the last of nine digits is 5e-9 of the smallest first digit.
    EXPECT_NEAR(stress, expected, 6e-9 * expected) << row[0] << row[1] << row[2];
    // The table's own minima are flat to the root of round-off: in 40 digits the wave of
    // smooth, 1e-5, 10 is 202.857916287, ours to 3e-10, the table's to 2.6e-8.
    EXPECT_NEAR(state->wavelength, wave, half_digit(row[4]) + 4e-8 * wave)
        << row[0] << " " << row[1] << " " << row[2];
    const double chi = state->wavenumber * H;
    EXPECT_NEAR(chi, std::stod(row[5]), half_digit(row[5]) + 4e-8 * chi);
  }
  EXPECT_EQ(n_smooth, 45u);
  EXPECT_EQ(n_bonded, 45u);
  RecordProperty("worst_stress", testing::PrintToString(worst_stress));
  RecordProperty("worst_wavelength", testing::PrintToString(worst_wave));
}

TEST(BondedTheory, SmoothCriticalStressFollowsTheMasterCurve)
{
  unsigned int n = 0;
  for (const auto &row : antiform::test::table("cover_master_curve.csv"))
    for (const double contrast : {1e-1, 1e-3, 1e-5})
    {
      ++n;
      // The variable is H/h (E0'/E')^(1/3), and nu = nu0.
      const double scale = std::cbrt(contrast);
      const theory::SupportedLayer buried =
          covered(contrast, std::stod(row[0]) / scale, false);
      const auto state = buried.critical();
      ASSERT_TRUE(state.has_value());
      const double F = state->stress / (buried.layer.plane_modulus() * scale * scale);
      EXPECT_NEAR(F, std::stod(row[1]), 1.01 * half_digit(row[1])) << row[0];
      // Printed to five decimals; where F is an inflection (1.3 to 2) the wave is hardly
      // held by it.
      EXPECT_NEAR(state->wavelength * scale, std::stod(row[2]), 1.2 * half_digit(row[2]))
          << row[0];
    }
  EXPECT_EQ(n, 3u * 28u);
}

TEST(BondedTheory, BondingStiffensTheDeepLayer)
{
  // nu0 = 1/2 and a thin layer: no difference; else the matrix also resists along it.
  const double limit = theory::deep_limit({1., 0.25, 1.}, 1e-4 / 0.9375, true).stress;
  const double smooth = covered(1e-4, 1e6, false).critical()->stress;
  EXPECT_NEAR(smooth, limit, 1e-12 * limit);
  EXPECT_GT(covered(1e-4, 1e6, true).critical()->stress, 1.05 * limit);
}
} // namespace bonded_theory_tests

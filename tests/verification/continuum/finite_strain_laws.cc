// Cases 50 and 51, the parts of a point: laws of large strain against closed forms.
#include "continuum/elastic_laws.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

namespace finite_strain_laws_tests
{
using namespace antiform::continuum;
using namespace antiform::test;

namespace
{
const auto soft = LameConstants::from_young_poisson(20e9, 0.3);
const NeoHookean neo_hookean(soft);
const StVenantKirchhoff st_venant_kirchhoff(soft);
const MaterialLaw *const large_strain_laws[] = {&neo_hookean, &st_venant_kirchhoff};

/// Deformation gradient in the plane.
struct Gradient
{
  double xx = 1., xy = 0., yx = 0., yy = 1.;

  Gradient operator*(const Gradient &o) const
  {
    return {xx * o.xx + xy * o.yx, xx * o.xy + xy * o.yy, yx * o.xx + yy * o.yx,
            yx * o.xy + yy * o.yy};
  }
  PlaneVector green_strain() const
  {
    return {0.5 * (xx * xx + yx * yx - 1.), 0.5 * (xy * xy + yy * yy - 1.),
            xx * xy + yx * yy};
  }
};

Gradient rotation(const double angle)
{
  return {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
}

PointResponse respond(const MaterialLaw &law, const Gradient &F)
{
  PointInput input;
  input.strain = F.green_strain();
  return law.respond(input, nullptr, nullptr);
}

/// Kirchhoff stress tau = F S F^T.
PointStress kirchhoff(const MaterialLaw &law, const Gradient &F)
{
  const PointStress S = respond(law, F).stress;
  const Gradient t =
      F * Gradient{S.xx, S.xy, S.xy, S.yy} * Gradient{F.xx, F.yx, F.xy, F.yy};
  return {t.xx, t.yy, S.zz, t.xy};
}

/// Uniaxial strain at the stretch @p L: PK1 stress P = L S and its slope S + L^2 dS/dE.
double nominal_stress(const MaterialLaw &law, const double L)
{
  return L * respond(law, {L, 0., 0., 1.}).stress.xx;
}
double nominal_slope(const MaterialLaw &law, const double L)
{
  const PointResponse response = respond(law, {L, 0., 0., 1.});
  return response.stress.xx + L * L * response.tangent[0][0];
}
} // namespace

TEST(FiniteStrainLaws, RigidTurnLeavesNoStress)
{
  for (const double degrees : {90., 37., 180., 271.})
  {
    const Gradient F = rotation(degrees * M_PI / 180.);
    // Round-off of F^T F - 1.
    EXPECT_LT(distance(respond(neo_hookean, F).stress, {}), 1e-15 * 27e9);
    EXPECT_LT(distance(respond(st_venant_kirchhoff, F).stress, {}), 1e-15 * 27e9);
  }
}

TEST(FiniteStrainLaws, StressTurnsWithTheBody)
{
  const Gradient F{1.3, 0.4, -0.2, 0.8};
  const double angle = 0.7;
  for (const MaterialLaw *law : large_strain_laws)
  {
    const PointStress still = kirchhoff(*law, F);
    const PointStress moved = kirchhoff(*law, rotation(angle) * F);
    EXPECT_LT(distance(turned(still, -angle), moved), 1e-14 * 100e9);
  }
}

TEST(FiniteStrainLaws, SmallStrainIsHookesAtFirstOrder)
{
  const auto error = [](const MaterialLaw &law, const double size)
  {
    // Strain and rotation of one size.
    const Gradient F{1. + 0.6 * size, 0.9 * size, -0.3 * size, 1. - 0.8 * size};
    PointInput small;
    small.strain = {0.6 * size, -0.8 * size, 0.6 * size};
    const PointStress hooke = LinearElastic(soft).respond(small, nullptr, nullptr).stress;
    return distance(kirchhoff(law, F), hooke) / std::abs(hooke.yy);
  };
  for (const MaterialLaw *law : large_strain_laws)
    for (const double size : {1e-3, 1e-4, 1e-5})
    {
      const double coarse = error(*law, size), fine = error(*law, size / 10.);
      // The second order of the expansion leaves up to a few times `size`.
      EXPECT_NEAR(std::log10(coarse / fine), 1., 5. * size) << coarse << " -> " << fine;
      EXPECT_LT(coarse, 5. * size);
    }
}

TEST(FiniteStrainLaws, StVenantKirchhoffIsSoftestAtItsCompressionLimit)
{
  // P = M L (L^2 - 1) / 2 is least at L = 1/sqrt(3).
  const StVenantKirchhoff &law = st_venant_kirchhoff;
  double below = 0.3, above = 0.9;
  ASSERT_LT(nominal_slope(law, below), 0.);
  ASSERT_GT(nominal_slope(law, above), 0.);
  while (above - below > 1e-12)
  {
    const double middle = 0.5 * (below + above);
    (nominal_slope(law, middle) < 0. ? below : above) = middle;
  }
  const double limit = 1. / std::sqrt(3.);
  EXPECT_NEAR(below, limit, 1e-10); // wanted: 1e-6
  const double oedometer = soft.lambda + 2. * soft.mu;
  EXPECT_NEAR(nominal_stress(law, limit), -oedometer / (3. * std::sqrt(3.)),
              1e-14 * oedometer);
  // Past it the law answers as it must: the force falls, nothing is cut off.
  for (const double L : {0.5, 0.3, 0.1, 1e-3})
    EXPECT_NEAR(nominal_stress(law, L), 0.5 * oedometer * L * (L * L - 1.),
                1e-14 * oedometer);
}

TEST(FiniteStrainLaws, NeoHookeanResistsEveryStretchMore)
{
  const NeoHookean &law = neo_hookean;
  double last = -INFINITY;
  for (double L = 1e-4; L < 20.; L *= 1.05)
  {
    EXPECT_GT(nominal_slope(law, L), 0.) << L;
    const double stress = nominal_stress(law, L);
    EXPECT_GT(stress, last) << L;
    last = stress;
  }
}

TEST(FiniteStrainLaws, NeoHookeanConfinedStretchIsTheClosedForm)
{
  // tau_11 = mu (L^2 - 1) + lambda ln L, tau_22 = tau_33 = lambda ln L.
  const NeoHookean &law = neo_hookean;
  for (const double L : {0.05, 0.3, 0.7, 0.999, 1., 1.001, 1.5, 4.})
  {
    const PointStress tau = kirchhoff(law, {L, 0., 0., 1.});
    // C = 1 + 2 E keeps the round-off of 1, which is 1/L^2 of itself.
    const double round_off =
        1e-15 * (1. + 1. / (L * L)) * (soft.lambda + soft.mu * L * L);
    EXPECT_NEAR(tau.xx, soft.mu * (L * L - 1.) + soft.lambda * std::log(L), round_off);
    EXPECT_NEAR(tau.yy, soft.lambda * std::log(L), round_off);
    EXPECT_NEAR(tau.zz, soft.lambda * std::log(L), round_off);
    EXPECT_EQ(tau.xy, 0.);
  }
}

TEST(FiniteStrainLaws, SimpleShearIsTheClosedForm)
{
  const double mu = soft.mu, lambda = soft.lambda;
  for (const double shear : {1e-3, 0.1, 1., 3.})
  {
    const Gradient F{1., shear, 0., 1.};
    const double square = shear * shear,
                 scale = 1e-14 * (lambda + 2. * mu) * (1. + square);
    // St Venant-Kirchhoff: E_22 = g^2/2, E_12 = g/2.
    const PointStress S = respond(st_venant_kirchhoff, F).stress;
    EXPECT_NEAR(S.xy, mu * shear, scale);
    EXPECT_NEAR(S.yy, (0.5 * lambda + mu) * square, scale);
    EXPECT_NEAR(S.xx, 0.5 * lambda * square, scale);
    EXPECT_NEAR(S.zz, 0.5 * lambda * square, scale);
    // neo-Hookean, J = 1: tau = mu (b - 1).
    const PointStress tau = kirchhoff(neo_hookean, F);
    EXPECT_NEAR(tau.xy, mu * shear, scale * (1. + square));
    EXPECT_NEAR(tau.xx, mu * square, scale * (1. + square));
    EXPECT_NEAR(tau.yy, 0., scale * (1. + square));
    EXPECT_NEAR(tau.zz, 0., scale * (1. + square));
  }
}
} // namespace finite_strain_laws_tests

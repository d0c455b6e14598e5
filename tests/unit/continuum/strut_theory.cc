#include "continuum/strut_theory.h"
#include "support/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace strut_theory_tests
{
namespace theory = antiform::continuum::theory;
using antiform::test::half_digit;

namespace
{
const theory::Layer layer{56e9, 0.2, 10.};
} // namespace

TEST(StrutTheory, ElasticaIsThatOfTheTable)
{
  unsigned int n = 0;
  for (const auto &row : antiform::test::table("elastica_pinned.csv"))
  {
    ++n;
    const theory::Elastica state =
        theory::elastica_pinned(std::stod(row[0]) * M_PI / 180.);
    EXPECT_NEAR(state.force, std::stod(row[1]), 1.001 * half_digit(row[1])) << row[0];
    EXPECT_NEAR(state.chord, std::stod(row[2]), 1.001 * half_digit(row[2])) << row[0];
    EXPECT_NEAR(state.deflection, std::stod(row[3]), 1.001 * half_digit(row[3]))
        << row[0];
  }
  EXPECT_EQ(n, 10u);
}

TEST(StrutTheory, ElasticaBalancesMomentsAtItsMiddle)
{
  // M = P times the deflection = D kappa: kappa L = pi^2 (P/P_E) (w/L).
  for (const double slope : {0.01, 0.5, 1., 2., 3.})
  {
    const theory::Elastica state = theory::elastica_pinned(slope);
    const double expected = M_PI * M_PI * state.force * state.deflection;
    EXPECT_NEAR(state.curvature, expected, 1e-14 * expected);
  }
  // Small slopes: a half sine of the Euler force, P/P_E = 1 + alpha^2/8.
  const theory::Elastica flat = theory::elastica_pinned(1e-3);
  EXPECT_NEAR(flat.force, 1. + 1e-6 / 8., 1e-12); // next term alpha^4
  EXPECT_NEAR(flat.deflection / (1e-3 / M_PI), 1., 1e-6);
}

TEST(StrutTheory, PerryRobertsonLiesBelowBothLimits)
{
  for (const double strength : {50e6, 162e6})
    for (const double euler : {1e6, 40e6, 162e6, 5e9})
    {
      // Straight: the lower of the two.
      EXPECT_NEAR(theory::perry_robertson(strength, euler, 0.), std::min(strength, euler),
                  1e-7 * strength); // where both are equal a root of round-off
      for (const double imperfection : {1e-6, 0.01, 0.3, 3.})
      {
        const double s = theory::perry_robertson(strength, euler, imperfection);
        EXPECT_LT(s, std::min(strength, euler));
        // The inner fibre: axial stress and amplified bending.
        const double fibre = s * (1. + imperfection * theory::amplification(s, euler));
        EXPECT_NEAR(fibre, strength, 1e-7 * strength); // 1 - s/euler = 6e-9 at least
      }
    }
}

TEST(StrutTheory, ConfinementWidensTheRangeOfFolding)
{
  EXPECT_NEAR(theory::strength_slope(M_PI / 6.), 3., 1e-14); // (1 + 1/2) / (1 - 1/2)
  EXPECT_NEAR(theory::strength_slope(41.960 * M_PI / 180.), 5.0352, 2e-4); // 5e-4 degrees
  EXPECT_EQ(theory::confined_slenderness_limit(5., 0.), 1.);
  EXPECT_NEAR(theory::confined_slenderness_limit(4., 1.), 0.5, 1e-15);
  // At that ratio buckling, sigma_1 = p + sigma_E, and failure, UCS + N p, coincide.
  const double E = 56e9, UCS = 162e6, p = 30e6, N = 5.;
  const double ratio = theory::confined_slenderness_limit(N, p / UCS);
  const double length =
      ratio * theory::critical_slenderness(E, UCS) * 10. / std::sqrt(12.);
  const double failure = UCS + N * p;
  EXPECT_NEAR(p + theory::euler_stress_pinned(E, length, 10.), failure, 1e-13 * failure);
  EXPECT_NEAR(theory::confined_failure_ratio(N, p / UCS), (failure - p) / UCS, 1e-15);
}

TEST(StrutTheory, StackOfEqualBedsIsALayerOrItsShare)
{
  const theory::Layer bed{56e9, 0.2, 2.5};
  const std::vector<theory::Layer> four(4, bed);
  const double whole = layer.bending_stiffness();
  EXPECT_NEAR(theory::stack_bending_stiffness(four, true), whole, 1e-14 * whole);
  EXPECT_NEAR(theory::stack_bending_stiffness(four, false), whole / 16., 1e-14 * whole);
}

TEST(StrutTheory, BedsThatStickBendAboutTheirCommonAxis)
{
  // Two beds, 1 and 2 thick, moduli 3 and 1: axis at (3 * 1/2 + 2 * 2) / 5 = 1.1;
  // D = 3/12 + 3 * 0.6^2 + 8/12 + 2 * 0.9^2.
  const std::vector<theory::Layer> beds = {{3., 0., 1.}, {1., 0., 2.}};
  EXPECT_NEAR(theory::stack_bending_stiffness(beds, true), 0.25 + 1.08 + 8. / 12. + 1.62,
              1e-14);
}

TEST(StrutTheory, ViscousMatrixLetsTheDominantWaveGrowFastest)
{
  const double stress = 40e6, viscosity = 1e19;
  const double wave = theory::viscous_dominant_wavelength(layer, stress),
               k = 2. * M_PI / wave;
  EXPECT_NEAR(wave, M_PI * 10. * std::sqrt(layer.plane_modulus() / stress), 1e-12 * wave);
  const auto rate = [&](const double wavenumber)
  { return theory::viscous_growth_rate(layer, stress, viscosity, wavenumber); };
  // There N k (1 - 1/3) / (4 eta); shorter and longer waves grow more slowly.
  EXPECT_NEAR(rate(k) / (stress * 10. * k / (6. * viscosity)), 1., 1e-14);
  for (const double step : {1e-3, 0.1})
  {
    EXPECT_LT(rate(k * (1. + step)), rate(k));
    EXPECT_LT(rate(k * (1. - step)), rate(k));
  }
  // The wave whose Euler force is N does not grow.
  const double still = std::sqrt(stress * 10. / layer.bending_stiffness());
  EXPECT_NEAR(rate(still) / rate(k), 0., 1e-14);
  // The correspondence: E0' k of an elastic matrix stands for 4 eta k d/dt.
  const theory::SupportedLayer elastic{
      layer, {{1e7, 0.5, 0.}, {1e7, 0.5, 0.}}}; // E0' k = 4 G0 k, G0 = E0/3
  EXPECT_NEAR(elastic.support_stiffness(k) / (4. * 1e7 / 3. * k), 1., 1e-14);
}
} // namespace strut_theory_tests

#include "continuum/arch_theory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arch_theory_tests
{
namespace theory = antiform::continuum::theory;
using theory::ArchEnds;

namespace
{
const theory::Layer layer{56e9, 0.2, 10.};

/// Integral of f over (-1/2, 1/2), Simpson with 2000 intervals: to (n/2000)^4, 1e-11.
template <class Function>
double integral(const Function &f)
{
  constexpr int n = 2000;
  double sum = 0.;
  for (int i = 0; i <= n; ++i)
    sum += (i == 0 || i == n ? 1. : (i % 2 == 1 ? 4. : 2.)) * f(-0.5 + i / double(n));
  return sum / (3. * n);
}
} // namespace

TEST(Upheaval, ConstantsFollowFromTheRootOfTan)
{
  const theory::UpheavalConstants c = theory::upheaval_constants();
  const double x = 0.5 * std::sqrt(c.force);
  EXPECT_NEAR(std::tan(x), x, 1e-13 * (1. + x * x) * 10.); // its slope is 1 + x^2
  EXPECT_GT(x, M_PI);
  EXPECT_LT(x, 1.5 * M_PI);
  EXPECT_NEAR(c.force, 80.763, 5e-4); // printed digits
  EXPECT_NEAR(c.deflection, 2.4068e-3, 5e-8);
  EXPECT_NEAR(c.moment, 0.06938, 5e-6);
  EXPECT_NEAR(c.squared_slope, 3.1940e-5, 5e-10);
}

TEST(Upheaval, ConstantsAreThoseOfTheShape)
{
  // D w'''' + P w'' = -q on (-1/2, 1/2), D = q = 1, with w'' = 0 at the ends by the
  // choice of B; then w' = 0 there because tan x = x.
  const theory::UpheavalConstants c = theory::upheaval_constants();
  const double P = c.force, n = std::sqrt(P), B = -1. / (P * P * std::cos(0.5 * n));
  const auto slope = [&](const double s) { return -B * n * std::sin(n * s) - s / P; };
  const auto curvature = [&](const double s)
  { return -B * P * std::cos(n * s) - 1. / P; };
  EXPECT_NEAR(slope(0.5), 0., 1e-16);
  EXPECT_NEAR(curvature(0.5), 0., 1e-16);
  const double rise = B * (1. - std::cos(0.5 * n)) + 1. / (8. * P); // w(0) - w(1/2)
  EXPECT_NEAR(c.deflection, rise, 1e-14 * rise);
  EXPECT_NEAR(c.moment, std::abs(curvature(0.)), 1e-14);
  double largest = 0.;
  for (double s = -0.5; s <= 0.5; s += 1e-3)
    largest = std::max(largest, std::abs(curvature(s)));
  EXPECT_NEAR(c.moment, largest, 1e-5 * largest); // the grid misses the middle
  const double squares = integral([&](const double s) { return slope(s) * slope(s); });
  EXPECT_NEAR(c.squared_slope, squares, 1e-10 * squares);
}

TEST(Upheaval, LeastForceIsASnap)
{
  const double load = 5e5, total = 3000.;
  const theory::Upheaval least = theory::least_upheaval(layer, load, total);
  for (const double factor : {0.9, 0.999, 1.001, 1.1})
    EXPECT_GT(
        theory::upheaval(layer, load, total, factor * least.length).prebuckling_force,
        least.prebuckling_force);
  // P_0 = a l^-2 + b l^7 at its minimum: 9/7 of what the buckle keeps.
  EXPECT_NEAR(least.prebuckling_force / least.force, 9. / 7., 1e-13);
  // The same shortening before and after.
  const double per_force = total / (layer.plane_modulus() * 10.);
  const double D = layer.bending_stiffness();
  const double slack = 0.5 * theory::upheaval_constants().squared_slope * load * load *
                       std::pow(least.length, 7) / (D * D);
  EXPECT_NEAR(least.prebuckling_force * per_force, least.force * per_force + slack,
              1e-13 * least.prebuckling_force * per_force);
  // A heavier cover is harder to lift: P_0 grows as q^(4/9).
  const theory::Upheaval heavier = theory::least_upheaval(layer, 512. * load, total);
  EXPECT_NEAR(heavier.prebuckling_force / least.prebuckling_force, 16., 1e-12);
}

TEST(Arch, NeitherGrowsNorSinksUnderItsCriticalLoad)
{
  const double L = 300., D = layer.bending_stiffness(), a0 = 5.;
  for (const ArchEnds ends : {ArchEnds::pinned, ArchEnds::guided})
  {
    const double q = theory::arch_critical_load(a0, L, D, ends);
    const double balanced = theory::arch_deflection(q, L, D, ends);
    EXPECT_NEAR(balanced, a0, 1e-14 * a0);
    for (const double ratio : {0., 0.3, 0.9}) // whatever the axial force
    {
      EXPECT_NEAR(theory::arch_rise(a0, balanced, ratio, 1.), 0., 1e-13);
      const double lighter = theory::arch_deflection(0.99 * q, L, D, ends),
                   heavier = theory::arch_deflection(1.01 * q, L, D, ends);
      EXPECT_GT(theory::arch_rise(a0, lighter, ratio, 1.), 0.);
      EXPECT_LT(theory::arch_rise(a0, heavier, ratio, 1.), 0.);
    }
  }
  const double pinned = theory::arch_critical_load(a0, L, D, ArchEnds::pinned);
  EXPECT_NEAR(pinned, std::pow(M_PI, 5) * D * a0 / (4. * std::pow(L, 4)), 1e-14 * pinned);
  EXPECT_DOUBLE_EQ(theory::arch_rise(5., 2., 0.5, 1.), 6.);
  EXPECT_THROW(theory::arch_rise(5., 2., 1., 1.), std::domain_error);
}

TEST(Arch, OneTermIsNearTheBeam)
{
  // Pinned and clamped beams without axial force: 5/384 and 1/384 q L^4 / D.
  EXPECT_NEAR(theory::arch_deflection(1., 1., 1., ArchEnds::pinned) / (5. / 384.), 1.0039,
              5e-5);
  EXPECT_NEAR(theory::arch_deflection(1., 1., 1., ArchEnds::guided) * 384., 0.9855, 5e-5);
  // With axial force, against the exact middle of the pinned beam: below 0.4 %.
  for (double ratio = 0.2; ratio < 0.91; ratio += 0.1)
  {
    const double exact = theory::pinned_beam_deflection(1., 1., 1., ratio);
    const double one_term = theory::arch_deflection(1., 1., 1., ArchEnds::pinned) *
                            theory::amplification(ratio, 1.);
    EXPECT_NEAR(one_term / exact, 1., 4e-3) << ratio;
  }
}

TEST(Arch, ExactDeflectionSolvesTheBeamColumn)
{
  // The sum over odd half waves: 4 q L^4 / (pi^5 D) sum (-1)^((m-1)/2) / (m^5 (1 -
  // r/m^2)).
  for (const double ratio : {0., 1e-6, 1e-4, 1.6e-4, 1.7e-4, 0.01, 0.3, 0.9, 0.999})
  {
    double sum = 0.;
    for (int m = 2001; m > 0; m -= 2)
      sum += ((m / 2) % 2 == 0 ? 1. : -1.) /
             (std::pow(m, 3) * (double(m) * m - ratio)); // the rest: 1e-17
    sum *= 4. / std::pow(M_PI, 5);
    EXPECT_NEAR(theory::pinned_beam_deflection(1., 1., 1., ratio) / sum, 1., 5e-9)
        << ratio; // cancels to 1e-16 / u^4 at u = 0.02
  }
}

TEST(SnapThrough, OfAShallowArchIsAtTheTopOfItsPath)
{
  const auto snap = theory::snap_through(3.);
  ASSERT_TRUE(snap.has_value());
  EXPECT_NEAR(snap->rise, 1.29099, 5e-6); // printed digits
  EXPECT_NEAR(snap->load, 4.0758, 5e-5);
  EXPECT_FALSE(snap->antisymmetric);
  for (double e0 = 2.1; e0 < 4.6; e0 += 0.3)
  {
    const auto top = theory::snap_through(e0);
    ASSERT_TRUE(top.has_value());
    EXPECT_NEAR(top->load, e0 + 0.5 * std::pow(top->rise, 3), 1e-13);
    EXPECT_LT(theory::shallow_arch_load(e0, top->rise + 1e-3), top->load);
    EXPECT_LT(theory::shallow_arch_load(e0, top->rise - 1e-3), top->load);
  }
  EXPECT_EQ(theory::shallow_arch_load(3., 3.), 0.);
  EXPECT_FALSE(theory::snap_through(2.).has_value()); // its path only rises
}

TEST(SnapThrough, OfAHighArchIsBySwaying)
{
  const auto snap = theory::snap_through(6.);
  ASSERT_TRUE(snap.has_value());
  EXPECT_TRUE(snap->antisymmetric);
  EXPECT_NEAR(snap->load, 6. + 3. * std::sqrt(20.), 1e-13);
  EXPECT_NEAR(snap->load, 19.416, 5e-4);
  // Axial force N / N_E = (e0^2 - e^2) / 4 is that of two half waves, 4.
  EXPECT_NEAR((36. - snap->rise * snap->rise) / 4., 4., 1e-14);
  // From sqrt(22) on it comes before the top of the path; there the two meet.
  const double limit = std::sqrt(22.);
  const auto below = theory::snap_through(limit * (1. - 1e-9)),
             above = theory::snap_through(limit * (1. + 1e-9));
  ASSERT_TRUE(below && above);
  EXPECT_FALSE(below->antisymmetric);
  EXPECT_TRUE(above->antisymmetric);
  EXPECT_NEAR(below->load, above->load, 1e-7); // the step of e0 itself
  EXPECT_NEAR(below->rise, above->rise, 1e-7);
}

TEST(SnapThrough, LoadUnitIsThatOfTheArch)
{
  const double k = M_PI / 300.;
  EXPECT_NEAR(theory::snap_load_unit(layer, 300.) /
                  (layer.bending_stiffness() * std::pow(k, 4) * 10. / std::sqrt(12.)),
              1., 1e-14);
}
} // namespace arch_theory_tests

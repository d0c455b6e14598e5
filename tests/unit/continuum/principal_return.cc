// Return to Mohr-Coulomb's planes and cut-offs by any route of principal stresses.
#include "continuum/principal_return.h"
#include "continuum/elastic_laws.h"
#include "continuum/errors.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace principal_return_tests
{
using namespace antiform::continuum;
using antiform::test::Dice;

namespace
{
/// A rock with cohesion 1 and shear modulus 1000.
struct Rock
{
  LameConstants elastic;
  double sin_friction, sin_dilation, cohesion_term, cutoff, apex;

  PrincipalReturn surface() const
  {
    return {elastic, cohesion_term, sin_friction, sin_dilation, cutoff};
  }
};

enum class Cutoff
{
  none,
  some,
  near_apex ///< 1e-3 to 1e-16 of it below
};

Rock random_rock(Dice &dice, const Cutoff cutoff, const bool associated)
{
  Rock rock{};
  rock.elastic = LameConstants::from_young_poisson(1., std::min(dice(-0.2, 0.55), 0.499));
  rock.elastic.lambda *= 1000. / rock.elastic.mu;
  rock.elastic.mu = 1000.;
  const double friction = std::max(0., dice(-0.1, 1.3)); // some without friction
  rock.sin_friction = std::sin(friction);
  const double share = associated ? 1. : std::max(0., dice(-0.3, 1.));
  rock.sin_dilation = associated ? rock.sin_friction : std::sin(share * friction);
  rock.cohesion_term = std::cos(friction);
  rock.apex = friction > 0. ? rock.cohesion_term / rock.sin_friction : INFINITY;
  rock.cutoff = INFINITY;
  if (cutoff == Cutoff::some)
    rock.cutoff = std::max(0., dice(-0.2, 1.)) * std::min(rock.apex, 5.);
  if (cutoff == Cutoff::near_apex)
    rock.cutoff = std::min(rock.apex, 1e3) * (1. - std::pow(10., dice(-16., -3.)));
  return rock;
}

PrincipalStress random_stress(Dice &dice, const double size, const double mean)
{
  PrincipalStress s{dice(-size, size), dice(-size, size), dice(-size, size)};
  for (double &value : s)
    value += mean;
  std::sort(s.rbegin(), s.rend());
  return s;
}

/// Around the tensile end of the surface, at distances of 1e-2 to 1e2.
PrincipalStress random_trial(Dice &dice, const Rock &rock)
{
  const double size = std::pow(10., dice(-2., 2.));
  const double end = std::min({rock.apex, rock.cutoff, 5.});
  return random_stress(dice, size, end + dice(-2., 1.) * size);
}

/// Yield functions by their definition.
double shear_yield(const Rock &rock, const double greater, const double lesser)
{
  return 0.5 * (greater - lesser) + 0.5 * (greater + lesser) * rock.sin_friction -
         rock.cohesion_term;
}
double yield(const Rock &rock, const PrincipalStress &s)
{
  return std::max(shear_yield(rock, s[0], s[2]), s[0] - rock.cutoff);
}

/// Names of the planes that a stress lies on.
std::string region(const Rock &rock, const PrincipalStress &s)
{
  const double near = 1e-9;
  std::string planes;
  const auto note = [&](const char *name, const double value)
  {
    if (std::abs(value) < near)
      planes += name;
  };
  note(" I-III", shear_yield(rock, s[0], s[2]));
  note(" II-III", shear_yield(rock, s[1], s[2]));
  note(" I-II", shear_yield(rock, s[0], s[1]));
  note(" I", s[0] - rock.cutoff);
  note(" II", s[1] - rock.cutoff);
  note(" III", s[2] - rock.cutoff);
  return planes;
}

double size_of(const PrincipalStress &s)
{
  return 1. + std::max(std::abs(s[0]), std::abs(s[2]));
}
} // namespace

TEST(PrincipalReturn, TakesEveryTrialStressToTheSurface)
{
  Dice dice(1);
  std::map<std::string, int> count;
  double worst = 0.;
  for (const Cutoff cutoff : {Cutoff::none, Cutoff::some, Cutoff::near_apex})
    for (int n = 0; n < 2000; ++n)
    {
      const Rock rock = random_rock(dice, cutoff, n % 2 == 0);
      const PrincipalReturn surface = rock.surface();
      for (int k = 0; k < 50; ++k)
      {
        const PrincipalStress trial = random_trial(dice, rock);
        const auto answer = surface(trial);
        const PrincipalStress &s = answer.stress;
        const double outside = yield(rock, trial);
        EXPECT_EQ(answer.is_elastic, outside <= 0.);
        EXPECT_GE(s[0] - s[1], -1e-12 * size_of(trial));
        EXPECT_GE(s[1] - s[2], -1e-12 * size_of(trial));
        if (answer.is_elastic)
          continue;
        worst = std::max(worst, std::abs(yield(rock, s)) / size_of(trial));
        for (int i = 0; i < 3; ++i)
          EXPECT_NEAR(s[i] + answer.drop[i], trial[i], 1e-11 * size_of(trial));
        ++count[region(rock, s)];
      }
    }
  EXPECT_LT(worst, 1e-12);
  RecordProperty("worst_of_1e-16", static_cast<int>(worst * 1e16));
  // Plane, two edges, apex; cut-off: plane, line with the shear plane, edge, corner of
  // all three, corners with the two edges.
  for (const char *name :
       {" I-III", " I-III II-III", " I-III I-II", " I-III II-III I-II", " I", " I-III I",
        " I II", " I II III", " I-III II-III I II", " I-III I-II I"})
    EXPECT_GT(count[name], 100) << name;
}

TEST(PrincipalReturn, AssociatedReturnIsTheClosestPoint)
{
  // Greatest plastic work (Hill): (trial - s) : C : (any admissible stress - s) <= 0,
  // which holds at one stress only.
  Dice dice(2);
  for (const Cutoff cutoff : {Cutoff::none, Cutoff::some, Cutoff::near_apex})
    for (int n = 0; n < 1000; ++n)
    {
      const Rock rock = random_rock(dice, cutoff, true);
      const PrincipalReturn surface = rock.surface();
      for (int k = 0; k < 10; ++k)
      {
        const PrincipalStress trial = random_trial(dice, rock);
        const auto answer = surface(trial);
        const PrincipalStress &d = answer.drop;
        const PointStrain flow = rock.elastic.strain({d[0], d[1], d[2], 0.});
        const double flow_size =
            std::abs(flow[0]) + std::abs(flow[1]) + std::abs(flow[2]);
        for (int j = 0; j < 50; ++j)
        {
          PrincipalStress other = random_stress(dice, 10., 0.);
          for (int step = 0; step < 60 && yield(rock, other) > 0.; ++step)
            for (double &value : other) // towards the admissible stress -1, -1, -1
              value = 0.8 * value - 0.2;
          if (yield(rock, other) > 0.)
            continue;
          double work = 0.;
          for (int i = 0; i < 3; ++i)
            work += flow[i] * (other[i] - answer.stress[i]);
          EXPECT_LE(work, 1e-10 * flow_size * size_of(trial));
        }
      }
    }
}

TEST(PrincipalReturn, ShearFlowDilatesByItsAngle)
{
  // On the plane and both edges: the sum of the lengthenings is N_psi times that of the
  // shortenings, N_psi = (1 + sin psi) / (1 - sin psi).
  Dice dice(3);
  int n_checked = 0;
  for (int n = 0; n < 2000; ++n)
  {
    const Rock rock = random_rock(dice, Cutoff::none, false);
    const PrincipalReturn surface = rock.surface();
    for (int k = 0; k < 10; ++k)
    {
      const auto answer = surface(random_trial(dice, rock));
      const std::string where = region(rock, answer.stress);
      if (answer.is_elastic || where == " I-III II-III I-II")
        continue;
      const PrincipalStress &d = answer.drop;
      const PointStrain flow = rock.elastic.strain({d[0], d[1], d[2], 0.});
      double longer = 0., shorter = 0.;
      for (int i = 0; i < 3; ++i)
        (flow[i] > 0. ? longer : shorter) += flow[i];
      // In its order: the greatest stress never shortens, the least never lengthens.
      EXPECT_GE(flow[0], -1e-12 * longer);
      EXPECT_LE(flow[2], 1e-12 * longer);
      EXPECT_NEAR(longer * (1. - rock.sin_dilation), -shorter * (1. + rock.sin_dilation),
                  1e-9 * longer + 1e-16 * size_of(answer.stress));
      ++n_checked;
    }
  }
  EXPECT_GT(n_checked, 2000);
}

TEST(PrincipalReturn, WorkOfTheFlowIsNotNegative)
{
  Dice dice(4);
  for (const Cutoff cutoff : {Cutoff::none, Cutoff::some, Cutoff::near_apex})
    for (int n = 0; n < 2000; ++n)
    {
      const Rock rock = random_rock(dice, cutoff, n % 2 == 0);
      const PrincipalReturn surface = rock.surface();
      for (int k = 0; k < 20; ++k)
      {
        const PrincipalStress trial = random_trial(dice, rock);
        const auto answer = surface(trial);
        const PrincipalStress &d = answer.drop, &s = answer.stress;
        const PointStrain flow = rock.elastic.strain({d[0], d[1], d[2], 0.});
        EXPECT_GE(flow[0] * s[0] + flow[1] * s[1] + flow[2] * s[2],
                  -1e-14 * size_of(trial) * size_of(trial) / 1000.);
      }
    }
}

TEST(PrincipalReturn, StressIsContinuousAcrossRegions)
{
  // Return is affine in a region; a wrong choice at a border would jump. The steepest
  // region of a rock of these constants is some 40 (nu = 0.499: pressure against shear).
  Dice dice(5);
  int n_crossed = 0;
  for (const Cutoff cutoff : {Cutoff::none, Cutoff::some, Cutoff::near_apex})
    for (int n = 0; n < 4000; ++n)
    {
      const Rock rock = random_rock(dice, cutoff, n % 2 == 0);
      const PrincipalReturn surface = rock.surface();
      PrincipalStress a = random_trial(dice, rock), b = random_trial(dice, rock);
      const auto stress = [&](const PrincipalStress &trial)
      { return surface(trial).stress; };
      if (region(rock, stress(a)) == region(rock, stress(b)))
        continue;
      ++n_crossed;
      // Halve to one border between them.
      const std::string start = region(rock, stress(a));
      const double scale = size_of(a) + size_of(b);
      for (int k = 0; k < 50; ++k)
      {
        PrincipalStress middle;
        for (int i = 0; i < 3; ++i)
          middle[i] = 0.5 * (a[i] + b[i]);
        (region(rock, stress(middle)) == start ? a : b) = middle;
      }
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(stress(a)[i], stress(b)[i], 1e-8 * scale) // the width of region()
            << start << " to " << region(rock, stress(b));
    }
  EXPECT_GT(n_crossed, 2000);
}

TEST(PrincipalReturn, RefusesWhatIsNotANumber)
{
  Dice dice(6);
  const PrincipalReturn surface = random_rock(dice, Cutoff::some, true).surface();
  EXPECT_THROW(surface({NAN, 0., 0.}), antiform::NumericalError);
  EXPECT_THROW(surface({0., NAN, 0.}), antiform::NumericalError);
  EXPECT_THROW(surface({INFINITY, 0., 0.}), antiform::NumericalError);
}
} // namespace principal_return_tests

#include "continuum/elastic_laws.h"
#include "continuum/errors.h"
#include "continuum/semi_linear_law.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

#include <memory>

namespace elastic_laws_tests
{
using namespace antiform::continuum;
using namespace antiform::test;

namespace
{
const auto rock = LameConstants::from_young_poisson(20e9, 0.25);

std::vector<std::unique_ptr<MaterialLaw>> all_laws()
{
  std::vector<std::unique_ptr<MaterialLaw>> laws;
  laws.push_back(std::make_unique<LinearElastic>(rock));
  laws.push_back(std::make_unique<NeoHookean>(rock));
  laws.push_back(std::make_unique<StVenantKirchhoff>(rock));
  laws.push_back(std::make_unique<SemiLinear>(rock));
  return laws;
}

/// Green-Lagrange strain of stretches between 0.6 and 1.6 in turned axes.
PlaneVector large_strain(Dice &dice)
{
  const double a = dice(0.6, 1.6), b = dice(0.6, 1.6);
  return turned(PlaneVector{0.5 * (a * a - 1.), 0.5 * (b * b - 1.), 0.}, dice(0., M_PI));
}
} // namespace

TEST(ElasticLaws, LameConstantsAreThoseOfTheTextbook)
{
  // E = 20, nu = 1/4: lambda = mu = 8, K = 40/3 GPa.
  EXPECT_NEAR(rock.lambda, 8e9, 1e-6);
  EXPECT_NEAR(rock.mu, 8e9, 1e-6);
  EXPECT_NEAR(rock.bulk_modulus(), 40e9 / 3., 1e-5);
}

TEST(ElasticLaws, StrainIsTheInverseOfStress)
{
  Dice dice(1);
  for (int n = 0; n < 100; ++n)
  {
    const PointStrain e{dice(-1., 1.), dice(-1., 1.), dice(-1., 1.), dice(-1., 1.)};
    const PointStrain back = rock.strain(rock.stress(e));
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(back[i], e[i], 1e-14);
  }
}

TEST(ElasticLaws, TangentIsTheDerivative)
{
  Dice dice(2);
  double worst = 0.;
  for (const auto &law : all_laws())
    for (int n = 0; n < 2000; ++n)
    {
      PointInput input;
      input.strain = large_strain(dice);
      input.initial = {dice(-1e9, 1e9), dice(-1e9, 1e9), dice(-1e9, 1e9),
                       dice(-1e9, 1e9)};
      // At a stretch of 0.6 derivatives grow by 1/0.6^2 each: C^-1 to the fourth power is
      // 60 times the stiffness at rest, so the truncation h^2 f''' stays below 1e-7.
      worst = std::max(worst, tangent_error(*law, input, {}, 1e-6, 24e9));
    }
  EXPECT_LT(worst, 1e-6);
  RecordProperty("worst_of_1e-12", static_cast<int>(worst * 1e12));
}

TEST(ElasticLaws, TangentIsSymmetric)
{
  Dice dice(3);
  for (const auto &law : all_laws())
  {
    EXPECT_TRUE(law->has_symmetric_tangent());
    for (int n = 0; n < 100; ++n)
    {
      PointInput input;
      input.strain = large_strain(dice);
      const auto tangent = law->respond(input, nullptr, nullptr).tangent;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j)
          EXPECT_NEAR(tangent[i][j], tangent[j][i], 1e-13 * std::abs(tangent[i][i]));
    }
  }
}

TEST(ElasticLaws, InitialStressIsAdded)
{
  const PointStress initial{-3e6, -9e6, -4e6, 1e6};
  PointInput with, without;
  with.initial = initial;
  for (const auto &law : all_laws())
  {
    EXPECT_EQ(distance(law->respond(with, nullptr, nullptr).stress, initial), 0.);
    with.strain = without.strain = {1e-3, -2e-3, 5e-4};
    const PointStress a = law->respond(with, nullptr, nullptr).stress;
    const PointStress b = law->respond(without, nullptr, nullptr).stress;
    EXPECT_NEAR(a.xx - b.xx, initial.xx, 1e-7);
    EXPECT_NEAR(a.yy - b.yy, initial.yy, 1e-7);
    EXPECT_NEAR(a.zz - b.zz, initial.zz, 1e-7);
    EXPECT_NEAR(a.xy - b.xy, initial.xy, 1e-7);
    with.strain = without.strain = {};
  }
}

TEST(ElasticLaws, StressTurnsWithTheStrain)
{
  Dice dice(4);
  for (const auto &law : all_laws())
    for (int n = 0; n < 200; ++n)
    {
      const double angle = dice(0., 2. * M_PI);
      PointInput input, other;
      input.strain = large_strain(dice);
      other.strain = turned(input.strain, angle);
      const PointStress s = law->respond(input, nullptr, nullptr).stress;
      const PointStress t = law->respond(other, nullptr, nullptr).stress;
      EXPECT_LT(distance(turned(s, angle), t), 1e-13 * 1e11);
    }
}

TEST(ElasticLaws, SmallStrainIsNotLostInRoundOff)
{
  // At 1e-12 of strain S differs from Hooke's stress by 1e-12 of it, not by the 1e-4 that
  // 1 - C^-1 and ln J would leave if formed from numbers near 1.
  PointInput input;
  input.strain = {1e-12, -3e-12, 2e-12};
  const PointStress hooke = LinearElastic(rock).respond(input, nullptr, nullptr).stress;
  const PointStress s = NeoHookean(rock).respond(input, nullptr, nullptr).stress;
  EXPECT_LT(distance(s, hooke), 2e-11 * std::abs(hooke.yy));
}

TEST(ElasticLaws, RefuseABodyPressedToNothing)
{
  for (const auto &law : all_laws())
  {
    PointInput input;
    for (const PlaneVector &flat :
         {PlaneVector{-0.5, 0., 0.}, PlaneVector{0., -0.6, 0.},
          PlaneVector{-0.7, -0.7, 0.}, PlaneVector{0., 0., 1.}, PlaneVector{NAN, 0., 0.}})
    {
      input.strain = flat;
      if (law->is_finite_strain())
        EXPECT_THROW(law->respond(input, nullptr, nullptr), antiform::NumericalError);
      else
        EXPECT_NO_THROW(law->respond(input, nullptr, nullptr));
    }
  }
}

TEST(ElasticLaws, RefuseConstantsOutOfRange)
{
  for (const double young : {0., -1., double(NAN)})
    EXPECT_THROW(LameConstants::from_young_poisson(young, 0.25), std::invalid_argument);
  for (const double poisson : {-1., 0.5, 0.6, double(NAN)})
    EXPECT_THROW(LameConstants::from_young_poisson(1e9, poisson), std::invalid_argument);
  try
  {
    LameConstants::from_young_poisson(1e9, 0.5);
  }
  catch (const std::invalid_argument &error)
  {
    EXPECT_STREQ(error.what(), "Poisson's ratio is 0.5; it must be > -1 and < 0.5.");
  }
}
} // namespace elastic_laws_tests

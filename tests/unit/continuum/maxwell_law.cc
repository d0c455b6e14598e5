#include "continuum/maxwell_law.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

namespace maxwell_law_tests
{
using namespace antiform::continuum;
using namespace antiform::test;

namespace
{
const auto matrix = LameConstants::from_young_poisson(10e9, 0.3);
const MaxwellBody body(matrix, 1e19);
} // namespace

TEST(MaxwellLaw, RelaxationTimeIsViscosityOverShearModulus)
{
  EXPECT_NEAR(body.relaxation_time(), 1e19 * 2.6 / 10e9, 1e-3);
}

TEST(MaxwellLaw, TangentIsTheDerivative)
{
  Dice dice(1);
  double worst = 0.;
  for (int n = 0; n < 2000; ++n)
  {
    PointInput input;
    input.strain = {dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
    input.initial = {dice(-1e7, 1e7), dice(-1e7, 1e7), dice(-1e7, 1e7), dice(-1e7, 1e7)};
    input.time_step =
        n == 0 ? 0. : body.relaxation_time() * std::pow(10., dice(-12., 3.));
    std::vector<double> history;
    for (int i = 0; i < 3; ++i)
      history.push_back(dice(-1e7, 1e7));
    for (int i = 0; i < 3; ++i)
      history.push_back(dice(-1e-3, 1e-3));
    worst = std::max(worst, tangent_error(body, input, history, 1e-4, 13e9));
  }
  EXPECT_LT(worst, 1e-11); // linear in the strain: round-off alone
}

TEST(MaxwellLaw, AStepOfNoTimeIsElastic)
{
  const LinearElastic elastic(matrix);
  MaterialPoint viscous(body), spring(elastic);
  Dice dice(2);
  for (int n = 0; n < 20; ++n)
  {
    const PlaneVector step{dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
    const PointResponse a = viscous.move(step), b = spring.move(step);
    EXPECT_LT(distance(a.stress, b.stress), 1e-6); // 1e-13 of the stress
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(a.tangent[i][j], b.tangent[i][j], 1e-5);
  }
}

TEST(MaxwellLaw, DecayOfShortAndLongStepsJoin)
{
  // Below 1e-8 of t_M a series: both sides of the change agree.
  const auto stiffness = [](const double r)
  {
    PointInput input;
    input.time_step = r * body.relaxation_time();
    const double begin[6] = {};
    double end[6];
    return body.respond(input, begin, end).tangent[2][2] / matrix.mu;
  };
  EXPECT_NEAR(stiffness(0.999999999e-8), stiffness(1.000000001e-8), 1e-15);
  EXPECT_NEAR(stiffness(1e-4), 1. - 0.5e-4 + 1e-8 / 6., 1e-13); // next term r^3 / 24
  EXPECT_NEAR(stiffness(1e3), 1e-3, 1e-18);
}

TEST(MaxwellLaw, StressTurnsWithTheStrain)
{
  Dice dice(3);
  for (int n = 0; n < 100; ++n)
  {
    const double angle = dice(0., 2. * M_PI);
    MaterialPoint straight(body), other(body);
    straight.input.initial = {dice(-1e7, 1e7), dice(-1e7, 1e7), dice(-1e7, 1e7), 1e6};
    other.input.initial = turned(straight.input.initial, angle);
    PointStress s, t;
    for (int k = 0; k < 3; ++k)
    {
      const PlaneVector step{dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
      const double duration = dice(0., 2.) * body.relaxation_time();
      s = straight.move(step, duration).stress;
      t = other.move(turned(step, angle), duration).stress;
    }
    EXPECT_LT(distance(turned(s, angle), t), 1e-14 * 100e6);
  }
}

TEST(MaxwellLaw, RefusesAViscosityThatIsNotPositive)
{
  for (const double viscosity : {0., -1e19, double(NAN)})
    EXPECT_THROW(MaxwellBody(matrix, viscosity), std::invalid_argument);
}
} // namespace maxwell_law_tests

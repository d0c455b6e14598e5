// Case 57: relaxation, steady flow and creep of a Maxwell body against closed forms.
#include "continuum/maxwell_law.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

namespace maxwell_relaxation_tests
{
using namespace antiform::continuum;
using namespace antiform::test;

namespace
{
const auto matrix = LameConstants::from_young_poisson(10e9, 0.3);
constexpr double viscosity = 1e19;
const MaxwellBody body(matrix, viscosity);
const double t_M = viscosity / matrix.mu;

/// Deviator of a stress, and its mean in the first place of the pair.
std::pair<double, PointStress> parts(const PointStress &s)
{
  const double mean = (s.xx + s.yy + s.zz) / 3.;
  return {mean, {s.xx - mean, s.yy - mean, s.zz - mean, s.xy}};
}
} // namespace

TEST(MaxwellRelaxation, StressOfAHeldStrainFallsAsTheExponential)
{
  const PlaneVector strain{1e-3, -3e-4, 8e-4};
  const auto [mean, s] = parts(matrix.stress({strain[0], strain[1], 0., strain[2]}));
  const double scale = std::abs(s.xx);
  double worst = 0.;
  // To t = 3 t_M in steps of 1e-4 to 3 relaxation times, then one of 1e3.
  for (const int n_steps : {1, 2, 7, 100, 30000})
  {
    MaterialPoint point(body);
    point.move(strain); // at once: elastic
    PointStress now{};
    for (int n = 0; n < n_steps; ++n)
      now = point.move({}, 3. * t_M / n_steps).stress;
    const double left = std::exp(-3.);
    const PointStress expected{mean + left * s.xx, mean + left * s.yy, mean + left * s.zz,
                               left * s.xy};
    worst = std::max(worst, distance(now, expected) / (left * scale));
    const auto end = parts(point.move({}, 1e3 * t_M).stress);
    EXPECT_LT(distance(end.second, {}), 1e-14 * scale);
    EXPECT_NEAR(end.first, mean, 1e-14 * scale);
  }
  EXPECT_LT(worst, 1e-10);
  RecordProperty("worst_of_1e-15", static_cast<int>(worst * 1e15));
}

TEST(MaxwellRelaxation, ShearAtAConstantRateIsTheClosedForm)
{
  // tau = eta g' (1 - exp(-t / t_M)), in steps of any length and of uneven lengths.
  const double rate = 1e-14, end_time = 2.5 * t_M;
  const double expected = viscosity * rate * -std::expm1(-2.5);
  for (const int n_steps : {1, 3, 1000})
  {
    MaterialPoint point(body);
    double now = 0.;
    for (int n = 0; n < n_steps; ++n)
      now = point.move({0., 0., rate * end_time / n_steps}, end_time / n_steps).stress.xy;
    EXPECT_NEAR(now, expected, 1e-12 * expected) << n_steps; // round-off of 1000 steps
  }
  MaterialPoint point(body);
  double now = 0.;
  for (const double share : {1e-12, 1e-9, 1e-6, 1e-3, 0.3, 0.7 - 1.001001001e-3 + 1e-12})
    now = point.move({0., 0., rate * end_time * share}, end_time * share).stress.xy;
  EXPECT_NEAR(now, expected, 1e-11 * expected); // the shares add up to 1 + 1e-12
}

TEST(MaxwellRelaxation, ALongStepFlowsAsAFluid)
{
  // tau = eta g' once t >> t_M.
  MaterialPoint point(body);
  EXPECT_NEAR(point.move({0., 0., 0.2}, 1e4 * t_M).stress.xy,
              viscosity * 0.2 / (1e4 * t_M), 1e-9);
}

TEST(MaxwellRelaxation, SplittingAStepChangesNothing)
{
  Dice dice(57);
  const PointStress initial{-20e6, -30e6, -25e6, 2e6};
  for (int n = 0; n < 200; ++n)
  {
    MaterialPoint whole(body), split(body);
    whole.input.initial = split.input.initial = initial;
    const PlaneVector first{dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
    whole.move(first, t_M);
    split.move(first, t_M);
    const PlaneVector step{dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
    const double duration = t_M * std::pow(10., dice(-6., 1.)), share = dice(0., 1.);
    const PointStress a = whole.move(step, duration).stress;
    split.move({share * step[0], share * step[1], share * step[2]}, share * duration);
    const PointStress b = split
                              .move({(1. - share) * step[0], (1. - share) * step[1],
                                     (1. - share) * step[2]},
                                    (1. - share) * duration)
                              .stress;
    EXPECT_LT(distance(a, b), 1e-14 * 50e6);
  }
}

TEST(MaxwellRelaxation, InitialDeviatorRelaxesAsWell)
{
  const PointStress initial{-20e6, -32e6, -26e6, 3e6};
  MaterialPoint point(body);
  point.input.initial = initial;
  EXPECT_EQ(distance(point.move({}).stress, initial), 0.);
  const auto [mean, s] = parts(initial);
  const double left = std::exp(-0.4);
  const PointStress expected{mean + left * s.xx, mean + left * s.yy, mean + left * s.zz,
                             left * s.xy};
  EXPECT_LT(distance(point.move({}, 0.4 * t_M).stress, expected), 1e-14 * 32e6);
}

TEST(MaxwellRelaxation, StressDoesWork)
{
  // Work put in is at least what is stored: of a closed path of strain it is not
  // negative.
  Dice dice(58);
  for (int path = 0; path < 50; ++path)
  {
    MaterialPoint point(body);
    PlaneVector there{};
    double work = 0.;
    for (int n = 0; n < 20; ++n)
    {
      const PlaneVector next =
          n == 19 ? PlaneVector{}
                  : PlaneVector{dice(-1e-3, 1e-3), dice(-1e-3, 1e-3), dice(-1e-3, 1e-3)};
      for (int part = 0; part < 200; ++part)
      {
        PlaneVector step;
        for (int i = 0; i < 3; ++i)
          step[i] = (next[i] - there[i]) / 200.;
        const PointStress s = point.move(step, t_M / 100.).stress;
        work += s.xx * step[0] + s.yy * step[1] + s.xy * step[2];
      }
      there = next;
    }
    EXPECT_GT(work, 0.);
  }
}
} // namespace maxwell_relaxation_tests

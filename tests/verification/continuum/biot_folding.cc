// Case 49: an elastic layer under axial stress in a viscous matrix folds at the rate and
// in the wavelength that Biot (1961) found.
#include "continuum/maxwell_law.h"
#include "continuum/newton_solver.h"
#include "continuum/strut_theory.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace biot_folding_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// k h = 0.1 for the wave that grows fastest: shear and the couple of the sticking matrix
/// count for (k h)^2.
constexpr double h = 1., poisson = 0.25;
const theory::Layer layer{1. - poisson * poisson, poisson, h}; // E' = 1
constexpr double stress = 2.5e-3;
const double fastest = 2. * M_PI / theory::viscous_dominant_wavelength(layer, stress);
/// That grows at 1 there.
const double viscosity = theory::viscous_growth_rate(layer, stress, 1., fastest);
/// Elasticity of the matrix: soft beside the layer, stiff beside what it bears as it
/// flows (growth times viscosity, 0.4 % of this), so that it flows like an incompressible
/// fluid.
const LameConstants elastic = LameConstants::from_young_poisson(0.03, 0.3);

struct Cells
{
  unsigned int n_columns = 16; ///< in half a wave
  unsigned int refinement = 1;
};

/// Half a wave of half the layer, whose axis stays in place along x as a fold's does,
/// with the matrix beside it, a wave thick. The axis is made as w0 cos(k x).
class Fold
{
public:
  Fold(const double wavenumber, const Cells &cells)
      : k_(wavenumber)
      , triangulation_(MPI_COMM_WORLD)
  {
    const double length = M_PI / k_, depth = 2. * M_PI / k_;
    const auto level = [this](const double y)
    { return [this, y](const double x) { return y + axis(x); }; };
    const double cell = 0.5 * h / cells.refinement;
    make_section(triangulation_, 0., length, cells.n_columns,
                 {{level(0.), level(0.5 * h), even_rows(cells.refinement), 0, false},
                  {level(0.5 * h), level(0.5 * h + depth),
                   graded_rows(depth, cell, 0., std::pow(2., 1. / cells.refinement),
                               0.2 * length / cells.refinement, false),
                   1, true}});
    NonlinearSolid::Options options;
    options.initial_stress = [this](const Point<2> &p)
    {
      PointStress initial;
      if (p[1] - axis(p[0]) < 0.5 * h)
        initial.xx = -stress;
      return initial;
    };
    solid_ = std::make_unique<NonlinearSolid>(
        triangulation_,
        std::vector<Law>{make_law<StVenantKirchhoff>(layer.young_modulus, poisson),
                         std::make_shared<MaxwellBody>(elastic, viscosity)},
        options);
    const auto zero = [](const Point<2> &) { return 0.; };
    for (const auto side : {boundary::left, boundary::right, boundary::bottom})
      prescribe(*solid_, side, 0, zero, supports_.displacements);
    for (const unsigned int c : {0u, 1u})
      prescribe(*solid_, boundary::top, c, zero, supports_.displacements);
  }

  /// Rate at which the wave grows from time 0.4 to 0.8, in steps of @p dt: of the two
  /// halves of that time, since W = A exp(s t) - B for a layer that was made bent.
  /// Before, the harmonics of a layer made of cells die away: the third as exp(-9 t).
  double growth_rate(const double dt)
  {
    LoadedSolid body(*solid_, supports_, {});
    NewtonSolver::Options options;
    options.convergence.tolerance = 1e-11; // the prestress is 1e5 times what grows
    NewtonSolver newton(body, options);
    auto u = solid_->make_vector();
    std::vector<double> crest;
    const auto record = [&]
    { crest.push_back(at_node(*solid_, u, Point<2>(0., axis(0.)), 1)); };
    for (const double step : {0.2, 0.2})
      newton.solve(0., step, u);
    record();
    const auto n = static_cast<unsigned int>(std::lround(0.2 / dt));
    for (unsigned int half = 0; half < 2; ++half)
    {
      for (unsigned int i = 0; i < n; ++i)
        newton.solve(0., dt, u);
      record();
    }
    return std::log((crest[2] - crest[1]) / (crest[1] - crest[0])) / 0.2;
  }

private:
  double axis(const double x) const { return 2e-3 * h * std::cos(k_ * x); }

  double k_;
  Triangulation triangulation_;
  std::unique_ptr<NonlinearSolid> solid_;
  Loads supports_;
};

/// The rate s of a body that steps from W to W / (1 - s dt), as one does which flows at
/// the rate of each step's end, from the growth that was seen.
double rate_of_steps(const double seen, const double dt)
{
  return -std::expm1(-seen * dt) / dt;
}

/// Without the limit of a thin layer and an incompressible fluid: by the correspondence
/// of elastic and viscous bodies the rate s at which the layer buckles under its stress
/// in a matrix of the shear modulus G = mu s t / (1 + s t), t = viscosity / mu.
double exact_rate(const double k)
{
  double low = 0., high = 2.;
  for (int i = 0; i < 60; ++i)
  {
    const double s = 0.5 * (low + high);
    const double G = viscosity * s / (1. + s * viscosity / elastic.mu);
    const double K = elastic.bulk_modulus();
    const double nu = (3. * K - 2. * G) / (2. * (3. * K + G));
    const theory::Side side{2. * G * (1. + nu), nu, 2. * M_PI / k,
                            theory::Side::FarFace::rough_rigid};
    const theory::SupportedLayer supported{layer, {side, side}, 0., true, true};
    (supported.buckling_force(k) < stress * h ? low : high) = s;
  }
  return low;
}
} // namespace

TEST(BiotFolding, WaveGrowsAtTheRateOfTheClosedForm)
{
  const double biot = theory::viscous_growth_rate(layer, stress, viscosity, fastest);
  ASSERT_NEAR(biot, 1., 1e-12);
  std::vector<double> rates;
  for (const double dt : {0.2, 0.1, 0.05})
  {
    rates.push_back(Fold(fastest, {}).growth_rate(dt));
    EXPECT_NEAR(rate_of_steps(rates.back(), dt), biot, 0.05) << dt;
    // Cells of four times their height in bending, 0.3 %; turning sections under the
    // axial force, (k h)^2 / 12 of it or 0.1 % of the rate; the prestress beside the
    // modulus, 0.25 %.
    EXPECT_NEAR(rate_of_steps(rates.back(), dt), exact_rate(fastest), 0.008) << dt;
    // Nothing but the rule of the steps depends on them.
    EXPECT_NEAR(rate_of_steps(rates.back(), dt), rate_of_steps(rates.front(), 0.2), 1e-4);
  }
  // Steps that flow at their end's rate are of order 1: s + s^2 dt / 2 + s^3 dt^2 / 3.
  const double order = std::log2((rates[0] - rates[1]) / (rates[1] - rates[2]));
  EXPECT_NEAR(order, 1.15, 0.1);
  EXPECT_NEAR(2. * rates[2] - rates[1], biot, 0.05);
}

TEST(BiotFolding, FastestWaveIsTheDominantWavelength)
{
  std::vector<double> ratios{0.7, 0.85, 1., 1.15, 1.3}, rates;
  for (const double ratio : ratios)
  {
    const double k = ratio * fastest;
    rates.push_back(rate_of_steps(Fold(k, {}).growth_rate(0.2), 0.2));
    const double biot = theory::viscous_growth_rate(layer, stress, viscosity, k);
    EXPECT_NEAR(rates.back(), biot, 0.05 * biot) << ratio;
    EXPECT_NEAR(rates.back(), exact_rate(k), 0.008 * exact_rate(k)) << ratio; // as above
  }
  // The rate is a k - b k^3, whose parabola through these is 0.4 % off at the top; thick
  // layers and sticking count for (k h)^2.
  const double slope = (rates[3] - rates[1]) / 0.3,
               curvature = (rates[3] - 2. * rates[2] + rates[1]) / (0.15 * 0.15);
  ASSERT_LT(curvature, 0.);
  EXPECT_NEAR(1. / (1. - slope / curvature), 1., 0.015); // wavelength over lambda_d
  // So it falls on both sides of the top, by 12 % and 15 %.
  EXPECT_LT(rates[0], 0.9 * rates[2]);
  EXPECT_LT(rates[4], 0.88 * rates[2]);
}

TEST(BiotFolding, RatesConvergeWithTheCellsLong)
{
  std::vector<double> rates;
  for (const Cells &cells : {Cells{4, 1}, Cells{8, 1}, Cells{16, 2}, Cells{32, 4}})
    rates.push_back(rate_of_steps(Fold(fastest, cells).growth_rate(0.1), 0.1));
  // Q2 in bending: cells of 16 to 2 times their height reach order 4 as they shorten.
  const auto order = [&](const std::size_t i)
  { return std::log2((rates[i + 1] - rates[i]) / (rates[i + 2] - rates[i + 1])); };
  EXPECT_NEAR(order(0), 2.7, 0.3);
  EXPECT_NEAR(order(1), 3.6, 0.4);
  EXPECT_NEAR(rates[3], exact_rate(fastest), 0.004); // without the cells' share
}
} // namespace biot_folding_tests

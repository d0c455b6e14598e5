// Case 53: Cook's membrane, whose volume hardly changes.
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace cooks_membrane_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// The trapezium (0, 0), (48, 44), (48, 60), (0, 44), held at the left and pulled up by a
/// force of 1 along its right side: how far the middle of that side, (48, 52), rises.
double rise(const Law &law,
            const unsigned int degree,
            const StrainForm form,
            const unsigned int n_cells,
            const bool allow_locking = false)
{
  Strip strip;
  strip.lower = [](const double x) { return 44. / 48. * x; };
  strip.upper = [](const double x) { return 44. + 16. / 48. * x; };
  strip.rows = even_rows(n_cells);
  Triangulation triangulation(MPI_COMM_WORLD);
  make_section(triangulation, 0., 48., n_cells, {strip});
  NonlinearSolid::Options options;
  options.degree = degree;
  options.strain_form = form;
  options.allow_locking = allow_locking;
  NonlinearSolid solid(triangulation, {law}, options);

  Loads growing;
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        solid, boundary::left, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
  growing.dead = boundary_traction(solid, {boundary::right},
                                   [](const Point<2> &, const auto &) {
                                     return dealii::Tensor<1, 2>({0., 1. / 16.});
                                   });
  LoadedSolid problem(solid, {}, growing);
  auto u = solid.make_vector();
  NewtonSolver(problem, NewtonSolver::Options()).solve(1., 0., u);
  return at_node(solid, u, Point<2>(48., 52.), 1);
}

constexpr auto plain = StrainForm::displacement, mean = StrainForm::mean_dilatation;
} // namespace

TEST(CooksMembrane, CompressibleOneRisesAsPublished)
{
  // Plane stress, E = 1, nu = 1/3: 23.96 (Cook, Malkus & Plesha 1989). In plane strain
  // that is E = 15/16, nu = 1/4.
  const Law law = make_law<LinearElastic>(0.9375, 0.25);
  EXPECT_NEAR(rise(law, 2, plain, 32), 23.96, 0.01);
  EXPECT_NEAR(rise(law, 1, mean, 48), 23.96, 0.1);
  EXPECT_NEAR(rise(law, 1, plain, 48), 23.96, 0.2);
}

TEST(CooksMembrane, NearlyIncompressibleOneDoesNotLock)
{
  // E = 1, nu = 0.4999. Displacement and pressure cells (Q2 and continuous Q1,
  // Taylor & Hood 1973) of a program of its own rise by 18.407, 18.464, 18.490, 18.502 in
  // meshes of 8 to 64 cells along a side, towards 18.51; it meets the published 23.96.
  const double exact = 18.51;
  const Law law = make_law<LinearElastic>(1., 0.4999);
  std::vector<double> q2, b_bar, q1;
  for (const unsigned int n : {8u, 16u, 32u})
  {
    q2.push_back(rise(law, 2, plain, n));
    b_bar.push_back(rise(law, 1, mean, n));
    q1.push_back(rise(law, 1, plain, n, true));
  }
  EXPECT_NEAR(q2[2], exact, 0.02 * exact);
  EXPECT_NEAR(b_bar[2], exact, 0.02 * exact);
  for (const auto *rises : {&q2, &b_bar})
    for (unsigned int level = 0; level < 2; ++level)
    {
      // The corner of the clamped side keeps the order near 1 for fine meshes.
      const double order =
          std::log2((exact - (*rises)[level]) / (exact - (*rises)[level + 1]));
      EXPECT_GT(order, 0.9);
    }
  // Four times as many locked cells gain little.
  EXPECT_LT(q1[2], 0.5 * exact);
}

TEST(CooksMembrane, PlainQ1IsRefused)
{
  const Law law = make_law<LinearElastic>(1., 0.4999);
  try
  {
    rise(law, 1, plain, 4);
    FAIL();
  }
  catch (const std::invalid_argument &problem)
  {
    const std::string text = problem.what();
    EXPECT_NE(text.find("Q2 cells"), std::string::npos) << text;
    EXPECT_NE(text.find("mean dilatation"), std::string::npos) << text;
  }
  EXPECT_THROW(rise(make_law<LinearElastic>(1., 0.45), 1, plain, 4),
               std::invalid_argument);
  EXPECT_NO_THROW(rise(make_law<LinearElastic>(1., 0.449), 1, plain, 4));
  EXPECT_THROW(rise(make_law<NeoHookean>(1., 0.3), 1, mean, 4), std::invalid_argument);
  EXPECT_THROW(rise(make_law<LinearElastic>(1., 0.3), 2, mean, 4), std::invalid_argument);
}
} // namespace cooks_membrane_tests

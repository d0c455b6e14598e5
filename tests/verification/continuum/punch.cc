// Prandtl's punch: a body whose plastic flow keeps its volume, pressed by a smooth rigid
// punch, yields at (2 + pi) c.
#include "continuum/newton_solver.h"
#include "continuum/plastic_laws.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace punch_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// Mean pressures under the punch over c, at half of the displacement and at all of it.
struct Pressures
{
  double half, whole;
};

/// Half of a body of 8 by 2 half widths of the punch, in square cells of 1 / @p n.
Pressures press(const unsigned int n, const unsigned int degree, const StrainForm form)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 4., 2., 4 * n, 2 * n);
  NonlinearSolid::Options options;
  options.degree = degree;
  options.strain_form = form;
  MohrCoulombParameters tresca{};
  tresca.cohesion = 1.;
  const auto law =
      std::make_shared<MohrCoulomb>(LameConstants::from_young_poisson(300., 0.3), tresca);
  NonlinearSolid solid(triangulation, {law}, options);

  const auto zero = [](const Point<2> &) { return 0.; };
  Loads pressing;
  prescribe(solid, boundary::left, 0, zero, pressing.displacements);
  prescribe(solid, boundary::right, 0, zero, pressing.displacements);
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(solid, boundary::bottom, c, zero, pressing.displacements);
  const auto is_under = [&](const auto dof)
  {
    const auto p = solid.support_point(dof);
    return solid.component(dof) == 1 && p[1] > 1. - 1e-9 && p[0] < 1. + 1e-9;
  };
  for (const auto dof : solid.locally_relevant())
    if (is_under(dof))
      pressing.displacements[dof] = -1.;
  LoadedSolid body(solid, {}, pressing);
  NewtonSolver newton(body, NewtonSolver::Options());

  auto u = solid.make_vector();
  const auto pressure = [&]
  {
    double sum = 0.;
    for (const auto dof : solid.locally_owned())
      if (is_under(dof))
        sum -= body.reactions()(dof);
    return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  };
  newton.advance(0., 0.06, 12, u);
  const double half = pressure();
  newton.advance(0.06, 0.12, 12, u);
  return {half, pressure()};
}
} // namespace

TEST(Punch, CollapsesAtPrandtlsLoad)
{
  // From above, with the width of a cell: under the rim the load reaches into the next.
  const double exact = 2. + M_PI;
  std::vector<double> loads;
  for (const unsigned int n : {2u, 4u, 8u})
  {
    const Pressures pressures = press(n, 1, StrainForm::mean_dilatation);
    loads.push_back(pressures.whole);
    EXPECT_NEAR(pressures.whole, pressures.half, 0.015 * exact); // it flows
  }
  for (unsigned int level = 0; level < 2; ++level)
    EXPECT_NEAR(std::log2((loads[level] - exact) / (loads[level + 1] - exact)), 1., 0.1);
  EXPECT_NEAR(2. * loads[2] - loads[1], exact, 5e-3 * exact);
}

TEST(Punch, LockedCellsNeverCollapse)
{
  // Poisson's ratio is 0.3, for which Q1 cells are good enough until the body flows.
  const Pressures pressures = press(8, 1, StrainForm::displacement);
  EXPECT_GT(pressures.whole, 1.03 * pressures.half);
  EXPECT_GT(pressures.whole, 1.1 * (2. + M_PI));
}
} // namespace punch_tests

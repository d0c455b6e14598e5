// Hanging nodes on strongly distorted cells, across a contrast of 1e4.
#include "continuum/dof_reduction.h"
#include "continuum/error_indicator.h"
#include "continuum/hanging_nodes.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"
#include "support/refined_meshes.h"

#include <gtest/gtest.h>

#include <numeric>

namespace hanging_nodes_hard_cases_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double strong = 20e9, weak = 2e6, nu_strong = 0.2, nu_weak = 0.4;
const std::vector<ElasticMaterial> materials{
    ElasticMaterial::isotropic(strong, nu_strong, 1.),
    ElasticMaterial::isotropic(weak, nu_weak, 1.)};

/// The material that meets y = 0 from above is the weak one. Stretched along x, and
/// pressed and sheared by tractions that are the same on both sides: gradients of either
/// side by Hooke's law.
double exact_field(const Point<2> &p, const unsigned int component)
{
  constexpr double e_xx = 1e-3, s_yy = -500., s_xy = 300., rotation = 2e-4; // [-], [Pa]
  const auto &C = materials[p[1] > 0. ? 1 : 0].stiffness;
  const double e_yy = (s_yy - C[1][0] * e_xx) / C[1][1], g_xy = s_xy / C[2][2];
  return component == 0 ? e_xx * p[0] + (g_xy - rotation) * p[1]
                        : rotation * p[0] + e_yy * p[1];
}

/// [0, 1] x [-1/2, 1/2] whose inner nodes are pushed to and fro by nearly half a cell;
/// those on y = 0 along it. Finer by one level in a strip across, and by two in its
/// middle.
void make_distorted(Triangulation &triangulation)
{
  constexpr unsigned int n = 6;
  make_rectangle(triangulation, 1., 1., n, n);
  dealii::GridTools::transform(
      [](const Point<2> &p)
      {
        const int i = static_cast<int>(std::lround(p[0] * n)),
                  j = static_cast<int>(std::lround((p[1] + 0.5) * n));
        if (i == 0 || j == 0 || i == n || j == n)
          return p;
        const double side = (i + j) % 2 == 0 ? 1. : -1.;
        return Point<2>(p[0] + 0.3 * side / n, 2 * j == n ? 0. : p[1] - 0.18 * side / n);
      },
      triangulation);
  for (const auto &cell : triangulation.active_cell_iterators())
    cell->set_material_id(cell->center()[1] > 0. ? 1 : 0);
  refine_where(triangulation,
               [](const Point<2> &p) { return std::abs(p[0] - 0.5) < 0.25; });
  refine_where(triangulation,
               [](const Point<2> &p) { return p.distance(Point<2>(0.5, 0.)) < 0.15; });
}

/// Least over largest Jacobian at the corners of a cell, of the worst of them.
double worst_shape(const Triangulation &triangulation)
{
  double worst = 1.;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      double least = 1e300, largest = 0.;
      for (const auto &corner :
           {std::array<unsigned int, 3>{0, 1, 2}, {1, 3, 0}, {3, 2, 1}, {2, 0, 3}})
      {
        const auto a = cell->vertex(corner[1]) - cell->vertex(corner[0]),
                   b = cell->vertex(corner[2]) - cell->vertex(corner[0]);
        const double J = a[0] * b[1] - a[1] * b[0];
        least = std::min(least, J);
        largest = std::max(largest, J);
      }
      worst = std::min(worst, least / largest);
    }
  return dealii::Utilities::MPI::min(worst, MPI_COMM_WORLD);
}
} // namespace

TEST(HardHangingNodes, PatchOfTwoMaterialsIsExact)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted(triangulation);
  EXPECT_GT(worst_shape(triangulation), 0.);
  EXPECT_LT(worst_shape(triangulation), 0.05);
  for (const unsigned int degree : {1u, 2u})
  {
    SCOPED_TRACE(degree);
    const ElasticSolid solid(triangulation, materials, degree);
    ASSERT_NE(solid.hanging_nodes(), nullptr);
    const auto exact = interpolate(solid, exact_field);
    const auto sides = prescribe_all_sides(solid, exact_field);
    const auto none = solid.make_vector();
    // Round-off; displacements of both sides are of a size, so the contrast does not
    // tell.
    const double tolerance = 1e-12 * largest(exact);
    StaticSolver::Options options;
    options.tolerance = 1e-14;
    options.method = StaticSolver::Method::conjugate_gradients;
    auto u = solve(solid, solid.stiffness(), sides, none, options);
    u -= exact;
    EXPECT_LT(largest(u), tolerance);
    u = solve_reduced(solid, DofReduction(solid, sides, {}), none);
    u -= exact;
    EXPECT_LT(largest(u), tolerance);

    u = solve_direct(solid, solid.stiffness(), sides, none);
    Surroundings surroundings;
    surroundings.displacements = sides;
    const auto indicators = error_indicators(solid, u, surroundings);
    const double sum = dealii::Utilities::MPI::sum(
        std::accumulate(indicators.begin(), indicators.end(), 0.), MPI_COMM_WORLD);
    EXPECT_LT(sum, 1e-24 * solid.strain_energy(u)); // squares of round-off
    u -= exact;
    EXPECT_LT(largest(u), tolerance);
  }
}

TEST(HardHangingNodes, PatchOfTwoLawsIsExactForNewton)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted(triangulation);
  for (const unsigned int degree : {1u, 2u})
  {
    SCOPED_TRACE(degree);
    NonlinearSolid::Options of_body;
    of_body.degree = degree;
    NonlinearSolid solid(triangulation,
                         {make_law<LinearElastic>(strong, nu_strong),
                          make_law<LinearElastic>(weak, nu_weak)},
                         of_body);
    Loads sides;
    sides.displacements = prescribe_all_sides(solid, exact_field);
    LoadedSolid body(solid, {}, sides);
    NewtonSolver::Options options;
    options.convergence.tolerance = 1e-13; // round-off of the forces
    auto u = solid.make_vector();
    NewtonSolver(body, options).advance(0., 1., 1, u);
    const auto exact = interpolate(solid, exact_field);
    u -= exact;
    // Forces of the strong side are 1e4 of the weak one's, and so is their round-off.
    EXPECT_LT(largest(u), 1e-10 * largest(exact));
  }
}
} // namespace hanging_nodes_hard_cases_tests

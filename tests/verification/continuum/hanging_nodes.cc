// Hanging nodes in all solvers: fields that are exact, symmetry, ranks.
#include "continuum/arc_length.h"
#include "continuum/dof_reduction.h"
#include "continuum/hanging_nodes.h"
#include "continuum/loads.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"
#include "support/refined_meshes.h"

#include <gtest/gtest.h>

namespace hanging_nodes_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double young_modulus = 20e9, poisson_ratio = 0.25;
const auto rock = ElasticMaterial::isotropic(young_modulus, poisson_ratio, 2500.);

double linear_field(const Point<2> &p, const unsigned int component)
{
  return component == 0 ? 1e-3 + 2e-3 * p[0] - 1e-3 * p[1]
                        : -2e-3 + 5e-4 * p[0] + 3e-3 * p[1];
}

/// Its stress is linear in the place: a uniform body force balances it.
double quadratic_field(const Point<2> &p, const unsigned int component)
{
  const double x = p[0], y = p[1];
  return component == 0 ? 1e-3 * (x * x - 2. * x * y + 0.5 * y * y)
                        : 1e-3 * (0.3 * x * x + x * y - y * y);
}

/// - div sigma of quadratic_field().
dealii::Tensor<1, 2> force_of_quadratic_field()
{
  const auto &C = rock.stiffness;
  // Derivatives of the strains (xx, yy, xy) along x and along y.
  const double along_x[3] = {2e-3, 1e-3, -2e-3 + 0.6e-3},
               along_y[3] = {-2e-3, -2e-3, 1e-3 + 1e-3};
  dealii::Tensor<1, 2> force;
  for (unsigned int j = 0; j < 3; ++j)
  {
    force[0] -= C[0][j] * along_x[j] + C[2][j] * along_y[j];
    force[1] -= C[2][j] * along_x[j] + C[1][j] * along_y[j];
  }
  return force;
}

/// A corner of two levels finer than the rest, and one cell in the middle.
void make_refined_square(Triangulation &triangulation)
{
  make_distorted_square(triangulation, 5);
  refine_where(triangulation, [](const Point<2> &p)
               { return p[0] + p[1] < 0.8 || p.distance(Point<2>(0.65, 0.7)) < 0.1; });
  refine_where(triangulation, [](const Point<2> &p) { return p[0] + p[1] < 0.5; });
}

StaticSolver::Options options_of(const StaticSolver::Method method)
{
  StaticSolver::Options options;
  options.method = method;
  options.tolerance = method == StaticSolver::Method::direct ? 1e-10 : 1e-14;
  return options;
}

/// Entries of a matrix on all ranks.
dealii::FullMatrix<double> dense(const Matrix &matrix)
{
  const auto n = static_cast<unsigned int>(matrix.m());
  std::vector<double> entries(static_cast<std::size_t>(n) * n, 0.);
  for (const auto row : matrix.locally_owned_range_indices())
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      entries[static_cast<std::size_t>(row) * n + entry->column()] = entry->value();
  dealii::Utilities::MPI::sum(entries, MPI_COMM_WORLD, entries);
  dealii::FullMatrix<double> result(n, n);
  result.fill(entries.data());
  return result;
}

void expect_linear_field_is_solved(const unsigned int degree)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_refined_square(triangulation);
  const ElasticSolid solid(triangulation, {rock}, degree);
  ASSERT_NE(solid.hanging_nodes(), nullptr);
  const auto exact = interpolate(solid, linear_field);
  const auto sides = prescribe_all_sides(solid, linear_field);
  const auto none = solid.make_vector();
  // Round-off times the condition of a few hundred nodes (some 1e3).
  const double tolerance = 1e-12 * largest(exact);
  for (const auto method :
       {StaticSolver::Method::direct, StaticSolver::Method::conjugate_gradients})
  {
    auto u = solve(solid, solid.stiffness(), sides, none, options_of(method));
    u -= exact;
    EXPECT_LT(largest(u), tolerance);
  }
  auto u = solve_reduced(solid, DofReduction(solid, sides, {}), none);
  u -= exact;
  EXPECT_LT(largest(u), tolerance);
}

void expect_homogeneous_deformation_is_solved(const unsigned int degree)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_refined_square(triangulation);
  NonlinearSolid::Options of_body;
  of_body.degree = degree;
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(young_modulus, 0.3)},
                       of_body);
  const auto large = [](const Point<2> &p, const unsigned int c)
  { return 100. * linear_field(p, c); };
  Loads sides;
  sides.displacements = prescribe_all_sides(solid, large);
  LoadedSolid body(solid, {}, sides);
  NewtonSolver::Options options;
  options.convergence.tolerance = 1e-13; // round-off of the forces
  NewtonSolver newton(body, options);
  // The state that it starts from is not continuous, and must be made so.
  auto u = solid.make_vector();
  for (const auto dof : solid.locally_owned())
    if (solid.hanging_nodes()->contains(dof))
      u(dof) = 0.01;
  newton.advance(0., 1., 1, u);
  u -= interpolate(solid, large);
  EXPECT_LT(largest(u), 1e-12 * 0.5); // of a largest displacement of 0.5 m
}
} // namespace

TEST(HangingNodes, AreThereOnlyWhereCellsDiffer)
{
  Triangulation even(MPI_COMM_WORLD), uneven(MPI_COMM_WORLD);
  make_rectangle(even, 1., 1., 2, 2);
  even.refine_global(1);
  EXPECT_EQ(ElasticSolid(even, {rock}, 2).hanging_nodes(), nullptr);

  // One cell of four is halved: its two inner sides carry a node each, in Q2 cells also
  // that of either half of a side.
  make_rectangle(uneven, 1., 1., 2, 2);
  refine_where(uneven, [](const Point<2> &p) { return p[0] < 0.5 && p[1] < 0.; });
  for (const unsigned int degree : {1u, 2u})
  {
    const ElasticSolid solid(uneven, {rock}, degree);
    ASSERT_NE(solid.hanging_nodes(), nullptr);
    EXPECT_EQ(solid.hanging_nodes()->n_dofs(), degree == 1 ? 4u : 12u);
    EXPECT_THROW(solid.lumped_mass(), std::invalid_argument);
  }
}

TEST(HangingNodes, LinearFieldIsSolvedExactlyByQ1)
{
  expect_linear_field_is_solved(1);
}
TEST(HangingNodes, LinearFieldIsSolvedExactlyByQ2)
{
  expect_linear_field_is_solved(2);
}
TEST(HangingNodes, HomogeneousDeformationIsExactInQ1)
{
  expect_homogeneous_deformation_is_solved(1);
}
TEST(HangingNodes, HomogeneousDeformationIsExactInQ2)
{
  expect_homogeneous_deformation_is_solved(2);
}

TEST(HangingNodes, QuadraticFieldIsSolvedExactlyByQ2)
{
  // Only on straight cells do Q2 cells hold all of it.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1.3, 1., 4, 3);
  refine_where(triangulation, [](const Point<2> &p) { return p[0] < 0.7 && p[1] < 0.2; });
  refine_where(triangulation, [](const Point<2> &p) { return p[0] < 0.3; });
  const ElasticSolid solid(triangulation, {rock}, 2);
  const auto exact = interpolate(solid, quadratic_field);
  const auto force =
      body_force(solid, [](const Point<2> &) { return force_of_quadratic_field(); });
  auto u = solve_direct(solid, solid.stiffness(),
                        prescribe_all_sides(solid, quadratic_field), force);
  u -= exact;
  EXPECT_LT(largest(u), 1e-12 * largest(exact)); // as above
}

TEST(HangingNodes, ReactionsBalanceTheLoad)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_refined_square(triangulation);
  NonlinearSolid solid(triangulation, {make_law<LinearElastic>(young_modulus, 0.3)},
                       NonlinearSolid::Options());
  Loads growing;
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
  const double force = 3e6; // per area of the section, along -y
  growing.dead = body_force(solid,
                            [&](const Point<2> &) {
                              return dealii::Tensor<1, 2>({0., -force});
                            });
  LoadedSolid body(solid, {}, growing);
  auto u = solid.make_vector();
  NewtonSolver(body, NewtonSolver::Options()).advance(0., 1., 1, u);
  double reaction = 0., area = 0.;
  for (const auto dof : solid.locally_owned())
    reaction += solid.component(dof) == 1 ? body.reactions()(dof) : 0.;
  for (const auto &state : solid.point_states(u))
    area += state.area;
  reaction = dealii::Utilities::MPI::sum(reaction, MPI_COMM_WORLD);
  area = dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD);
  // The residual that Newton's method leaves, 1e-8 of the forces.
  EXPECT_NEAR(reaction, force * area, 1e-8 * force * area);
}

TEST(HangingNodes, ReducedMatrixIsSymmetricAndHasRigidMotionsOnly)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_refined_square(triangulation);
  const ElasticSolid solid(triangulation, {rock}, 2);
  const DofReduction reduction(solid, {}, {});
  EXPECT_EQ(reduction.make_vector().size() + solid.hanging_nodes()->n_dofs(),
            solid.dof_handler().n_dofs());
  const auto K = dense(reduction.reduce(solid.stiffness()));
  double asymmetry = 0.;
  dealii::LAPACKFullMatrix<double> matrix(K.m(), K.m());
  for (unsigned int i = 0; i < K.m(); ++i)
    for (unsigned int j = 0; j < K.m(); ++j)
    {
      asymmetry = std::max(asymmetry, std::abs(K(i, j) - K(j, i)));
      matrix(i, j) = 0.5 * (K(i, j) + K(j, i));
    }
  EXPECT_LT(asymmetry, 1e-14 * K.linfty_norm()); // round-off of the products
  dealii::FullMatrix<double> vectors;
  dealii::Vector<double> values;
  matrix.compute_eigenvalues_symmetric(-1e300, 1e300, 0., values, vectors);
  // Two translations and a rotation to round-off; the next, a bent square, is some 1e-3.
  const double size = values[values.size() - 1];
  for (unsigned int k = 0; k < 3; ++k)
    EXPECT_NEAR(values[k], 0., 1e-12 * size) << k;
  EXPECT_GT(values[3], 1e-6 * size);
}

// A block pressed by a dead load: the arc's end is Newton's equilibrium.
TEST(HangingNodes, ArcLengthMeetsNewton)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 3, 3);
  refine_where(triangulation, [](const Point<2> &p) { return p[0] + p[1] < 0.2; });
  NonlinearSolid::Options of_body;
  of_body.degree = 1;
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)}, of_body);
  Loads growing;
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
  growing.dead = pressure(solid, {boundary::top}, 0.1);
  LoadedSolid body(solid, {}, growing);
  auto by_newton = solid.make_vector(), by_arc = solid.make_vector();
  NewtonSolver(body, NewtonSolver::Options()).advance(0., 1., 1, by_newton);
  ArcLength::Options options;
  options.first_length = 0.03;
  double factor = 0.;
  ArcLength(body, options)
      .follow(
          by_arc, factor, [](const Vector &, const double f) { return f; }, 1.);
  EXPECT_NEAR(factor, 1., 2e-6);
  by_arc -= by_newton;
  EXPECT_LT(largest(by_arc), 3e-6 * largest(by_newton)); // the arc's end is 1e-6 off
}

TEST(HangingNodes, AreNeitherPrescribedNorTied)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_refined_square(triangulation);
  const ElasticSolid solid(triangulation, {rock}, 1);
  DirichletValues values = prescribe_all_sides(solid, linear_field);
  for (const auto dof : solid.locally_owned())
    if (solid.hanging_nodes()->contains(dof))
      values[dof] = 0.;
  EXPECT_THROW(StaticSolver(solid, solid.stiffness(), values), std::invalid_argument);
  EXPECT_THROW(DofReduction(solid, values, {}), std::invalid_argument);
}

TEST(HangingNodes, LeaveMultigridAtWork)
{
  // Six levels of cells towards a corner: some 14 iterations in Q1 and 22 in Q2.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 8, 8);
  for (const double radius : {0.6, 0.4, 0.2, 0.1, 0.05})
    refine_where(triangulation, [&](const Point<2> &p)
                 { return p.distance(Point<2>(0., 0.)) < radius; });
  for (const unsigned int degree : {1u, 2u})
  {
    const ElasticSolid solid(triangulation, {rock}, degree);
    const auto sides = prescribe_all_sides(solid, linear_field);
    const auto force = body_force(solid,
                                  [](const Point<2> &) {
                                    return dealii::Tensor<1, 2>({1e6, -3e7});
                                  });
    auto u = solid.make_vector();
    auto options = options_of(StaticSolver::Method::conjugate_gradients);
    options.tolerance = 1e-10;
    const unsigned int iterations =
        StaticSolver(solid, solid.stiffness(), sides, options).solve(force, u);
    EXPECT_LT(iterations, 40u); // without a preconditioner some hundreds
    u -= solve_direct(solid, solid.stiffness(), sides, force);
    // Tolerance times the condition that multigrid leaves, of displacements up to 5e-3 m.
    EXPECT_LT(largest(u), 1e-8 * 5e-3);
  }
}
} // namespace hanging_nodes_tests

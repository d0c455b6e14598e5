// The tangent is the derivative of the forces, and Newton's method converges accordingly.
#include "continuum/foundation.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace tangent_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
struct Body
{
  const char *name;
  Law law;
  unsigned int degree;
  StrainForm form;
};

const std::vector<Body> &bodies()
{
  static const Law hooke = make_law<LinearElastic>(1., 0.3),
                   neo_hookean = make_law<NeoHookean>(1., 0.3);
  static const std::vector<Body> all{
      {"Hooke, Q1 with mean dilatation", hooke, 1, StrainForm::mean_dilatation},
      {"Hooke, Q2", hooke, 2, StrainForm::displacement},
      {"neo-Hooke, Q1", neo_hookean, 1, StrainForm::displacement},
      {"neo-Hooke, Q2", neo_hookean, 2, StrainForm::displacement}};
  return all;
}

/// Another direction than wavy_field()'s.
double direction_field(const Point<2> &p, const unsigned int c)
{
  return c == 0 ? std::cos(4. * p[1]) : std::sin(3. * p[0] - p[1]);
}

/// |(r(u + h d) - r(u - h d)) / 2h + K d| / |K d| at a large strain.
double tangent_error(LoadedSolid &problem, const double factor)
{
  NonlinearSolid &solid = problem.solid();
  const Vector u = wavy_field(solid, 0.08), d = interpolate(solid, direction_field);
  Matrix tangent = solid.make_matrix();
  problem.assemble(u, factor, 0., &tangent);
  auto Kd = solid.make_vector();
  tangent.vmult(Kd, d);

  // Central differences err by h^2 / 6 of the third derivative and by round-off over h.
  const double h = 1e-5;
  auto difference = solid.make_vector();
  for (const double side : {1., -1.})
  {
    auto moved = u;
    moved.add(side * h, d);
    moved.update_ghost_values();
    problem.assemble(moved, factor, 0., nullptr);
    difference.add(side / (2. * h), problem.residual());
  }
  difference += Kd;
  return difference.l2_norm() / Kd.l2_norm();
}
} // namespace

TEST(Tangent, IsTheDerivativeOfTheForces)
{
  for (const Body &body : bodies())
  {
    SCOPED_TRACE(body.name);
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 3);
    NonlinearSolid::Options options;
    options.degree = body.degree;
    options.strain_form = body.form;
    options.initial_stress = [](const Point<2> &p) {
      return PointStress{-0.02, -0.01 - 0.03 * p[1], -0.02, 0.01 * p[0]};
    };
    options.weight = [](const Point<2> &p) { return 0.5 + 0.4 * p[0]; };
    NonlinearSolid solid(triangulation, {body.law}, options);
    solid.add_springs(winkler_foundation(solid, {boundary::bottom}, 0.3));
    Loads growing;
    growing.pressures.emplace_back(solid, BoundaryIds{boundary::top, boundary::right},
                                   [](const Point<2> &p) { return 0.5 + 0.1 * p[0]; });
    LoadedSolid problem(solid, {}, growing);
    EXPECT_LT(tangent_error(problem, 0.), 1e-8);
    EXPECT_LT(tangent_error(problem, 0.7), 1e-8);
  }
}

TEST(Tangent, OfAPressureAllAroundIsSymmetric)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 3);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  const FollowerPressure around(solid, {0, 1, 2, 3}, 1.),
      on_top(solid, {boundary::top}, 1.);
  const auto asymmetry = [&](const FollowerPressure &pressure)
  {
    auto force = solid.make_vector();
    Matrix K = solid.make_matrix();
    pressure.add(wavy_field(solid, 0.08), 1., force, &K);
    K.compress(dealii::VectorOperation::add);
    const auto a = interpolate(solid, direction_field), b = wavy_field(solid, 1.);
    auto Ka = solid.make_vector(), Kb = solid.make_vector();
    K.vmult(Ka, a);
    K.vmult(Kb, b);
    return std::abs(b * Ka - a * Kb);
  };
  EXPECT_LT(asymmetry(around), 1e-13);
  EXPECT_GT(asymmetry(on_top), 1e-3);
}

TEST(Newton, ConvergesQuadratically)
{
  // A neo-Hookean block, its base held, is bent and squeezed by pressures that follow.
  for (const unsigned int degree : {1u, 2u})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 4);
    NonlinearSolid::Options body;
    body.degree = degree;
    NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)}, body);
    Loads growing;
    for (unsigned int c = 0; c < 2; ++c)
      prescribe(
          solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
          growing.displacements);
    growing.pressures.emplace_back(solid, BoundaryIds{boundary::left}, 0.08);
    growing.pressures.emplace_back(solid, BoundaryIds{boundary::top}, 0.1);
    LoadedSolid problem(solid, {}, growing);
    NewtonSolver::Options options;
    options.convergence.tolerance = 1e-13;
    NewtonSolver newton(problem, options);
    auto u = solid.make_vector();
    newton.advance(0., 1., 1, u);
    ASSERT_EQ(newton.steps().size(), 1u);
    EXPECT_GT(largest(u), 0.1);

    // |r_k+1| <= c |r_k|^2: the exponent from three residuals in a row, while they lie
    // between the first approach and round-off.
    const auto &r = newton.steps()[0].residuals;
    EXPECT_LE(r.size(), 8u);
    double best = 0.;
    for (std::size_t k = 0; k + 2 < r.size(); ++k)
      if (r[k] < 0.2 && r[k + 2] > 1e-13)
        best = std::max(best, std::log(r[k + 2] / r[k + 1]) / std::log(r[k + 1] / r[k]));
    EXPECT_GT(best, 1.7);
    for (std::size_t k = 0; k + 1 < r.size(); ++k)
      EXPECT_TRUE(r[k] > 1e-3 || r[k + 1] < std::max(1e-13, 20. * r[k] * r[k]));
  }
}

TEST(Newton, BothSolversFindTheSameState)
{
  const auto solve = [](const StaticSolver::Method method)
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 6);
    NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                         NonlinearSolid::Options());
    Loads growing;
    for (unsigned int c = 0; c < 2; ++c)
    {
      prescribe(
          solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
          growing.displacements);
      prescribe(
          solid, boundary::top, c, [=](const Point<2> &) { return 0.2 - 0.3 * c; },
          growing.displacements);
    }
    LoadedSolid problem(solid, {}, growing);
    NewtonSolver::Options options;
    options.method = method;
    NewtonSolver newton(problem, options);
    auto u = solid.make_vector();
    newton.advance(0., 1., 2, u);
    return u.l2_norm();
  };
  const double direct = solve(StaticSolver::Method::direct);
  EXPECT_GT(direct, 0.1);
  EXPECT_NEAR(solve(StaticSolver::Method::conjugate_gradients), direct, 1e-7 * direct);
}

TEST(Newton, RefusesConjugateGradientsWithPressuresThatFollow)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 2);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  Loads growing;
  growing.pressures.emplace_back(solid, BoundaryIds{boundary::top}, 1.);
  LoadedSolid problem(solid, {}, growing);
  NewtonSolver::Options options;
  options.method = StaticSolver::Method::conjugate_gradients;
  EXPECT_THROW(NewtonSolver(problem, options), std::invalid_argument);
}
} // namespace tangent_tests

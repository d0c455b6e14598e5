// The same body on one rank and on all of them.
#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace ranks_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
struct Result
{
  double energy, largest_displacement, stable_step, mass, stress_sum;
  unsigned int iterations;
};

/// A stiff wavy layer in a soft matrix on springs, under gravity and squeezed.
Result solve_on(const MPI_Comm communicator, const StaticSolver::Method method)
{
  const auto wave = [](const double height)
  { return [=](const double x) { return height + 2. * std::sin(x / 10.); }; };
  Strip base{[](double) { return -20.; }, wave(0.), even_rows(6), 1, false};
  Strip layer{wave(0.), wave(4.), even_rows(3), 0, true};
  Strip cover{wave(4.), [](double) { return 25.; }, even_rows(6), 1, true};
  Triangulation triangulation(communicator);
  make_section(triangulation, 0., 62.8, 24, {base, layer, cover});

  ElasticSolid solid(triangulation,
                     {ElasticMaterial::isotropic(50e9, 0.2, 2700.),
                      ElasticMaterial::isotropic(50e6, 0.25, 2300.)},
                     2, [](const Point<2> &p) { return 0.2 + 0.01 * p[0]; });
  solid.add_to_stiffness(winkler_foundation(solid, {boundary::bottom}, 1e6));
  DirichletValues values;
  prescribe(
      solid, boundary::left, 0, [](const Point<2> &) { return 0.01; }, values);
  prescribe(
      solid, boundary::right, 0, [](const Point<2> &) { return -0.01; }, values);
  StaticSolver::Options options;
  options.method = method;
  options.tolerance = 1e-12;
  auto u = solid.make_vector();
  const StaticSolver solver(solid, solid.stiffness(), values, options);
  Result result{};
  result.iterations = solver.solve(gravity(solid, dealii::Tensor<1, 2>({0., -9.81})), u);
  result.energy = solid.strain_energy(u);
  result.largest_displacement = largest(u);
  Vector inverse = solid.make_vector();
  for (unsigned int i = 0; i < inverse.locally_owned_size(); ++i)
    inverse.local_element(i) = 1. / solid.lumped_mass().local_element(i);
  result.stable_step = solid.stable_step(inverse);
  result.mass = solid.lumped_mass().l1_norm() / 2.;
  double sum = 0.;
  for (const auto &state : solid.cell_states(u))
    sum += state.area * state.weight * std::abs(state.stress[0]);
  result.stress_sum = dealii::Utilities::MPI::sum(sum, communicator);
  return result;
}

void expect_equal(const StaticSolver::Method method)
{
  const Result one = solve_on(MPI_COMM_SELF, method),
               all = solve_on(MPI_COMM_WORLD, method);
  // Tolerance of the solver times the contrast of 1e3, with a margin.
  EXPECT_NEAR(one.energy, all.energy, 1e-8 * one.energy);
  EXPECT_NEAR(one.largest_displacement, all.largest_displacement,
              1e-8 * one.largest_displacement);
  EXPECT_NEAR(one.stress_sum, all.stress_sum, 1e-8 * one.stress_sum);
  EXPECT_NEAR(one.stable_step, all.stable_step, 1e-12 * one.stable_step);
  EXPECT_NEAR(one.mass, all.mass, 1e-12 * one.mass);
  EXPECT_GT(one.energy, 0.);
}
} // namespace

TEST(Ranks, DoNotChangeTheResultOfConjugateGradients)
{
  expect_equal(StaticSolver::Method::conjugate_gradients);
}

TEST(Ranks, DoNotChangeTheResultOfTheDirectSolver)
{
  expect_equal(StaticSolver::Method::direct);
}

TEST(Ranks, BothSolversAgree)
{
  const Result cg = solve_on(MPI_COMM_WORLD, StaticSolver::Method::conjugate_gradients),
               direct = solve_on(MPI_COMM_WORLD, StaticSolver::Method::direct);
  EXPECT_NEAR(cg.energy, direct.energy, 1e-8 * direct.energy); // as above
  EXPECT_LT(cg.iterations,
            100u); // multigrid is at work: unpreconditioned takes thousands
}
} // namespace ranks_tests

#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace static_solver_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;
using antiform::NumericalError;

namespace
{
const auto rock = ElasticMaterial::isotropic(20e9, 0.25, 2500.);
const auto zero = [](const Point<2> &) { return 0.; };

/// A block 4 x 1 m held at its left side and pulled at its right one.
class Block
{
public:
  Block()
      : triangulation(MPI_COMM_WORLD)
      , solid(mesh(), {rock}, 1)
  {
    prescribe(solid, boundary::left, 0, zero, held);
    prescribe(solid, boundary::left, 1, zero, held);
    pull = pressure(solid, {boundary::right}, -1e6);
  }

private:
  Triangulation triangulation; // before the solid that is made on it
  const Triangulation &mesh()
  {
    make_rectangle(triangulation, 4., 1., 96, 24); // large enough for two levels
    return triangulation;
  }

public:
  ElasticSolid solid;
  DirichletValues held;
  Vector pull;
};

StaticSolver::Options with(const StaticSolver::Method method)
{
  StaticSolver::Options options;
  options.method = method;
  return options;
}

constexpr auto cg = StaticSolver::Method::conjugate_gradients;
constexpr auto direct = StaticSolver::Method::direct;
} // namespace

TEST(StaticSolver, LeavesTheLoadBalanced)
{
  const Block block;
  for (const auto method : {cg, direct})
  {
    auto residual = block.pull;
    const auto u =
        solve(block.solid, block.solid.stiffness(), block.held, block.pull, with(method));
    block.solid.add_internal_force(u, residual);
    double rest = 0.;
    for (const auto dof : block.solid.locally_owned())
      if (block.held.count(dof) == 0)
        rest = std::max(rest, std::abs(residual(dof)));
    EXPECT_LT(rest, 1e-10 * block.pull.l2_norm()); // the tolerance asked for
    EXPECT_GT(largest(u), 1e-4);                   // about 1e6 x 4 / 20e9
  }
}

TEST(StaticSolver, TakesNewValuesForTheSameDofs)
{
  const Block block;
  for (const auto method : {cg, direct})
  {
    DirichletValues values = block.held;
    prescribe(block.solid, boundary::right, 0, zero, values);
    StaticSolver solver(block.solid, block.solid.stiffness(), values, with(method));
    auto u = block.solid.make_vector();
    for (const double stretch : {1e-3, -2e-3})
    {
      prescribe(
          block.solid, boundary::right, 0, [&](const Point<2> &) { return stretch; },
          values);
      solver.set_values(values);
      solver.solve(block.solid.make_vector(), u);
      EXPECT_NEAR(largest(u), std::abs(stretch),
                  1e-15); // prescribed, largest at that end
    }
    EXPECT_THROW(solver.set_values(block.held), std::invalid_argument);
  }
}

TEST(StaticSolver, WarmStartAtTheSolutionNeedsNoIteration)
{
  const Block block;
  const StaticSolver solver(block.solid, block.solid.stiffness(), block.held,
                            StaticSolver::Options());
  auto u = block.solid.make_vector();
  const unsigned int cold = solver.solve(block.pull, u);
  EXPECT_GT(cold, 3u);
  EXPECT_LT(cold, 60u); // multigrid; plain conjugate gradients need some 400
  EXPECT_LE(solver.solve(block.pull, u), 1u);
}

TEST(StaticSolver, SaysThatItDidNotConverge)
{
  const Block block;
  auto options = with(cg);
  options.max_iterations = 3;
  EXPECT_THROW(
      solve(block.solid, block.solid.stiffness(), block.held, block.pull, options),
      NumericalError);
}

TEST(StaticSolver, RefusesABodyWithoutSupport)
{
  const Block block;
  // Nothing balances the pull.
  EXPECT_THROW(solve(block.solid, block.solid.stiffness(), {}, block.pull, with(direct)),
               NumericalError);
  EXPECT_THROW(solve(block.solid, block.solid.stiffness(), {}, block.pull, with(cg)),
               NumericalError);
}

TEST(NumericalError, NamesComponentStepValueAndLimit)
{
  const NumericalError error("matrix", "step too long", 2.5e-6, 2e-6, 41);
  EXPECT_STREQ(error.what(),
               "matrix, step 41: step too long (value 2.5e-06, limit 2e-06)");
}
} // namespace static_solver_tests

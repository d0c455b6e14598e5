// A base that pushes and does not pull: what it carries, and the tangent.
#include "continuum/unilateral_foundation.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace unilateral_foundation_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double length = 20., thickness = 1., base_stiffness = 1e8;
}

TEST(UnilateralFoundation, IsMetAtItsDistanceOrPressesFromTheStart)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, length, thickness, 4, 1);
  NonlinearSolid solid(triangulation, {make_law<StVenantKirchhoff>(1e10, 0.25)},
                       NonlinearSolid::Options());
  // Under the left half the base is 1 mm lower, the right half is pressed by 3 mm.
  UnilateralFoundation::Options options;
  options.gap = [](const Point<2> &p) { return p[0] < 0.5 * length ? 1e-3 : -3e-3; };
  UnilateralFoundation base(solid, {boundary::bottom}, base_stiffness, options);
  const auto force_at = [&](const double sinking)
  {
    return base
        .support(interpolate(solid, [=](const Point<2> &, const unsigned int c)
                             { return c == 1 ? -sinking : 0.; }))
        .force;
  };
  const double of_half = base_stiffness * 0.5 * length;
  EXPECT_NEAR(force_at(0.), 3e-3 * of_half, 1e-12 * of_half);
  EXPECT_NEAR(force_at(2e-3), (5e-3 + 1e-3) * of_half, 1e-12 * of_half);
  EXPECT_NEAR(force_at(-4e-3), 0., 0.);
  EXPECT_THROW(UnilateralFoundation(solid, {boundary::bottom}, 0.),
               std::invalid_argument);
}

TEST(UnilateralFoundation, TangentIsTheDerivativeOfTheForces)
{
  for (const unsigned int degree : {1u, 2u})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 4);
    NonlinearSolid::Options options;
    options.degree = degree;
    NonlinearSolid solid(triangulation, {make_law<StVenantKirchhoff>(1., 0.25)}, options);
    UnilateralFoundation base(solid, {boundary::bottom, boundary::right}, 3.);
    const auto u = wavy_field(solid, 0.08);
    const auto support = base.support(u);
    EXPECT_GT(support.touching, 0.3);
    EXPECT_GT(support.lifted, 0.3);

    const auto force_at = [&](const Vector &displacement, Matrix *tangent)
    {
      auto force = solid.make_vector();
      base.add(displacement, force, tangent);
      force.compress(dealii::VectorOperation::add);
      if (tangent)
        tangent->compress(dealii::VectorOperation::add);
      return force;
    };
    Matrix tangent = solid.make_matrix();
    force_at(u, &tangent);
    const auto d = interpolate(
        solid, [](const Point<2> &p, const unsigned int c)
        { return c == 0 ? std::cos(4. * p[1]) : std::sin(3. * p[0] - p[1]); });
    auto Kd = solid.make_vector();
    tangent.vmult(Kd, d);
    // Forces are linear but where a point lifts; no point is so near to that.
    const double h = 1e-6;
    auto difference = solid.make_vector();
    for (const double side : {1., -1.})
    {
      auto moved = u;
      moved.add(side * h, d);
      moved.update_ghost_values();
      difference.add(side / (2. * h), force_at(moved, nullptr));
    }
    difference.add(-1., Kd);
    EXPECT_GT(Kd.l2_norm(), 0.1);
    EXPECT_LT(difference.l2_norm(), 1e-9 * Kd.l2_norm()); // round-off over h
  }
}
} // namespace unilateral_foundation_tests

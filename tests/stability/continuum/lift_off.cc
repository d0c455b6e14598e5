// A strip that lies on a base which does not pull, is lifted and pressed and put down.
#include "continuum/newton_solver.h"
#include "continuum/unilateral_foundation.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace antiform;
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double length = 20., thickness = 1., weight = 2e4; // [m], [m], [N/m^3]
constexpr double base_stiffness = 1e8;
constexpr double total = weight * length * thickness;

/// A strip whose weight is constant and whose right end a force lifts, load factor times
/// the weight.
struct RestingStrip
{
  explicit RestingStrip(const MPI_Comm communicator = MPI_COMM_WORLD)
      : triangulation(communicator)
  {
    make_rectangle(triangulation, length, thickness, 20, 1);
    solid = std::make_unique<NonlinearSolid>(
        triangulation, std::vector<Law>{make_law<StVenantKirchhoff>(1e10, 0.)},
        NonlinearSolid::Options());
    base = std::make_shared<UnilateralFoundation>(*solid, BoundaryIds{boundary::bottom},
                                                  base_stiffness);
    solid->add(base);
    Loads constant, growing;
    constant.dead = body_force(*solid,
                               [](const Point<2> &) {
                                 return dealii::Tensor<1, 2>({0., -weight});
                               });
    hold_node(*solid, {0., 0.}, 0, constant.displacements);
    growing.dead =
        boundary_traction(*solid, {boundary::right},
                          [](const Point<2> &, const auto &) {
                            return dealii::Tensor<1, 2>({0., total / thickness});
                          });
    body = std::make_unique<LoadedSolid>(*solid, constant, growing);
    NewtonSolver::Options options;
    options.convergence.tolerance = 1e-10;
    newton = std::make_unique<NewtonSolver>(*body, options);
    u = solid->make_vector();
    newton->solve(0., 0., u);
  }

  Triangulation triangulation;
  std::unique_ptr<NonlinearSolid> solid;
  std::shared_ptr<UnilateralFoundation> base;
  std::unique_ptr<LoadedSolid> body;
  std::unique_ptr<NewtonSolver> newton;
  Vector u;
};
} // namespace

TEST(LiftOff, StripThatIsLiftedAndPressedLiesAgainAsItLay)
{
  RestingStrip strip;
  const Vector before = strip.u;
  // By its own weight, at a Poisson's ratio of 0, it sinks in evenly.
  EXPECT_NEAR(at_node(*strip.solid, before, {length, -0.5 * thickness}, 1),
              -weight * thickness / base_stiffness, 1e-8 * weight / base_stiffness);
  EXPECT_EQ(strip.base->support(before).lifted, 0.);

  double factor = 0.;
  for (const double next : {0.3, -3., 0.4, 0.})
  {
    strip.newton->advance(factor, next, 2, strip.u);
    factor = next;
    const auto support = strip.base->support(strip.u);
    // What the base bears is the weight less the lift.
    EXPECT_NEAR(support.force, (1. - factor) * total, 1e-8 * total) << factor;
    EXPECT_NEAR(support.lifted + support.touching, length, 1e-9 * length);
    if (factor > 0.)
    {
      EXPECT_GT(support.lifted, factor * length);
      EXPECT_GT(at_node(*strip.solid, strip.u, {length, -0.5 * thickness}, 1), 0.);
    }
    else
    {
      EXPECT_EQ(support.lifted > 0., factor < 0.); // the far end rises under a press
    }
  }
  auto change = strip.u;
  change -= before;
  EXPECT_LT(largest(change), 1e-8 * largest(before));
}

TEST(LiftOff, ForceBeyondHalfTheWeightIsRefusedAndTheStripStaysAsItWas)
{
  // It turns about its far edge: no equilibrium but upright, out of reach.
  RestingStrip strip;
  strip.newton->advance(0., 0.3, 2, strip.u);
  const Vector before = strip.u;
  EXPECT_THROW(strip.newton->solve(0.6, 0., strip.u), NumericalError);
  auto change = strip.u;
  change -= before;
  EXPECT_EQ(change.l2_norm(), 0.);
}

TEST(LiftOff, RanksDoNotChangeTheResult)
{
  RestingStrip one(MPI_COMM_SELF), all;
  for (RestingStrip *strip : {&one, &all})
    strip->newton->advance(0., 0.4, 2, strip->u);
  EXPECT_NEAR(all.u.l2_norm(), one.u.l2_norm(), 1e-8 * one.u.l2_norm());
  const auto a = all.base->support(all.u), b = one.base->support(one.u);
  EXPECT_NEAR(a.force, b.force, 1e-8 * b.force);
  EXPECT_NEAR(a.lifted, b.lifted, 1e-12 * length);
  EXPECT_NEAR(a.greatest_depth, b.greatest_depth, 1e-8 * b.greatest_depth);
}

TEST(LiftOff, BaseAtADistanceIsMetAndOneInTouchMayPressFromTheStart)
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

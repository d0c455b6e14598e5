// A strip that lies on a base which does not pull, or on another one, is lifted and
// pressed and put down.
#include "continuum/unilateral_foundation.h"
#include "support/two_strips.h"

#include <gtest/gtest.h>

namespace lift_off_tests
{
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

TEST(LiftOff, StripLiftedFromAnotherOneLiesAgainAsItLay)
{
  TwoStrips form;
  form.length = length;
  form.height = thickness;
  form.n_columns = 20;
  form.n_rows = 1;
  form.degree = 2;
  form.law = make_law<StVenantKirchhoff>(1e10, 0.25);
  const ContactSide side{LameConstants::from_young_poisson(1e10, 0.25), thickness};
  TwoStripBody body(form, FrictionlessContact{contact_stiffness(side, side).normal});
  NonlinearSolid &solid = body.solid();
  Loads constant, growing;
  constant.dead =
      body_force(solid,
                 [](const Point<2> &p) {
                   return dealii::Tensor<1, 2>({0., p[1] > 0. ? -weight : 0.});
                 });
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
        constant.displacements);
  hold_node(solid, {0., thickness}, 0, constant.displacements);
  growing.dead = boundary_traction(
      solid, {boundary::right},
      [](const Point<2> &p, const auto &) {
        return dealii::Tensor<1, 2>({0., p[1] > 0. ? total / thickness : 0.});
      });
  LoadedSolid loaded(solid, constant, growing);
  NewtonSolver::Options options;
  options.convergence.tolerance = 1e-10;
  NewtonSolver newton(loaded, options);
  auto u = solid.make_vector();
  newton.solve(0., 0., u);
  const Vector before = u;

  double factor = 0.;
  for (const double next : {0.3, -1., 0.})
  {
    newton.advance(factor, next, 4, u);
    factor = next;
    double carried = 0., open = 0.;
    for (const auto &state : body.contact().point_states(u))
    {
      carried -= state.traction.normal * state.normal[1] * state.length;
      open += state.phase == ContactPhase::open ? state.length : 0.;
    }
    carried = dealii::Utilities::MPI::sum(carried, MPI_COMM_WORLD);
    open = dealii::Utilities::MPI::sum(open, MPI_COMM_WORLD);
    EXPECT_NEAR(carried, (1. - factor) * total, 1e-8 * total); // Newton's tolerance
    if (factor > 0.)
    {
      EXPECT_GT(open, factor * length);
    }
  }
  auto change = u;
  change -= before;
  EXPECT_LT(largest(change), 1e-8 * largest(before));
}
} // namespace lift_off_tests

// What the nonlinear solution must survive, or refuse with a word on what to do.
#include "continuum/arc_length.h"
#include "continuum/arch_theory.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace nonlinear_hard_cases_tests
{
using namespace antiform;
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// The text of the error that @p action throws; empty if it throws none.
template <class Error, class Action>
std::string refusal(const Action &action)
{
  try
  {
    action();
  }
  catch (const Error &problem)
  {
    return problem.what();
  }
  return {};
}

void expect_mentions(const std::string &text, const std::string &words)
{
  EXPECT_NE(text.find(words), std::string::npos) << "'" << text << "' lacks " << words;
}

/// A shallow sine arch of e0 = 3 between pins whose load factor counts D k^4 r.
struct Arch
{
  static constexpr double length = 200., e0 = 3.;
  const double radius = 1. / std::sqrt(12.);
  PinnedStrip strip{make_law<StVenantKirchhoff>(1e4, 0.),
                    make_law<StVenantKirchhoff>(1e6, 0.),
                    length,
                    1.,
                    32,
                    e0 *radius};
  Loads pins, load;

  Arch()
  {
    for (const double x : {0., length})
      for (unsigned int c = 0; c < 2; ++c)
        strip.hold_pin(x, c, pins.displacements);
    const double unit = theory::snap_load_unit({1e4, 0., 1.}, length);
    load.dead = strip.load_across([=](const double x)
                                  { return unit * std::sin(M_PI * x / length); });
  }
  double rise(const Vector &u) const
  {
    return e0 + strip.at_axis(u, 0.5 * length, 1) / radius;
  }
};

/// A square whose base is held while its top moves by @p shift (over its height), in one
/// step if that can be. Returns the number of steps.
std::size_t shear_square(NonlinearSolid &solid,
                         const std::array<double, 2> &shift,
                         const NewtonSolver::Options &options,
                         Vector &u)
{
  Loads growing;
  for (unsigned int c = 0; c < 2; ++c)
  {
    prescribe(
        solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
    prescribe(
        solid, boundary::top, c, [&](const Point<2> &) { return shift[c]; },
        growing.displacements);
  }
  LoadedSolid body(solid, {}, growing);
  NewtonSolver newton(body, options);
  newton.advance(0., 1., 1, u);
  return newton.steps().size();
}
} // namespace

TEST(HardContinuum, ArchIsFollowedFromItsRiseToItsMirrorImage)
{
  // Down to e = -3: past both limit points, where the load factor falls and even turns.
  Arch arch;
  LoadedSolid body(arch.strip.solid(), arch.pins, arch.load);
  ArcLength::Options options;
  options.first_length = 0.02;
  ArcLength path(body, options);
  auto u = arch.strip.solid().make_vector();
  double factor = 0.;
  const auto rise = [&](const Vector &v, double) { return arch.rise(v); };
  for (const double target : {2., 1., 0., -1., -2., -3.})
  {
    path.follow(u, factor, rise, target);
    EXPECT_NEAR(arch.rise(u), target, 1e-5);
    // Mesh and slope make 5e-3.
    EXPECT_NEAR(factor, theory::shallow_arch_load(Arch::e0, target), 0.03);
  }
  double highest = 0., lowest = 1e300;
  for (const auto &point : path.path())
  {
    if (point.measure > 0.)
      highest = std::max(highest, point.factor);
    else
      lowest = std::min(lowest, point.factor);
  }
  EXPECT_NEAR(highest, 4.0758, 0.05); // the nearest point of the path
  EXPECT_NEAR(lowest, 1.9242, 0.05);  // e0 - e_c^3 / 2
}

TEST(HardContinuum, LoadBeyondALimitPointIsReachedOnlyAfterASnap)
{
  // Under a growing load equilibrium jumps from the upper branch to the lower one, which
  // Newton's method may or may not find; what it says it found is one.
  Arch arch;
  LoadedSolid body(arch.strip.solid(), arch.pins, arch.load);
  NewtonSolver newton(body, NewtonSolver::Options());
  auto u = arch.strip.solid().make_vector();
  newton.advance(0., 4., 20, u);
  EXPECT_GT(arch.rise(u), 1.29);
  const std::string text =
      refusal<NumericalError>([&] { newton.advance(4., 4.2, 1, u); });
  if (text.empty())
    EXPECT_LT(arch.rise(u), -2.);
  else
  {
    expect_mentions(text, "load steps get too small");
    EXPECT_GT(arch.rise(u), 1.29); // the last good state
  }
}

TEST(HardContinuum, PathThatNeverMeetsItsTargetEndsWithAWord)
{
  Arch arch;
  LoadedSolid body(arch.strip.solid(), arch.pins, arch.load);
  ArcLength::Options options;
  options.first_length = 0.02;
  options.max_steps = 20;
  ArcLength path(body, options);
  auto u = arch.strip.solid().make_vector();
  double factor = 0.;
  // The load pushes down: it never rises.
  expect_mentions(refusal<NumericalError>(
                      [&]
                      {
                        path.follow(
                            u, factor,
                            [&](const Vector &v, double) { return arch.rise(v); }, 4.);
                      }),
                  "never get there");
  options.first_length = 0.;
  EXPECT_THROW(ArcLength(body, options), std::invalid_argument);
}

TEST(HardContinuum, InvertedCellIsRefused)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 4, 4);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  // Mirrored: det C = J^2 alone would not tell.
  const auto mirrored = interpolate(solid, [](const Point<2> &p, const unsigned int c)
                                    { return c == 0 ? -2. * p[0] : 0.; });
  auto force = solid.make_vector();
  const std::string text =
      refusal<NumericalError>([&] { solid.assemble(mirrored, 0., force, nullptr); });
  expect_mentions(text, "turned inside out at (");
  expect_mentions(text, "take smaller load steps");
  expect_mentions(text, "value -1");
}

TEST(HardContinuum, InvertedCellOnOneRankIsRefusedOnAll)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 8, 8);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  // Only one corner folds over.
  const auto folded =
      interpolate(solid, [](const Point<2> &p, const unsigned int c)
                  { return c == 0 && p[0] > 0.99 && p[1] > 0.49 ? -0.4 : 0.; });
  auto force = solid.make_vector();
  EXPECT_THROW(solid.assemble(folded, 0., force, nullptr), NumericalError);
}

TEST(HardContinuum, MeshWithAnInvertedCellIsRefused)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 4, 4);
  dealii::GridTools::transform(
      [](const Point<2> &p)
      { return p.distance(Point<2>(0.5, 0.)) < 0.1 ? Point<2>(0.95, 0.4) : p; },
      triangulation);
  expect_mentions(refusal<std::invalid_argument>(
                      [&]
                      {
                        NonlinearSolid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                                       NonlinearSolid::Options());
                      }),
                  "make its faces smoother");
}

TEST(HardContinuum, StepThatTurnsCellsInsideOutIsCutBack)
{
  // The top goes by two heights to the side and by 0.4 down.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 4);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  auto u = solid.make_vector();
  EXPECT_GT(shear_square(solid, {2., -0.4}, NewtonSolver::Options(), u), 1u);
  for (const auto &state : solid.point_states(u))
    EXPECT_GT(state.volume_ratio, 0.);

  // To a height below 0 no step is small enough.
  auto v = solid.make_vector();
  const std::string text = refusal<NumericalError>(
      [&] {
        shear_square(solid, {0., -1.5}, NewtonSolver::Options(), v);
      });
  expect_mentions(text, "load steps get too small");
  expect_mentions(text, "last problem");
}

TEST(HardContinuum, NearlyIncompressibleSquareTakesLargeShear)
{
  for (const unsigned int n_cells : {4u, 8u})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, n_cells);
    NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.4999)},
                         NonlinearSolid::Options());
    auto u = solid.make_vector();
    shear_square(solid, {0.8, 0.}, NewtonSolver::Options(), u);
    double area = 0., new_area = 0.;
    for (const auto &state : solid.point_states(u))
    {
      area += state.area;
      new_area += state.area * state.volume_ratio;
    }
    area = dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD);
    new_area = dealii::Utilities::MPI::sum(new_area, MPI_COMM_WORLD);
    EXPECT_NEAR(new_area, area, 1e-3 * area); // free sides: mean stress some 0.1 of E
  }
}

TEST(HardContinuum, LooseBodyIsRefused)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 2, 2);
  NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                       NonlinearSolid::Options());
  Loads growing;
  growing.dead = pressure(solid, {boundary::top}, 0.1);
  LoadedSolid body(solid, {}, growing);
  NewtonSolver newton(body, NewtonSolver::Options());
  auto u = solid.make_vector();
  expect_mentions(refusal<NumericalError>([&] { newton.advance(0., 1., 1, u); }),
                  "without support");
}

TEST(HardContinuum, RanksDoNotChangeTheResult)
{
  const auto solve = [](const MPI_Comm communicator)
  {
    Triangulation triangulation(communicator);
    make_distorted_square(triangulation, 6);
    NonlinearSolid solid(triangulation, {make_law<NeoHookean>(1., 0.3)},
                         NonlinearSolid::Options());
    Loads growing;
    for (unsigned int c = 0; c < 2; ++c)
      prescribe(
          solid, boundary::bottom, c, [](const Point<2> &) { return 0.; },
          growing.displacements);
    growing.pressures.emplace_back(solid, BoundaryIds{boundary::left, boundary::top},
                                   0.1);
    LoadedSolid body(solid, {}, growing);
    NewtonSolver newton(body, NewtonSolver::Options());
    auto u = solid.make_vector();
    newton.advance(0., 1., 2, u);
    return std::array<double, 3>{u.l2_norm(), body.reactions().l2_norm(),
                                 newton.steps()[1].residuals[2]};
  };
  const auto one = solve(MPI_COMM_SELF), all = solve(MPI_COMM_WORLD);
  EXPECT_NEAR(all[0], one[0], 1e-10 * one[0]);
  EXPECT_NEAR(all[1], one[1], 1e-10 * one[1]);
  EXPECT_NEAR(all[2], one[2], 1e-8 * one[2] + 1e-14);
}
} // namespace nonlinear_hard_cases_tests

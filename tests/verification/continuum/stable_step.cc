// The step of the explicit scheme: closed form, bound, and what happens beside it.
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace stable_step_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double poisson = 0.25, density = 2500.;
const auto rock = ElasticMaterial::isotropic(20e9, poisson, density);

Vector inverse_of(const Vector &mass)
{
  Vector inverse = mass;
  for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
    inverse.local_element(i) = 1. / mass.local_element(i);
  inverse.update_ghost_values();
  return inverse;
}

/// Deterministic start that is not orthogonal to any mode of a small mesh.
Vector irregular(const ElasticSolid &solid)
{
  return interpolate(solid,
                     [](const Point<2> &p, const unsigned int c) {
                       return std::sin(40. * p[0] + 7. * c) + std::cos(33. * p[1] - p[0]);
                     });
}

/// 2 / omega of the fastest mode by power iteration on M^-1 K: never below the true
/// limit, since the Rayleigh quotient never exceeds the largest eigenvalue.
double limit_by_power_iteration(const ElasticSolid &solid, const unsigned int iterations)
{
  const Vector inverse = inverse_of(solid.lumped_mass());
  Vector u = irregular(solid);
  double squared_frequency = 0.;
  for (unsigned int i = 0; i < iterations; ++i)
  {
    Vector momentum = u; // M u
    momentum.scale(solid.lumped_mass());
    Vector next = solid.make_vector();
    solid.add_internal_force(u, next);
    next *= -1.;
    squared_frequency = (u * next) / (u * momentum);
    next.scale(inverse);
    next /= next.l2_norm();
    next.update_ghost_values();
    u = next;
  }
  return 2. / std::sqrt(squared_frequency);
}

/// Largest displacement within @p n_steps of an undamped leapfrog, over the initial one.
double growth(const ElasticSolid &solid, const double step, const unsigned int n_steps)
{
  const Vector inverse = inverse_of(solid.lumped_mass());
  Vector u = irregular(solid), velocity = solid.make_vector();
  const double start = largest(u);
  double most = 0.;
  for (unsigned int i = 0; i < n_steps; ++i)
  {
    Vector force = solid.make_vector();
    solid.add_internal_force(u, force);
    force.scale(inverse);
    u.zero_out_ghost_values();
    velocity.add(step, force);
    u.add(step, velocity);
    u.update_ghost_values();
    most = std::max(most, largest(u));
    if (most > 1e6 * start)
      break;
  }
  return most / start;
}

double square_step(const double side)
{
  const double wave_speed = std::sqrt(rock.stiffness[0][0] / density);
  return side / wave_speed * std::sqrt(1. - poisson);
}
} // namespace

TEST(StableStep, OfOneSquareIsSideOverWaveSpeedTimesRootOfOneLessPoisson)
{
  const double side = 0.4;
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, side, side, 1, 1);
  ElasticSolid solid(triangulation, {rock}, 1);
  // The next lower squared frequency is 0.75 of the largest: 0.75^(2 x 200) is round-off.
  EXPECT_NEAR(limit_by_power_iteration(solid, 200), square_step(side),
              1e-10 * square_step(side));
}

TEST(StableStep, LeapfrogIsBoundedJustBelowAndDivergesJustAbove)
{
  const double side = 0.4;
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, side, side, 1, 1);
  ElasticSolid solid(triangulation, {rock}, 1);
  // At 0.999 of the limit the amplitude of the fastest mode is that of the start over
  // sqrt(1 - 0.999^2), 22 times; above it grows by 2 sqrt(2 x 0.001), 9 % a step. The
  // free rigid motions carry no velocity here.
  EXPECT_LT(growth(solid, 0.999 * square_step(side), 10000), 50.);
  EXPECT_GT(growth(solid, 1.001 * square_step(side), 1000), 1e6);
}

TEST(StableStep, BoundNeverExceedsTheTrueLimit)
{
  const auto weight = [](const Point<2> &p)
  { return 1e-3 + (p[0] > 0.5 ? 1. : p[1] + 0.1); };
  for (const unsigned int degree : {1, 2})
    for (const bool weighted : {false, true})
    {
      Triangulation triangulation(MPI_COMM_WORLD);
      make_distorted_square(triangulation, 6);
      ElasticSolid solid(triangulation, {rock}, degree,
                         weighted ? std::function<double(const Point<2> &)>(weight)
                                  : nullptr);
      const double bound = solid.stable_step(inverse_of(solid.lumped_mass()));
      const double limit = limit_by_power_iteration(solid, 3000);
      EXPECT_LE(bound, limit) << "degree " << degree << ", weighted " << weighted;
      // Gershgorin's circles are within a factor of two of these spectra; a bound that
      // fell far below would be correct and useless.
      EXPECT_GT(bound, 0.5 * limit) << "degree " << degree << ", weighted " << weighted;
    }
}

TEST(StableStep, LeapfrogIsBoundedAtTheBound)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 5);
    ElasticSolid solid(triangulation, {rock}, degree);
    const double bound = solid.stable_step(inverse_of(solid.lumped_mass()));
    // 1/sqrt(1 - (bound/limit)^2) for the fastest mode, superposed over the modes.
    EXPECT_LT(growth(solid, bound, 5000), 50.) << "degree " << degree;
  }
}

TEST(StableStep, LeavesOutNodesThatAreHeld)
{
  // A thin row below a high one: with its nodes held the high row alone sets the step.
  Triangulation triangulation(MPI_COMM_WORLD);
  const Strip strip{
      [](double) { return 0.; }, [](double) { return 1.; }, {0., 0.1, 1.}, 0, false};
  make_section(triangulation, 0., 4., 4, {strip});
  ElasticSolid solid(triangulation, {rock}, 1);
  Vector inverse = inverse_of(solid.lumped_mass());
  const double free = solid.stable_step(inverse);
  for (const auto dof : solid.locally_owned())
    if (solid.support_point(dof)[1] < 0.5)
      inverse(dof) = 0.;
  EXPECT_GT(solid.stable_step(inverse), 2. * free);
  inverse = 0.;
  EXPECT_TRUE(std::isinf(solid.stable_step(inverse)));
}
} // namespace stable_step_tests

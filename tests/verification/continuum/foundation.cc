#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

using namespace antiform::continuum;
using namespace antiform::testing;

TEST(Foundation, StripSettlesByLoadOverStiffness)
{
  const double stiffness = 4e6, load = 2e5; // [Pa/m], [Pa]
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 20., 2., 10, 3);
    ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(20e9, 0.2, 2500.)},
                       degree);
    solid.add_to_stiffness(winkler_foundation(solid, {boundary::bottom}, stiffness));
    DirichletValues values;
    hold_node(solid, Point<2>(0., -1.), 0, values);
    const auto u = solve_direct(solid, solid.stiffness(), values,
                                pressure(solid, {boundary::top}, load));
    // Uniform stress solves the problem; the rest is round-off times a condition of 1e5.
    for (const auto dof : solid.locally_owned())
    {
      if (solid.component(dof) != 1 || solid.support_point(dof)[1] > -1. + 1e-9)
        continue;
      EXPECT_NEAR(u(dof), -load / stiffness, 1e-10 * load / stiffness);
    }
    // Energy of the springs and of the strip compressed by load h / E'.
    const double springs = 0.5 * load * load / stiffness * 20.;
    const double strip = 0.5 * load * load / (20e9 / (1. - 0.04)) * 2. * 20.;
    EXPECT_NEAR(solid.strain_energy(u), springs + strip, 1e-10 * springs);
  }
}

TEST(Foundation, CarriesNoShear)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 20., 2., 10, 3);
  ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(20e9, 0.2, 2500.)}, 2);
  const auto springs = winkler_foundation(solid, {boundary::bottom}, 4e6);
  const auto slide = interpolate(solid, [](const Point<2> &, const unsigned int c)
                                 { return c == 0 ? 1. : 0.; });
  const auto lift = interpolate(solid, [](const Point<2> &, const unsigned int c)
                                { return c == 1 ? 1. : 0.; });
  Vector force = solid.make_vector();
  springs.vmult(force, slide);
  EXPECT_EQ(largest(force), 0.);
  springs.vmult(force, lift);
  EXPECT_NEAR(force * lift, 4e6 * 20., 1e-12 * 4e6 * 20.); // k_n times length: round-off
}

TEST(Foundation, RefusesANegativeStiffness)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 2, 2);
  ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(1., 0.2, 1.)}, 1);
  EXPECT_THROW(winkler_foundation(solid, {boundary::bottom}, -1.), std::invalid_argument);
}

#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace foundation_tests
{
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

namespace
{
/// Twice the energy of a shear layer under a displacement: u . P u [J].
double twice_energy(const ElasticSolid &solid,
                    const double shear_stiffness,
                    const std::function<double(const Point<2> &, unsigned int)> &field)
{
  const auto layer = pasternak_foundation(solid, {boundary::top}, shear_stiffness);
  const auto u = interpolate(solid, field);
  Vector force = solid.make_vector();
  layer.vmult(force, u);
  return force * u;
}

/// A body below a curved face y(x) over 0 < x < 1 in @p n columns.
void make_hill(Triangulation &triangulation,
               const std::function<double(double)> &y,
               const unsigned int n)
{
  make_section(triangulation, 0., 1., n,
               {{[](double) { return -1.; }, y, even_rows(2), 0, false}});
}
} // namespace

TEST(ShearLayer, EnergyIsThatOfTheSlope)
{
  // w = x^2 on a flat face of length L: integral of (2 x)^2 = 4 L^3 / 3, and Q2 holds it.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 3., 1., 5, 2);
  const ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(1., 0.2, 1.)}, 2);
  const double energy =
      twice_energy(solid, 7., [](const Point<2> &p, const unsigned int c)
                   { return (c == 0 ? 2. : 1.) * p[0] * p[0]; });
  EXPECT_NEAR(energy, 7. * 4. * 27. / 3., 1e-12 * 252.); // round-off
}

TEST(ShearLayer, OfACurvedFaceStrainsByItsTurningAlone)
{
  const auto hill = [](const double x) { return 0.3 * std::sin(M_PI * x); };
  for (const unsigned int degree : {1, 2})
  {
    const unsigned int n = 12;
    Triangulation triangulation(MPI_COMM_WORLD);
    make_hill(triangulation, hill, n);
    const ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(1., 0.2, 1.)},
                             degree);
    double length = 0.; // of the face as meshed, straight from node to node
    for (unsigned int i = 0; i < n; ++i)
      length += std::hypot(1. / n, hill((i + 1.) / n) - hill(1. * i / n));
    const double shear_stiffness = 5e3, turn = 1e-3;
    const double scale = shear_stiffness * turn * turn * length;
    const double turned =
        twice_energy(solid, shear_stiffness, [&](const Point<2> &p, const unsigned int c)
                     { return turn * (c == 0 ? -p[1] : p[0]); });
    EXPECT_NEAR(turned, scale, 1e-11 * scale); // n . du/ds = turn wherever: round-off
    const double moved =
        twice_energy(solid, shear_stiffness, [&](const Point<2> &, const unsigned int c)
                     { return turn * (c == 0 ? 1. : 2.); });
    EXPECT_NEAR(moved, 0., 1e-11 * scale);
  }
}

TEST(ShearLayer, OfACircleConvergesAtSecondOrder)
{
  // Arc of radius R under u = a s n (s along it): n . du/ds = a, t . du/ds = a s / R. The
  // energy is that of a flat face of the same length, G_p a^2 per length.
  const double radius = 1., slope = 1e-2;
  const auto arc = [&](const double x)
  { return std::sqrt(radius * radius - (x - 0.5) * (x - 0.5)); };
  const double length = radius * 2. * std::asin(0.5 / radius);
  std::vector<double> errors;
  for (const unsigned int n : {8, 16, 32})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_hill(triangulation, arc, n);
    const ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(1., 0.2, 1.)}, 1);
    const double energy =
        twice_energy(solid, 1., [&](const Point<2> &p, const unsigned int c)
                     {
                       const double turn = std::asin((p[0] - 0.5) / radius);
                       return slope * radius * turn *
                              (c == 0 ? std::sin(turn) : std::cos(turn));
                     });
    errors.push_back(energy / (slope * slope * length) - 1.);
  }
  // The chord is shorter than the arc by (s / R)^2 / 24.
  EXPECT_LT(std::abs(errors[2]), 1e-3);
  for (const unsigned int k : {1u, 2u})
    EXPECT_NEAR(std::log2(errors[k - 1] / errors[k]), 2., 0.1);
}

TEST(ShearLayer, RefusesANegativeStiffness)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 2, 2);
  const ElasticSolid solid(triangulation, {ElasticMaterial::isotropic(1., 0.2, 1.)}, 1);
  EXPECT_THROW(pasternak_foundation(solid, {boundary::bottom}, -1.),
               std::invalid_argument);
}
} // namespace foundation_tests

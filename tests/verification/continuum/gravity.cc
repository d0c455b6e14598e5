// Lithostatic state and settlement of a column under its weight.
#include "continuum/layer_theory.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace gravity_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double young = 5e9, poisson = 0.3, density = 2400., g = 9.81, height = 100.;
const auto rock = ElasticMaterial::isotropic(young, poisson, density);
const dealii::Tensor<1, 2> down({0., -g});

/// Vertical stress by depth, horizontal one in proportion, no shear [Pa].
dealii::SymmetricTensor<2, 2> lithostatic(const Point<2> &p)
{
  dealii::SymmetricTensor<2, 2> stress;
  stress[1][1] = -density * g * (height / 2. - p[1]);
  stress[0][0] = 0.6 * stress[1][1];
  return stress;
}
} // namespace

TEST(Gravity, IsBalancedByLithostaticPrestress)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 60., height, 6, 9);
    // Slanted cells, sides kept straight so that the top stays free of traction.
    dealii::GridTools::transform(
        [](const Point<2> &p)
        {
          return Point<2>(p[0] + 2. * std::sin(0.05 * p[0] * M_PI / 3.) * std::sin(p[1]),
                          p[1]);
        },
        triangulation);
    ElasticSolid solid(triangulation, {rock}, degree);
    const Vector weight = gravity(solid, down);
    Vector residual = prestress(solid, lithostatic);
    residual += weight;
    residual += boundary_traction(
        solid, {boundary::left, boundary::right, boundary::bottom},
        [](const Point<2> &p, const auto &normal) { return lithostatic(p) * normal; });
    // All integrands are polynomials that the Gauss points integrate exactly.
    const double total = density * g * height * 60.;
    EXPECT_LT(largest(residual), 1e-10 * total) << "degree " << degree;
    EXPECT_GT(largest(weight), 1e-3 * total); // there was something to balance
  }
}

TEST(Gravity, UniformPrestressIsBalancedByItsTractions)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 5);
  ElasticSolid solid(triangulation, {rock}, 2);
  dealii::SymmetricTensor<2, 2> stress;
  stress[0][0] = -20e6;
  stress[1][1] = -12e6;
  stress[0][1] = 3e6;
  Vector residual = prestress(solid, stress);
  residual += boundary_traction(solid, {0, 1, 2, 3},
                                [&](const Point<2> &, const auto &normal)
                                { return stress * normal; });
  EXPECT_LT(largest(residual), 1e-12 * 20e6); // round-off; the square has side 1 m
}

TEST(Gravity, ColumnSettlesByHalfItsWeightOverTheOedometerModulus)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 10., height, 2, 20);
    ElasticSolid solid(triangulation, {rock}, degree);
    DirichletValues values;
    const auto zero = [](const Point<2> &) { return 0.; };
    prescribe(solid, boundary::left, 0, zero, values);
    prescribe(solid, boundary::right, 0, zero, values);
    prescribe(solid, boundary::bottom, 1, zero, values);
    const auto u = solve(solid, solid.stiffness(), values, gravity(solid, down), {});
    // Elements in one dimension are exact at their nodes: only the solver's tolerance.
    const double expected =
        density * g * height * height / (2. * theory::oedometer_modulus(young, poisson));
    EXPECT_NEAR(largest(u), expected, 1e-6 * expected) << "degree " << degree;
  }
}
} // namespace gravity_tests

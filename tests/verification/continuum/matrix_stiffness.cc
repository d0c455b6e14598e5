// Case 42: stiffness of a matrix layer under a wave of its smooth face, by half a wave.
#include "continuum/layer_theory.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace matrix_stiffness_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;
using FarFace = theory::Side::FarFace;

namespace
{
constexpr double young_modulus = 1., wavenumber = 1.;

/// K(k) of a layer of thickness chi / k from the energy of half a wave: the lower face
/// moves into it by cos k x without shear, so that the energy is K V^2 L / 4.
double stiffness(const double chi,
                 const double poisson_ratio,
                 const FarFace far_face,
                 const unsigned int n_columns)
{
  const double length = M_PI / wavenumber, height = chi / wavenumber;
  Strip strip;
  strip.lower = [](double) { return 0.; };
  strip.upper = [=](double) { return height; };
  // A row as high as a column is wide, 4 rows at least; above they grow as the wave
  // fades.
  const double cell = std::min(length / n_columns, 2. * height / n_columns);
  strip.rows = graded_rows(height, cell, std::min(height, 0.25 * length), 1.15,
                           0.25 * length, false);
  Triangulation triangulation(MPI_COMM_WORLD);
  make_section(triangulation, 0., length, n_columns, {strip});
  ElasticSolid solid(triangulation,
                     {ElasticMaterial::isotropic(young_modulus, poisson_ratio, 1.)}, 2);
  const auto zero = [](const Point<2> &) { return 0.; };
  DirichletValues values;
  prescribe(solid, boundary::left, 0, zero, values);
  prescribe(solid, boundary::right, 0, zero, values);
  if (far_face != FarFace::free)
    prescribe(solid, boundary::top, 1, zero, values);
  if (far_face == FarFace::rough_rigid)
    prescribe(solid, boundary::top, 0, zero, values);
  prescribe(
      solid, boundary::bottom, 1,
      [=](const Point<2> &p) { return std::cos(wavenumber * p[0]); }, values);
  const auto u = solve_direct(solid, solid.stiffness(), values, solid.make_vector());
  return 4. * solid.strain_energy(u) / length;
}
} // namespace

TEST(MatrixStiffness, FollowsTheClosedFormForThreeFarFaces)
{
  for (const FarFace far_face :
       {FarFace::free, FarFace::smooth_rigid, FarFace::rough_rigid})
    for (const double poisson_ratio : {0., 0.25, 0.49, 0.499})
      for (const double chi : {0.05, 0.3, 1., 3., 10.})
      {
        SCOPED_TRACE("nu " + std::to_string(poisson_ratio) + ", chi " +
                     std::to_string(chi));
        const theory::Side side{young_modulus, poisson_ratio, chi / wavenumber, far_face};
        const double exact = side.stiffness(wavenumber);
        EXPECT_NEAR(stiffness(chi, poisson_ratio, far_face, 16), exact, 5e-3 * exact);
      }
}

TEST(MatrixStiffness, ConvergesAtFourthOrder)
{
  // Twice the order of the displacements' gradient. At chi = 3 and 10 the rows are graded
  // and do not halve from level to level.
  for (const FarFace far_face :
       {FarFace::free, FarFace::smooth_rigid, FarFace::rough_rigid})
    for (const double poisson_ratio : {0.25, 0.499})
      for (const double chi : {0.3, 1.})
      {
        const theory::Side side{young_modulus, poisson_ratio, chi / wavenumber, far_face};
        const double exact = side.stiffness(wavenumber);
        std::vector<double> errors;
        for (const unsigned int n_columns : {8u, 16u, 32u})
          errors.push_back(
              std::abs(stiffness(chi, poisson_ratio, far_face, n_columns) - exact));
        EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4., 0.3);
      }
}
} // namespace matrix_stiffness_tests

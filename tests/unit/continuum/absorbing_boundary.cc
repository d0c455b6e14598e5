#include "continuum/absorbing_boundary.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace absorbing_boundary_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// rho = 4, c_p = 3, c_s = 1.5: impedances 12 and 6.
ElasticMaterial soft()
{
  ElasticMaterial material;
  material.stiffness = {{{36., 18., 0.}, {18., 36., 0.}, {0., 0., 9.}}};
  material.density = 4.;
  return material;
}

struct Sum
{
  double xx = 0., xy = 0., yy = 0.;
};
/// Of the dashpots of all ranks at nodes that @p counts.
Sum sum_over(const ElasticSolid &solid,
             const std::vector<NodalDashpot> &dashpots,
             const std::function<bool(const Point<2> &)> &counts)
{
  Sum sum;
  for (const NodalDashpot &dashpot : dashpots)
  {
    const auto dof = solid.locally_owned().nth_index_in_set(dashpot.dof_x);
    EXPECT_EQ(solid.component(dof), 0u);
    EXPECT_EQ(dashpot.dof_y, dashpot.dof_x + 1);
    if (!counts(solid.support_point(dof)))
      continue;
    sum.xx += dashpot.xx;
    sum.xy += dashpot.xy;
    sum.yy += dashpot.yy;
  }
  for (double *const part : {&sum.xx, &sum.xy, &sum.yy})
    *part = dealii::Utilities::MPI::sum(*part, MPI_COMM_WORLD);
  return sum;
}
bool all(const Point<2> &)
{
  return true;
}
} // namespace

TEST(AbsorbingDashpots, AreTheImpedanceTimesTheFacesLumpedToNodes)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 5., 2., 5, 4);
    const ElasticSolid solid(triangulation, {soft()}, degree);
    const auto dashpots = absorbing_dashpots(solid, {boundary::right});
    const Sum whole = sum_over(solid, dashpots, all);
    EXPECT_NEAR(whole.xx, 12. * 2., 1e-13 * 24.); // rho c_p along the normal
    EXPECT_NEAR(whole.yy, 6. * 2., 1e-13 * 24.);  // rho c_s along the face
    EXPECT_NEAR(whole.xy, 0., 1e-13 * 24.);
    // A vertex between two faces of 0.5: halves (trapezia) or sixths (Simpson) of both.
    const Sum middle = sum_over(solid, dashpots,
                                [](const Point<2> &p) { return std::abs(p[1]) < 1e-9; });
    EXPECT_NEAR(middle.xx, 12. * (degree == 1 ? 0.5 : 1. / 6.), 1e-13 * 24.);
  }
}

TEST(AbsorbingDashpots, OfACornerAreTheSumOfItsFaces)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 5., 2., 5, 4);
  const ElasticSolid solid(triangulation, {soft()}, 1);
  const auto dashpots = absorbing_dashpots(solid, {boundary::right, boundary::bottom});
  const Sum corner = sum_over(solid, dashpots,
                              [](const Point<2> &p) { return p[0] - p[1] > 6. - 1e-9; });
  // Half of a face of 0.5 at the side, half of one of 1 below.
  EXPECT_NEAR(corner.xx, 12. * 0.25 + 6. * 0.5, 1e-12);
  EXPECT_NEAR(corner.yy, 6. * 0.25 + 12. * 0.5, 1e-12);
}

TEST(AbsorbingDashpots, TurnWithTheFace)
{
  const double turn = 0.6, c = std::cos(turn), s = std::sin(turn);
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 5., 2., 5, 4);
  dealii::GridTools::rotate(turn, triangulation);
  const ElasticSolid solid(triangulation, {soft()}, 1);
  const Sum sum = sum_over(solid, absorbing_dashpots(solid, {boundary::right}), all);
  // 2 (12 n n + 6 t t) with n = (c, s), t = (-s, c).
  EXPECT_NEAR(sum.xx, 24. * c * c + 12. * s * s, 1e-12);
  EXPECT_NEAR(sum.yy, 24. * s * s + 12. * c * c, 1e-12);
  EXPECT_NEAR(sum.xy, 12. * c * s, 1e-12);
}

TEST(AbsorbingDashpots, OfAnAnisotropicMaterialAreTheRootOfChristoffelsMatrix)
{
  ElasticMaterial material;
  material.stiffness = {{{50., 10., 3.}, {10., 20., -2.}, {3., -2., 8.}}};
  material.density = 2.;
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 5., 1., 5, 1);
  const ElasticSolid solid(triangulation, {material}, 1);
  // n = x: Gamma = (C_xx,xx, C_xx,xy; C_xx,xy, C_xy,xy); Z squared is rho Gamma.
  const Sum z = sum_over(solid, absorbing_dashpots(solid, {boundary::right}), all);
  EXPECT_NEAR(z.xx * z.xx + z.xy * z.xy, 2. * 50., 1e-11);
  EXPECT_NEAR(z.xy * (z.xx + z.yy), 2. * 3., 1e-11);
  EXPECT_NEAR(z.xy * z.xy + z.yy * z.yy, 2. * 8., 1e-11);
  EXPECT_GT(z.xx * z.yy, z.xy * z.xy); // the positive root
}

TEST(AbsorbingDashpots, AreOfTheMaterialBehindTheFace)
{
  ElasticMaterial dense = soft(); // c_p 1.5, c_s 0.75: impedances 24 and 12
  dense.density = 16.;
  Triangulation triangulation(MPI_COMM_WORLD);
  const auto at = [](const double y) { return [y](double) { return y; }; };
  make_section(triangulation, 0., 3., 3,
               {{at(0.), at(1.), even_rows(2), 0, false},
                {at(1.), at(3.), even_rows(2), 1, true}});
  const ElasticSolid solid(triangulation, {soft(), dense}, 1);
  const Sum sum = sum_over(solid, absorbing_dashpots(solid, {boundary::left}), all);
  EXPECT_NEAR(sum.xx, 12. * 1. + 24. * 2., 1e-12);
  EXPECT_NEAR(sum.yy, 6. * 1. + 12. * 2., 1e-12);
}

TEST(AbsorbingDashpots, RefuseFacesThatAreNotThereAndMaterialsWithoutDensity)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 2, 2);
  const ElasticSolid solid(triangulation, {soft()}, 1);
  EXPECT_THROW(absorbing_dashpots(solid, {17}), std::invalid_argument);
  ElasticMaterial massless = soft();
  massless.density = 0.;
  const ElasticSolid light(triangulation, {massless}, 1);
  EXPECT_THROW(absorbing_dashpots(light, {boundary::left}), std::invalid_argument);
}
} // namespace absorbing_boundary_tests

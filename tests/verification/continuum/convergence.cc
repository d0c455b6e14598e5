// Order of convergence with a manufactured solution on distorted meshes.
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/numerics/vector_tools_integrate_difference.h>

#include <gtest/gtest.h>

namespace convergence_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
const auto rock = ElasticMaterial::isotropic(2.5, 0.3, 1.);
constexpr double a = 2., b = 3.;

/// u = (sin ax cos by, cos bx sin ay).
class Exact : public dealii::Function<2>
{
public:
  Exact()
      : dealii::Function<2>(2)
  {
  }
  double value(const Point<2> &p, const unsigned int c) const override
  {
    return c == 0 ? std::sin(a * p[0]) * std::cos(b * p[1])
                  : std::cos(b * p[0]) * std::sin(a * p[1]);
  }
};

/// - div sigma(u) [N/m^3].
dealii::Tensor<1, 2> load(const Point<2> &p)
{
  const double M = rock.stiffness[0][0], lambda = rock.stiffness[0][1],
               G = rock.stiffness[2][2];
  const double u = Exact().value(p, 0), v = Exact().value(p, 1);
  const double u_xy = -a * b * std::cos(a * p[0]) * std::sin(b * p[1]);
  const double v_xy = -a * b * std::sin(b * p[0]) * std::cos(a * p[1]);
  return dealii::Tensor<1, 2>({(M * a * a + G * b * b) * u - (lambda + G) * v_xy,
                               (M * a * a + G * b * b) * v - (lambda + G) * u_xy});
}

/// L2 norm of the error on n x n cells.
double error(const unsigned int degree, const unsigned int n)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, n);
  ElasticSolid solid(triangulation, {rock}, degree);
  const Exact exact;
  const auto values = prescribe_all_sides(
      solid, [&](const Point<2> &p, const unsigned int c) { return exact.value(p, c); });
  const auto u = solve(solid, solid.stiffness(), values, body_force(solid, load), {});
  dealii::Vector<double> of_cells(triangulation.n_active_cells());
  dealii::VectorTools::integrate_difference(solid.dof_handler(), u, exact, of_cells,
                                            dealii::QGauss<2>(degree + 3),
                                            dealii::VectorTools::L2_norm);
  return dealii::VectorTools::compute_global_error(triangulation, of_cells,
                                                   dealii::VectorTools::L2_norm);
}

void expect_order(const unsigned int degree)
{
  const double coarse = error(degree, 10), middle = error(degree, 20),
               fine = error(degree, 40);
  // A smooth map of even cells: order degree + 1, reached to 0.1 on these meshes.
  EXPECT_NEAR(std::log2(coarse / middle), degree + 1., 0.15)
      << coarse << " -> " << middle;
  EXPECT_NEAR(std::log2(middle / fine), degree + 1., 0.1) << middle << " -> " << fine;
}
} // namespace

TEST(Convergence, Q1DisplacementIsOfSecondOrder)
{
  expect_order(1);
}
TEST(Convergence, Q2DisplacementIsOfThirdOrder)
{
  expect_order(2);
}
} // namespace convergence_tests

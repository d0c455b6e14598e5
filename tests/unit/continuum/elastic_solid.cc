#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <random>

namespace elastic_solid_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
const auto rock = ElasticMaterial::isotropic(20e9, 0.25, 2500.);

double smooth_field(const Point<2> &p, const unsigned int c)
{
  return std::sin(3. * p[0] + c) * std::cos(2. * p[1] - c);
}

/// Field of @p vector at a point by an evaluation [m].
std::array<double, 2> value_at(const PointEvaluation &at, const Vector &vector)
{
  std::array<double, 2> value{};
  for (std::size_t k = 0; k < at.value.size(); ++k)
  {
    value[0] += at.value[k] * vector(at.dof_x[k]);
    value[1] += at.value[k] * vector(at.dof_y[k]);
  }
  return value;
}

/// Points of [0, 1] x [lower, lower + 1], the same on every rank.
std::vector<Point<2>> random_points(const unsigned int n, const double lower)
{
  std::mt19937 generator(7);
  std::vector<Point<2>> points;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double x =
        generator() / 4294967296.; // one draw a statement: the order is fixed
    const double y = lower + generator() / 4294967296.;
    points.emplace_back(x, y);
  }
  return points;
}
} // namespace

TEST(ElasticMaterial, IsotropicStiffnessIsHookesInPlaneStrain)
{
  // E = 1, nu = 1/4: lambda = G = 0.4, M = 1.2.
  const auto C = ElasticMaterial::isotropic(1., 0.25, 1.).stiffness;
  EXPECT_NEAR(C[0][0], 1.2, 1e-15);
  EXPECT_NEAR(C[1][1], 1.2, 1e-15);
  EXPECT_NEAR(C[0][1], 0.4, 1e-15);
  EXPECT_NEAR(C[2][2], 0.4, 1e-15);
  EXPECT_EQ(C[0][2], 0.);
  EXPECT_THROW(ElasticMaterial::isotropic(1., 0.5, 1.), std::invalid_argument);
  EXPECT_THROW(ElasticMaterial::isotropic(0., 0.2, 1.), std::invalid_argument);
}

TEST(ElasticSolid, InternalForceIsThatOfTheSystemMatrix)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 8);
    ElasticSolid solid(triangulation, {rock}, degree);
    solid.add_to_stiffness(winkler_foundation(solid, {boundary::bottom}, 1e10));
    const auto u = interpolate(solid, smooth_field);
    auto product = solid.make_vector(), force = solid.make_vector();
    solid.stiffness().vmult(product, u);
    solid.add_internal_force(u, force);
    EXPECT_GT(largest(force), 0.);
    const double energy = 0.5 * (u * product);
    force += product;
    // The same products in another order.
    EXPECT_LT(largest(force), 1e-14 * largest(solid.absolute_row_sums()) * largest(u));
    EXPECT_NEAR(solid.strain_energy(u), energy, 1e-12 * energy);
  }
}

TEST(ElasticSolid, FoundationChangesTheInternalForce)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 4., 1., 4, 2);
  ElasticSolid solid(triangulation, {rock}, 1);
  solid.add_to_stiffness(winkler_foundation(solid, {boundary::bottom}, 1e6));
  const auto lift =
      interpolate(solid, [](const Point<2> &, const unsigned int c) { return c; });
  auto force = solid.make_vector();
  solid.add_internal_force(lift, force);
  // k_n times length; the solid itself resists a translation by round-off of its rows.
  EXPECT_NEAR(force * lift, -4e6, 1e-12 * largest(solid.absolute_row_sums()));
}

TEST(ElasticSolid, InternalForceDoesNotDependOnThreads)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 80, 80); // large enough to be threaded
  ElasticSolid solid(triangulation, {rock}, 1);
  const auto u = interpolate(solid, smooth_field);
  const int n_threads = omp_get_max_threads();
  auto one = solid.make_vector(), three = solid.make_vector();
  omp_set_num_threads(1);
  solid.add_internal_force(u, one);
  omp_set_num_threads(3);
  solid.add_internal_force(u, three);
  omp_set_num_threads(n_threads);
  for (unsigned int i = 0; i < one.locally_owned_size(); ++i)
    EXPECT_EQ(one.local_element(i), three.local_element(i));
}

TEST(ElasticSolid, LumpedMassIsPositiveAndSumsToTheWeightedMass)
{
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 2., 3., 5, 4);
    ElasticSolid solid(triangulation, {rock}, degree,
                       [](const Point<2> &p) { return 0.25 + 0.25 * p[0]; });
    double sum = 0.;
    for (const auto dof : solid.locally_owned())
    {
      EXPECT_GT(solid.lumped_mass()(dof), 0.);
      sum += solid.component(dof) == 1 ? solid.lumped_mass()(dof) : 0.;
    }
    // The weight is linear: the rule is exact. Its mean is 1/2.
    EXPECT_NEAR(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD), 0.5 * 2500. * 6.,
                1e-12 * 2500. * 6.);
  }
}

TEST(ElasticSolid, WeightScalesStiffnessAndCellStates)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 4);
  ElasticSolid full(triangulation, {rock}, 1);
  ElasticSolid weak(triangulation, {rock}, 1, [](const Point<2> &) { return 0.25; });
  const auto u = interpolate(full, smooth_field);
  const double energy = full.strain_energy(u);
  EXPECT_NEAR(weak.strain_energy(u), 0.25 * energy, 1e-13 * energy);
  const auto states = full.cell_states(u), weak_states = weak.cell_states(u);
  for (std::size_t c = 0; c < states.size(); ++c)
  {
    EXPECT_DOUBLE_EQ(states[c].stress[0], weak_states[c].stress[0]);
    EXPECT_DOUBLE_EQ(weak_states[c].weight, 0.25);
  }
}

TEST(ElasticSolid, GeometricStiffnessIsStressTimesSquaredGradient)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 4);
  ElasticSolid solid(triangulation, {rock}, 2);
  dealii::SymmetricTensor<2, 2> stress;
  stress[0][0] = -3.;
  stress[0][1] = 0.5;
  stress[1][1] = 2.;
  const auto matrix = solid.geometric_stiffness(stress);
  // u = (a x + b y, c x + d y): grad u S grad u^T summed over both rows, times the area.
  const double a = 0.3, b = -0.2, c = 0.5, d = 0.1;
  const auto u =
      interpolate(solid, [&](const Point<2> &p, const unsigned int component)
                  { return component == 0 ? a * p[0] + b * p[1] : c * p[0] + d * p[1]; });
  auto product = solid.make_vector();
  matrix.vmult(product, u);
  double area = 0.;
  for (const auto &state : solid.cell_states(u))
    area += state.area;
  area = dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD);
  const double density =
      -3. * (a * a + c * c) + 2. * (b * b + d * d) + 2. * 0.5 * (a * b + c * d);
  EXPECT_NEAR(u * product, density * area, 1e-12); // round-off
}

TEST(ElasticSolid, ShapeValuesReproduceTheFieldOfTheMesh)
{
  const auto field = [](const Point<2> &p, const unsigned int c)
  { return c == 0 ? 1. + 2. * p[0] - p[1] : -3. * p[0] + 0.5 * p[1]; };
  for (const unsigned int degree : {1, 2})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 7);
    ElasticSolid solid(triangulation, {rock}, degree);
    const auto u = interpolate(solid, field);
    unsigned int n_found = 0;
    for (const auto &p : random_points(500, 0.))
      if (solid.contains(p))
      {
        ++n_found;
        for (const auto &at : {solid.shape_values(p), solid.vertex_values(p)})
        {
          const auto value = value_at(at, u);
          EXPECT_NEAR(value[0], field(p, 0), 1e-13); // Newton's method to round-off
          EXPECT_NEAR(value[1], field(p, 1), 1e-13);
        }
        EXPECT_EQ(solid.vertex_values(p).value.size(), 4u);
        EXPECT_EQ(solid.shape_values(p).value.size(), degree == 1 ? 4u : 9u);
      }
    // The distorted square covers most of the points, and every point is on some rank.
    EXPECT_GT(dealii::Utilities::MPI::sum(n_found, MPI_COMM_WORLD), 400u);
  }
}

TEST(ElasticSolid, ShapeValuesOfQ2ReproduceAParabolaOnRectangles)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 5, 4);
  ElasticSolid solid(triangulation, {rock}, 2);
  const auto parabola = [](const Point<2> &p, const unsigned int c)
  { return p[0] * p[0] - p[0] * p[1] + c * p[1] * p[1]; };
  const auto u = interpolate(solid, parabola);
  for (const auto &p : random_points(300, -0.5))
    if (solid.contains(p))
    {
      EXPECT_NEAR(value_at(solid.shape_values(p), u)[1], parabola(p, 1), 1e-13);
    }
}

TEST(ElasticSolid, PointsOutsideTheMeshAreRefused)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 1., 1., 5, 4);
  ElasticSolid solid(triangulation, {rock}, 1);
  EXPECT_THROW(solid.shape_values(Point<2>(1. + 1e-6, 0.)), std::out_of_range);
  EXPECT_THROW(solid.vertex_values(Point<2>(0.5, -30.)), std::out_of_range);
  EXPECT_FALSE(solid.contains(Point<2>(-5., 0.)));
  // Within 1e-8 of a cell: round-off of the caller's geometry.
  const unsigned int known = solid.contains(Point<2>(1. + 1e-10, 0.1));
  EXPECT_GE(dealii::Utilities::MPI::sum(known, MPI_COMM_WORLD), 1u);
}

TEST(ElasticSolid, KnowsComponentAndPlaceOfADof)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 2., 1., 2, 1);
  ElasticSolid solid(triangulation, {rock}, 2);
  std::array<unsigned int, 2> n{};
  double sum = 0.;
  for (const auto dof : solid.locally_owned())
  {
    ++n[solid.component(dof)];
    sum += solid.support_point(dof)[0];
  }
  EXPECT_EQ(n[0], n[1]);
  // 5 x 3 nodes with two dofs, mean x = 1.
  EXPECT_EQ(dealii::Utilities::MPI::sum(n[0], MPI_COMM_WORLD), 15u);
  EXPECT_NEAR(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD), 30., 1e-12);
}

TEST(ElasticSolid, RefusesACellWithoutMaterial)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  Strip strip{[](double) { return 0.; }, [](double) { return 1.; }, even_rows(4), 3,
              false};
  make_section(triangulation, 0., 1., 4, {strip});
  EXPECT_THROW(ElasticSolid(triangulation, {rock}, 1), std::invalid_argument);
}

TEST(Loads, PressureAndGravityHaveTheirResultants)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 4., 2., 6, 3);
  ElasticSolid solid(triangulation, {rock}, 2);
  const auto resultant = [&](const Vector &force, const unsigned int component)
  {
    return force * interpolate(solid, [=](const Point<2> &, const unsigned int c)
                               { return c == component ? 1. : 0.; });
  };
  // Exact integrals: round-off.
  const auto top = pressure(solid, {boundary::top}, 3.);
  EXPECT_NEAR(resultant(top, 1), -12., 1e-12);
  EXPECT_NEAR(resultant(top, 0), 0., 1e-12);
  EXPECT_NEAR(resultant(pressure(solid, {boundary::left}, 3.), 0), 6., 1e-12);
  const auto weight = gravity(solid, dealii::Tensor<1, 2>({0., -10.}));
  EXPECT_NEAR(resultant(weight, 1), -2500. * 10. * 8., 1e-7);
}
} // namespace elastic_solid_tests

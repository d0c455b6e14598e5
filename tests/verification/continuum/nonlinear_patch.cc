// Case 50: linear fields and rigid rotations of bodies whose materials are laws.
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace nonlinear_patch_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double young_modulus = 20e9, poisson_ratio = 0.3;

struct Body
{
  const char *name;
  Law law;
  unsigned int degree;
  StrainForm form;
};

std::vector<Body> bodies()
{
  const Law hooke = make_law<LinearElastic>(young_modulus, poisson_ratio),
            neo_hookean = make_law<NeoHookean>(young_modulus, poisson_ratio),
            kirchhoff = make_law<StVenantKirchhoff>(young_modulus, poisson_ratio);
  return {{"Hooke, Q1", hooke, 1, StrainForm::displacement},
          {"Hooke, Q1 with mean dilatation", hooke, 1, StrainForm::mean_dilatation},
          {"Hooke, Q2", hooke, 2, StrainForm::displacement},
          {"neo-Hooke, Q1", neo_hookean, 1, StrainForm::displacement},
          {"neo-Hooke, Q2", neo_hookean, 2, StrainForm::displacement},
          {"St Venant-Kirchhoff, Q1", kirchhoff, 1, StrainForm::displacement},
          {"St Venant-Kirchhoff, Q2", kirchhoff, 2, StrainForm::displacement}};
}

NonlinearSolid make_solid(const Triangulation &triangulation, const Body &body)
{
  NonlinearSolid::Options options;
  options.degree = body.degree;
  options.strain_form = body.form;
  return NonlinearSolid(triangulation, {body.law}, options);
}

/// A homogeneous deformation with all four gradients and a translation [m].
double linear_field(const Point<2> &p, const unsigned int component)
{
  return component == 0 ? 1e-3 + 0.2 * p[0] - 0.1 * p[1]
                        : -2e-3 + 0.05 * p[0] - 0.15 * p[1];
}

double quarter_turn(const Point<2> &p, const unsigned int component)
{
  return component == 0 ? -p[1] - p[0] : p[0] - p[1];
}

/// Cauchy stress that the law answers to the gradients of linear_field().
PointStress exact_stress(const MaterialLaw &law)
{
  const double a = 0.2, b = -0.1, c = 0.05, d = -0.15;
  PointInput input;
  if (!law.is_finite_strain())
  {
    input.strain = {a, d, b + c};
    return law.respond(input, nullptr, nullptr).stress;
  }
  input.strain = {a + 0.5 * (a * a + c * c), d + 0.5 * (b * b + d * d),
                  b + c + a * b + c * d};
  const PointStress S = law.respond(input, nullptr, nullptr).stress;
  const double F[2][2] = {{1. + a, b}, {c, 1. + d}};
  const double J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  const auto push = [&](const int i, const int j)
  {
    return (F[i][0] * S.xx * F[j][0] + F[i][0] * S.xy * F[j][1] +
            F[i][1] * S.xy * F[j][0] + F[i][1] * S.yy * F[j][1]) /
           J;
  };
  return {push(0, 0), push(1, 1), S.zz / J, push(0, 1)};
}
} // namespace

TEST(NonlinearPatch, HomogeneousDeformationIsSolvedExactly)
{
  for (const Body &body : bodies())
  {
    SCOPED_TRACE(body.name);
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 5);
    NonlinearSolid solid = make_solid(triangulation, body);
    Loads sides;
    sides.displacements = prescribe_all_sides(solid, linear_field);
    LoadedSolid problem(solid, {}, sides);
    NewtonSolver::Options options;
    options.convergence.tolerance = 1e-13; // round-off of the forces
    NewtonSolver newton(problem, options);
    auto u = solid.make_vector();
    newton.advance(0., 1., 1, u);

    const PointStress exact = exact_stress(*body.law);
    const double size = 1e-12 * young_modulus;
    for (const auto &state : solid.point_states(u))
    {
      EXPECT_NEAR(state.stress.xx, exact.xx, size);
      EXPECT_NEAR(state.stress.yy, exact.yy, size);
      EXPECT_NEAR(state.stress.zz, exact.zz, size);
      EXPECT_NEAR(state.stress.xy, exact.xy, size);
    }
    u -= interpolate(solid, linear_field);
    EXPECT_LT(largest(u), 1e-12 * 0.3); // of a largest displacement of 0.3 m
  }
}

TEST(NonlinearPatch, QuarterTurnIsFreeOfStress)
{
  for (const Body &body : bodies())
  {
    if (!body.law->is_finite_strain())
      continue;
    SCOPED_TRACE(body.name);
    Triangulation triangulation(MPI_COMM_WORLD);
    make_distorted_square(triangulation, 5);
    NonlinearSolid solid = make_solid(triangulation, body);
    const auto u = interpolate(solid, quarter_turn);
    auto force = solid.make_vector();
    solid.assemble(u, 0., force, nullptr);
    // Strain is round-off of gradients of size 1.
    EXPECT_LT(largest(force), 1e-14 * young_modulus);
    for (const auto &state : solid.point_states(u))
    {
      EXPECT_NEAR(state.stress.xx, 0., 1e-13 * young_modulus);
      EXPECT_NEAR(state.stress.yy, 0., 1e-13 * young_modulus);
      EXPECT_NEAR(state.stress.xy, 0., 1e-13 * young_modulus);
      EXPECT_NEAR(state.volume_ratio, 1., 1e-13);
    }
  }
}

TEST(NonlinearPatch, BodyThatTurnsWithItsSidesStaysFreeOfStress)
{
  // The same, found by Newton's method in steps of 9 degrees.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 4);
  NonlinearSolid solid =
      make_solid(triangulation, {"", make_law<NeoHookean>(young_modulus, poisson_ratio),
                                 2, StrainForm::displacement});
  auto u = solid.make_vector();
  for (unsigned int step = 1; step <= 10; ++step)
  {
    const double angle = step * M_PI / 20.;
    const auto turn = [=](const Point<2> &p, const unsigned int c)
    {
      const double x = std::cos(angle) * p[0] - std::sin(angle) * p[1],
                   y = std::sin(angle) * p[0] + std::cos(angle) * p[1];
      return c == 0 ? x - p[0] : y - p[1];
    };
    Loads sides;
    sides.displacements = prescribe_all_sides(solid, turn);
    LoadedSolid problem(solid, sides, {});
    NewtonSolver::Options options;
    options.convergence.least_force =
        1e-2 * young_modulus; // the body is without stress at the end
    NewtonSolver(problem, options).solve(0., 0., u);
  }
  u -= interpolate(solid, quarter_turn);
  EXPECT_LT(largest(u), 1e-9); // tolerance 1e-8 times force_scale over stiffness
}

TEST(NonlinearPatch, SmallDisplacementsAnswerLikeHooke)
{
  // f(e u) / e - K u falls like e.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 3);
  ElasticSolid linear(triangulation,
                      {ElasticMaterial::isotropic(young_modulus, poisson_ratio, 1.)}, 2);
  auto Ku = linear.make_vector();
  linear.add_internal_force(wavy_field(linear, 1.), Ku);
  for (const Body &body : bodies())
  {
    if (body.degree != 2)
      continue;
    SCOPED_TRACE(body.name);
    NonlinearSolid solid = make_solid(triangulation, body);
    std::vector<double> errors;
    for (const double size : {1e-3, 1e-4, 1e-5})
    {
      auto force = solid.make_vector();
      solid.assemble(wavy_field(solid, size), 0., force, nullptr);
      force *= 1. / size;
      force += Ku; // which is -K u
      errors.push_back(force.l2_norm() / Ku.l2_norm());
    }
    if (!body.law->is_finite_strain())
    {
      EXPECT_LT(errors[0], 1e-12); // the same sums
      continue;
    }
    EXPECT_LT(errors[2], 1e-4);
    for (unsigned int level = 0; level < 2; ++level)
      EXPECT_NEAR(std::log10(errors[level] / errors[level + 1]), 1., 0.02);
  }
}
} // namespace nonlinear_patch_tests

// Case 47: a layer under a pressure on both faces and ends. As it follows the faces, the
// layer buckles at sigma_1 - p = sigma_E. Dead pressures would stay upright while the
// section turns by w' and make a couple p h w' a length, as an axial compression p h more
// does: it would buckle at sigma_1 + p = sigma_E.
#include "continuum/newton_solver.h"
#include "continuum/strut_theory.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace follower_confinement_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
// Shear takes 1.6e-3 of the Euler stress.
const theory::Layer layer{20e9, 0.25, 1.};
constexpr double length = 40.;
const double euler_stress =
    theory::euler_stress_pinned(layer.plane_modulus(), length, layer.thickness);
const BoundaryIds all_sides{boundary::left, boundary::right, boundary::bottom,
                            boundary::top};

enum class Pressure
{
  follows,
  dead
};

/// A strip whose axis is held across at its ends, under a pressure @p p on all sides [Pa]
/// and a dead axial stress, of which the load factor counts sigma_E.
class ConfinedStrip
{
public:
  ConfinedStrip(const double p, const Pressure kind, const unsigned int n_columns)
      : triangulation_(MPI_COMM_WORLD)
      , solid_(mesh(n_columns),
               {make_law<StVenantKirchhoff>(layer.young_modulus, layer.poisson_ratio)},
               NonlinearSolid::Options())
      , tangent_(solid_.make_matrix())
  {
    hold_node(solid_, Point<2>(0., 0.), 0, confinement_.displacements);
    hold_node(solid_, Point<2>(0., 0.), 1, confinement_.displacements);
    hold_node(solid_, Point<2>(length, 0.), 1, confinement_.displacements);
    if (kind == Pressure::follows)
      confinement_.pressures.emplace_back(solid_, all_sides, p);
    else
      confinement_.dead = pressure(solid_, all_sides, p);
    Loads axial;
    axial.dead = pressure(solid_, {boundary::left, boundary::right}, euler_stress);
    body_ = std::make_unique<LoadedSolid>(solid_, confinement_, axial);
  }

  /// The least eigenvalue of the tangent over its greatest; of the straight layer.
  double least_eigenvalue(const double factor)
  {
    assemble_straight(factor);
    const auto values = eigenvalues(solid_, tangent_, confinement_.displacements);
    return values.front() / values.back();
  }

  /// (sigma_1 - p) / sigma_E at which the layer buckles: where the line through two
  /// resistances to a wave of load meets 0 (Southwell).
  double critical_factor()
  {
    const double first = 0.3, second = 0.6;
    const double a = resistance(first), b = resistance(second);
    return first + a * (second - first) / (a - b);
  }

private:
  const Triangulation &mesh(const unsigned int n_columns)
  {
    make_rectangle(triangulation_, length, layer.thickness, n_columns, 1);
    return triangulation_;
  }

  /// Of the straight layer, which is in equilibrium whether stable or not.
  void assemble_straight(const double factor)
  {
    auto u = solid_.make_vector();
    NewtonSolver(*body_, NewtonSolver::Options()).solve(factor, 0., u);
    body_->assemble(u, factor, 0., &tangent_);
  }

  /// Load sin(pi x / L) across over the deflection that it makes.
  double resistance(const double factor)
  {
    assemble_straight(factor);
    const auto load = boundary_traction(
        solid_, {boundary::top},
        [](const Point<2> &p, const auto &) {
          return dealii::Tensor<1, 2>({0., std::sin(M_PI * p[0] / length)});
        });
    const auto u = solve_direct(solid_, tangent_, confinement_.displacements, load);
    return 1. / at_node(solid_, u, Point<2>(0.5 * length, 0.), 1);
  }

  Triangulation triangulation_;
  NonlinearSolid solid_;
  Matrix tangent_;
  Loads confinement_;
  std::unique_ptr<LoadedSolid> body_;
};
} // namespace

TEST(FollowerConfinement, HydrostaticPressureNeverBuckles)
{
  const double unloaded = ConfinedStrip(0., Pressure::follows, 10).least_eigenvalue(0.);
  EXPECT_GT(unloaded, 0.);
  for (const double ratio : {1., 3., 10., 30.})
  {
    ConfinedStrip strip(ratio * euler_stress, Pressure::follows, 10);
    // Strain under 30 sigma_E is 1.5 %.
    EXPECT_NEAR(strip.least_eigenvalue(0.), unloaded, 0.02 * unloaded) << ratio;
  }
}

TEST(FollowerConfinement, DeadHydrostaticPressureWouldBuckleAtHalfTheEulerStress)
{
  ConfinedStrip below(0.45 * euler_stress, Pressure::dead, 10);
  EXPECT_GT(below.least_eigenvalue(0.), 0.);
  ConfinedStrip above(0.55 * euler_stress, Pressure::dead, 10);
  EXPECT_LT(above.least_eigenvalue(0.), 0.);
}

TEST(FollowerConfinement, StressBeyondThePressureIsEulers)
{
  for (const double p : {0., 5e6, 10e6, 20e6})
  {
    SCOPED_TRACE(p);
    std::vector<double> errors;
    for (const unsigned int n_columns : {10u, 20u, 40u})
      errors.push_back(ConfinedStrip(p, Pressure::follows, n_columns).critical_factor() -
                       1.);
    // Shear, and the strain p / E of the layer before it buckles (1e-3).
    EXPECT_NEAR(errors[2], 0., 0.01);
    // The mesh: falls faster than by 8 a level.
    EXPECT_LT(std::abs(errors[1] - errors[2]), std::abs(errors[0] - errors[1]) / 8.);
  }
}

TEST(FollowerConfinement, DeadPressureFailsThisTest)
{
  for (const double p : {5e6, 10e6, 20e6})
  {
    const double factor = ConfinedStrip(p, Pressure::dead, 20).critical_factor();
    EXPECT_GT(std::abs(factor - 1.), 0.5);
    EXPECT_NEAR(factor, 1. - 2. * p / euler_stress, 0.01);
  }
}
} // namespace follower_confinement_tests

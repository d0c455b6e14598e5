// Case 45: a shallow sine arch between pins under q sin(pi x / L), as a solid, followed
// past its limit point; a higher one sways before.
#include "continuum/arch_theory.h"
#include "continuum/arc_length.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace snap_through_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
// Slender, as the theory is of a shallow arch without shear: they count for (a0 k)^2,
// 7e-4 at e0 = 6, and 0.2 (k h)^2 = 5e-5.
constexpr double length = 200., thickness = 1., young_modulus = 1e4;
const double radius = thickness / std::sqrt(12.);

/// An arch of rise e0 r whose load factor counts D k^4 r.
class Arch
{
public:
  Arch(const double e0, const unsigned int n_columns)
      : initial_rise_(e0)
      , strip_(make_law<StVenantKirchhoff>(young_modulus, 0.),
               make_law<StVenantKirchhoff>(100. * young_modulus, 0.),
               length,
               thickness,
               n_columns,
               e0 * radius)
  {
    for (const double x : {0., length})
      for (unsigned int c = 0; c < 2; ++c)
        strip_.hold_pin(x, c, supports_.displacements);
    const double unit = theory::snap_load_unit({young_modulus, 0., thickness}, length);
    load_.dead = strip_.load_across([=](const double x)
                                    { return unit * std::sin(M_PI * x / length); });
    body_ = std::make_unique<LoadedSolid>(strip_.solid(), supports_, load_);
  }

  LoadedSolid &body() { return *body_; }
  const DirichletValues &supports() const { return supports_.displacements; }
  /// e of the middle.
  double rise(const Vector &displacement) const
  {
    return initial_rise_ + strip_.at_axis(displacement, 0.5 * length, 1) / radius;
  }

private:
  double initial_rise_;
  PinnedStrip strip_;
  Loads supports_, load_;
  std::unique_ptr<LoadedSolid> body_;
};

ArcLength::Options steps()
{
  ArcLength::Options options;
  options.first_length = 0.005;
  options.largest_length = 0.015;
  return options;
}

struct Top
{
  double rise, load;
};

/// Where the load is greatest: the top of the parabola through the highest three points.
Top top_of(const std::vector<ArcLength::Point> &path)
{
  std::size_t i = 1;
  while (i + 2 < path.size() && path[i + 1].factor > path[i].factor)
    ++i;
  const auto &a = path[i - 1], &b = path[i], &c = path[i + 1];
  const double s = (b.factor - a.factor) / (b.measure - a.measure),
               t = (c.factor - b.factor) / (c.measure - b.measure),
               curvature = (t - s) / (c.measure - a.measure);
  const double rise = 0.5 * (a.measure + b.measure - s / curvature);
  return {rise, a.factor + (rise - a.measure) * (s + curvature * (rise - b.measure))};
}
} // namespace

TEST(SnapThrough, LimitPointOfAShallowArchIsTheClosedForm)
{
  const auto exact = theory::snap_through(3.);
  ASSERT_TRUE(exact && !exact->antisymmetric);
  EXPECT_NEAR(exact->load, 4.0758, 5e-5);
  std::vector<double> loads;
  for (const unsigned int n_columns : {8u, 16u, 32u})
  {
    Arch arch(3., n_columns);
    auto u = arch.body().solid().make_vector();
    double factor = 0.;
    ArcLength path(arch.body(), steps());
    path.follow(
        u, factor, [&](const Vector &v, double) { return arch.rise(v); }, 0.8);
    const Top top = top_of(path.path());
    loads.push_back(top.load);
    EXPECT_NEAR(top.rise, exact->rise, 2e-3); // of a path that is flat there
  }
  EXPECT_NEAR(loads[2], exact->load, 5e-3 * exact->load);
  // The arch is a polygon: second order. What is left beyond are shear and slope.
  EXPECT_NEAR(std::log2((loads[1] - loads[0]) / (loads[2] - loads[1])), 2., 0.15);
  EXPECT_NEAR(loads[2] + (loads[2] - loads[1]) / 3., exact->load, 1e-3 * exact->load);
}

TEST(SnapThrough, HighArchSwaysBeforeItsLimitPoint)
{
  const double e0 = 6.;
  const auto exact = theory::snap_through(e0);
  ASSERT_TRUE(exact && exact->antisymmetric);
  EXPECT_NEAR(exact->load, 19.416, 5e-4);

  std::vector<double> loads;
  for (const unsigned int n_columns : {8u, 16u, 32u})
  {
    Arch arch(e0, n_columns);
    NonlinearSolid &solid = arch.body().solid();
    auto u = solid.make_vector();
    Matrix tangent = solid.make_matrix();
    ArcLength path(arch.body(), steps());
    double factor = 0.;
    // The symmetric path is followed past the point where the tangent stops being
    // positive definite; the load there from a parabola through three eigenvalues.
    std::vector<double> load, eigenvalue;
    for (const double rise : {4.8, 4.5, 4.2})
    {
      path.follow(
          u, factor, [&](const Vector &v, double) { return arch.rise(v); }, rise);
      arch.body().assemble(u, factor, 0., &tangent);
      load.push_back(factor);
      eigenvalue.push_back(eigenvalues(solid, tangent, arch.supports()).front());
    }
    EXPECT_GT(eigenvalue.front(), 0.);
    EXPECT_LT(eigenvalue.back(), 0.);
    double at_zero = 0.;
    for (unsigned int i = 0; i < 3; ++i)
    {
      double term = load[i];
      for (unsigned int j = 0; j < 3; ++j)
        if (j != i)
          term *= -eigenvalue[j] / (eigenvalue[i] - eigenvalue[j]);
      at_zero += term;
    }
    loads.push_back(at_zero);
  }
  EXPECT_NEAR(loads[2], exact->load, 5e-3 * exact->load);
  EXPECT_GT(std::log2((loads[0] - loads[1]) / (loads[1] - loads[2])), 1.8);
}
} // namespace snap_through_tests

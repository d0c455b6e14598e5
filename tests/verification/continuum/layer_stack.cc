// Two layers on one another, clamped at one end, under a load across: layers that slide
// bend about their own axes, D = 2 D_1; joined they have one axis, D = 8 D_1.
#include "continuum/layer_theory.h"
#include "support/two_strips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace layer_stack_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double E = 1e10, length = 20.;
const theory::Layer layer{E, 0., 1.}; // without Poisson's ratio the clamp is a beam's
const TwoStrips form = []
{
  TwoStrips strips;
  strips.length = length;
  strips.n_columns = 20;
  strips.n_rows = 1;
  strips.degree = 2;
  strips.law = make_law<LinearElastic>(E, 0.);
  return strips;
}();

/// End deflection of a cantilever under an even load on two layers, as a beam of this
/// bending stiffness that shears (Timoshenko), per load [m/Pa].
double beam(const double bending_stiffness)
{
  const double shear_stiffness = 5. / 6. * 0.5 * E * 2. * layer.thickness;
  return std::pow(length, 4) / (8. * bending_stiffness) +
         length * length / (2. * shear_stiffness);
}

ContactStiffness stiffness(const double ratio)
{
  const ContactSide side{LameConstants::from_young_poisson(E, 0.), layer.thickness};
  return contact_stiffness(side, side, ratio);
}

/// That of the two strips [m/Pa]; without a law they are joined.
double deflection(const std::optional<ContactLaw> &law,
                  const MPI_Comm communicator = MPI_COMM_WORLD)
{
  constexpr double load = 1.; // strains of 1e-7: the interface does not turn
  TwoStripBody body(form, law, communicator);
  Loads growing;
  growing.dead = pressure(body.solid(), {boundary::top}, load);
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        body.solid(), boundary::left, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
  LoadedSolid loaded(body.solid(), {}, growing);
  NewtonSolver newton(loaded, NewtonSolver::Options());
  auto u = body.solid().make_vector();
  newton.advance(0., 1., 1, u);
  double top = 0.;
  for (const auto dof : body.solid().locally_owned())
    if (body.solid().component(dof) == 1 &&
        body.solid().support_point(dof).distance({length, 1.}) < 1e-9)
      top = -u(dof) / load;
  return dealii::Utilities::MPI::sum(top, communicator);
}
} // namespace

TEST(LayerStack, BendsAsTwoLayersWhereTheySlideAndAsOneWhereJoined)
{
  const double D = layer.bending_stiffness(), joined = deflection(std::nullopt),
               frictionless = deflection(FrictionlessContact{stiffness(100.).normal}),
               sliding = deflection(SlidingContact{stiffness(100.).normal});
  // Cells as long as high, of a cubic deflection, and the clamp, which keeps sections
  // plane: some (thickness / length)^2 / 5.
  EXPECT_NEAR(joined, beam(8. * D), 1e-3 * joined);
  EXPECT_NEAR(frictionless, beam(2. * D), 1e-3 * frictionless);
  EXPECT_NEAR(sliding, frictionless, 1e-6 * sliding); // nothing opens
  EXPECT_NEAR(frictionless / joined, 4., 0.03); // both shear alike: 0.8 % of the joined
}

TEST(LayerStack, ThatSticksComesToTheJoinedOneAsStiffnessGrows)
{
  // Shear t = 3/2 V / H of the stack's middle makes a slip t / k_t; with that of a unit
  // force at the end its work is the end's further deflection, (3/2 / H)^2 L^2 / 2 k_t.
  const double joined = deflection(std::nullopt), height = 2. * layer.thickness;
  std::vector<double> errors;
  for (const double ratio : {25., 50., 100.})
  {
    const ContactStiffness k = stiffness(ratio);
    const FrictionalContact law{k.normal, k.shear, 0.6, 1e9};
    errors.push_back(deflection(law) / joined - 1.);
    const double more = std::pow(1.5 / height * length, 2) / (2. * k.shear);
    EXPECT_NEAR(errors.back(), more / joined,
                0.05 * more / joined); // no slip at the clamp
  }
  for (const std::size_t i : {0, 1})
    EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 1., 0.02);
}

TEST(LayerStack, RanksDoNotChangeTheResult)
{
  const FrictionlessContact law{stiffness(100.).normal};
  const double one = deflection(law, MPI_COMM_SELF), all = deflection(law);
  EXPECT_NEAR(all, one, 1e-8 * one);
}

TEST(LayerStack, OfSlidingLayersBendsFarAsTheElastica)
{
  // P L^2 / D = 1 at the free end: deflection and shortening over L and slope of a
  // cantilever (Mattiasson 1981), whose layers slip by their thickness times the slope.
  constexpr double sag = 0.30172, shortening = 0.05643, slope = 0.46135;
  TwoStrips slender = form;
  slender.length = 40.;
  slender.law = make_law<StVenantKirchhoff>(E, 0.);
  const double L = slender.length, face = L / slender.n_columns;
  TwoStripBody body(slender, SlidingContact{stiffness(100.).normal});
  Loads growing;
  growing.dead = boundary_traction(
      body.solid(), {boundary::right},
      [=](const Point<2> &, const auto &) {
        return dealii::Tensor<1, 2>({0., -layer.bending_stiffness() / (L * L)});
      });
  for (unsigned int c = 0; c < 2; ++c)
    prescribe(
        body.solid(), boundary::left, c, [](const Point<2> &) { return 0.; },
        growing.displacements);
  LoadedSolid loaded(body.solid(), {}, growing);
  NewtonSolver newton(loaded, NewtonSolver::Options());
  auto u = body.solid().make_vector();
  newton.advance(0., 1., 4, u);
  const auto mean_of_axes = [&](const unsigned int component)
  {
    double sum = 0.;
    for (const double y : {-0.5, 0.5})
      sum += at_node(body.solid(), u, {L, y * layer.thickness}, component);
    return 0.5 * sum;
  };
  // Shear and the layers' different radii make some (thickness / L)^2 = 6e-4.
  EXPECT_NEAR(mean_of_axes(1), -sag * L, 1e-3 * sag * L);
  EXPECT_NEAR(mean_of_axes(0), -shortening * L, 2e-3 * shortening * L);
  EXPECT_NEAR(body.contact().relative_slip(u), slope * layer.thickness / face,
              2e-3 * slope * layer.thickness / face);
}
} // namespace layer_stack_tests

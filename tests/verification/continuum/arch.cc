// Case 44: a pinned sine arch under a dead load and an axial force, as a solid: whether
// its crest rises or sinks as the force grows is the load's matter alone.
#include "continuum/arch_theory.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace arch_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double length = 100., thickness = 1., rise = 0.5, poisson = 0.25;
const theory::Layer layer{1e4, poisson, thickness};
const double D = layer.bending_stiffness(), k = M_PI / length, euler_force = D * k * k;
const double critical_load =
    theory::arch_critical_load(rise, length, D, theory::ArchEnds::pinned);

/// Height of the crest under an axial force (over Euler's) and each of the @p loads (over
/// the critical one, ascending), where one pin slides [m].
std::vector<double>
crests(const double force, const std::vector<double> &loads, const unsigned int n_columns)
{
  PinnedStrip arch(make_law<StVenantKirchhoff>(layer.young_modulus, poisson),
                   make_law<StVenantKirchhoff>(100. * layer.young_modulus, poisson),
                   length, thickness, n_columns, rise);
  Loads pins, push, weight;
  for (const double x : {0., length})
    arch.hold_pin(x, 1, pins.displacements);
  arch.hold_pin(0., 0, pins.displacements);

  push.dead = arch.solid().make_vector();
  DirichletValues sliding;
  arch.hold_pin(length, 0, sliding);
  for (const auto &[dof, value] : sliding)
    if (arch.solid().locally_owned().is_element(dof))
      (*push.dead)(dof) = -force * euler_force;
  weight.dead = arch.load_across([](double) { return critical_load; });

  auto u = arch.solid().make_vector();
  LoadedSolid pushed(arch.solid(), pins, push);
  NewtonSolver(pushed, {}).advance(0., 1., 2, u);
  Loads held = pins;
  held.dead = push.dead;
  LoadedSolid loaded(arch.solid(), held, weight);
  NewtonSolver newton(loaded, {});
  std::vector<double> heights;
  double before = 0.;
  for (const double load : loads)
  {
    if (load > before)
      newton.advance(before, load, 1, u);
    before = load;
    heights.push_back(rise + arch.at_axis(u, 0.5 * length, 1));
  }
  return heights;
}

/// By superposition: the half wave that the arch is made with, and the exact beam.
double beam_crest(const double force, const double load)
{
  return rise * theory::amplification(force, 1.) -
         theory::pinned_beam_deflection(load * critical_load, length, D, force);
}
} // namespace

TEST(Arch, RiseIsThatOfTheAmplitudeLaw)
{
  const std::vector<double> loads{0., 0.5, 1.5};
  for (const double force : {0.2, 0.5, 0.8})
  {
    const auto heights = crests(force, loads, 32);
    for (std::size_t i = 0; i < loads.size(); ++i)
    {
      const std::string which = std::to_string(force) + ", " + std::to_string(loads[i]);
      const double sunk = theory::arch_deflection(loads[i] * critical_load, length, D,
                                                  theory::ArchEnds::pinned);
      const double law = theory::arch_rise(rise, sunk, force, 1.);
      // The one term of the load is 0.4 % off without a force, a share that is greater of
      // the difference of rise and deflection: 0.8 % here.
      EXPECT_NEAR(heights[i], law, 0.01 * std::abs(law)) << which;
      // Against the beam's whole deflection what is left are shear, 0.27 (k h)^2 = 3e-4
      // of Euler's force, the polygon, (k column)^2 / 12 = 8e-4 of the rise, and slopes
      // of up to 0.08, (slope)^2 / 8 of the force: amplified up to fivefold.
      EXPECT_NEAR(heights[i], beam_crest(force, loads[i]), 5e-3 * std::abs(law)) << which;
    }
  }
}

TEST(Arch, CrestStandsAtTheCriticalLoadWhateverTheForce)
{
  // What the crest does between two forces is linear in the load: 0 at this one.
  const auto zero = [](const std::vector<double> &from, const std::vector<double> &to)
  {
    const double below = to[0] - from[0], above = to[1] - from[1];
    EXPECT_GT(below, 0.); // it rises under the lesser load
    EXPECT_LT(above, 0.);
    return 0.9 + 0.2 * below / (below - above);
  };
  const std::vector<double> loads{0.9, 1.1};
  const auto beam = [&](const double force) {
    return std::vector<double>{beam_crest(force, 0.9), beam_crest(force, 1.1)};
  };

  std::vector<double> zeros;
  auto from = crests(0., loads, 32), beam_from = beam(0.);
  for (const double force : {0.3, 0.6, 0.8})
  {
    const auto to = crests(force, loads, 32), beam_to = beam(force);
    zeros.push_back(zero(from, to));
    EXPECT_NEAR(zeros.back(), 1., 0.01) << force;
    EXPECT_NEAR(zeros.back(), zero(beam_from, beam_to), 2e-3) << force; // as above
    from = to;
    beam_from = beam_to;
  }
  // Those of the beam differ by 3e-4: the third term of the load is amplified less.
  EXPECT_NEAR(zeros.front(), zeros.back(), 5e-4);
}

TEST(Arch, CrestsConvergeAtSecondOrder)
{
  std::vector<double> heights;
  for (const unsigned int n_columns : {8, 16, 32})
    heights.push_back(crests(0.6, {0.}, n_columns).front());
  // The arch is a polygon of second order; Q2 in bending falls faster.
  const double order = std::log2((heights[1] - heights[0]) / (heights[2] - heights[1]));
  EXPECT_GT(order, 1.9);
  EXPECT_LT(order, 2.5);
  EXPECT_NEAR(heights[2] + (heights[2] - heights[1]) / 3., beam_crest(0.6, 0.),
              2e-3 * heights[2]); // shear and slopes
}
} // namespace arch_tests

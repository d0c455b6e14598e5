// A wave packet runs from the grains through the overlap into the mesh: amplitude that
// comes back. n is the number of cells per wavelength.
#include "support/chain_fixture.h"
#include "support/coupling_loop.h"
#include "support/figures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::reflection_tests
{
namespace
{
/// Drive the grains left of @p end, let the packet pass, and compare the energy that is
/// back among the grains with that of the model.
double reflected_amplitude(Bridged &model,
                           const Packet &packet,
                           const double end,
                           const double speed,
                           const double distance)
{
  discrete::Grains &g = model.state.grains;
  const std::vector<std::size_t> driven = hold_end(model, end);
  model.factorise();
  const double dt = 0.8 * model.stable_step();
  Loop run(model, dt, {});
  drive(run, model, driven, packet);
  // A strip without shear of its height: side grains move along x only.
  std::vector<GrainBase::Support> supports;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.inverse_inertia[i] == 0.)
      supports.push_back(
          {static_cast<std::int32_t>(i), std::numeric_limits<double>::infinity()});
  run.add(std::make_unique<GrainBase>(model.state, supports), {Stage::forces}, 90,
          "sides");

  discrete::GrainVelocities before;
  run.add(std::make_unique<Every>(
              [&](const Clock &clock)
              {
                if (clock.sample_due)
                  before = discrete::velocities(g);
              }),
          {Stage::kick}, 1, "velocities");
  const auto n = static_cast<std::int64_t>((packet.duration() + distance / speed) / dt);
  double ratio = 0.;
  run.probe(n,
            [&](const Clock &clock)
            {
              if (clock.step == 0)
                return;
              const Energies e = run.simulation.energies();
              const double all = e.kinetic + e.strain_grains + e.strain_continuum;
              const double grains = discrete::kinetic_energy(g, before) + e.strain_grains;
              ratio = std::sqrt(grains / all);
            });
  run.advance(n + 1);
  return ratio;
}

double chain_reflection(const Wave &wave, const double mesh_modulus_ratio = 1.)
{
  Bridged model;
  const Chain chain = make_chain(model, wave, 4., mesh_modulus_ratio);
  return reflected_amplitude(model, chain.packet, chain.begin + 0.5, chain.speed,
                             chain.length + 2. * wave.w());
}

/// Strip of the hexagonal lattice between two of its mirror lines: side rows count half,
/// with sides that slide.
double lattice_reflection(const Wave &wave)
{
  constexpr int n_rows = 8;
  const double height = n_rows * 0.5 * std::sqrt(3.);
  const FlatJoint law = elastic_law();
  const continuum::ElasticMaterial material = lattice_material(law);
  const double k = 2. * M_PI / wave.wavelength(), mass = 0.25 * M_PI;
  // Dispersion of the P-wave along a row.
  const double K_n = 1., K_s = 1. / law.stiffness_ratio;
  const double square = (4. * K_n * std::pow(std::sin(0.5 * k), 2) +
                         (2. * K_n + 6. * K_s) * std::pow(std::sin(0.25 * k), 2)) /
                        mass;
  const Packet packet{std::sqrt(square)};
  const double c = std::sqrt(material.stiffness[0][0] / material.density);
  const double length = c * packet.duration(), begin = -std::floor(length);

  Bridged model;
  model.weight.distance_to_core = [](const Vec2 &x) { return std::max(0., x.x); };
  model.weight.width = wave.w();
  model.weight.cubic = wave.cubic;
  const int n_cells = static_cast<int>(std::ceil(length / wave.h + wave.cells));
  make_cells(model.triangulation, lines(0., n_cells * wave.h, n_cells),
             lines(0., height, 3), [](const Vec2 &) { return true; });
  GrainState &state = model.state;
  state.grains = hexagonal_lattice({begin, wave.w(), 0., height}, {begin + 0.19, 0.},
                                   [](const Vec2 &) { return true; });
  const auto is_side = [&](const std::size_t i)
  {
    return state.grains.reference_y[i] < 0.1 ||
           state.grains.reference_y[i] > height - 0.1;
  };
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    if (is_side(i))
    {
      state.grains.mass[i] *= 0.5;
      state.grains.inertia[i] *= 0.5;
    }
  state.joints.begin_group(law, 0, "grains");
  for (const auto &[i, j] : discrete::pairs_within(state.grains, 1e-6, 0, 0))
  {
    state.joints.add(state.grains, i, j, 1., 1.);
    if (is_side(i) && is_side(j))
      state.joints.stiffness.back() *= 0.5;
  }
  state.joints.finish(state.grains.size());
  model.join_bonded(material, wave.h * height / 3.);
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    if (is_side(i))
      state.grains.inverse_inertia[i] = 0.;
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const double y = model.mesh_place(dof).y;
    if (model.solid->component(dof) == 1 && (y < 1e-9 || y > height - 1e-9))
      model.mesh->prescribe(dof, -1);
  }
  return reflected_amplitude(model, packet, begin + 0.75, c, length + 2. * wave.w());
}

double shown(const char *what, const Wave &wave, const double amplitude)
{
  std::printf("  %s, h = %g d, w = %g cells, %s, n = %g: %.3f %%\n", what, wave.h,
              wave.cells, wave.cubic ? "cubic" : "linear", wave.n, 100. * amplitude);
  return amplitude;
}
double chain(const Wave &wave)
{
  return shown("chain", wave, chain_reflection(wave));
}
double lattice(const Wave &wave)
{
  return shown("lattice", wave, lattice_reflection(wave));
}
} // namespace

// Thresholds are about twice what was measured when the formulation was chosen; the lower
// bounds show that the measure sees something.
TEST(ChainReflection, IsBelowTwoPercentWithFourCells)
{
  for (const bool cubic : {false, true})
    for (const double n : {8., 12.})
    {
      const double amplitude = chain({n, 2., 4., cubic});
      EXPECT_LE(amplitude, 0.02);
      EXPECT_GE(amplitude, 1e-5);
    }
}

namespace
{
/// The static mismatch of the patch test reflects a little of any wave: less than a fifth
/// of the least that was found when the formulation was chosen, 0.28 %, is no reflection
/// that was measured.
void expect_reflected(const double amplitude, const double most)
{
  EXPECT_LE(amplitude, most);
  EXPECT_GE(amplitude, 0.2 * 0.0028);
}
} // namespace

TEST(ChainReflection, FallsFurtherWithEightCells)
{
  for (const double n : {6., 8.})
  {
    expect_reflected(chain({n, 2., 8., false}), 0.012);
    expect_reflected(chain({n, 2., 8., true}), 0.006);
  }
  expect_reflected(chain({6., 4., 8., false}), 0.012);
  expect_reflected(chain({6., 4., 8., true}), 0.006);
}

TEST(ChainReflection, OfUnresolvedWavesIsLarge)
{
  // No demand, except that the mesh cannot carry what is shorter than pi h.
  chain({4., 2., 4., false});
  chain({4., 2., 4., true});
  EXPECT_GT(chain({3., 2., 4., false}), 0.3);
  EXPECT_GT(chain({2.5, 2., 4., false}), 0.9);
}

// The whole curve, from what the mesh cannot carry to the static mismatch of long waves.
TEST(ChainReflection, FollowsTheWavelengthLong)
{
  antiform::test::Figure figure("reflection",
                                "cells_per_wavelength,width_over_cell,cubic,amplitude");
  for (const double cells : {4., 8.})
    for (const bool cubic : {false, true})
      for (const double n : {2.5, 2.75, 3., 3.14, 3.25, 3.5, 3.75, 4., 4.5, 5., 6., 7.,
                             8., 10., 12., 16., 20.})
      {
        const double amplitude = chain({n, 2., cells, cubic});
        figure.add({n, cells, cubic ? 1. : 0., amplitude});
        // The mesh's highest frequency, 2 c / h, is the chain's at n = 3; the packet's
        // frequencies scatter by 6 %.
        if (n < 2.6)
        {
          EXPECT_NEAR(amplitude, 1., 0.02);
        }
        if (n >= 6. && cells == 8.)
        {
          EXPECT_LE(amplitude, cubic ? 0.006 : 0.012);
        }
        if (n >= 8.)
        {
          EXPECT_LE(amplitude, 0.02);
        }
        EXPECT_GE(amplitude, 1e-5);
      }
}

namespace
{
// Long waves do not see the overlap's width of 4 d: r = (Z2 - Z1) / (Z2 + Z1) with Z^2 in
// proportion to the modulus. The overlap is a gradual step, which reflects less by
// (k w)^2 / 6 at most, 0.4 % at a wavelength of 160 d.
void expect_sharp_joint(const double mesh_modulus_ratio)
{
  const double r = chain_reflection({80., 2., 2., false}, mesh_modulus_ratio);
  std::printf("  modulus of the mesh times %g: reflected amplitude %.5f\n",
              mesh_modulus_ratio, r);
  EXPECT_NEAR(r, 1. / 3., 0.01 / 3.);
}
} // namespace

TEST(ChainReflection, OfAnImpedanceStepIsThatOfASharpJoint)
{
  expect_sharp_joint(0.25);
}

TEST(ChainReflection, OfAStepToAStifferMeshIsThatOfASharpJointLong)
{
  expect_sharp_joint(4.);
}

TEST(LatticeReflection, IsBelowTwoPercentWithFourCells)
{
  for (const bool cubic : {false, true})
    for (const double n : {8., 12.})
    {
      const double amplitude = lattice({n, 2., 4., cubic});
      EXPECT_LE(amplitude, 0.02);
      EXPECT_GE(amplitude, 1e-5);
    }
}

TEST(LatticeReflection, FollowsTheWavelengthLong)
{
  antiform::test::Figure figure("reflection_lattice",
                                "cells_per_wavelength,width_over_cell,cubic,amplitude");
  for (const double cells : {4., 8.})
    for (const bool cubic : {false, true})
      for (const double n : {3., 3.5, 4., 5., 6., 8., 12.})
      {
        const double amplitude = lattice({n, 2., cells, cubic});
        figure.add({n, cells, cubic ? 1. : 0., amplitude});
        if (n >= 8.)
        {
          EXPECT_LE(amplitude, 0.02);
        }
        EXPECT_GE(amplitude, 1e-5);
      }
}

TEST(LatticeReflection, FallsFurtherWithEightCells)
{
  for (const double n : {6., 8.})
  {
    expect_reflected(lattice({n, 2., 8., false}), 0.015);
    expect_reflected(lattice({n, 2., 8., true}), 0.005);
  }
}
} // namespace antiform::coupling::test::reflection_tests

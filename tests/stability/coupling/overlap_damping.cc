// Damping in the overlap: takes the waves that the mesh cannot carry and leaves the
// others.
#include "support/chain_fixture.h"
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::coupling::test::overlap_damping_tests
{
namespace
{
struct Passage
{
  double lost = 0.;    ///< energy damped over that of the packet
  double closure = 0.; ///< largest error of the ledger over that energy
  double left = 0.;    ///< energy of the model at the end over that of the packet
};

/// The packet is driven into the chains, which are held at their end from then on, and
/// reaches the overlap once.
Passage passage(const Wave &wave, const double rate_factor)
{
  Bridged model;
  const Chain chain = make_chain(model, wave);
  const std::vector<std::size_t> driven = hold_end(model, chain.begin + 0.5);
  model.factorise();
  const double dt = 0.8 * model.stable_step();
  Loop::Options options;
  options.overlap_damping = rate_factor * chain.speed; // d = 1
  Loop run(model, dt, options);
  drive(run, model, driven, chain.packet);
  Passage result;
  double energy = 0.;
  const double begin = chain.packet.duration(),
               // group velocity c cos(k / 2)
      end = begin + (chain.length + 2. * wave.w()) / chain.speed /
                        std::cos(M_PI / wave.wavelength());
  run.probe(50,
            [&](const Clock &clock)
            {
              if (clock.time < begin)
                return;
              const Energies e = run.simulation.energies();
              const double stored = e.kinetic + e.strain_grains + e.strain_continuum;
              if (energy == 0.)
                energy = stored + e.damping;
              result.lost = e.damping / energy;
              result.left = stored / energy;
              result.closure =
                  std::max(result.closure, std::abs((stored + e.damping) / energy - 1.));
            });
  run.advance(static_cast<std::int64_t>(end / dt) + 1);
  std::printf("  n = %g, rate %g c/d: %.3f %% damped, ledger closes to %.1e\n", wave.n,
              rate_factor, 100. * result.lost, result.closure);
  return result;
}
} // namespace

TEST(OverlapDamping, TakesWhatTheMeshCannotCarry)
{
  // Shorter than pi h (n = 3.1) a wave comes back from the overlap. What it leaves there
  // is its part that the mesh does not follow: little near the limit, most of it far
  // below. A motion without any share of the mesh for the time 2 w / c = 16 d/c of a
  // passage would lose 1 - exp(-0.05 16) = 55 %, and shorter waves are slower.
  const Passage at_limit = passage({3., 2., 4., false}, 0.05),
                below = passage({2., 2., 4., false}, 0.05),
                far_below = passage({1.5, 2., 4., false}, 0.05);
  EXPECT_GE(at_limit.lost, 0.005);
  EXPECT_GE(below.lost, 0.2);
  EXPECT_GE(far_below.lost, 0.5);
  for (const Passage &p : {at_limit, below, far_below})
  {
    EXPECT_NEAR(p.left, 1. - p.lost, 1e-9);
    EXPECT_LE(p.closure, 1e-9); // the half-step ledger is exact on a linear model
  }
  const Passage free = passage({2., 2., 4., false}, 0.);
  EXPECT_EQ(free.lost, 0.);
  EXPECT_LE(free.closure, 1e-9);
}

TEST(OverlapDamping, LeavesLongWaves)
{
  for (const double n : {6., 8., 12., 24.})
  {
    const Passage damped = passage({n, 2., 4., false}, 0.05);
    EXPECT_LE(damped.lost, 0.01);
    EXPECT_GT(damped.lost, 0.);
    EXPECT_LE(damped.closure, 1e-9);
  }
}

TEST(OverlapDamping, KeepsMomentum)
{
  // A free lattice block full of noise.
  Bridged model;
  make_lattice_block(model, {});
  model.factorise();
  white_noise(model, 1e-9, 6);
  const auto momentum = [&]
  {
    Vec2 sum;
    const discrete::Grains &g = model.state.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      sum += (1. / g.inverse_mass[i]) * g.velocity(i);
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const double p = model.mesh->mass(dof) * model.mesh->velocity(dof);
      model.solid->component(dof) == 0 ? sum.x += p : sum.y += p;
    }
    return sum;
  };
  Loop::Options options;
  options.overlap_damping = 0.2;
  Loop run(model, 0.8 * model.stable_step(), options);
  run.probe(1, [](const Clock &) {}); // keeps what the energies need
  const Vec2 before = momentum();
  run.advance(300);
  const Vec2 after = momentum();
  EXPECT_NEAR(after.x, before.x, 1e-11 * norm(before));
  EXPECT_NEAR(after.y, before.y, 1e-11 * norm(before));
  EXPECT_GT(run.simulation.energies().damping, 0.);
}

TEST(OverlapDamping, RefusesANegativeRate)
{
  Bridged model;
  make_lattice_block(model, {});
  EXPECT_THROW(OverlapDamping(*model.domain, *model.solid, model.state, *model.mesh, -1.),
               std::invalid_argument);
}
} // namespace antiform::coupling::test::overlap_damping_tests

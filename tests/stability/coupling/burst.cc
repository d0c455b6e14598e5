// A brittle burst in the core of a bridged model: a stretched rock on the verge, in which
// a few weak bonds give way.
#include "support/breaking_loop.h"
#include "support/coupling_loop.h"
#include "support/lattice_patch.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::burst_tests
{
namespace
{
constexpr double strain = 1e-3; // of the joints; E* is 1, so their stress as well

struct Burst
{
  std::size_t elements = 0, cracks = 0; ///< all, and broken in the end
  std::size_t fastest = 0;              ///< in any 100 steps of the longer step
  double closure = 0.;                  ///< error of the ledger
  double gap = 0.;                      ///< displacement gap over largest displacement
  double released = 0.;                 ///< of the first elastic energy
  double fastest_grain = 0.;            ///< largest speed at a sample [d/s]
  bool finite = true;
};

/// The core, stretched alike in all directions, carries 1/1.1 to 1 of its strength but
/// for its middle, which carries more; held at the outer boundary of the mesh.
Burst burst(const double step, const std::int64_t n_steps, const std::size_t window)
{
  BlockShape shape;
  shape.core_x = shape.core_y = 32.;
  Bridged model;
  make_block_mesh(model, shape);
  const Rectangle box{-shape.w, shape.core_x + shape.w, -shape.w, shape.core_y + shape.w};
  model.state.grains = hexagonal_lattice(
      box, {0.137, 0.271}, [&](const Vec2 &x) { return model.weight.holds_grains(x); });
  discrete::Random random(7, 0);
  const Vec2 middle{0.5 * shape.core_x, 0.5 * shape.core_y};
  bond_with_core(
      model, brittle_law(strain),
      [&](const Vec2 &x) { return model.weight.distance_to_core(x) == 0.; },
      [&](const Vec2 &x)
      { return norm(x - middle) < 1.5 ? 0.9 : 1.01 + 0.1 * random.uniform(); });
  const FlatJoint law = elastic_law();
  model.join_bonded(lattice_material(law), shape.h * shape.h);
  set_displacement(model,
                   solve_patch(model, shape, {strain, strain, 0.}, model.domain.get()));
  const double out = shape.w + shape.rim - 1e-9;
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (x.x < -out || x.x > shape.core_x + out || x.y < -out || x.y > shape.core_y + out)
      model.mesh->prescribe(dof, -1);
  }
  model.factorise();

  Loop::Options options;
  options.damping = 0.1;
  Loop run(model, step * model.stable_step(), options);
  const Breakage breakage(run, model);
  Burst result;
  std::vector<std::size_t> count;
  run.add(std::make_unique<Every>(
              [&](const Clock &)
              {
                count.push_back(model.state.cracks.size());
                const std::size_t n = count.size();
                const std::size_t before = n > window ? count[n - 1 - window] : 0;
                result.fastest = std::max(result.fastest, count.back() - before);
              }),
          {Stage::sample}, 5, "count");
  Ledger ledger;
  double first = 0.;
  run.probe(10,
            [&](const Clock &)
            {
              const Energies e = run.simulation.energies();
              ledger.record(e);
              const double elastic = e.strain_grains + e.strain_continuum;
              first = std::max(first, elastic);
              result.released = 1. - elastic / first;
              const discrete::Grains &g = model.state.grains;
              for (std::size_t i = 0; i < g.size(); ++i)
                result.fastest_grain =
                    std::max(result.fastest_grain, norm(g.velocity(i)));
            });
  run.advance(n_steps + 1);
  for (const discrete::JointGroup &group : model.state.joints.groups)
    result.elements += (group.end - group.begin) * 3;
  result.cracks = model.state.cracks.size();
  result.closure = ledger.closure();
  result.finite = ledger.finite;
  result.gap =
      model.domain->displacement_gap(model.state.grains, model.mesh->displacement) /
      largest_displacement(model);
  return result;
}
} // namespace

TEST(BridgedBurst, KeepsItsEnergyAndDoesNotDependOnTheStep)
{
  const Burst coarse = burst(0.4, 2000, 100), fine = burst(0.2, 4000, 200);
  for (const Burst &b : {coarse, fine})
    std::printf("  cracks %zu of %zu elements, %zu in 100 steps; closure %.1e, gap %.1e, "
                "%.0f %% of the strain energy released, fastest grain %.1e\n",
                b.cracks, b.elements, b.fastest, b.closure, b.gap, 100. * b.released,
                b.fastest_grain);
  EXPECT_TRUE(coarse.finite && fine.finite);
  EXPECT_GE(coarse.fastest, coarse.elements / 20); // 5 % of all: it is a burst
  EXPECT_LT(coarse.cracks, coarse.elements / 2);   // and not dust
  for (const Burst &b : {coarse, fine})
  {
    EXPECT_LE(b.closure, 1e-3); // the limit of runs with breaks
    EXPECT_GT(b.released, 0.05);
    EXPECT_LE(b.gap, 1e-10); // the overlap's constraint holds through it
    // No cap on speeds: what is released bounds them, strain times wave speed, 1.3 here.
    EXPECT_LT(b.fastest_grain, 10. * strain);
    EXPECT_GT(b.fastest_grain, 0.1 * strain);
  }
  EXPECT_NEAR(static_cast<double>(fine.cracks) / static_cast<double>(coarse.cracks), 1.,
              0.1);
}
} // namespace antiform::coupling::test::burst_tests

// Hard cases of grains and mesh in one loop: parts that lose all their joints, walls that
// turn round, layers of very different stiffness, an overlap one cell wide.
#include "support/breaking_loop.h"
#include "support/column_fixture.h"
#include "support/coupling_loop.h"
#include "support/lattice_patch.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::hard_bridges_tests
{
namespace
{
constexpr double strain = 1e-4; // of the joints; E* is 1, so their stress as well

struct Parted
{
  std::size_t cracks = 0, joints = 0; ///< elements broken, joints around the cluster
  double closure = 0.;                ///< error of the ledger
  double gap = 0.;                    ///< displacement gap over largest displacement
  double momentum = 0.;               ///< its change over sum of |m v|
  double moved = 0.; ///< of the cluster against its surroundings, over its stretch
  bool finite = true;
};

/// A free block, stretched alike in all directions, whose grains within @p radius of
/// @p place break away from all others in the first step.
Parted part(const Vec2 &place, const double radius, const double damping)
{
  BlockShape shape;
  shape.rim = 4.;
  Bridged model;
  make_block_mesh(model, shape);
  const Rectangle box{-shape.w, shape.core_x + shape.w, -shape.w, shape.core_y + shape.w};
  discrete::Grains &g = model.state.grains;
  g = hexagonal_lattice(box, {0.137, 0.271},
                        [&](const Vec2 &x) { return model.weight.holds_grains(x); });
  const auto inside = [&](const std::size_t i)
  { return norm(g.reference(i) - place) < radius; };
  discrete::Joints &joints = model.state.joints;
  Parted result;
  const auto pairs = discrete::pairs_within(g, 1e-6, 0, 0);
  for (const bool weak : {true, false})
  {
    joints.begin_group(weak ? brittle_law(0.5 * strain) : elastic_law(), 0, "grains");
    for (const auto &[i, j] : pairs)
      if ((inside(i) != inside(j)) == weak)
        joints.add(g, i, j, 1., 1.);
    if (weak)
      result.joints = joints.size();
  }
  joints.finish(g.size());
  const FlatJoint law = elastic_law();
  model.join_bonded(lattice_material(law), shape.h * shape.h);
  set_displacement(model,
                   solve_patch(model, shape, {strain, strain, 0.}, model.domain.get()));
  model.factorise();
  Loop::Options options;
  options.damping = damping;
  Loop run(model, 0.5 * model.stable_step(), options);
  const Breakage breakage(run, model);
  Ledger ledger;
  run.probe(10, [&](const Clock &) { ledger.record(run.simulation.energies()); });
  run.advance(1001);

  Vec2 sum;
  double size = 0.;
  MeshState &m = *model.mesh;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    sum += (1. / g.inverse_mass[i]) * g.velocity(i);
    size += norm(g.velocity(i)) / g.inverse_mass[i];
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const double p = m.mass(dof) * m.velocity(dof);
    model.solid->component(dof) == 0 ? sum.x += p : sum.y += p;
    size += std::abs(p);
  }
  result.cracks = model.state.cracks.size();
  result.closure = ledger.closure();
  result.finite = ledger.finite;
  result.momentum = norm(sum) / size;
  result.gap =
      model.domain->displacement_gap(g, m.displacement) / largest_displacement(model);
  for (std::size_t i = 0; i < g.size(); ++i)
    if (inside(i))
      for (const auto &[a, b] : pairs)
        if (static_cast<std::size_t>(a) == i || static_cast<std::size_t>(b) == i)
          result.moved =
              std::max(result.moved, norm(g.position(a) - g.position(b)) -
                                         norm(g.reference(a) - g.reference(b)));
  result.moved /= strain;
  return result;
}
} // namespace

// In the middle of the core, at its rim, in the overlap and at the outer rim of that,
// where weights are least.
TEST(PartedGrains, LeaveTheLoopSound)
{
  struct Case
  {
    const char *what;
    Vec2 place;
    double radius; ///< 0.6: one grain; 1.6: seven, or what there is of them
    std::size_t n_joints;
    double damping;
  };
  for (const Case &c : {Case{"a grain of the core", {8.637, 8.065}, 0.6, 6, 0.},
                        {"a cluster of the core", {8.637, 8.065}, 1.6, 18, 0.},
                        {"a cluster at the core's rim", {15.637, 8.065}, 1.6, 18, 0.},
                        {"a grain of the overlap", {20.637, 8.065}, 0.6, 6, 0.},
                        {"a cluster of the overlap", {20.637, 8.065}, 1.6, 18, 0.},
                        {"a cluster at the outer rim", {22.637, 8.065}, 1.6, 13, 0.},
                        {"the same, damped", {22.637, 8.065}, 1.6, 13, 0.7}})
  {
    const Parted p = part(c.place, c.radius, c.damping);
    std::printf("  %s: %zu joints, %zu cracks; closure %.1e, gap %.1e, momentum %.1e, "
                "opened %.2f\n",
                c.what, p.joints, p.cracks, p.closure, p.gap, p.momentum, p.moved);
    EXPECT_TRUE(p.finite);
    EXPECT_EQ(p.cracks, 3 * p.joints); // of three elements each
    EXPECT_EQ(p.joints, c.n_joints);
    EXPECT_LE(p.closure, 1e-3); // the limit of runs with breaks
    EXPECT_LE(p.gap, 1e-10);
    if (c.damping == 0.)
    {
      EXPECT_LE(p.momentum, 1e-10); // local damping does not keep it
      EXPECT_GT(p.moved, 1.);       // free: its joints do not hold it at their stretch
    }
  }
}

namespace
{
struct Turn
{
  double pulled = 0., pressed = 0., last = 0.; ///< reactions over stiffness times way
  double error = 0.;                           ///< largest from stiffness times closure
  double closure = 0.;                         ///< error of the ledger
  std::size_t cracks = 0, crossing = 0;        ///< elements, of joints that may break
};

/// The end of a column is pulled by 1e-4 of its length, brought back, pressed as far and
/// brought back, as the cube of a sine of time.
Turn turn_round(const bool breaks, const double damping)
{
  Column column;
  Bridged &model = column.model;
  discrete::Joints &joints = model.state.joints;
  Turn result;
  const double distance = strain * (column.end - column.begin);
  if (breaks) // across one section of the core
  {
    joints.groups[0].law = brittle_law(0.3 * strain);
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const double a = model.state.grains.reference_x[joints.first[j]],
                   b = model.state.grains.reference_x[joints.second[j]];
      const bool crosses = std::min(a, b) < -7.1 && std::max(a, b) > -7.1;
      joints.tension_factor.push_back(crosses ? 1. : 1e6);
      joints.cohesion_factor.push_back(crosses ? 1. : 1e6);
      result.crossing += crosses ? 1 : 0;
    }
  }
  column.support(0., false);
  column.equilibrate(distance);
  const double stiffness = -column.pressing_force() / distance;
  column.equilibrate(0.);
  const double period = 12000.; // lowest axial one: 60, opened as well
  Loop::Options options;
  options.damping = damping;
  options.wall_speed = [=](const double t)
  {
    const double s = 2. * M_PI * t / period;
    return t < period
               ? -distance * 6. * M_PI / period * std::pow(std::sin(s), 2) * std::cos(s)
               : 0.;
  };
  const double dt = 0.8 * model.stable_step();
  Loop run(model, dt, options);
  const Breakage breakage(run, model);
  Ledger ledger;
  double least = 0., most = 0.;
  run.probe(20,
            [&](const Clock &)
            {
              const double closure = run.walls().closure(),
                           force = run.walls().mesh_reaction(),
                           share = force / (stiffness * distance);
              ledger.record(run.simulation.energies());
              result.error = std::max(result.error, std::abs(share - closure / distance));
              if (closure < least)
                result.pulled = share;
              if (closure > most)
                result.pressed = share;
              least = std::min(least, closure);
              most = std::max(most, closure);
              result.last = share;
            });
  run.advance(20 * static_cast<std::int64_t>(1.05 * period / dt / 20.) + 1);
  result.closure = ledger.closure();
  result.cracks = model.state.cracks.size();
  std::printf(
      "  %s, damping %g: pulled %.5f, pressed %.5f, at the end %.1e, largest error "
      "%.1e, closure %.1e, %zu cracks of %zu joints\n",
      breaks ? "breaks" : "elastic", damping, result.pulled, result.pressed, result.last,
      result.error, result.closure, result.cracks, result.crossing);
  return result;
}
} // namespace

TEST(WallReversal, OfAnElasticColumnRetracesItsLine)
{
  const Turn turn = turn_round(false, 0.);
  // Joints turn by the strain, which changes stiffness by 1e-4; slow, not static: 1e-4.
  EXPECT_NEAR(turn.pulled, -1., 1e-3);
  EXPECT_NEAR(turn.pressed, 1., 1e-3);
  EXPECT_LE(turn.error, 1e-3);
  EXPECT_LE(std::abs(turn.last), 1e-3);
  EXPECT_LE(turn.closure, 1e-5); // the limit of undamped runs without breaks
}

TEST(WallReversal, OpensACrackAndClosesItAgain)
{
  const Turn turn = turn_round(true, 0.7);
  EXPECT_EQ(turn.cracks, 3 * turn.crossing);
  EXPECT_NEAR(turn.pulled, 0., 1e-3); // parted
  // Closed faces are as stiff as they were, and their friction holds what shear they get.
  EXPECT_NEAR(turn.pressed, 1., 1e-2);
  EXPECT_LE(std::abs(turn.last), 1e-2);
  EXPECT_LE(turn.closure, 1e-3); // the limit of runs with breaks
}

namespace
{
/// Largest step at which no grain is made heavier.
double largest_grain_step(const Bridged &model)
{
  const auto sums =
      discrete::stiffness_sums(model.state.grains, model.state.joints, false);
  double step = 0.;
  for (std::size_t i = 0; i < sums.translation.size(); ++i)
    step = std::max(step, std::sqrt(model.state.grains.mass[i] / sums.translation[i]));
  return step;
}

/// A column whose grains left of x = -4 d are ten thousand times as stiff as the rest.
void stiffen(Column &column)
{
  discrete::Joints &joints = column.model.state.joints;
  const discrete::Grains &g = column.model.state.grains;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (std::max(g.reference_x[joints.first[j]], g.reference_x[joints.second[j]]) < -4.)
      joints.stiffness[j] *= 1e4;
}
} // namespace

TEST(ContrastOfTenThousand, RelaxesToTheStaticSolution)
{
  Column column;
  stiffen(column);
  Bridged &model = column.model;
  const double dt0 = largest_grain_step(model), force = 1e-8;
  column.support(dt0, true);
  StaticSystem system = column.static_system(true, 0.);
  continuum::Vector load = model.solid->make_vector();
  for (const unsigned int dof : column.end_dofs)
  {
    load(dof) = force / static_cast<double>(column.end_dofs.size());
    system.add_mesh_force(dof, load(dof));
  }
  const StaticSolution wanted = system.solve();
  Loop::Options options;
  options.damping = 0.7;
  // Masses scaled for the soft grains: the stiff ones need no smaller step.
  EXPECT_GE(model.stable_step(), 0.8 * dt0);
  Loop run(model, 0.8 * model.stable_step(), options);
  run.add(std::make_unique<MeshLoads>(*model.mesh, load), {Stage::forces}, 60, "pull");
  run.probe(100, [](const Clock &) {});
  run.advance(1);
  do
    run.advance(100);
  while (run.unbalanced_ratio() > 1e-12 && run.simulation.clock().step < 100000);
  const double gap =
      model.domain->displacement_gap(model.state.grains, model.mesh->displacement) /
      largest_displacement(model);
  double worst = 0.;
  for (std::size_t i = 0; i < model.state.grains.size(); ++i)
    worst =
        std::max(worst, std::abs(model.state.grains.displacement_x[i] - wanted.ux[i]));
  continuum::Vector difference = model.mesh->displacement;
  difference -= wanted.mesh;
  worst = std::max(worst, difference.linfty_norm()) / wanted.mesh.linfty_norm();
  std::printf(
      "  contrast 1e4: %ld steps to a ratio of %.1e; displacement error %.1e, gap "
      "%.1e, residual of the static solution %.1e\n",
      static_cast<long>(run.simulation.clock().step), run.unbalanced_ratio(), worst, gap,
      wanted.residual);
  EXPECT_LE(run.unbalanced_ratio(), 1e-12);
  EXPECT_LE(worst, 1e-7);
  EXPECT_LE(gap, 1e-8);
  EXPECT_LE(wanted.residual, 1e-8);
}

namespace
{
/// Energy and gap of white noise in 10,000 steps at 0.99 of the stable step.
void expect_bounded_noise(Bridged &model, const char *what)
{
  white_noise(model, 1e-9, 8);
  Loop run(model, 0.99 * model.stable_step(), {});
  double first = 0., drift = 0.;
  run.probe(100,
            [&](const Clock &)
            {
              const Energies e = run.simulation.energies();
              const double energy = e.kinetic + e.strain_grains + e.strain_continuum;
              if (first == 0.)
                first = energy;
              drift = std::max(drift, std::abs(energy / first - 1.));
            });
  run.advance(10001);
  const double gap =
      model.domain->displacement_gap(model.state.grains, model.mesh->displacement) /
      largest_displacement(model);
  std::printf("  %s: energy drift %.1e, gap %.1e, grains' step over uncoupled %.4f\n",
              what, drift, gap, model.grain_step() / model.uncoupled_grain_step());
  EXPECT_LE(drift, 5e-4);
  EXPECT_LE(gap, 1e-10);
  EXPECT_GE(model.grain_step() / model.uncoupled_grain_step(), 0.99);
}
} // namespace

TEST(ContrastOfTenThousand, KeepsItsEnergy)
{
  Column column;
  stiffen(column);
  column.support(0., true);
  expect_bounded_noise(column.model, "contrast 1e4");
}

TEST(OneCellOfOverlap, KeepsItsEnergy)
{
  for (const bool cubic : {false, true})
  {
    BlockShape shape;
    shape.w = 2.;
    shape.rim = 4.;
    shape.cubic = cubic;
    Bridged model;
    make_lattice_block(model, shape);
    model.factorise();
    expect_bounded_noise(model, cubic ? "one cell, cubic" : "one cell, linear");
  }
}
} // namespace antiform::coupling::test::hard_bridges_tests

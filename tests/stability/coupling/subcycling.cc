// Mesh forces every n steps of the grains: result, energy and what is refused.
#include "support/chain_fixture.h"
#include "support/coupling_loop.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::coupling::test::subcycling_tests
{
namespace
{
// Cells of 16 d: the mesh's step is then far above the grains', and the rule leaves room.
const Wave wave{10., 16., 4., true};

struct Result
{
  continuum::Vector mesh; ///< displacement at the end
  double input = 0.;      ///< energy of the packet [J]
  double growth = -1e9;   ///< of stored and spent energy over it, largest
  double gap = 0.;        ///< displacement gap over the largest displacement
  double ratio = 0.;      ///< stable step of the mesh over the step
  std::int64_t interval = 1;
};

/// Every @p interval -th step; 0: as seldom as the rule allows.
Result run_packet(std::int64_t interval, const double rate_factor)
{
  Bridged model;
  const Chain chain = make_chain(model, wave, 16.);
  const std::vector<std::size_t> driven = hold_end(model, chain.begin + 0.5);
  model.factorise();
  const double dt = 0.8 * model.grain_step();
  Result result;
  result.ratio = model.mesh_step() / dt;
  if (interval == 0)
    interval = static_cast<std::int64_t>(0.3 * result.ratio);
  result.interval = interval;
  Loop::Options options;
  options.interval = interval;
  options.overlap_damping = rate_factor * chain.speed;
  Loop run(model, dt, options);
  drive(run, model, driven, chain.packet);
  const double begin = chain.packet.duration();
  run.probe(60, // a multiple of every interval here
            [&](const Clock &clock)
            {
              if (clock.time < begin)
                return;
              const Energies e = run.simulation.energies();
              if (result.input == 0.)
                result.input = e.stored_and_spent();
              result.growth =
                  std::max(result.growth, e.stored_and_spent() / result.input - 1.);
            });
  // The packet's centre has just left the overlap.
  const double end = begin + (0.5 * chain.length + wave.w()) / chain.speed;
  run.advance(60 * static_cast<std::int64_t>(end / dt / 60.) + 1);
  result.mesh = model.mesh->displacement;
  result.gap =
      model.domain->displacement_gap(model.state.grains, model.mesh->displacement) /
      largest_displacement(model);
  return result;
}

double difference(const Result &one, const Result &two)
{
  continuum::Vector d = one.mesh;
  d -= two.mesh;
  return d.l2_norm() / two.mesh.l2_norm();
}

/// A free block with a pulse in it, at a step so small that an interval of 10 obeys the
/// rule: masses on joints and cells that oscillate against each other.
struct Oscillation
{
  std::vector<double> displacement; ///< of all grains along x
  double momentum_change = 0.;      ///< over the momentum
  double growth = 0., loss = 0.;    ///< of stored energy between samples, over the first
};
Oscillation oscillate(const std::int64_t interval)
{
  Bridged model;
  BlockShape shape;
  shape.core_x = shape.core_y = 8.;
  shape.rim = 4.;
  make_lattice_block(model, shape);
  model.factorise();
  discrete::Grains &g = model.state.grains;
  MeshState &m = *model.mesh;
  const auto speed = [&](const Vec2 &x)
  {
    const double r = norm(x - Vec2{8., 4.});
    return 1e-9 * std::exp(-0.5 * r * r / 25.);
  };
  for (std::size_t i = 0; i < g.size(); ++i)
    g.velocity_x[i] = speed(g.reference(i));
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    if (model.solid->component(dof) == 0)
      m.velocity(dof) = speed(model.mesh_place(dof));
  model.domain->project(g, m.velocity);
  const auto momentum = [&]
  {
    double sum = 0.;
    for (std::size_t i = 0; i < g.size(); ++i)
      sum += g.velocity_x[i] / g.inverse_mass[i];
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
      sum += model.solid->component(dof) == 0 ? m.mass(dof) * m.velocity(dof) : 0.;
    return sum;
  };
  const double before = momentum(), dt = 0.029 * model.mesh_step();
  Loop::Options options;
  options.interval = interval;
  options.overlap_damping = 0.05;
  Loop run(model, dt, options);
  Oscillation result;
  double first = 0., last = 0.;
  run.probe(20,
            [&](const Clock &)
            {
              const Energies e = run.simulation.energies();
              const double stored = e.kinetic + e.strain_grains + e.strain_continuum;
              if (first == 0.)
                first = last = stored;
              result.growth = std::max(result.growth, (stored - last) / first);
              last = stored;
              result.loss = 1. - stored / first;
            });
  // A passage of the block and back.
  run.advance(20 * static_cast<std::int64_t>(60. / dt / 20.) + 1);
  result.momentum_change = std::abs(momentum() / before - 1.);
  result.displacement = g.displacement_x;
  return result;
}

/// Adds energy that nothing has put in.
class Source : public Component
{
public:
  explicit Source(const double a_step)
      : a_step_(a_step)
  {
  }
  void run(Stage, const Clock &) override { ++n_; }
  void add_energies(Energies &e) const override { e.kinetic += 1. + a_step_ * n_; }

private:
  double a_step_;
  int n_ = 0;
};
} // namespace

TEST(Subcycling, GivesTheResultOfEveryStep)
{
  const Result every = run_packet(1, 0.05), seldom = run_packet(0, 0.05);
  const double error = difference(seldom, every);
  std::printf("  every %lld steps, mesh step / step %.2f: difference %.2e, growth %.1e, "
              "gap %.1e\n",
              static_cast<long long>(seldom.interval), seldom.ratio, error, seldom.growth,
              seldom.gap);
  // The error is that of leapfrog, (omega n dt)^2 / 24 a radian: n^2 - 1 against n = 1.
  const Result twice = run_packet(2, 0.05);
  const double n = static_cast<double>(seldom.interval);
  EXPECT_NEAR(error / difference(twice, every) / ((n * n - 1.) / 3.), 1., 0.3);
  EXPECT_GE(n, 3.);
  EXPECT_LE(error, 0.01);
  EXPECT_LE(seldom.growth, 1e-3);
  EXPECT_LE(seldom.gap, 1e-10); // the constraint is obeyed in every step
}

TEST(Subcycling, OscillationKeepsItsMomentumAndGainsNoEnergy)
{
  const Oscillation every = oscillate(1);
  for (const std::int64_t interval : {1, 2, 10})
  {
    const Oscillation seldom = oscillate(interval);
    double square = 0., reference = 0.;
    for (std::size_t i = 0; i < every.displacement.size(); ++i)
    {
      square += std::pow(seldom.displacement[i] - every.displacement[i], 2);
      reference += std::pow(every.displacement[i], 2);
    }
    const double difference = std::sqrt(square / reference);
    std::printf("  every %lld steps: difference %.1e, momentum %.1e, growth %.1e, loss "
                "%.2e\n",
                static_cast<long long>(interval), difference, seldom.momentum_change,
                seldom.growth, seldom.loss);
    EXPECT_LE(difference, 0.01);
    EXPECT_LE(seldom.momentum_change, 1e-11); // round-off of the steps
    // Between impulses the ledger is exact to second order in n dt only.
    EXPECT_LE(seldom.growth, 1e-4);
    EXPECT_GT(seldom.loss, 0.);
  }
}

TEST(Subcycling, RefusesBeyondTheRuleAndNamesTheRemedy)
{
  Bridged model;
  make_chain(model, wave, 16.);
  model.factorise();
  const double dt = 0.8 * model.grain_step();
  const auto possible = static_cast<std::int64_t>(0.3 * model.mesh_step() / dt);
  EXPECT_NO_THROW(
      SubcycledMesh(*model.mesh, model.walls, possible, dt, model.mesh_step()));
  EXPECT_NO_THROW(SubcycledMesh(*model.mesh, model.walls, 1, dt, 0.9 * dt));
  try
  {
    SubcycledMesh(*model.mesh, model.walls, possible + 1, dt, model.mesh_step());
    FAIL() << "accepted";
  }
  catch (const NumericalError &error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("Take an interval of " + std::to_string(possible) + " or less"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("Matrix / Cell size ratio"), std::string::npos) << text;
    EXPECT_NEAR(error.value, static_cast<double>(possible + 1) * dt / model.mesh_step(),
                1e-12);
    EXPECT_EQ(error.limit, 0.3);
  }
  EXPECT_THROW(SubcycledMesh(*model.mesh, model.walls, 0, dt, model.mesh_step()),
               std::invalid_argument);
}

TEST(EnergyWatch, RefusesGrowthAndLetsTheRestPass)
{
  for (const double a_step : {0., -1e-3, 1e-3})
  {
    Simulation simulation(1.);
    simulation.add(std::make_unique<Source>(a_step), {Stage::forces}, 0, "source", "");
    auto &watch = simulation.add(std::make_unique<EnergyWatch>(simulation, 0.05),
                                 {Stage::sample}, 0, "watch", "");
    simulation.set_sampler([](const Clock &) { return true; });
    int steps = 0;
    try
    {
      for (; steps < 100; ++steps)
        simulation.step();
    }
    catch (const NumericalError &error)
    {
      EXPECT_GT(error.value, 0.05);
      EXPECT_EQ(error.step, steps);
    }
    // Growth of 0.05 relative to the largest, 1 + 1e-3 n, is passed after 54 steps.
    EXPECT_EQ(steps, a_step > 0. ? 53 : 100);
    EXPECT_EQ(watch.growth() > 0.05, a_step > 0.);
  }
}
} // namespace antiform::coupling::test::subcycling_tests

// A beam of grains, overlap and mesh that is forced at its lowest frequency: undamped it
// swings up at the rate of an oscillator of its modal mass, damped it stays bounded.
#include "support/column_fixture.h"
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::coupling::test::resonance_tests
{
namespace
{
/// Displacements, or masses, of all degrees of freedom: grains (x, y, rotation), mesh.
using Field = std::vector<double>;

struct Beam
{
  Column column;
  Field mass;           ///< inertial; 0 where held
  Field mode;           ///< the lowest, largest displacement of the mesh 1
  double omega;         ///< its angular frequency
  double modal;         ///< its mass, mode . M mode
  double residual = 0.; ///< of the mode

  Beam()
  {
    column.support(0., true);
    const discrete::Grains &g = column.model.state.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      for (const double inverse :
           {g.inverse_mass[i], g.inverse_mass[i], g.inverse_inertia[i]})
        mass.push_back(inverse > 0. ? 1. / inverse : 0.);
    for (unsigned int dof = 0; dof < column.model.n_mesh_dofs(); ++dof)
      mass.push_back(column.model.mesh->mass(dof));
    iterate();
  }

  double product(const Field &a, const Field &b) const
  {
    double sum = 0.;
    for (std::size_t k = 0; k < mass.size(); ++k)
      sum += a[k] * mass[k] * b[k];
    return sum;
  }

  /// Answer to the forces M @p field, constraint and supports kept.
  Field solve(const Field &field) const
  {
    StaticSystem system = column.static_system(true, 0.);
    const std::size_t n_grains = column.model.state.grains.size();
    for (std::size_t k = 0; k < mass.size(); ++k)
      if (mass[k] > 0. && k < 3 * n_grains)
        system.add_grain_force(k / 3, static_cast<unsigned int>(k % 3),
                               mass[k] * field[k]);
      else if (mass[k] > 0.)
        system.add_mesh_force(k - 3 * n_grains, mass[k] * field[k]);
    const StaticSolution u = system.solve();
    Field values;
    for (std::size_t i = 0; i < n_grains; ++i)
      values.insert(values.end(), {u.ux[i], u.uy[i], u.rotation[i]});
    values.insert(values.end(), u.mesh.begin(), u.mesh.end());
    return values;
  }

  /// Inverse iteration from a bent shape.
  void iterate()
  {
    const std::size_t n_grains = column.model.state.grains.size();
    mode.assign(mass.size(), 0.);
    for (std::size_t k = 3 * n_grains; k < mass.size(); ++k)
      mode[k] =
          column.model.solid->component(static_cast<unsigned int>(k - 3 * n_grains)) == 1
              ? 1.
              : 0.;
    for (int n = 0; n < 12; ++n)
    {
      const Field next = solve(mode);
      const double square = product(next, mode) / product(next, next);
      omega = std::sqrt(square);
      residual = 0.;
      double largest = 0.;
      for (std::size_t k = 0; k < mass.size(); ++k)
      {
        residual = std::max(residual, std::abs(square * next[k] - mode[k]));
        largest = std::max(largest, k < 3 * n_grains ? 0. : std::abs(next[k]));
      }
      mode = next;
      for (double &v : mode)
        v /= largest;
    }
    modal = product(mode, mode);
  }

  /// q = mode . M u / modal mass of the present displacements.
  double amplitude() const
  {
    const discrete::Grains &g = column.model.state.grains;
    Field u;
    for (std::size_t i = 0; i < g.size(); ++i)
      u.insert(u.end(), {g.displacement_x[i], g.displacement_y[i], g.rotation[i]});
    const continuum::Vector &mesh = column.model.mesh->displacement;
    u.insert(u.end(), mesh.begin(), mesh.end());
    return product(mode, u) / modal;
  }
};

constexpr double force = 1e-9; ///< amplitude of the modal force

/// The modal amplitude in time under force cos(omega t) along the mode, put on as M mode
/// everywhere, or at the free end alone.
struct Swing
{
  std::vector<double> time, amplitude;
};
Swing swing(Beam &beam, const double damping, const bool at_end, const double n_periods)
{
  Bridged &model = beam.column.model;
  const std::size_t n_grains = model.state.grains.size();
  Field load(beam.mass.size(), 0.);
  if (at_end)
  {
    double along = 0.; // of a unit force, the modal one
    std::vector<std::size_t> end;
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
      if (model.solid->component(dof) == 1 &&
          model.mesh_place(dof).x > beam.column.end - 1e-9)
      {
        end.push_back(3 * n_grains + dof);
        along += beam.mode[end.back()];
      }
    for (const std::size_t k : end)
      load[k] = force / along;
  }
  else
    for (std::size_t k = 0; k < load.size(); ++k)
      load[k] = force * beam.mass[k] * beam.mode[k] / beam.modal;

  Loop::Options options;
  options.damping = damping;
  const double dt = 0.8 * model.stable_step();
  Loop run(model, dt, options);
  run.add(std::make_unique<Every>(
              [&](const Clock &clock)
              {
                const double now = std::cos(beam.omega * clock.time);
                discrete::Grains &g = model.state.grains;
                for (std::size_t i = 0; i < n_grains; ++i)
                {
                  g.force_x[i] += now * load[3 * i];
                  g.force_y[i] += now * load[3 * i + 1];
                  g.torque[i] += now * load[3 * i + 2];
                }
                for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
                  model.mesh->force(dof) += now * load[3 * n_grains + dof];
              }),
          {Stage::forces}, 60, "force");
  Swing result;
  run.probe(10,
            [&](const Clock &clock)
            {
              result.time.push_back(clock.time);
              result.amplitude.push_back(beam.amplitude());
            });
  run.advance(static_cast<std::int64_t>(n_periods * 2. * M_PI / beam.omega / dt));
  return result;
}

/// Largest |amplitude| between two times.
double peak(const Swing &swing, const double from, const double to)
{
  double largest = 0.;
  for (std::size_t k = 0; k < swing.time.size(); ++k)
    if (swing.time[k] >= from && swing.time[k] < to)
      largest = std::max(largest, std::abs(swing.amplitude[k]));
  return largest;
}

/// The oscillator m q'' = r - alpha |r| sgn(q'), r = F cos(omega t) - m omega^2 q,
/// stepped finer than the beam: largest q in the last of @p n_periods.
double damped_oscillator(const Beam &beam, const double alpha, const int n_periods)
{
  const int n = 200000; // steps a period
  const double dt = 2. * M_PI / beam.omega / n, m = beam.modal;
  double q = 0., v = 0., largest = 0.;
  for (int step = 0; step < n_periods * n; ++step)
  {
    const double r =
        force * std::cos(beam.omega * step * dt) - m * beam.omega * beam.omega * q;
    const double d = v > 0. ? -alpha * std::abs(r) : v < 0. ? alpha * std::abs(r) : 0.;
    v += dt * (r + d) / m;
    q += dt * v;
    if (step >= (n_periods - 1) * n)
      largest = std::max(largest, std::abs(q));
  }
  return largest;
}
} // namespace

TEST(Resonance, GrowsAtTheRateOfAnOscillatorOfItsModalMass)
{
  Beam beam;
  EXPECT_LE(beam.residual, 1e-6);
  const Swing found = swing(beam, 0., true, 10.);
  // q = F t sin(omega t) / (2 m omega): peaks near the quarters of a period. The force at
  // the end excites all other modes as well, which the projection leaves out. Growth from
  // the third to the ninth period.
  const double period = 2. * M_PI / beam.omega;
  const double growth =
      (peak(found, 9. * period, 9.5 * period) - peak(found, 3. * period, 3.5 * period)) /
      (6. * period);
  const double wanted = force / (2. * beam.modal * beam.omega);
  std::printf("  period %.1f, modal mass %.2f, residual %.1e; growth %.5e, F / 2 m omega "
              "%.5e, ratio %.5f\n",
              period, beam.modal, beam.residual, growth, wanted, growth / wanted);
  // The step's own shift of the frequency, (omega dt)^2 / 24, is 1e-7.
  EXPECT_NEAR(growth / wanted, 1., 0.01);
}

TEST(Resonance, IsBoundedWithLocalDamping)
{
  Beam beam;
  const double alpha = 0.7, period = 2. * M_PI / beam.omega;
  const Swing found = swing(beam, alpha, false, 8.);
  const double sixth = peak(found, 5. * period, 6. * period),
               last = peak(found, 7. * period, 8. * period),
               wanted = damped_oscillator(beam, alpha, 8);
  // Without damping it would have been F 8 T / (2 m omega).
  const double undamped = force * 8. * period / (2. * beam.modal * beam.omega);
  std::printf("  amplitude in the sixth period %.5e, in the eighth %.5e, of the damped "
              "oscillator %.5e, undamped %.1e\n",
              sixth, last, wanted, undamped);
  EXPECT_NEAR(last / sixth, 1., 5e-3); // what the start leaves
  // The mode has one sign everywhere or none: damping of each degree of freedom is that
  // of the mode. The beam's own turns of velocity come some steps apart.
  EXPECT_NEAR(last / wanted, 1., 0.02);
  EXPECT_LT(last, 0.2 * undamped);
}
} // namespace antiform::coupling::test::resonance_tests

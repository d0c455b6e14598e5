// A bending wave runs along a beam of grains through the overlap into a beam of mesh.
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::coupling::test::bending_wave_tests
{
namespace
{
/// Energy among the grains over all of it, once the packet has gone into the mesh.
/// \param wavelength of the bending wave [d], from the theory of Timoshenko's beam
double reflected_energy(const double wavelength,
                        const bool cubic,
                        const double mesh_modulus_ratio = 1.)
{
  constexpr int n_rows = 12;
  const double height = n_rows * 0.5 * std::sqrt(3.);
  const FlatJoint law = elastic_law();
  const continuum::ElasticMaterial material = lattice_material(law);
  const auto &C = material.stiffness;
  const double E = C[0][0] - C[0][1] * C[0][1] / C[1][1], G = C[2][2] * 5. / 6.;
  const double rho = material.density, k = 2. * M_PI / wavelength,
               r2 = height * height / 12.;
  // Lower branch of (rho w^2 - G k^2)(rho r2 w^2 - E r2 k^2 - G) = G^2 k^2.
  const auto omega_of = [&](const double q)
  {
    const double a = rho * rho * r2,
                 b = -rho * (E * r2 * q * q + G) - rho * r2 * G * q * q,
                 c = G * q * q * E * r2 * q * q;
    return std::sqrt((-b - std::sqrt(b * b - 4. * a * c)) / (2. * a));
  };
  const double omega = omega_of(k),
               group = (omega_of(1.01 * k) - omega_of(0.99 * k)) / (0.02 * k);
  const double deviation = 2.5 * 2. * M_PI / omega, duration = 8. * deviation;
  const double length = std::floor(0.75 * group * duration);

  Bridged model;
  model.weight.distance_to_core = [](const Vec2 &x) { return std::max(0., x.x); };
  model.weight.width = 8.;
  model.weight.cubic = cubic;
  const int n_cells = static_cast<int>(std::ceil(1.5 * group * duration / 2.));
  make_cells(model.triangulation, lines(0., 2. * n_cells, n_cells), lines(0., height, 5),
             [](const Vec2 &) { return true; });
  model.state.grains = hexagonal_lattice({-length, 8., 0., height}, {-length + 0.19, 0.},
                                         [](const Vec2 &) { return true; });
  continuum::ElasticMaterial of_mesh = material;
  for (auto &row : of_mesh.stiffness)
    for (double &c : row)
      c *= mesh_modulus_ratio;
  model.join(law, 1e-6, of_mesh, 2. * height / 5.);
  discrete::Grains &g = model.state.grains;
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.reference_x[i] < -length + 0.75)
    {
      driven.push_back(i);
      model.hold_grain(i);
    }
  model.factorise();
  const double dt = 0.8 * model.stable_step();
  Loop run(model, dt, {});
  run.add(std::make_unique<Every>(
              [&](const Clock &clock)
              {
                const double s =
                    (clock.time + 0.5 * clock.dt - 4. * deviation) / deviation;
                const double v = s < 4. ? 1e-9 * std::exp(-0.5 * s * s) *
                                              std::sin(omega * s * deviation)
                                        : 0.;
                for (const std::size_t i : driven)
                  g.velocity_y[i] = v;
              }),
          {Stage::kick}, 51, "drive");
  discrete::GrainVelocities before;
  run.add(std::make_unique<Every>(
              [&](const Clock &clock)
              {
                if (clock.sample_due)
                  before = discrete::velocities(g);
              }),
          {Stage::kick}, 1, "velocities");
  // The centre starts at 4 deviations and is 4 of them beyond the overlap at the end.
  const double end = 4. * deviation + (length + 16.) / group + 4. * deviation;
  const auto n = static_cast<std::int64_t>(end / dt);
  double ratio = 0.;
  run.probe(n,
            [&](const Clock &clock)
            {
              if (clock.step == 0)
                return;
              const Energies e = run.simulation.energies();
              ratio = (discrete::kinetic_energy(g, before) + e.strain_grains) /
                      (e.kinetic + e.strain_grains + e.strain_continuum);
            });
  run.advance(n + 1);
  std::printf("  wavelength %g d, %s: group velocity %.3f, %.3f %% of the energy among "
              "the grains\n",
              wavelength, cubic ? "cubic" : "linear", group, 100. * ratio);
  return ratio;
}
} // namespace

// Waves longer than ten cells, 20 d; the beams, 12 rows high, differ by their outer rows,
// which have half the joints. More than 99 % of the energy is to pass.
TEST(BendingWave, PassesTheOverlapLong)
{
  for (const bool cubic : {false, true})
    for (const double wavelength : {24., 48.})
    {
      const double energy = reflected_energy(wavelength, cubic);
      EXPECT_LE(energy, 0.01);
      EXPECT_GE(energy, 1e-8);
    }
}

TEST(BendingWave, ComesBackFromASofterBeamLong)
{
  // Negative control of the measure: a sixteenth of the modulus, a wavelength of half.
  EXPECT_GE(reflected_energy(48., false, 1. / 16.), 0.02);
}
} // namespace antiform::coupling::test::bending_wave_tests

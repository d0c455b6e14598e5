#pragma once
// Chains of grains that end in a strip of mesh, and wave packets that run along them.
#include "support/coupling_loop.h"

namespace antiform::coupling::test
{
struct Wave
{
  double n = 8.;      ///< cells a wavelength
  double h = 2.;      ///< cell [d]
  double cells = 4.;  ///< of the overlap
  bool cubic = false; ///< ramp
  double wavelength() const { return n * h; }
  double w() const { return cells * h; }
};

/// Gaussian packet of standard deviation 2.5 periods, cut at 4 of them.
struct Packet
{
  double frequency; ///< angular [rad/s]
  double deviation() const { return 2.5 * 2. * M_PI / frequency; }
  double duration() const { return 8. * deviation(); }
  double velocity(const double t) const
  {
    const double s = (t - 4. * deviation()) / deviation();
    return t < duration()
               ? 1e-9 * std::exp(-0.5 * s * s) * std::sin(frequency * s * deviation())
               : 0.;
  }
};

/// Two equal chains without contact (one would leave the upper and the lower multipliers
/// of a cell alike) and a strip of one row of cells, of equal density and, times a ratio,
/// equal rigidity.
struct Chain
{
  Packet packet;
  double length; ///< that long waves run while the packet passes [d]
  double begin;  ///< of the grains; their first is 0.37 to its right [d]
  double speed;  ///< of long waves [d/s]
  std::int32_t n_cells;
};
inline Chain make_chain(Bridged &model,
                        const Wave &wave,
                        const double height = 4.,
                        const double mesh_modulus_ratio = 1.)
{
  constexpr double mass = 0.25 * M_PI;
  const double k = 2. * M_PI / wave.wavelength();
  const double c = std::sqrt(1. / mass); // of long waves; K_n = 1
  const Packet packet{2. * std::sqrt(1. / mass) * std::sin(0.5 * k)};
  const double length = c * packet.duration();
  model.weight.distance_to_core = [](const Vec2 &x) { return std::max(0., x.x); };
  model.weight.width = wave.w();
  model.weight.cubic = wave.cubic;
  const int n_cells = static_cast<int>(std::ceil(
      length * std::sqrt(std::max(1., mesh_modulus_ratio)) / wave.h + wave.cells));
  make_cells(model.triangulation, lines(0., n_cells * wave.h, n_cells),
             {-0.5 * height, 0.5 * height}, [](const Vec2 &) { return true; });
  for (const double y : {-0.25 * height, 0.25 * height})
    for (double x = 0.37 - std::floor(length); x <= wave.w(); x += 1.)
      model.state.grains.add({x, y}, 0.5, 1., 0);
  continuum::ElasticMaterial material;
  const double modulus =
      mesh_modulus_ratio * 2. / height; // two chains of rigidity K_n d = 1; nu = 0
  material.stiffness = {{{modulus, 0., 0.}, {0., modulus, 0.}, {0., 0., 0.5 * modulus}}};
  material.density = 2. * mass / height;
  model.join(elastic_law(), 1e-6, material, wave.h * height);
  return {packet, length, -std::floor(length), c, n_cells};
}

/// Hold the grains left of @p end, to be driven.
inline std::vector<std::size_t> hold_end(Bridged &model, const double end)
{
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < model.state.grains.size(); ++i)
    if (model.state.grains.reference_x[i] < end)
    {
      driven.push_back(i);
      model.hold_grain(i);
    }
  return driven;
}
inline void
drive(Loop &run, Bridged &model, std::vector<std::size_t> driven, Packet packet)
{
  run.add(std::make_unique<Every>(
              [&model, driven = std::move(driven), packet](const Clock &clock)
              {
                for (const std::size_t i : driven)
                  model.state.grains.velocity_x[i] =
                      packet.velocity(clock.time + 0.5 * clock.dt);
              }),
          {Stage::kick}, 51, "drive");
}
} // namespace antiform::coupling::test

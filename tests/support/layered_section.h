#pragma once
// A stiff bonded layer of the hexagonal lattice in a soft matrix of the same lattice,
// whole in grains, or with mesh where the layer is far. Unit of length is the grain
// diameter, of stress the modulus E* of the layer's grains.
#include "coupling/coupled_buckling.h"
#include "support/coupling_fixtures.h"

namespace antiform::coupling::test
{
/// Rows of grains count from the layer's middle, upwards.
struct LayerShape
{
  int half_rows = 2; ///< the layer has 2 half_rows + 1 rows
  int cover_rows = 5, base_rows = 60;
  int length = 100; ///< between walls, even
  double contrast = 20.;
  double buffer = 4., overlap = 8., cell = 2.; ///< of the coupled model
  bool cubic = false;
  double mesh_modulus_ratio = 1.; ///< of the mesh over its due [-]

  static double row() { return 0.5 * std::sqrt(3.); }
  double thickness() const { return (2. * half_rows + 1.) * row(); }
  double edge() const { return 0.5 * thickness(); }
  double top() const { return (half_rows + cover_rows + 0.5) * row(); } ///< free surface
  double bottom() const { return -(half_rows + base_rows) * row(); }    ///< the support
  /// Mesh above the layer too, where there is room for it.
  bool mesh_above() const { return top() > edge() + buffer + overlap + cell; }
  double core_top() const { return mesh_above() ? edge() + buffer : top(); }
  double core_bottom() const { return -edge() - buffer; }
};

class LayeredSection
{
public:
  LayeredSection(const LayerShape &shape, const bool coupled)
      : shape_(shape)
      , coupled_(coupled)
  {
    model_.weight.distance_to_core = [shape](const Vec2 &x) {
      return std::max({shape.core_bottom() - x.y, x.y - shape.core_top(), 0.});
    };
    model_.weight.width = shape.overlap;
    model_.weight.cubic = shape.cubic;
    add_grains();
    if (coupled)
      add_mesh();
  }

  std::size_t n_grains() const { return model_.state.grains.size(); }

  /// Lowest critical shortenings [-] and modes. The prestress is the linear state between
  /// smooth end walls on a smooth base.
  std::vector<CoupledMode> modes(const unsigned int n, const StrainMeasure measure) const
  {
    constexpr double strain = 1e-2;
    StaticSystem system = supported(strain);
    auto found = lowest_coupled_modes(
        system, geometric_stiffness(system, system.solve(), measure), {n});
    for (CoupledMode &mode : found)
      mode.load_factor *= strain;
    return found;
  }
  int n_unstable(const double strain, const StrainMeasure measure) const
  {
    StaticSystem system = supported(strain);
    return n_unstable_directions(system,
                                 geometric_stiffness(system, system.solve(), measure));
  }

  /// Half waves of the layer's middle row that have the largest amplitude, and that
  /// amplitude over the root of the sum of all squares.
  std::pair<int, double> half_waves(const CoupledMode &mode) const
  {
    const discrete::Grains &g = model_.state.grains;
    std::pair<int, double> largest{0, 0.};
    double squares = 0.;
    for (int m = 1; m < shape_.length / 4; ++m)
    {
      double amplitude = 0.;
      for (std::size_t i = 0; i < g.size(); ++i)
        if (std::abs(g.reference_y[i]) < 1e-6)
          amplitude +=
              mode.shape.uy[i] * std::cos(m * M_PI * g.reference_x[i] / shape_.length);
      squares += amplitude * amplitude;
      if (std::abs(amplitude) > largest.second)
        largest = {m, std::abs(amplitude)};
    }
    return {largest.first, largest.second / std::sqrt(squares)};
  }

private:
  void add_grains()
  {
    const double small = 1e-6;
    discrete::Grains lattice = hexagonal_lattice(
        {0., static_cast<double>(shape_.length), shape_.bottom(), shape_.top()}, {0., 0.},
        [this](const Vec2 &x) { return !coupled_ || model_.weight.holds_grains(x); });
    discrete::Grains &grains = model_.state.grains = std::move(lattice);
    for (std::size_t i = 0; i < grains.size(); ++i)
      grains.region[i] = std::abs(grains.reference_y[i]) < shape_.edge() ? 0 : 1;
    discrete::Joints &joints = model_.state.joints;
    joints.begin_group(elastic_law(), 0, "grains");
    const auto modulus = [&](const std::int32_t i) {
      return grains.region[static_cast<std::size_t>(i)] == 0 ? 1. : 1. / shape_.contrast;
    };
    for (const auto &[a, b] : {std::pair{0, 0}, std::pair{0, 1}, std::pair{1, 1}})
      for (const auto &[i, j] : discrete::pairs_within(grains, small, a, b))
        joints.add(grains, i, j, modulus(i), modulus(j));
    joints.finish(grains.size());
  }

  void add_mesh()
  {
    const auto between = [this](const double from, const double to)
    {
      return lines(from, to,
                   std::max(1, static_cast<int>(std::lround((to - from) / shape_.cell))));
    };
    std::vector<double> y = between(shape_.bottom(), shape_.core_bottom());
    if (shape_.mesh_above())
    {
      const std::vector<double> above = between(shape_.core_top(), shape_.top());
      y.insert(y.end(), above.begin(), above.end());
    }
    make_cells(model_.triangulation, between(0., shape_.length), y,
               [this](const Vec2 &centre)
               { return model_.weight.distance_to_core(centre) > 0.; });
    continuum::ElasticMaterial material = lattice_material(elastic_law());
    for (auto &row : material.stiffness)
      for (double &c : row)
        c *= shape_.mesh_modulus_ratio / shape_.contrast;
    model_.join_bonded(material, shape_.cell * shape_.cell);
  }

  StaticSystem supported(const double strain) const
  {
    const discrete::Grains &g = model_.state.grains;
    StaticSystem system(g, model_.state.joints, model_.solid.get(), model_.domain.get());
    const double L = shape_.length, bottom = shape_.bottom();
    const auto pushed = [=](const double x) { return -strain * (x - 0.5 * L); };
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const Vec2 x = g.reference(i);
      if (std::min(x.x, L - x.x) < 0.75) // the first of each row
        system.fix_grain(i, 0, pushed(x.x));
      if (x.y < bottom + 1e-6)
        system.fix_grain(i, 1, 0.);
    }
    for (std::size_t dof = 0; coupled_ && dof < model_.n_mesh_dofs(); ++dof)
    {
      const Vec2 x = model_.mesh_place(dof);
      const bool is_x = model_.solid->component(dof) == 0;
      if (is_x && std::min(x.x, L - x.x) < 1e-6)
        system.fix_mesh(dof, pushed(x.x));
      if (!is_x && x.y < bottom + 1e-6)
        system.fix_mesh(dof, 0.);
    }
    return system;
  }

  LayerShape shape_;
  bool coupled_;
  Bridged model_;
};
} // namespace antiform::coupling::test

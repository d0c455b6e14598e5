#pragma once
// A stiff bonded layer of the hexagonal lattice, or of a random packing, in a soft matrix
// of the same, whole in grains, or with mesh where the layer is far. Unit of length is
// the grain diameter, of stress the modulus E* of the layer's grains.
#include "coupling/coupled_buckling.h"
#include "support/coupling_fixtures.h"

#include "discrete/homogenise.h"
#include "discrete/packing.h"

namespace antiform::coupling::test
{
/// Rows of grains count from the layer's middle, upwards.
struct LayerShape
{
  double half_rows = 2.; ///< the layer has 2 half_rows + 1 rows, a whole number
  int cover_rows = 5, base_rows = 60;
  int length = 100; ///< between walls, even
  double contrast = 20.;
  double buffer = 4., overlap = 8., cell = 2.; ///< of the coupled model
  bool cubic = false;
  double mesh_modulus_ratio = 1.; ///< of the mesh over its due [-]

  static double row() { return 0.5 * std::sqrt(3.); }
  double n_rows() const { return 2. * half_rows + 1.; } ///< of the layer
  double thickness() const { return n_rows() * row(); }
  double edge() const { return 0.5 * thickness(); }
  double top() const { return (half_rows + cover_rows + 0.5) * row(); } ///< free surface
  double bottom() const { return -(half_rows + base_rows) * row(); }    ///< the support
  /// Mesh above the layer too, where there is room for it.
  bool mesh_above() const { return top() > edge() + buffer + overlap + cell; }
  double core_top() const { return mesh_above() ? edge() + buffer : top(); }
  double core_bottom() const { return -edge() - buffer; }
};

/// A random packing as large as a section, and what it answers to strain.
struct RandomRock
{
  static constexpr double installation_gap = 0.15;

  RandomRock(const LayerShape &shape, const std::uint64_t seed)
  {
    discrete::PackingParameters parameters;
    parameters.seed = seed;
    tile = discrete::pack_periodic(
        {static_cast<double>(shape.length), shape.top() - shape.bottom()}, parameters);
    response = discrete::homogenise(tile, installation_gap, elastic_law());
  }
  discrete::PeriodicTile tile;
  discrete::TileResponse response; ///< of the modulus 1
};

class LayeredSection
{
public:
  /// \param rock instead of the lattice; outlives the section
  LayeredSection(const LayerShape &shape,
                 const bool coupled,
                 const RandomRock *const rock = nullptr)
      : shape_(shape)
      , coupled_(coupled)
  {
    model_.weight.distance_to_core = [shape](const Vec2 &x) {
      return std::max({shape.core_bottom() - x.y, x.y - shape.core_top(), 0.});
    };
    model_.weight.width = shape.overlap;
    model_.weight.cubic = shape.cubic;
    if (rock == nullptr)
      add_lattice();
    else
      add_random_grains(*rock);
    if (coupled)
      add_mesh(rock == nullptr ? lattice_material(elastic_law()) : material_of(*rock));
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

  /// Of the present state after the linear shortening @p strain, by the joints' exact
  /// tangent. \param mesh_turns whether the mesh has a geometric stiffness; in runs it
  /// has none
  int n_unstable_now(const double strain, const bool mesh_turns)
  {
    StaticSystem system = supported(strain);
    const StaticSolution state = system.solve();
    discrete::Grains &g = model_.state.grains;
    g.displacement_x = state.ux;
    g.displacement_y = state.uy;
    g.rotation = state.rotation;
    return n_unstable_directions(
        system, present_geometric_stiffness(system, coupled_ && mesh_turns ? &state.mesh
                                                                           : nullptr));
  }

  /// Half waves of the layer's middle that have the largest amplitude, and that
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
        if (std::abs(g.reference_y[i]) < 0.45) // of the lattice one row, or two
          amplitude +=
              mode.shape.uy[i] * std::cos(m * M_PI * g.reference_x[i] / shape_.length);
      squares += amplitude * amplitude;
      if (std::abs(amplitude) > largest.second)
        largest = {m, std::abs(amplitude)};
    }
    return {largest.first, largest.second / std::sqrt(squares)};
  }

private:
  bool holds(const Vec2 &x) const { return !coupled_ || model_.weight.holds_grains(x); }
  double modulus(const std::size_t i) const
  {
    return model_.state.grains.region[i] == 0 ? 1. : 1. / shape_.contrast;
  }

  void add_lattice()
  {
    // Of an odd number of rows one is the layer's middle, of an even one none.
    const double middle = (shape_.half_rows - std::floor(shape_.half_rows)) * shape_.row();
    discrete::Grains lattice = hexagonal_lattice(
        {0., static_cast<double>(shape_.length), shape_.bottom(), shape_.top()},
        {0., middle}, [this](const Vec2 &x) { return holds(x); });
    discrete::Grains &grains = model_.state.grains = std::move(lattice);
    for (std::size_t i = 0; i < grains.size(); ++i)
      grains.region[i] = std::abs(grains.reference_y[i]) < shape_.edge() ? 0 : 1;
    discrete::Joints &joints = model_.state.joints;
    joints.begin_group(elastic_law(), 0, "grains");
    for (const auto &[a, b] : {std::pair{0, 0}, std::pair{0, 1}, std::pair{1, 1}})
      for (const auto &[i, j] : discrete::pairs_within(grains, 1e-6, a, b))
        joints.add(grains, i, j, modulus(static_cast<std::size_t>(i)),
                   modulus(static_cast<std::size_t>(j)));
    joints.finish(grains.size());
  }

  static continuum::ElasticMaterial material_of(const RandomRock &rock)
  {
    continuum::ElasticMaterial material;
    material.stiffness = rock.response.stiffness;
    material.density = rock.response.density_factor;
    return material;
  }

  /// The tile, cut open at its sides; grains that the cut leaves loose go.
  void add_random_grains(const RandomRock &rock)
  {
    const auto place = [&](const int i)
    {
      return rock.tile.disks[static_cast<std::size_t>(i)].centre +
             Vec2{0., shape_.bottom()};
    };
    std::vector<const discrete::TileJoint *> inside;
    std::vector<std::int32_t> number(rock.tile.disks.size(), -1);
    discrete::Grains &grains = model_.state.grains;
    for (const discrete::TileJoint &joint : rock.response.joints)
      if (norm(joint.shift) == 0. && holds(place(joint.first)) &&
          holds(place(joint.second)))
        inside.push_back(&joint);
    const auto number_of = [&](const int i)
    {
      std::int32_t &grain = number[static_cast<std::size_t>(i)];
      if (grain < 0)
      {
        grain = static_cast<std::int32_t>(grains.size());
        grains.add(place(i), rock.tile.disks[static_cast<std::size_t>(i)].radius, 1.,
                   std::abs(place(i).y) < shape_.edge() ? 0 : 1);
      }
      return grain;
    };
    discrete::Joints &joints = model_.state.joints;
    joints.begin_group(elastic_law(), 0, "grains");
    for (const discrete::TileJoint *const joint : inside)
    {
      const std::int32_t i = number_of(joint->first), j = number_of(joint->second);
      joints.add(grains, i, j, modulus(static_cast<std::size_t>(i)),
                 modulus(static_cast<std::size_t>(j)));
    }
    joints.finish(grains.size());
  }

  void add_mesh(continuum::ElasticMaterial material)
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
      if (x.y < bottom + 0.5) // of the lattice one row
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

#pragma once
// A breakable layer of packed disks in a soft matrix: grains around the layer, mesh above
// and below, between frictionless walls on a smooth base. Mean grain diameter 1 m, the
// layer's strengths and stiffness those of a hard rock.
#include "support/coupling_fixtures.h"

#include "coupling/bridged_balance.h"
#include "coupling/event_driver.h"
#include "coupling/walled_grains.h"
#include "discrete/homogenise.h"
#include "discrete/packing.h"

namespace antiform::coupling::test
{
/// Heights above the middle of the layer.
struct CoupledShape
{
  double length = 24.;  ///< between the walls [m]
  double layer = 3.;    ///< half its thickness
  double core = 5.;     ///< layer and buffer
  double overlap = 6.;  ///< its width
  double surface = 19.; ///< and, below, the base
  double cell = 2.;
  double contrast = 20.; ///< of the moduli of layer and matrix
  std::uint64_t seed = 1;
  bool finite_strain = false;  ///< of the mesh
  std::int32_t tied_every = 0; ///< that many-th grain of the overlap follows the mesh
};

struct CoupledLayer
{
  Bridged model;
  CoupledShape shape;

  explicit CoupledLayer(const CoupledShape &of, const FlatJoint &law = FlatJoint())
      : shape(of)
  {
    make_grains(law);
    make_mesh(law);
    model.state.breaking = true;
  }

  std::size_t n_grains() const { return model.state.grains.size(); }
  /// The load parameter is the shortening of the section.
  std::vector<BearingWall> bearing()
  {
    const double rate = 0.5 * shape.length;
    return {{&model.walls[0], rate, false, 0.}, {&model.walls[1], rate, false, 0.}};
  }
  /// Mean stress of the section for the force conjugate to the shortening [Pa].
  double stress(const double force) const
  {
    return force / (shape.length * 2. * shape.surface);
  }

private:
  void make_grains(const FlatJoint &law)
  {
    discrete::PackingParameters packing;
    packing.seed = shape.seed;
    const double top = shape.core + shape.overlap, L = shape.length;
    discrete::Grains &grains = model.state.grains;
    for (const discrete::Disk &disk :
         discrete::pack_polygon({{0., -top}, {L, -top}, {L, top}, {0., top}}, packing)
             .disks)
      grains.add(disk.centre, disk.radius, 2600.,
                 std::abs(disk.centre.y) < shape.layer ? 0 : 1);
    FlatJoint soft = law;
    soft.breakable = false;
    const std::vector<double> modulus{law.effective_modulus,
                                      law.effective_modulus / shape.contrast};
    discrete::Joints &joints = model.state.joints;
    const double gap = 0.5 * packing.installation_gap_ratio;
    joints.begin_group(law, 0, "layer");
    for (const auto &[i, j] : discrete::pairs_within(grains, gap, 0, 0))
      joints.add(grains, i, j, modulus[0], modulus[0]);
    joints.begin_group(soft, 1, "matrix");
    for (const int other : {0, 1})
      for (const auto &[i, j] : discrete::pairs_within(grains, gap, other, 1))
        joints.add(grains, i, j, modulus[static_cast<std::size_t>(other)], modulus[1]);
    joints.finish(grains.size());
    for (const double side : {-1., 1.})
    {
      discrete::Wall wall;
      wall.point = {side < 0. ? 0. : L, 0.};
      wall.normal = {-side, 0.};
      discrete::install_wall_contacts(grains, wall, 1., gap, modulus);
      model.walls.push_back(wall);
    }
  }

  void make_mesh(const FlatJoint &law)
  {
    const double core = shape.core;
    model.weight.distance_to_core = [core](const Vec2 &x)
    { return std::max(0., std::abs(x.y) - core); };
    model.weight.width = shape.overlap;
    const auto n = [this](const double size)
    { return static_cast<int>(std::lround(size / shape.cell)); };
    std::vector<double> y = lines(-shape.surface, -core, n(shape.surface - core));
    const std::vector<double> upper = lines(core, shape.surface, n(shape.surface - core));
    y.insert(y.end(), upper.begin(), upper.end());
    make_cells(model.triangulation, lines(0., shape.length, n(shape.length)), y,
               [core](const Vec2 &centre) { return std::abs(centre.y) > core; });
    discrete::PackingParameters packing;
    packing.seed = 100;
    const discrete::TileResponse tile =
        discrete::homogenise(discrete::pack_periodic({24., 24.}, packing),
                             0.5 * packing.installation_gap_ratio, law);
    continuum::ElasticMaterial material;
    material.stiffness = tile.stiffness;
    for (auto &row : material.stiffness)
      for (double &c : row)
        c /= shape.contrast;
    material.density = 2600. * tile.density_factor;
    model.finite_strain = shape.finite_strain;
    model.tie_unsupported = shape.tied_every == 0;
    const discrete::Grains &grains = model.state.grains;
    for (std::int32_t i = 0;
         !model.tie_unsupported && i < static_cast<int>(grains.size());
         i += shape.tied_every)
      if (const double d = model.weight.distance_to_core(grains.reference(i));
          d > 0. && d <= shape.overlap)
        model.options.tied_grains.push_back(i);
    model.join_bonded(material, shape.cell * shape.cell);
    for (discrete::Wall &wall : model.walls)
      for (discrete::WallContact &contact : wall.contacts)
        contact.weight = model.weight.grains(model.state.grains.reference(contact.grain));
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const Vec2 x = model.mesh_place(dof);
      const bool is_x = model.solid->component(dof) == 0;
      if (is_x && x.x < 1e-9)
        model.mesh->prescribe(dof, 0);
      else if (is_x && x.x > shape.length - 1e-9)
        model.mesh->prescribe(dof, 1);
      else if (!is_x && x.y < 1e-9 - shape.surface)
        model.mesh->prescribe(dof, -1);
    }
  }
};

inline BridgedBalance body_of(CoupledLayer &layer)
{
  return BridgedBalance(layer.model.state, layer.bearing(), {}, *layer.model.mesh,
                        *layer.model.domain);
}

/// The driver of a body of grains and mesh.
struct Driven
{
  BridgedBalance body;
  EventDriver driver;

  Driven(CoupledLayer &layer, const DriverSettings &settings)
      : body(body_of(layer))
      , driver(
            layer.model.state,
            body,
            [this, dynamics = settings.dynamics](const RestGoal &goal)
            { return body.settle(dynamics, goal); },
            settings)
  {
  }
};

/// Densities for motion in time: every grain and node about as fast.
inline void scale_for_motion(Bridged &model)
{
  model.set_masses(common_step(
      model.state.grains,
      discrete::stiffness_sums(model.state.grains, model.state.joints, false)));
  model.factorise();
}

/// Terms of the last record, with the springs of the walls, whose work is in it.
inline Energies books_of(const Driven &run, const CoupledLayer &layer)
{
  Energies books = run.driver.report().records.back().energies;
  for (const discrete::Wall &wall : layer.model.walls)
    books.strain_grains += wall_energy(layer.model.state.grains, wall);
  return books;
}

inline double open_share(const Energies &books)
{
  return std::abs(books.boundary_work - books.stored_and_spent()) / books.magnitude();
}
} // namespace antiform::coupling::test

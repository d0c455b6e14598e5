#pragma once
// A layer of grains between meshes (or on one), joined at the surface. Units as in
// coupling_fixtures.h: mean grain diameter d, modulus E*, density of a grain.
#include "support/coupling_fixtures.h"

#include "coupling/surface_component.h"

namespace antiform::coupling::test
{
constexpr dealii::types::boundary_id lower_edge = 7, upper_edge = 8;

struct LayeredShape
{
  double length = 24.;  ///< of layer and meshes [d]
  int rows = 6;         ///< of the lattice
  double h = 2.;        ///< cell [d]
  double height = 8.;   ///< of each mesh [d]
  bool above = true;    ///< a second mesh on the layer
  double first = 0.137; ///< x of the first grain: in general position to the cells
  double modulus_ratio = 1.;
  unsigned int degree = 1;

  double thickness() const { return 0.5 * std::sqrt(3.) * (rows - 1) + 1.; }
};

/// Meshes below y = 0 and above the layer, the faces towards it with the two ids.
inline void make_layered_mesh(Bridged &model, const LayeredShape &shape)
{
  const double top = shape.thickness();
  const int nx = static_cast<int>(std::lround(shape.length / shape.h)),
            ny = static_cast<int>(std::lround(shape.height / shape.h));
  std::vector<double> y = lines(-shape.height, 0., ny);
  if (shape.above)
    for (const double v : lines(top, top + shape.height, ny))
      y.push_back(v);
  make_cells(model.triangulation, lines(0., shape.length, nx), y,
             [top](const Vec2 &centre) { return centre.y < 0. || centre.y > top; });
  for (const auto &cell : model.triangulation.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->at_boundary(f))
      {
        const double at = cell->face(f)->center()[1];
        if (std::abs(at) < 1e-9)
          cell->face(f)->set_boundary_id(lower_edge);
        if (std::abs(at - top) < 1e-9)
          cell->face(f)->set_boundary_id(upper_edge);
      }
}

/// Body of one material behind the mesh's edges; grains are there.
inline void finish_layered(Bridged &model,
                           const LayeredShape &shape,
                           continuum::ElasticMaterial material)
{
  for (auto &row : material.stiffness)
    for (double &c : row)
      c *= shape.modulus_ratio;
  model.state.breaking = false;
  model.solid = std::make_unique<continuum::ElasticSolid>(
      model.triangulation, std::vector<continuum::ElasticMaterial>{material},
      shape.degree);
  model.mesh.emplace(*model.solid);
}

/// A layer of the hexagonal lattice.
inline void make_layered_lattice(Bridged &model, const LayeredShape &shape)
{
  make_layered_mesh(model, shape);
  model.state.grains =
      hexagonal_lattice({0., shape.length, 0., shape.thickness()}, {shape.first, 0.5},
                        [](const Vec2 &) { return true; });
  const FlatJoint law = elastic_law();
  discrete::Joints &joints = model.state.joints;
  joints.begin_group(law, 0, "grains");
  for (const auto &[i, j] : discrete::pairs_within(model.state.grains, 1e-6, 0, 0))
    joints.add(model.state.grains, i, j, 1., 1.);
  joints.finish(model.state.grains.size());
  finish_layered(model, shape, lattice_material(law));
}

inline SurfaceInterface interface_below(const Bridged &model)
{
  const discrete::Grains &g = model.state.grains;
  return {g, outer_side(g, {}, 1., {0., -1.}), *model.solid, lower_edge};
}
inline SurfaceInterface interface_above(const Bridged &model)
{
  const discrete::Grains &g = model.state.grains;
  return {g, outer_side(g, {}, 1., {0., 1.}), *model.solid, upper_edge};
}
inline SurfaceTie
make_tie(const Bridged &model, const SurfaceTie::Kind kind, const bool above)
{
  std::vector<SurfaceInterface> interfaces{interface_below(model)};
  if (above)
    interfaces.push_back(interface_above(model));
  return {model.state.grains, std::move(interfaces), kind};
}

/// Random velocities of all that may move.
inline void stir(Bridged &model, const double speed, const std::uint64_t seed)
{
  discrete::Random random(seed, 7);
  const auto number = [&] { return speed * (2. * random.uniform() - 1.); };
  discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    g.velocity_x[i] = g.inverse_mass[i] > 0. ? number() : 0.;
    g.velocity_y[i] = g.inverse_mass[i] > 0. ? number() : 0.;
    g.spin[i] = g.inverse_inertia[i] > 0. ? number() : 0.;
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    model.mesh->velocity(dof) = model.mesh->inverse_mass(dof) > 0. ? number() : 0.;
}

/// Momentum and angular momentum about the origin of vectors on grains (x, y, moment) and
/// mesh, at their reference places or where they are.
struct Momenta
{
  double x = 0., y = 0., angular = 0.;
  double magnitude = 0.; ///< sum of the absolute values of what is summed
};
template <class OfGrain, class OfDof>
Momenta momenta(const Bridged &model,
                const bool in_place,
                const OfGrain &of_grain,
                const OfDof &of_dof)
{
  Momenta sum;
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const auto [force, moment] = of_grain(i);
    const Vec2 at = in_place ? g.position(i) : g.reference(i);
    sum.x += force.x;
    sum.y += force.y;
    sum.angular += cross(at, force) + moment;
    sum.magnitude += norm(force) * norm(at) + std::abs(moment);
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const unsigned int c = model.solid->component(dof);
    Vec2 at = model.mesh_place(dof);
    if (in_place) // only the coordinate across the component counts, its dof is beside
      at += c == 0 ? Vec2{0., model.mesh->displacement(dof + 1)}
                   : Vec2{model.mesh->displacement(dof - 1), 0.};
    const double f = of_dof(dof);
    (c == 0 ? sum.x : sum.y) += f;
    sum.angular += c == 0 ? -at.y * f : at.x * f;
    sum.magnitude += std::abs(f) * norm(at);
  }
  return sum;
}

/// Displace all rigidly: by linear kinematics, or turned finitely about the origin.
inline void
move_rigidly(Bridged &model, const Vec2 &shift, const double angle, const bool finite)
{
  const auto moved = [&](const Vec2 &x)
  { return shift + (finite ? rotated(x, angle) - x : angle * perpendicular(x)); };
  discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 u = moved(g.reference(i));
    g.displacement_x[i] = u.x;
    g.displacement_y[i] = u.y;
    g.rotation[i] = angle;
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 u = moved(model.mesh_place(dof));
    model.mesh->displacement(dof) = model.solid->component(dof) == 0 ? u.x : u.y;
  }
  model.mesh->displacement.update_ghost_values();
}
} // namespace antiform::coupling::test

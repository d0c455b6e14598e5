#pragma once
// A column along x: lattice grains on the left, held at their end; overlap; mesh on the
// right, whose end moves with a wall or is pulled. Free sides.
#include "continuum/loads.h"
#include "support/coupling_fixtures.h"

namespace antiform::coupling::test
{
struct Column
{
  Bridged model;
  double begin;        ///< of the grains
  double end = 24.;    ///< of the mesh
  double height = 0.;
  std::vector<unsigned int> end_dofs; ///< x dofs of the mesh's end
  std::vector<std::size_t> held;      ///< grains of the other end
  continuum::Vector load;             ///< of the prestress on the mesh [N]

  explicit Column(const double first = -14.)
      : begin(first)
  {
    constexpr int n_rows = 12; // even: the column is symmetric about its axis
    height = n_rows * 0.5 * std::sqrt(3.);
    model.weight.distance_to_core = [](const Vec2 &x) { return std::max(0., x.x); };
    model.weight.width = 8.;
    make_cells(model.triangulation, lines(0., end, 12), lines(0., height, 5),
               [](const Vec2 &) { return true; });
    model.state.grains =
        hexagonal_lattice({begin, model.weight.width, 0., height}, {begin, 0.},
                          [](const Vec2 &) { return true; });
    const FlatJoint law = elastic_law();
    model.join(law, 1e-6, lattice_material(law), 2. * height / 5.);
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
      if (model.solid->component(dof) == 0 && model.mesh_place(dof).x > end - 1e-9)
        end_dofs.push_back(dof);
    for (std::size_t i = 0; i < model.state.grains.size(); ++i)
      if (model.state.grains.reference_x[i] < begin + 0.6)
        held.push_back(i);
    load = model.solid->make_vector();
  }

  /// Install the uniform stress S_xx = -p in joints and mesh: the joints' deformation
  /// under it is affine on the lattice.
  void prestress(const double p)
  {
    const auto &C = model.solid->materials()[0].stiffness;
    const double determinant = C[0][0] * C[1][1] - C[0][1] * C[0][1];
    const Vec2 strain{-p * C[1][1] / determinant, p * C[0][1] / determinant};
    discrete::Joints &joints = model.state.joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const double nx = joints.normal_x[j], ny = joints.normal_y[j];
      const Vec2 stretch = joints.length[j] * Vec2{strain.x * nx, strain.y * ny};
      joints.initial_gap.push_back(stretch.x * nx + stretch.y * ny);
      joints.initial_shear.push_back(stretch.y * nx - stretch.x * ny);
      joints.initial_rotation.push_back(0.);
    }
    dealii::SymmetricTensor<2, 2> stress;
    stress[0][0] = -p;
    load = continuum::prestress(*model.solid, stress);
  }

  /// Masses at @p dt0, supports and constraint; the end of the mesh follows wall 0 unless
  /// it is free.
  void support(const double dt0, const bool free_end)
  {
    model.set_masses(dt0);
    for (const std::size_t i : held)
      model.hold_grain(i);
    if (!free_end)
    {
      discrete::Wall wall;
      wall.point = {end, 0.};
      wall.normal = {-1., 0.};
      model.walls.push_back(wall);
      for (const unsigned int dof : end_dofs)
        model.mesh->prescribe(dof, 0);
    }
    model.factorise();
  }

  StaticSystem static_system(const bool free_end, const double pull) const
  {
    StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                        model.domain.get());
    for (const std::size_t i : held)
      for (const unsigned int c : {0u, 1u, 2u})
        system.fix_grain(i, c, 0.);
    if (!free_end)
      for (const unsigned int dof : end_dofs)
        system.fix_mesh(dof, pull);
    return system;
  }

  /// Forces at the present positions, prestress included.
  void forces()
  {
    compute_forces(model);
    model.mesh->force += load;
  }
  /// Pressing force on the supported end of the mesh at the present positions [N].
  double pressing_force()
  {
    forces();
    double sum = 0.;
    for (const unsigned int dof : end_dofs)
      sum += model.mesh->force(dof);
    return sum;
  }

  /// Equilibrium of the prestressed state, with the end pulled by @p pull: corrections by
  /// the linear static system until they are at round-off.
  void equilibrate(const double pull)
  {
    discrete::Grains &g = model.state.grains;
    for (int iteration = 0; iteration < 8; ++iteration)
    {
      forces();
      const double at_end = model.mesh->displacement(end_dofs.front());
      StaticSystem system = static_system(false, pull - at_end);
      for (std::size_t i = 0; i < g.size(); ++i)
        if (std::find(held.begin(), held.end(), i) == held.end())
        {
          system.add_grain_force(i, 0, g.force_x[i]);
          system.add_grain_force(i, 1, g.force_y[i]);
          system.add_grain_force(i, 2, g.torque[i]);
        }
      for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
        system.add_mesh_force(dof, model.mesh->force(dof));
      const StaticSolution correction = system.solve();
      for (std::size_t i = 0; i < g.size(); ++i)
      {
        g.displacement_x[i] += correction.ux[i];
        g.displacement_y[i] += correction.uy[i];
        g.rotation[i] += correction.rotation[i];
      }
      model.mesh->displacement += correction.mesh;
      model.mesh->displacement.update_ghost_values();
    }
  }
};
} // namespace antiform::coupling::test

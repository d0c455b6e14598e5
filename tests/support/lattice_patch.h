#pragma once
// Patch test of a lattice block: uniform strain imposed at the outer boundary of the
// mesh.
#include "support/coupling_fixtures.h"

#include <Eigen/Dense>

#include <array>

namespace antiform::coupling::test
{
using Strain = std::array<double, 3>; // xx, yy, engineering xy
constexpr std::array<Strain, 3> unit_strains{{{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}};

inline Vec2 affine(const Strain &e, const Vec2 &x)
{
  return {e[0] * x.x + 0.5 * e[2] * x.y, 0.5 * e[2] * x.x + e[1] * x.y};
}

inline double norm_of(const Strain &e)
{
  return std::sqrt(e[0] * e[0] + e[1] * e[1] + 0.5 * e[2] * e[2]);
}

inline StaticSolution solve_patch(const Bridged &model,
                                  const BlockShape &shape,
                                  const Strain &strain,
                                  const BridgingDomain *domain,
                                  const double anchor = 0.)
{
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(), domain);
  const double out = shape.w + shape.rim, small = 1e-9;
  for (std::size_t dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (x.x < -out + small || x.x > shape.core_x + out - small || x.y < -out + small ||
        x.y > shape.core_y + out - small)
    {
      const Vec2 u = affine(strain, x);
      system.fix_mesh(
          dof, model.solid->component(static_cast<unsigned int>(dof)) == 0 ? u.x : u.y);
    }
  }
  if (anchor > 0.)
    for (std::size_t i = 0; i < model.state.grains.size(); ++i)
      for (const unsigned int c : {0u, 1u})
        system.add_grain_spring(i, c, anchor);
  return system.solve();
}

struct PatchError
{
  double strain = 0.; ///< of the core: fit of a linear field to its grains
  double force = 0.;  ///< of the core's joints: RMS error over RMS force
  double mesh = 0.;   ///< largest of the cells outside of the overlap
  void enlarge(const PatchError &e)
  {
    strain = std::max(strain, e.strain);
    force = std::max(force, e.force);
    mesh = std::max(mesh, e.mesh);
  }
};

/// Mean strain of the grains in the core, from a least-squares fit of their displacement.
inline Strain fitted_strain(const Bridged &model, const StaticSolution &u)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (model.weight.distance_to_core(g.reference(i)) == 0.)
    {
      const Eigen::Vector3d row(1., g.reference_x[i], g.reference_y[i]);
      normal += row * row.transpose();
      right += row * Eigen::RowVector2d(u.ux[i], u.uy[i]);
    }
  const Eigen::Matrix<double, 3, 2> a = normal.ldlt().solve(right);
  return {a(1, 0), a(2, 1), a(2, 0) + a(1, 1)};
}

inline PatchError
error_of(const Bridged &model, const Strain &strain, const StaticSolution &u)
{
  PatchError error;
  const Strain core = fitted_strain(model, u);
  error.strain =
      norm_of({core[0] - strain[0], core[1] - strain[1], core[2] - strain[2]}) /
      norm_of(strain);

  const discrete::Joints &joints = model.state.joints;
  const discrete::Grains &g = model.state.grains;
  double square = 0., reference = 0.;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    if (model.weight.distance_to_core(g.reference(one)) > 0. ||
        model.weight.distance_to_core(g.reference(two)) > 0.)
      continue;
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    const Vec2 a = affine(strain, g.reference(one)), b = affine(strain, g.reference(two));
    const std::array<double, 6> exact{a.x, a.y, 0., b.x, b.y, 0.};
    const std::array<double, 6> found{u.ux[one], u.uy[one], u.rotation[one],
                                      u.ux[two], u.uy[two], u.rotation[two]};
    for (const int r : {0, 1}) // normal and shear force
    {
      double wanted = 0., had = 0.;
      for (int c = 0; c < 6; ++c)
      {
        wanted += stiffness[r] * rows[r][c] * exact[c];
        had += stiffness[r] * rows[r][c] * found[c];
      }
      square += (had - wanted) * (had - wanted);
      reference += wanted * wanted;
    }
  }
  error.force = std::sqrt(square / reference);

  const auto cells = model.solid->cell_states(u.mesh);
  for (const auto &cell : cells)
    if (cell.weight == 1.)
    {
      const Strain &e = cell.strain;
      error.mesh = std::max(
          error.mesh, norm_of({e[0] - strain[0], e[1] - strain[1], e[2] - strain[2]}) /
                          norm_of(strain));
    }
  return error;
}

} // namespace antiform::coupling::test

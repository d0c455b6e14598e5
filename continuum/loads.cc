#include "continuum/loads.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
Vector finished(Vector force)
{
  force.compress(VectorOperation::add);
  force.update_ghost_values();
  return force;
}

/// Sum w_C times @p integrand(cell, values, i, q) of every dof i over the cells.
template <class Integrand>
Vector integrate_cells(const DisplacementSpace &solid, const Integrand &integrand)
{
  const auto &fe = solid.fe();
  FEValues<2> values(fe, QGauss<2>(fe.degree + 1),
                     update_values | update_gradients | update_quadrature_points |
                         update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  Vector force = solid.make_vector();
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      for (const unsigned int q : values.quadrature_point_indices())
      {
        const double w = solid.weight(values.quadrature_point(q)) * values.JxW(q);
        const auto at_point = integrand(cell, values.quadrature_point(q));
        for (unsigned int i = 0; i < dofs.size(); ++i)
          force(dofs[i]) += w * at_point(values, i, q);
      }
    }
  return finished(std::move(force));
}
} // namespace

Vector gravity(const ElasticSolid &solid, const Tensor<1, 2> &acceleration)
{
  const auto &fe = solid.fe();
  return integrate_cells(
      solid,
      [&](const auto &cell, const Point<2> &)
      {
        const double density = solid.materials()[cell->material_id()].density;
        return [&fe, &acceleration, density](const FEValues<2> &values,
                                             const unsigned int i, const unsigned int q)
        {
          return density * acceleration[fe.system_to_component_index(i).first] *
                 values.shape_value(i, q);
        };
      });
}

Vector body_force(const DisplacementSpace &solid,
                  const std::function<Tensor<1, 2>(const Point<2> &)> &density)
{
  const auto &fe = solid.fe();
  return integrate_cells(
      solid,
      [&](const auto &, const Point<2> &place)
      {
        return [&fe, f = density(place)](const FEValues<2> &values, const unsigned int i,
                                         const unsigned int q)
        { return f[fe.system_to_component_index(i).first] * values.shape_value(i, q); };
      });
}

Vector prestress(const DisplacementSpace &solid, const StressField &initial_stress)
{
  const auto &fe = solid.fe();
  return integrate_cells(
      solid,
      [&](const auto &, const Point<2> &place)
      {
        return [&fe, stress = initial_stress(place)](const FEValues<2> &values,
                                                     const unsigned int i,
                                                     const unsigned int q) {
          return -(stress *
                   values.shape_grad(i, q))[fe.system_to_component_index(i).first];
        };
      });
}

Vector prestress(const DisplacementSpace &solid,
                 const SymmetricTensor<2, 2> &initial_stress)
{
  return prestress(solid, [&](const Point<2> &) { return initial_stress; });
}

Vector boundary_traction(const DisplacementSpace &solid,
                         const BoundaryIds &boundaries,
                         const Traction &traction)
{
  const auto &fe = solid.fe();
  FEFaceValues<2> values(fe, QGauss<1>(fe.degree + 2),
                         update_values | update_quadrature_points |
                             update_normal_vectors | update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  Vector force = solid.make_vector();
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && boundaries.count(face->boundary_id()) > 0)
        {
          values.reinit(cell, face);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : values.quadrature_point_indices())
          {
            const Tensor<1, 2> t =
                traction(values.quadrature_point(q), values.normal_vector(q));
            for (unsigned int i = 0; i < dofs.size(); ++i)
              force(dofs[i]) += t[fe.system_to_component_index(i).first] *
                                values.shape_value(i, q) * values.JxW(q);
          }
        }
  return finished(std::move(force));
}

Vector pressure(const DisplacementSpace &solid,
                const BoundaryIds &boundaries,
                const double pressure)
{
  return boundary_traction(solid, boundaries,
                           [&](const Point<2> &, const Tensor<1, 2> &normal)
                           { return -pressure * normal; });
}
} // namespace antiform::continuum

#include "continuum/follower_pressure.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace antiform::continuum
{
using namespace dealii;

FollowerPressure::FollowerPressure(const DisplacementSpace &space,
                                   BoundaryIds boundaries,
                                   std::function<double(const Point<2> &)> pressure)
    : space_(space)
    , boundaries_(std::move(boundaries))
    , pressure_(std::move(pressure))
{
}

FollowerPressure::FollowerPressure(const DisplacementSpace &space,
                                   BoundaryIds boundaries,
                                   const double pressure)
    : FollowerPressure(
          space, std::move(boundaries), [=](const Point<2> &) { return pressure; })
{
}

// With T the unit tangent of the reference face, the normal turned by +90 degrees, a
// piece dS of it becomes the vector t dS, t = T + du/dT, and n da = (t_y, -t_x) dS.
void FollowerPressure::add(const Vector &displacement,
                           const double factor,
                           Vector &force,
                           TrilinosWrappers::SparseMatrix *tangent) const
{
  const auto &fe = space_.fe();
  const unsigned int n = fe.n_dofs_per_cell();
  // N_a t is of degree 2 p along a face: exact.
  FEFaceValues<2> values(fe, QGauss<1>(fe.degree + 1),
                         update_values | update_gradients | update_quadrature_points |
                             update_normal_vectors | update_JxW_values);
  FullMatrix<double> K(n, n);
  std::vector<double> along(n);
  std::vector<types::global_dof_index> dofs(n);
  const auto component = [&](const unsigned int i)
  { return fe.system_to_component_index(i).first; };

  for (const auto &cell : space_.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && boundaries_.count(face->boundary_id()) > 0)
        {
          values.reinit(cell, face);
          cell->get_dof_indices(dofs);
          K = 0.;
          for (const unsigned int q : values.quadrature_point_indices())
          {
            const Tensor<1, 2> &normal = values.normal_vector(q);
            const Tensor<1, 2> T({-normal[1], normal[0]});
            Tensor<1, 2> t = T;
            for (unsigned int i = 0; i < n; ++i)
            {
              along[i] = values.shape_grad(i, q) * T;
              t[component(i)] += along[i] * displacement(dofs[i]);
            }
            const double w =
                factor * pressure_(values.quadrature_point(q)) * values.JxW(q);
            for (unsigned int i = 0; i < n; ++i)
            {
              const double N = w * values.shape_value(i, q);
              force(dofs[i]) += component(i) == 0 ? -N * t[1] : N * t[0];
              for (unsigned int j = 0; j < n; ++j)
                if (component(i) != component(j))
                  K(i, j) += (component(i) == 0 ? N : -N) * along[j];
            }
          }
          if (tangent)
            tangent->add(dofs, K);
        }
}
} // namespace antiform::continuum

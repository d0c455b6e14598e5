#include "continuum/unilateral_foundation.h"

#include "continuum/require.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <vector>

namespace antiform::continuum
{
using namespace dealii;

UnilateralFoundation::UnilateralFoundation(const DisplacementSpace &space,
                                           BoundaryIds boundaries,
                                           const double normal_stiffness,
                                           Options options)
    : space_(space)
    , boundaries_(std::move(boundaries))
    , normal_stiffness_(normal_stiffness)
    , options_(std::move(options))
{
  require(normal_stiffness > 0., "unilateral foundation: the normal stiffness",
          normal_stiffness, "Pa/m", "> 0");
  if (options_.points_per_face == 0)
    options_.points_per_face = space.degree() + 3;
}

UnilateralFoundation::UnilateralFoundation(const DisplacementSpace &space,
                                           BoundaryIds boundaries,
                                           const double normal_stiffness)
    : UnilateralFoundation(space, std::move(boundaries), normal_stiffness, Options())
{
}

/// Calls at_point(dofs, depth, normal_part, JxW) at every point of this rank's faces;
/// normal_part is N n of each dof of the cell, so that u.n is their sum with u.
template <class AtPoint>
void UnilateralFoundation::at_points(const Vector &displacement,
                                     const AtPoint &at_point) const
{
  const auto &fe = space_.fe();
  const unsigned int n = fe.n_dofs_per_cell();
  FEFaceValues<2> values(fe, QGauss<1>(options_.points_per_face),
                         update_values | update_quadrature_points |
                             update_normal_vectors | update_JxW_values);
  std::vector<double> normal_part(n);
  std::vector<types::global_dof_index> dofs(n);
  for (const auto &cell : space_.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && boundaries_.count(face->boundary_id()) > 0)
        {
          values.reinit(cell, face);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : values.quadrature_point_indices())
          {
            const Tensor<1, 2> &normal = values.normal_vector(q);
            double depth = options_.gap ? -options_.gap(values.quadrature_point(q)) : 0.;
            for (unsigned int i = 0; i < n; ++i)
            {
              normal_part[i] = values.shape_value(i, q) *
                               normal[fe.system_to_component_index(i).first];
              depth += normal_part[i] * displacement(dofs[i]);
            }
            at_point(dofs, depth, normal_part, values.JxW(q));
          }
        }
}

void UnilateralFoundation::add(const Vector &displacement,
                               Vector &internal_force,
                               TrilinosWrappers::SparseMatrix *tangent)
{
  FullMatrix<double> K(space_.fe().n_dofs_per_cell());
  at_points(displacement,
            [&](const auto &dofs, const double depth, const auto &normal_part,
                const double length)
            {
              if (depth < 0.)
                return;
              const double k = normal_stiffness_ * length;
              for (unsigned int i = 0; i < dofs.size(); ++i)
              {
                internal_force(dofs[i]) += k * depth * normal_part[i];
                for (unsigned int j = 0; j < dofs.size(); ++j)
                  K(i, j) = k * normal_part[i] * normal_part[j];
              }
              if (tangent)
                tangent->add(dofs, K);
            });
}

UnilateralFoundation::Support
UnilateralFoundation::support(const Vector &displacement) const
{
  Support all;
  at_points(displacement,
            [&](const auto &, const double depth, const auto &, const double length)
            {
              all.force += normal_stiffness_ * std::max(0., depth) * length;
              (depth >= 0. ? all.touching : all.lifted) += length;
              all.greatest_depth = std::max(all.greatest_depth, depth);
            });
  const MPI_Comm communicator = space_.dof_handler().get_communicator();
  all.force = Utilities::MPI::sum(all.force, communicator);
  all.touching = Utilities::MPI::sum(all.touching, communicator);
  all.lifted = Utilities::MPI::sum(all.lifted, communicator);
  all.greatest_depth = Utilities::MPI::max(all.greatest_depth, communicator);
  return all;
}
} // namespace antiform::continuum

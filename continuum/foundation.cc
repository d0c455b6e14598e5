#include "continuum/foundation.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

TrilinosWrappers::SparseMatrix
winkler_foundation(const DisplacementSpace &solid,
                   const std::set<types::boundary_id> &boundaries,
                   const double normal_stiffness)
{
  if (!(normal_stiffness >= 0.))
    throw std::invalid_argument("foundation: stiffness " +
                                std::to_string(normal_stiffness) +
                                " Pa/m would push the body away; give a value >= 0.");
  TrilinosWrappers::SparseMatrix matrix = solid.make_matrix();

  const auto &fe = solid.fe();
  const unsigned int n = fe.n_dofs_per_cell();
  // degree + 1 points integrate N_a N_b of degree 2 p exactly.
  FEFaceValues<2> values(fe, QGauss<1>(solid.degree() + 1),
                         update_values | update_normal_vectors | update_JxW_values);
  FullMatrix<double> face_matrix(n, n);
  std::vector<double> normal_part(n);
  std::vector<types::global_dof_index> dofs(n);
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && boundaries.count(face->boundary_id()) > 0)
        {
          values.reinit(cell, face);
          face_matrix = 0.;
          for (const unsigned int q : values.quadrature_point_indices())
          {
            const auto normal = values.normal_vector(q);
            for (unsigned int i = 0; i < n; ++i)
              normal_part[i] = values.shape_value(i, q) *
                               normal[fe.system_to_component_index(i).first];
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                face_matrix(i, j) +=
                    normal_stiffness * normal_part[i] * normal_part[j] * values.JxW(q);
          }
          cell->get_dof_indices(dofs);
          matrix.add(dofs, face_matrix);
        }
  matrix.compress(VectorOperation::add);
  return matrix;
}
} // namespace antiform::continuum

#include "continuum/foundation.h"

#include "continuum/require.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
/// integral c p_a p_b over boundary faces, where @p part(values, i, q) is the linear
/// functional p of dof i at a point.
template <class Part>
TrilinosWrappers::SparseMatrix
boundary_matrix(const DisplacementSpace &solid,
                const std::set<types::boundary_id> &boundaries,
                const double coefficient,
                const Part &part)
{
  TrilinosWrappers::SparseMatrix matrix = solid.make_matrix();
  const unsigned int n = solid.fe().n_dofs_per_cell();
  // degree + 1 points integrate N_a N_b of degree 2 p exactly.
  FEFaceValues<2> values(solid.fe(), QGauss<1>(solid.degree() + 1),
                         update_values | update_gradients | update_normal_vectors |
                             update_JxW_values);
  FullMatrix<double> face_matrix(n, n);
  std::vector<double> parts(n);
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
            for (unsigned int i = 0; i < n; ++i)
              parts[i] = part(values, i, q);
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                face_matrix(i, j) += coefficient * parts[i] * parts[j] * values.JxW(q);
          }
          cell->get_dof_indices(dofs);
          matrix.add(dofs, face_matrix);
        }
  matrix.compress(VectorOperation::add);
  return matrix;
}
} // namespace

TrilinosWrappers::SparseMatrix
winkler_foundation(const DisplacementSpace &solid,
                   const std::set<types::boundary_id> &boundaries,
                   const double normal_stiffness)
{
  if (!(normal_stiffness >= 0.))
    throw std::invalid_argument("foundation: stiffness " +
                                std::to_string(normal_stiffness) +
                                " Pa/m would push the body away; give a value >= 0.");
  return boundary_matrix(
      solid, boundaries, normal_stiffness,
      [&fe = solid.fe()](const FEFaceValues<2> &values, const unsigned int i,
                         const unsigned int q)
      {
        return values.shape_value(i, q) *
               values.normal_vector(q)[fe.system_to_component_index(i).first];
      });
}

TrilinosWrappers::SparseMatrix
pasternak_foundation(const DisplacementSpace &solid,
                     const std::set<types::boundary_id> &boundaries,
                     const double shear_stiffness)
{
  require(shear_stiffness >= 0., "Shear stiffness of a foundation", shear_stiffness,
          "N/m", ">= 0");
  return boundary_matrix(
      solid, boundaries, shear_stiffness,
      [&fe = solid.fe()](const FEFaceValues<2> &values, const unsigned int i,
                         const unsigned int q)
      {
        const Tensor<1, 2> normal = values.normal_vector(q),
                           tangent({-normal[1], normal[0]});
        return (values.shape_grad(i, q) * tangent) *
               normal[fe.system_to_component_index(i).first];
      });
}
} // namespace antiform::continuum

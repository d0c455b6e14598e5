#include "continuum/absorbing_boundary.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
/// Symmetric 2 x 2: xx, yy, xy.
using Block = std::array<double, 3>;

/// (rho Gamma)^(1/2) for the normal @p n [Pa s/m].
Block impedance(const ElasticMaterial &material, const Tensor<1, 2> &n)
{
  // Columns of B for the gradients n e_x and n e_y; Gamma = B^T C B.
  const std::array<std::array<double, 3>, 2> strain{{{n[0], 0., n[1]}, {0., n[1], n[0]}}};
  const auto gamma = [&](const unsigned int a, const unsigned int b)
  {
    double sum = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        sum += strain[a][i] * material.stiffness[i][j] * strain[b][j];
    return material.density * sum;
  };
  // Root of a 2 x 2 matrix A: (A + s 1) / t, s = det(A)^(1/2), t = (tr A + 2 s)^(1/2).
  const double xx = gamma(0, 0), yy = gamma(1, 1), xy = gamma(0, 1);
  const double s = std::sqrt(xx * yy - xy * xy), t = std::sqrt(xx + yy + 2. * s);
  return {(xx + s) / t, (yy + s) / t, xy / t};
}

struct Lumped
{
  Vector diagonal;     ///< C of either component with itself
  Vector off_diagonal; ///< C_xy, at the x dofs
  unsigned int n_faces = 0, n_without_density = 0;
};

Lumped lump(const ElasticSolid &solid, const std::set<types::boundary_id> &boundaries)
{
  Lumped sums{solid.make_vector(), solid.make_vector()};
  const auto &fe = solid.fe();
  // The points are the nodes: one shape function of each component is not 0.
  FEFaceValues<2> values(fe, QGaussLobatto<1>(solid.degree() + 1),
                         update_values | update_normal_vectors | update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && boundaries.count(face->boundary_id()) > 0)
        {
          const ElasticMaterial &material = solid.materials()[cell->material_id()];
          ++sums.n_faces;
          if (!(material.density > 0.))
            ++sums.n_without_density;
          values.reinit(cell, face);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : values.quadrature_point_indices())
          {
            const Block z = impedance(material, values.normal_vector(q));
            for (unsigned int i = 0; i < dofs.size(); ++i)
            {
              const double length = values.shape_value(i, q) * values.JxW(q);
              const unsigned int c = fe.system_to_component_index(i).first;
              sums.diagonal(dofs[i]) += length * z[c];
              if (c == 0)
                sums.off_diagonal(dofs[i]) += length * z[2];
            }
          }
        }
  sums.diagonal.compress(VectorOperation::add);
  sums.off_diagonal.compress(VectorOperation::add);
  const MPI_Comm communicator = solid.dof_handler().get_communicator();
  sums.n_faces = Utilities::MPI::sum(sums.n_faces, communicator);
  sums.n_without_density = Utilities::MPI::sum(sums.n_without_density, communicator);
  return sums;
}
} // namespace

std::vector<NodalDashpot>
absorbing_dashpots(const ElasticSolid &solid,
                   const std::set<types::boundary_id> &boundaries)
{
  const Lumped sums = lump(solid, boundaries);
  if (sums.n_faces == 0)
    throw std::invalid_argument(
        "absorbing boundary: no face of the mesh has the ids given.");
  if (sums.n_without_density > 0)
    throw std::invalid_argument(
        "absorbing boundary: the material behind " +
        std::to_string(sums.n_without_density) +
        " faces has no density, so that no wave runs in it; give it one > 0.");

  // The two dofs of a node are neighbours, x first, and have one owner.
  std::vector<NodalDashpot> dashpots;
  for (std::uint32_t x = 0; x < sums.diagonal.locally_owned_size(); x += 2)
    if (sums.diagonal.local_element(x) > 0.)
      dashpots.push_back({x, x + 1, sums.diagonal.local_element(x),
                          sums.off_diagonal.local_element(x),
                          sums.diagonal.local_element(x + 1)});
  return dashpots;
}
} // namespace antiform::continuum

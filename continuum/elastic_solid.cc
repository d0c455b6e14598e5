#include "continuum/elastic_solid.h"

#include "continuum/hanging_nodes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace antiform::continuum
{
namespace
{
using namespace dealii;
using TrilinosMatrix = TrilinosWrappers::SparseMatrix;

std::array<double, 3> stress_of(const ElasticMaterial &material,
                                const std::array<double, 3> &strain)
{
  std::array<double, 3> stress{};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      stress[i] += material.stiffness[i][j] * strain[j];
  return stress;
}

/// Column of B of a dof with component @p c: strain (xx, yy, xy) per displacement [1/m].
std::array<double, 3> strain_of(const unsigned int c, const Tensor<1, 2> &gradient)
{
  return c == 0 ? std::array<double, 3>{gradient[0], 0., gradient[1]}
                : std::array<double, 3>{0., gradient[1], gradient[0]};
}

double dot(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Run @p add_cell(cell, fe_values, cell_matrix) over the locally owned cells and sum the
/// matrices that it fills into @p matrix.
template <class AddCell>
void assemble(const DoFHandler<2> &dof_handler,
              TrilinosMatrix &matrix,
              const AddCell &add_cell)
{
  const auto &fe = dof_handler.get_fe();
  FEValues<2> values(fe, QGauss<2>(fe.degree + 1),
                     update_gradients | update_quadrature_points | update_JxW_values);
  FullMatrix<double> cell_matrix(fe.n_dofs_per_cell(), fe.n_dofs_per_cell());
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell_matrix = 0.;
      add_cell(cell, values, cell_matrix);
      cell->get_dof_indices(dofs);
      matrix.add(dofs, cell_matrix);
    }
  matrix.compress(VectorOperation::add);
}
} // namespace

ElasticMaterial ElasticMaterial::isotropic(const double young_modulus,
                                           const double poisson_ratio,
                                           const double density,
                                           const std::string &name)
{
  if (!(young_modulus > 0. && poisson_ratio > -1. && poisson_ratio < 0.5))
    throw std::invalid_argument(
        "material '" + name + "': Young's modulus " + std::to_string(young_modulus) +
        " Pa and Poisson's ratio " + std::to_string(poisson_ratio) +
        " are not those of an elastic solid; give E > 0 and -1 < nu < 0.5.");
  ElasticMaterial material;
  const double shear = young_modulus / (2. * (1. + poisson_ratio));
  const double lambda = 2. * shear * poisson_ratio / (1. - 2. * poisson_ratio);
  material.stiffness = {{{lambda + 2. * shear, lambda, 0.},
                         {lambda, lambda + 2. * shear, 0.},
                         {0., 0., shear}}};
  material.density = density;
  material.name = name;
  return material;
}

ElasticSolid::ElasticSolid(const parallel::distributed::Triangulation<2> &triangulation,
                           std::vector<ElasticMaterial> materials,
                           const unsigned int degree,
                           std::function<double(const Point<2> &)> weight)
    : DisplacementSpace(triangulation, degree, std::move(weight))
    , materials_(std::move(materials))
{
  assemble_stiffness();
  assemble_mass();
  build_rows();
}

const ElasticMaterial &ElasticSolid::material(const types::material_id id) const
{
  if (id >= materials_.size())
    throw std::invalid_argument(
        "elastic solid: a cell has material " + std::to_string(id) + ", but only " +
        std::to_string(materials_.size()) + " materials are given.");
  return materials_[id];
}

void ElasticSolid::assemble_stiffness()
{
  stiffness_.reinit(make_matrix());

  const unsigned int n = fe().n_dofs_per_cell();
  std::vector<std::array<double, 3>> strains(n), stresses(n);
  assemble(dof_handler(), stiffness_,
           [&](const auto &cell, const FEValues<2> &values, FullMatrix<double> &K)
           {
             const auto &law = material(cell->material_id());
             for (const unsigned int q : values.quadrature_point_indices())
             {
               const double w = weight(values.quadrature_point(q)) * values.JxW(q);
               for (unsigned int i = 0; i < n; ++i)
               {
                 strains[i] = strain_of(fe().system_to_component_index(i).first,
                                        values.shape_grad(i, q));
                 stresses[i] = stress_of(law, strains[i]);
               }
               for (unsigned int i = 0; i < n; ++i)
                 for (unsigned int j = 0; j < n; ++j)
                   K(i, j) += w * dot(strains[i], stresses[j]);
             }
           });
}

template <class Stress>
TrilinosMatrix ElasticSolid::geometric_stiffness_of(const Stress &stress) const
{
  TrilinosMatrix matrix;
  matrix.reinit(stiffness_);
  const unsigned int n = fe().n_dofs_per_cell();
  assemble(dof_handler(), matrix,
           [&](const auto &cell, const FEValues<2> &values, FullMatrix<double> &K)
           {
             for (const unsigned int q : values.quadrature_point_indices())
             {
               const double w = weight(values.quadrature_point(q)) * values.JxW(q);
               const SymmetricTensor<2, 2> initial = stress(cell, values, q);
               for (unsigned int i = 0; i < n; ++i)
               {
                 const Tensor<1, 2> pull = w * (initial * values.shape_grad(i, q));
                 for (unsigned int j = 0; j < n; ++j)
                   if (fe().system_to_component_index(i).first ==
                       fe().system_to_component_index(j).first)
                     K(i, j) += pull * values.shape_grad(j, q);
               }
             }
           });
  return matrix;
}

TrilinosMatrix
ElasticSolid::geometric_stiffness(const SymmetricTensor<2, 2> &initial_stress) const
{
  return geometric_stiffness_of([&](const auto &, const FEValues<2> &, unsigned int)
                                { return initial_stress; });
}

TrilinosMatrix ElasticSolid::geometric_stiffness(const Vector &displacement) const
{
  const unsigned int n = fe().n_dofs_per_cell();
  std::vector<types::global_dof_index> dofs(n);
  return geometric_stiffness_of(
      [&](const auto &cell, const FEValues<2> &values, const unsigned int q)
      {
        cell->get_dof_indices(dofs);
        std::array<double, 3> strain{};
        for (unsigned int i = 0; i < n; ++i)
        {
          const auto of_dof =
              strain_of(fe().system_to_component_index(i).first, values.shape_grad(i, q));
          for (unsigned int k = 0; k < 3; ++k)
            strain[k] += of_dof[k] * displacement(dofs[i]);
        }
        const auto s = stress_of(material(cell->material_id()), strain);
        SymmetricTensor<2, 2> stress;
        stress[0][0] = s[0];
        stress[1][1] = s[1];
        stress[0][1] = s[2];
        return stress;
      });
}

const Vector &ElasticSolid::lumped_mass() const
{
  if (hanging_nodes() != nullptr)
    throw std::invalid_argument(
        "elastic solid: " + std::to_string(hanging_nodes()->n_dofs()) +
        " dofs hang on edges of larger cells and have no lumped mass; motion in time "
        "needs a mesh that is refined evenly.");
  return lumped_mass_;
}

void ElasticSolid::assemble_mass()
{
  lumped_mass_ = make_vector();
  FEValues<2> values(fe(), QGaussLobatto<2>(degree() + 1),
                     update_values | update_quadrature_points | update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe().n_dofs_per_cell());
  for (const auto &cell : dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      const double density = material(cell->material_id()).density;
      for (const unsigned int q : values.quadrature_point_indices())
      {
        const double mass = weight(values.quadrature_point(q)) * density * values.JxW(q);
        // The points are the nodes: one shape function of each component is not 0.
        for (unsigned int i = 0; i < dofs.size(); ++i)
          lumped_mass_(dofs[i]) += mass * values.shape_value(i, q);
      }
    }
  lumped_mass_.compress(VectorOperation::add);
  lumped_mass_.update_ghost_values();
}

std::vector<ElasticSolid::CellState>
ElasticSolid::cell_states(const Vector &displacement) const
{
  FEValues<2> values(fe(), QGauss<2>(degree() + 1),
                     update_gradients | update_quadrature_points | update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe().n_dofs_per_cell());
  std::vector<CellState> states;
  for (const auto &cell : dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      double area = 0., weighted_area = 0.;
      Tensor<2, 2> gradient; // [c][d] = integral of du_c/dx_d
      for (const unsigned int q : values.quadrature_point_indices())
      {
        area += values.JxW(q);
        weighted_area += weight(values.quadrature_point(q)) * values.JxW(q);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          gradient[fe().system_to_component_index(i).first] +=
              displacement(dofs[i]) * values.JxW(q) * values.shape_grad(i, q);
      }
      gradient /= area;

      CellState state;
      state.strain = {gradient[0][0], gradient[1][1], gradient[0][1] + gradient[1][0]};
      state.stress = stress_of(material(cell->material_id()), state.strain);
      state.rotation = 0.5 * (gradient[1][0] - gradient[0][1]);
      state.area = area;
      state.weight = weighted_area / area;
      state.material = cell->material_id();
      states.push_back(state);
    }
  return states;
}
} // namespace antiform::continuum

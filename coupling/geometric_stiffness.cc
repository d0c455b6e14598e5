#include "coupling/geometric_stiffness.h"

#include "discrete/joint_tangent.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe_values.h>

#include <stdexcept>
#include <string>

namespace antiform::coupling
{
namespace
{
using JointEntries = std::vector<Eigen::Triplet<double>>;

void add_entry(JointEntries &entries,
               const std::size_t row,
               const std::size_t column,
               const double value)
{
  if (value != 0.)
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
}

void add_joint(const StaticSystem &system,
               const std::size_t j,
               const discrete::JointMatrix &G,
               JointEntries &entries)
{
  const discrete::Joints &joints = system.joints();
  const auto place = [&](const std::size_t a)
  {
    const auto grain =
        static_cast<std::size_t>(a < 3 ? joints.first[j] : joints.second[j]);
    return system.index(grain, static_cast<unsigned int>(a % 3));
  };
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      add_entry(entries, place(a), place(b), G[a][b]);
}

void refuse_damage(const discrete::Joints &joints)
{
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.damage[j] >= 0)
      throw std::invalid_argument(
          "geometric stiffness: joint " + std::to_string(j) +
          " is damaged: linear buckling takes the prestress from intact joints. Ask for "
          "the stability of the present state instead.");
}

/// Less the integral of w_C S : e e, S from @p displacement: Green's to Biot's strain.
void add_biot_part(const continuum::ElasticSolid &solid,
                   const continuum::Vector &displacement,
                   const std::size_t begin,
                   JointEntries &entries)
{
  const auto &fe = solid.fe();
  dealii::FEValues<2> values(fe, dealii::QGauss<2>(fe.degree + 1),
                             dealii::update_gradients | dealii::update_quadrature_points |
                                 dealii::update_JxW_values);
  const unsigned int n = fe.n_dofs_per_cell();
  std::vector<dealii::types::global_dof_index> dofs(n);
  std::vector<dealii::SymmetricTensor<2, 2>> e(n);
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
  {
    values.reinit(cell);
    cell->get_dof_indices(dofs);
    const auto &C = solid.materials()[cell->material_id()].stiffness;
    dealii::FullMatrix<double> G(n, n);
    for (const unsigned int q : values.quadrature_point_indices())
    {
      dealii::SymmetricTensor<2, 2> strain;
      for (unsigned int i = 0; i < n; ++i)
      {
        dealii::Tensor<2, 2> gradient;
        gradient[fe.system_to_component_index(i).first] = values.shape_grad(i, q);
        e[i] = dealii::symmetrize(gradient);
        strain += displacement(dofs[i]) * e[i];
      }
      const std::array<double, 3> voigt{{strain[0][0], strain[1][1], 2. * strain[0][1]}};
      std::array<double, 3> s{};
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          s[r] += C[r][c] * voigt[c];
      dealii::Tensor<2, 2> stress;
      stress[0][0] = s[0];
      stress[1][1] = s[1];
      stress[0][1] = stress[1][0] = s[2];
      const double w = solid.weight(values.quadrature_point(q)) * values.JxW(q);
      for (unsigned int i = 0; i < n; ++i)
      {
        const dealii::Tensor<2, 2> one(e[i]), pulled = stress * one;
        for (unsigned int j = 0; j < n; ++j) // S : e_i e_j, symmetric part
          G(i, j) -= w * dealii::scalar_product(dealii::symmetrize(pulled), e[j]);
      }
    }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        add_entry(entries, begin + dofs[i], begin + dofs[j], G(i, j));
  }
}

void add_mesh(const StaticSystem &system,
              const continuum::Vector &displacement,
              const StrainMeasure measure,
              JointEntries &entries)
{
  const auto G = system.solid()->geometric_stiffness(displacement);
  for (unsigned int row = 0; row < system.solid()->dof_handler().n_dofs(); ++row)
    for (auto it = G.begin(row); it != G.end(row); ++it)
      add_entry(entries, system.mesh_begin() + row, system.mesh_begin() + it->column(),
                it->value());
  if (measure == StrainMeasure::biot)
    add_biot_part(*system.solid(), displacement, system.mesh_begin(), entries);
}

SparseMatrix assembled(const StaticSystem &system, const JointEntries &entries)
{
  const auto n = static_cast<Eigen::Index>(system.n_unknowns());
  SparseMatrix G(n, n);
  G.setFromTriplets(entries.begin(), entries.end());
  return G;
}
} // namespace

SparseMatrix geometric_stiffness(const StaticSystem &system,
                                 const StaticSolution &prestress,
                                 const StrainMeasure measure)
{
  const discrete::Joints &joints = system.joints();
  refuse_damage(joints);
  JointEntries entries;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const auto rows = joint_rows(joints, j);
    const auto one = static_cast<std::size_t>(joints.first[j]),
               two = static_cast<std::size_t>(joints.second[j]);
    const std::array<double, 6> u{{prestress.ux[one], prestress.uy[one],
                                   prestress.rotation[one], prestress.ux[two],
                                   prestress.uy[two], prestress.rotation[two]}};
    discrete::JointDeformation d;
    for (std::size_t a = 0; a < 6; ++a)
    {
      d.gap += rows[0][a] * u[a];
      d.shear += rows[1][a] * u[a];
    }
    add_joint(system, j,
              discrete::geometric_stiffness_at_rest(
                  joints, j, discrete::intact_tension(joints, j, d)),
              entries);
  }
  if (system.solid() != nullptr)
    add_mesh(system, prestress.mesh, measure, entries);
  return assembled(system, entries);
}

SparseMatrix present_geometric_stiffness(const StaticSystem &system,
                                         const continuum::Vector *const mesh_displacement,
                                         const StrainMeasure measure,
                                         const double kept_share)
{
  const discrete::Joints &joints = system.joints();
  JointEntries entries;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const double taken = joints.damage[j] < 0 ? 1. : 1. - kept_share;
    discrete::JointMatrix G = discrete::tangent_stiffness(system.grains(), joints, j);
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        for (std::size_t r = 0; r < 3; ++r)
          G[a][b] -= taken * rows[r][a] * stiffness[r] * rows[r][b];
    add_joint(system, j, G, entries);
  }
  if (mesh_displacement != nullptr)
    add_mesh(system, *mesh_displacement, measure, entries);
  return assembled(system, entries);
}
} // namespace antiform::coupling

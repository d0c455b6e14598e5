#include "coupling/bridging_domain.h"

#include <deal.II/base/point.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace antiform::coupling
{
namespace
{
SparseRows transposed(const SparseRows &rows, const std::size_t n_columns)
{
  SparseRows columns;
  columns.begin.assign(n_columns + 1, 0);
  for (const std::int32_t c : rows.column)
    ++columns.begin[c + 1];
  for (std::size_t c = 0; c < n_columns; ++c)
    columns.begin[c + 1] += columns.begin[c];
  columns.column.resize(rows.column.size());
  columns.value.resize(rows.value.size());
  std::vector<std::int32_t> next(columns.begin.begin(), columns.begin.end() - 1);
  for (std::size_t r = 0; r < rows.n_rows(); ++r)
    for (std::int32_t k = rows.begin[r]; k < rows.begin[r + 1]; ++k)
    {
      const std::int32_t place = next[rows.column[k]]++;
      columns.column[place] = static_cast<std::int32_t>(r);
      columns.value[place] = rows.value[k];
    }
  return columns;
}

Vec2 contact_point(const discrete::Grains &grains,
                   const discrete::Joints &joints,
                   const std::size_t j)
{
  const double r1 = 0.5 * (joints.length[j] - joints.lever_difference[j]);
  return grains.reference(joints.first[j]) +
         r1 * Vec2{joints.normal_x[j], joints.normal_y[j]};
}

dealii::Point<2> to_point(const Vec2 &v)
{
  return {v.x, v.y};
}

/// Lumped mass integral w_C rho N_J, at the points where the stiffness takes its weight.
/// At the nodes, as the solid takes it, the vertices on the rim of the core would have
/// the weight's floor for their mass, but not for their stiffness: a quarter of the step.
/// The functions of Q2 cells are not positive; there N_J^2 shares out the cell's mass.
continuum::Vector weighted_mass(const continuum::ElasticSolid &solid)
{
  const auto &fe = solid.fe();
  dealii::FEValues<2> values(fe, dealii::QGauss<2>(fe.degree + 1),
                             dealii::update_values | dealii::update_quadrature_points |
                                 dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> dofs(fe.n_dofs_per_cell());
  continuum::Vector mass = solid.make_vector();
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
  {
    values.reinit(cell);
    cell->get_dof_indices(dofs);
    const double density = solid.materials()[cell->material_id()].density;
    std::vector<double> share(dofs.size(), 0.);
    double cell_mass = 0., sum = 0.; // of the shares of one component
    for (const unsigned int q : values.quadrature_point_indices())
    {
      const double m = solid.weight(values.quadrature_point(q)) * density * values.JxW(q);
      cell_mass += m;
      for (unsigned int i = 0; i < dofs.size(); ++i)
      {
        const double N = values.shape_value(i, q),
                     part = m * (fe.degree == 1 ? N : N * N);
        share[i] += part;
        sum += 0.5 * part;
      }
    }
    for (unsigned int i = 0; i < dofs.size(); ++i)
      mass(dofs[i]) += share[i] * cell_mass / sum;
  }
  return mass;
}
} // namespace

std::vector<double> joint_weights(const discrete::Grains &grains,
                                  const discrete::Joints &joints,
                                  const OverlapWeight &weight)
{
  std::vector<double> weights(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    weights[j] = weight.grains(contact_point(grains, joints, j));
  return weights;
}

BridgingDomain::BridgingDomain(const discrete::Grains &grains,
                               const discrete::Joints &joints,
                               const continuum::ElasticSolid &solid,
                               OverlapWeight weight,
                               const double smallest_mass)
    : weight_(std::move(weight))
    , mesh_mass_(weighted_mass(solid))
{
  build_rows(grains, solid, smallest_mass);
  weigh_masses(grains, joints, solid);
}

void BridgingDomain::build_rows(const discrete::Grains &grains,
                                const continuum::ElasticSolid &solid,
                                const double smallest_mass)
{
  // By vertex: the grains that press on its multiplier, and the nodes that answer.
  struct Row
  {
    std::uint32_t dof_y = 0;
    double mass = 0.;
    std::vector<std::pair<std::int32_t, double>> grains;
    std::map<std::uint32_t, double> nodes; // by x dof
  };
  std::map<std::uint32_t, Row> rows; // by x dof of the vertex: a fixed order
  std::map<std::uint32_t, std::uint32_t> y_of_x;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 x = grains.reference(i);
    if (!weight_.in_overlap(x))
      continue;
    const auto index = static_cast<std::int32_t>(overlap_grains_.size());
    overlap_grains_.push_back(static_cast<std::int32_t>(i));
    const continuum::PointEvaluation vertex = solid.vertex_values(to_point(x));
    const continuum::PointEvaluation shape = solid.shape_values(to_point(x));
    for (std::size_t a = 0; a < vertex.value.size(); ++a)
    {
      Row &row = rows[static_cast<std::uint32_t>(vertex.dof_x[a])];
      row.dof_y = static_cast<std::uint32_t>(vertex.dof_y[a]);
      const double m = grains.mass[i] * vertex.value[a];
      row.mass += m;
      row.grains.emplace_back(index, m);
      for (std::size_t k = 0; k < shape.value.size(); ++k)
      {
        row.nodes[static_cast<std::uint32_t>(shape.dof_x[k])] -= m * shape.value[k];
        y_of_x[static_cast<std::uint32_t>(shape.dof_x[k])] =
            static_cast<std::uint32_t>(shape.dof_y[k]);
      }
    }
  }

  std::map<std::uint32_t, std::int32_t> node_index;
  for (const auto &[dof_x, dof_y] : y_of_x)
  {
    node_index[dof_x] = static_cast<std::int32_t>(node_dofs_.size());
    node_dofs_.push_back({dof_x, dof_y});
  }
  for (const auto &[dof_x, row] : rows)
  {
    if (row.mass <= smallest_mass)
      continue;
    for (const auto &[grain, m] : row.grains)
      grain_rows_.add(grain, m);
    grain_rows_.close_row();
    for (const auto &[node, m] : row.nodes)
      mesh_rows_.add(node_index[node], m);
    mesh_rows_.close_row();
    const dealii::Point<2> p = solid.support_point(dof_x);
    row_names_.push_back("vertex (" + std::to_string(p[0]) + " m, " +
                         std::to_string(p[1]) + " m)");
  }
  grain_columns_ = transposed(grain_rows_, overlap_grains_.size());
  mesh_columns_ = transposed(mesh_rows_, node_dofs_.size());
  node_of_dof_.assign(solid.dof_handler().n_dofs(), -1);
  for (std::size_t k = 0; k < node_dofs_.size(); ++k)
    for (const std::uint32_t dof : node_dofs_[k])
      node_of_dof_[dof] = static_cast<std::int32_t>(k);
  multiplier_.assign(n_multipliers(), 0.);
}

void BridgingDomain::weigh_masses(const discrete::Grains &grains,
                                  const discrete::Joints &joints,
                                  const continuum::ElasticSolid &solid)
{
  mu_.resize(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i)
    mu_[i] = weight_.grains(grains.reference(i));
  const std::vector<double> at_centre = mu_;
  const std::vector<double> of_joint = joint_weights(grains, joints, weight_);
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (const std::int32_t i : {joints.first[j], joints.second[j]})
      mu_[i] = std::max(mu_[i], of_joint[j]);

  const continuum::Vector whole = mesh_mass_;
  // The surplus is the mass of half a grain layer; reflection triples if it stays.
  for (const std::int32_t i : overlap_grains_)
  {
    const double surplus = grains.mass[i] * (mu_[i] - at_centre[i]);
    const continuum::PointEvaluation shape =
        solid.shape_values(to_point(grains.reference(i)));
    for (std::size_t k = 0; k < shape.value.size(); ++k)
    {
      mesh_mass_(shape.dof_x[k]) -= surplus * shape.value[k];
      mesh_mass_(shape.dof_y[k]) -= surplus * shape.value[k];
    }
  }
  for (const auto dof : solid.locally_owned())
    mesh_mass_(dof) = std::max(mesh_mass_(dof), 0.5 * whole(dof));
}

bool BridgingDomain::is_factorised_for(const discrete::Grains &grains) const
{
  for (std::size_t k = 0; k < overlap_grains_.size(); ++k)
    if (grain_inverse_mass_[k] != grains.inverse_mass[overlap_grains_[k]])
      return false;
  return true;
}

void BridgingDomain::factorise(const discrete::Grains &grains,
                               const continuum::Vector &inverse_mass)
{
  const auto n = static_cast<int>(grain_rows_.n_rows());
  grain_inverse_mass_.resize(overlap_grains_.size());
  for (std::size_t k = 0; k < overlap_grains_.size(); ++k)
    grain_inverse_mass_[k] = grains.inverse_mass[overlap_grains_[k]];
  node_inverse_mass_.resize(node_dofs_.size());
  for (std::size_t k = 0; k < node_dofs_.size(); ++k)
    node_inverse_mass_[k] = {inverse_mass(node_dofs_[k][0]),
                             inverse_mass(node_dofs_[k][1])};

  std::vector<Eigen::Triplet<double>> triplets;
  const auto add_products = [&](const SparseRows &columns, const int offset,
                                const std::function<double(std::size_t)> &mass_inverse)
  {
    for (std::size_t c = 0; c < columns.n_rows(); ++c)
    {
      const double m = mass_inverse(c);
      for (std::int32_t a = columns.begin[c]; a < columns.begin[c + 1]; ++a)
        for (std::int32_t b = columns.begin[c]; b < columns.begin[c + 1]; ++b)
          triplets.emplace_back(offset + columns.column[a], offset + columns.column[b],
                                columns.value[a] * m * columns.value[b]);
    }
  };
  for (const int component : {0, 1})
  {
    add_products(grain_columns_, component * n,
                 [&](const std::size_t c) { return grain_inverse_mass_[c]; });
    add_products(mesh_columns_, component * n,
                 [&](const std::size_t c) { return node_inverse_mass_[c][component]; });
  }
  Eigen::SparseMatrix<double> matrix(2 * n, 2 * n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  solver_.emplace(matrix, [this, n](const Eigen::Index row)
                  { return row_names_[row % n] + (row < n ? ", x" : ", y"); });
}

template <class GrainField, class MeshField>
void BridgingDomain::apply(const GrainField &grain_field,
                           const MeshField &mesh_field,
                           std::vector<double> &b) const
{
  const auto n = static_cast<std::int64_t>(grain_rows_.n_rows());
  b.resize(2 * n);
#pragma omp parallel for schedule(static)
  for (std::int64_t r = 0; r < n; ++r)
  {
    Vec2 sum;
    for (std::int32_t k = grain_rows_.begin[r]; k < grain_rows_.begin[r + 1]; ++k)
      sum += grain_rows_.value[k] * grain_field(overlap_grains_[grain_rows_.column[k]]);
    for (std::int32_t k = mesh_rows_.begin[r]; k < mesh_rows_.begin[r + 1]; ++k)
      sum += mesh_rows_.value[k] * mesh_field(node_dofs_[mesh_rows_.column[k]]);
    b[r] = sum.x;
    b[n + r] = sum.y;
  }
}

template <class ToGrain, class ToNode>
void BridgingDomain::apply_transposed(const std::vector<double> &L,
                                      const ToGrain &to_grain,
                                      const ToNode &to_node) const
{
  const std::size_t n = grain_rows_.n_rows();
  const auto column_sum = [&L, n](const SparseRows &columns, const std::int64_t c)
  {
    Vec2 sum;
    for (std::int32_t k = columns.begin[c]; k < columns.begin[c + 1]; ++k)
      sum += columns.value[k] * Vec2{L[columns.column[k]], L[n + columns.column[k]]};
    return sum;
  };
  const auto n_grains = static_cast<std::int64_t>(overlap_grains_.size());
  const auto n_nodes = static_cast<std::int64_t>(node_dofs_.size());
#pragma omp parallel
  {
#pragma omp for schedule(static) nowait
    for (std::int64_t c = 0; c < n_grains; ++c)
      to_grain(c, column_sum(grain_columns_, c));
#pragma omp for schedule(static)
    for (std::int64_t c = 0; c < n_nodes; ++c)
      to_node(c, column_sum(mesh_columns_, c));
  }
}

void BridgingDomain::project(discrete::Grains &grains, continuum::Vector &velocity)
{
  double *const v = velocity.begin();
  apply([&](const std::int32_t i) { return grains.velocity(i); },
        [v](const std::array<std::uint32_t, 2> &dofs) {
          return Vec2{v[dofs[0]], v[dofs[1]]};
        },
        multiplier_);
  solver_->solve(multiplier_);
  apply_transposed(
      multiplier_,
      [&](const std::int64_t c, const Vec2 &impulse)
      {
        grains.velocity_x[overlap_grains_[c]] -= grain_inverse_mass_[c] * impulse.x;
        grains.velocity_y[overlap_grains_[c]] -= grain_inverse_mass_[c] * impulse.y;
      },
      [&](const std::int64_t c, const Vec2 &impulse)
      {
        v[node_dofs_[c][0]] -= node_inverse_mass_[c][0] * impulse.x;
        v[node_dofs_[c][1]] -= node_inverse_mass_[c][1] * impulse.y;
      });
}

double BridgingDomain::mesh_impulse(const std::size_t dof) const
{
  const std::int32_t c = node_of_dof_[dof];
  if (c < 0)
    return 0.;
  const std::size_t offset = node_dofs_[c][0] == dof ? 0 : grain_rows_.n_rows();
  double sum = 0.;
  for (std::int32_t k = mesh_columns_.begin[c]; k < mesh_columns_.begin[c + 1]; ++k)
    sum += mesh_columns_.value[k] * multiplier_[offset + mesh_columns_.column[k]];
  return sum;
}

void BridgingDomain::constrain_forces(const discrete::Grains &grains,
                                      const continuum::Vector &inverse_mass,
                                      std::vector<double> &fx,
                                      std::vector<double> &fy,
                                      continuum::Vector &mesh_force) const
{
  double *const F = mesh_force.begin();
  const double *const Mi = inverse_mass.begin();
  std::vector<double> L;
  apply(
      [&](const std::int32_t i) {
        return grains.inverse_mass[i] * Vec2{fx[i], fy[i]};
      },
      [F, Mi](const std::array<std::uint32_t, 2> &dofs) {
        return Vec2{Mi[dofs[0]] * F[dofs[0]], Mi[dofs[1]] * F[dofs[1]]};
      },
      L);
  solver_->solve(L);
  apply_transposed(
      L,
      [&](const std::int64_t c, const Vec2 &force)
      {
        fx[overlap_grains_[c]] -= force.x;
        fy[overlap_grains_[c]] -= force.y;
      },
      [&](const std::int64_t c, const Vec2 &force)
      {
        F[node_dofs_[c][0]] -= force.x;
        F[node_dofs_[c][1]] -= force.y;
      });
}

double BridgingDomain::displacement_gap(const discrete::Grains &grains,
                                        const continuum::Vector &displacement) const
{
  const double *const u = displacement.begin();
  std::vector<double> g;
  apply(
      [&](const std::int32_t i) {
        return Vec2{grains.displacement_x[i], grains.displacement_y[i]};
      },
      [u](const std::array<std::uint32_t, 2> &dofs) {
        return Vec2{u[dofs[0]], u[dofs[1]]};
      },
      g);
  double largest = 0.;
  const std::size_t n = grain_rows_.n_rows();
  for (std::size_t r = 0; r < n; ++r)
  {
    double mass = 0.;
    for (std::int32_t k = grain_rows_.begin[r]; k < grain_rows_.begin[r + 1]; ++k)
      mass += grain_rows_.value[k];
    largest = std::max({largest, std::abs(g[r]) / mass, std::abs(g[n + r]) / mass});
  }
  return largest;
}
} // namespace antiform::coupling

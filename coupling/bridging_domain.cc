#include "coupling/bridging_domain.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>

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
    if (!cell->is_locally_owned())
      continue;
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
  mass.compress(dealii::VectorOperation::add);
  return mass;
}

/// Grains of the overlap that are not tied, ascending.
std::vector<std::int32_t> constrained_grains(const discrete::Grains &grains,
                                             const OverlapWeight &weight,
                                             const GrainTies &ties)
{
  std::vector<bool> is_tied(grains.size(), false);
  for (const GrainTie &tie : ties.ties())
    is_tied[tie.grain] = true;
  std::vector<std::int32_t> constrained;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (weight.in_overlap(grains.reference(i)) && !is_tied[i])
      constrained.push_back(static_cast<std::int32_t>(i));
  return constrained;
}


[[noreturn]] void refuse_factors(const double n)
{
  throw NumericalError("bridging domain", "the constraint matrix could not be solved", n,
                       0.);
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
                               const double smallest_mass,
                               const BridgingOptions &options)
    : weight_(std::move(weight))
    , ties_(grains, solid, options.tied_grains)
    , mesh_mass_(weighted_mass(solid))
    , node_of_dof_(solid.partitioner().locally_owned_size(), -1)
    , communicator_(solid.dof_handler().get_communicator())
    , is_alone_(dealii::Utilities::MPI::n_mpi_processes(communicator_) == 1)
{
  const std::vector<GrainPlace> places =
      grain_places(grains, solid, constrained_grains(grains, weight_, ties_));
  rows_ = constraint_rows(grains, solid, places, smallest_mass, options.multipliers);
  grain_columns_ = transposed(rows_.grains, rows_.overlap_grains.size());
  mesh_columns_ = transposed(rows_.nodes, rows_.node_dofs.size());
  multiplier_.assign(n_multipliers(), 0.);
  for (std::size_t k = 0; k < rows_.node_dofs.size(); ++k)
    for (const std::uint32_t dof : rows_.node_dofs[k])
      node_of_dof_[dof] = static_cast<std::int32_t>(k);
  weigh_masses(grains, joints, solid, places);
}

void BridgingDomain::weigh_masses(const discrete::Grains &grains,
                                  const discrete::Joints &joints,
                                  const continuum::ElasticSolid &solid,
                                  const std::vector<GrainPlace> &places)
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
  for (const GrainPlace &place : places)
  {
    const std::int32_t i = place.grain;
    const double surplus = grains.mass[i] * (mu_[i] - at_centre[i]);
    for (std::size_t k = 0; k < place.shape.value.size(); ++k)
      if (solid.locally_owned().is_element(place.shape.dof_x[k]))
      {
        mesh_mass_(place.shape.dof_x[k]) -= surplus * place.shape.value[k];
        mesh_mass_(place.shape.dof_y[k]) -= surplus * place.shape.value[k];
      }
  }
  for (const auto dof : solid.locally_owned())
    mesh_mass_(dof) = std::max(mesh_mass_(dof), 0.5 * whole(dof));
  for (const GrainTie &tie : ties_.ties())
    for (const GrainTie::Node &node : tie.nodes)
    {
      const double m = grains.mass[tie.grain] * mu_[tie.grain] * node.mass_share;
      mesh_mass_.local_element(node.dof_x) += m;
      mesh_mass_.local_element(node.dof_y) += m;
    }
}

bool BridgingDomain::is_factorised_for(const discrete::Grains &grains) const
{
  if (!solver_ && !distributed_)
    return false;
  for (std::size_t k = 0; k < rows_.overlap_grains.size(); ++k)
    if (grain_inverse_mass_[k] != grains.inverse_mass[rows_.overlap_grains[k]])
      return false;
  return true;
}

void BridgingDomain::factorise(const discrete::Grains &grains,
                               const continuum::Vector &inverse_mass)
{
  grain_inverse_mass_.resize(rows_.overlap_grains.size());
  for (std::size_t k = 0; k < rows_.overlap_grains.size(); ++k)
    grain_inverse_mass_[k] = grains.inverse_mass[rows_.overlap_grains[k]];
  node_inverse_mass_.resize(rows_.node_dofs.size());
  for (std::size_t k = 0; k < rows_.node_dofs.size(); ++k)
    node_inverse_mass_[k] = {inverse_mass.local_element(rows_.node_dofs[k][0]),
                             inverse_mass.local_element(rows_.node_dofs[k][1])};

  const auto n = static_cast<Eigen::Index>(rows_.grains.n_rows());
  const auto name_of_row = [this, n](const Eigen::Index row)
  { return rows_.names[row % n] + (row < n ? ", x" : ", y"); };
  if (is_alone_)
  {
    solver_.emplace(constraint_matrix<Eigen::SparseMatrix<double>>(), name_of_row);
    return;
  }
  std::vector<int> own;
  for (int row = 0; row < 2 * n; ++row)
    if (owns_row(row % n))
      own.push_back(row);
  distributed_ = std::make_unique<DistributedSystem>(
      constraint_matrix<DistributedSystem::Matrix>(), own, communicator_);
  demand_regular(distributed_->on_first_rank(), name_of_row, communicator_);
  if (!distributed_->factorise())
    refuse_factors(2 * n);
}

template <class Matrix>
Matrix BridgingDomain::constraint_matrix() const
{
  const auto n = static_cast<int>(rows_.grains.n_rows());
  std::vector<Eigen::Triplet<double>> triplets;
  const auto add_products = [&](const SparseRows &columns, const int offset,
                                const bool in_own_rows,
                                const std::function<double(std::size_t)> &mass_inverse)
  {
    for (std::size_t c = 0; c < columns.n_rows(); ++c)
    {
      const double m = mass_inverse(c);
      for (std::int32_t a = columns.begin[c]; a < columns.begin[c + 1]; ++a)
        for (std::int32_t b = columns.begin[c];
             b < columns.begin[c + 1] && (!in_own_rows || owns_row(columns.column[a]));
             ++b)
          triplets.emplace_back(offset + columns.column[a], offset + columns.column[b],
                                columns.value[a] * m * columns.value[b]);
    }
  };
  for (const int component : {0, 1})
  {
    add_products(grain_columns_, component * n, true,
                 [&](const std::size_t c) { return grain_inverse_mass_[c]; });
    add_products(mesh_columns_, component * n, false,
                 [&](const std::size_t c) { return node_inverse_mass_[c][component]; });
  }
  Matrix matrix(2 * n, 2 * n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

void BridgingDomain::solve(std::vector<double> &b) const
{
  if (is_alone_)
    solver_->solve(b);
  else if (!distributed_->solve(b.data()))
    refuse_factors(static_cast<double>(b.size()));
}

template <class GrainField, class MeshField>
void BridgingDomain::apply(const GrainField &grain_field,
                           const MeshField &mesh_field,
                           std::vector<double> &b) const
{
  const auto n = static_cast<std::int64_t>(rows_.grains.n_rows());
  b.resize(2 * n);
#pragma omp parallel for schedule(static)
  for (std::int64_t r = 0; r < n; ++r)
  {
    Vec2 sum;
    if (owns_row(r))
      for (std::int32_t k = rows_.grains.begin[r]; k < rows_.grains.begin[r + 1]; ++k)
        sum += rows_.grains.value[k] *
               grain_field(rows_.overlap_grains[rows_.grains.column[k]]);
    for (std::int32_t k = rows_.nodes.begin[r]; k < rows_.nodes.begin[r + 1]; ++k)
      sum += rows_.nodes.value[k] * mesh_field(rows_.node_dofs[rows_.nodes.column[k]]);
    b[r] = sum.x;
    b[n + r] = sum.y;
  }
}

template <class ToGrain, class ToNode>
void BridgingDomain::apply_transposed(const std::vector<double> &L,
                                      const ToGrain &to_grain,
                                      const ToNode &to_node) const
{
  const std::size_t n = rows_.grains.n_rows();
  const auto column_sum = [&L, n](const SparseRows &columns, const std::int64_t c)
  {
    Vec2 sum;
    for (std::int32_t k = columns.begin[c]; k < columns.begin[c + 1]; ++k)
      sum += columns.value[k] * Vec2{L[columns.column[k]], L[n + columns.column[k]]};
    return sum;
  };
  const auto n_grains = static_cast<std::int64_t>(rows_.overlap_grains.size());
  const auto n_nodes = static_cast<std::int64_t>(rows_.node_dofs.size());
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
  solve(multiplier_);
  apply_transposed(
      multiplier_,
      [&](const std::int64_t c, const Vec2 &impulse)
      {
        grains.velocity_x[rows_.overlap_grains[c]] -= grain_inverse_mass_[c] * impulse.x;
        grains.velocity_y[rows_.overlap_grains[c]] -= grain_inverse_mass_[c] * impulse.y;
      },
      [&](const std::int64_t c, const Vec2 &impulse)
      {
        v[rows_.node_dofs[c][0]] -= node_inverse_mass_[c][0] * impulse.x;
        v[rows_.node_dofs[c][1]] -= node_inverse_mass_[c][1] * impulse.y;
      });
  ties_.follow(grains, velocity);
}

double BridgingDomain::mesh_impulse(const std::size_t dof) const
{
  const std::int32_t c = node_of_dof_[dof];
  if (c < 0)
    return 0.;
  const std::size_t offset = rows_.node_dofs[c][0] == dof ? 0 : rows_.grains.n_rows();
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
  solve(L);
  apply_transposed(
      L,
      [&](const std::int64_t c, const Vec2 &force)
      {
        fx[rows_.overlap_grains[c]] -= force.x;
        fy[rows_.overlap_grains[c]] -= force.y;
      },
      [&](const std::int64_t c, const Vec2 &force)
      {
        F[rows_.node_dofs[c][0]] -= force.x;
        F[rows_.node_dofs[c][1]] -= force.y;
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
  if (!is_alone_)
    dealii::Utilities::MPI::sum(g, communicator_, g);
  double largest = 0.;
  const std::size_t n = rows_.grains.n_rows();
  for (std::size_t r = 0; r < n; ++r)
  {
    double mass = 0.;
    for (std::int32_t k = rows_.grains.begin[r]; k < rows_.grains.begin[r + 1]; ++k)
      mass += rows_.grains.value[k];
    largest = std::max({largest, std::abs(g[r]) / mass, std::abs(g[n + r]) / mass});
  }
  return largest;
}
} // namespace antiform::coupling

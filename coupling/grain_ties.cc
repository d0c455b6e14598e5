#include "coupling/grain_ties.h"

#include "continuum/point_locator.h"
#include "coupling/grain_components.h"
#include "coupling/grain_places.h"
#include "coupling/mesh_components.h"
#include "coupling/static_system.h"

#include <deal.II/base/quadrature.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace antiform::coupling
{
namespace
{
/// Part of the joints' graph that each grain belongs to.
std::vector<std::int32_t> connected_parts(const discrete::Joints &joints,
                                          const std::vector<bool> &is_out)
{
  std::vector<std::int32_t> part(is_out.size(), -1);
  for (std::size_t seed = 0; seed < part.size(); ++seed)
  {
    if (part[seed] >= 0)
      continue;
    std::vector<std::int32_t> open{static_cast<std::int32_t>(seed)};
    part[seed] = static_cast<std::int32_t>(seed);
    while (!open.empty())
    {
      const std::int32_t i = open.back();
      open.pop_back();
      if (is_out[i])
        continue; // nothing is held through a grain that is not held itself
      for (std::int32_t k = joints.grain_begin[i]; k < joints.grain_begin[i + 1]; ++k)
      {
        const std::int32_t j = joints.grain_joint[k], other = joints.first[j] == i
                                                                  ? joints.second[j]
                                                                  : joints.first[j];
        if (part[other] < 0 && !is_out[other])
        {
          part[other] = part[seed];
          open.push_back(other);
        }
      }
    }
  }
  return part;
}

/// Whether grain @p i can move while the grains that it is joined to rest: the smallest
/// eigenvalue of its own block of the unweighted stiffness, lengths in radii, relative to
/// the largest.
bool is_mechanism(const discrete::Grains &grains,
                  const discrete::Joints &joints,
                  const std::vector<bool> &is_out,
                  const std::size_t i)
{
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (std::int32_t k = joints.grain_begin[i]; k < joints.grain_begin[i + 1]; ++k)
  {
    const std::int32_t j = joints.grain_joint[k];
    const bool is_first = joints.first[j] == static_cast<std::int32_t>(i);
    if (is_out[is_first ? joints.second[j] : joints.first[j]])
      continue;
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    const double weight = joints.weight.empty() ? 1. : joints.weight[j];
    for (int r = 0; r < 3; ++r)
    {
      Eigen::Vector3d row;
      for (int c = 0; c < 3; ++c)
        row[c] = rows[r][(is_first ? 0 : 3) + c];
      row[2] /= grains.radius[i];
      block += stiffness[r] / weight * row * row.transpose();
    }
  }
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues();
  return !(values[0] > 1e-10 * values[2]);
}

/// theta = 1/2 curl: coefficient of the x and of the y dof of a node.
std::array<double, 2> turn_of(const GrainTie::Node &node)
{
  return {{-0.5 * node.by_y, 0.5 * node.by_x}};
}
} // namespace

std::vector<std::int32_t> unsupported_grains(const discrete::Grains &grains,
                                             const discrete::Joints &joints,
                                             const OverlapWeight &weight)
{
  const std::size_t n = grains.size();
  const auto in_core = [&](const std::size_t i)
  { return weight.distance_to_core(grains.reference(i)) == 0.; };
  std::vector<bool> is_out(n, false);
  for (bool found = true; found;)
  {
    found = false;
    const std::vector<std::int32_t> part = connected_parts(joints, is_out);
    std::vector<bool> reaches_core(n, false);
    for (std::size_t i = 0; i < n; ++i)
      if (in_core(i) && !is_out[i])
        reaches_core[part[i]] = true;
    for (std::size_t i = 0; i < n; ++i)
      if (!is_out[i] && !in_core(i) &&
          (!reaches_core[part[i]] || is_mechanism(grains, joints, is_out, i)))
        is_out[i] = found = true;
  }
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < n; ++i)
    if (is_out[i])
      result.push_back(static_cast<std::int32_t>(i));
  return result;
}

namespace
{
/// The sum over ranks, by the first: other ways may round differently on each rank.
std::vector<double> summed_with_equal_bits(std::vector<double> share,
                                           const MPI_Comm communicator)
{
  if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
    return share;
  const auto n = static_cast<int>(share.size());
  std::vector<double> sum(share.size());
  MPI_Reduce(share.data(), sum.data(), n, MPI_DOUBLE, MPI_SUM, 0, communicator);
  MPI_Bcast(sum.data(), n, MPI_DOUBLE, 0, communicator);
  return sum;
}

/// With all nodes of the cell, by global dofs.
GrainTie make_tie(const discrete::Grains &grains,
                  const continuum::ElasticSolid &solid,
                  const continuum::PointLocator &locator,
                  const std::int32_t grain)
{
  const auto &fe = solid.fe();
  std::vector<dealii::types::global_dof_index> dofs(fe.n_dofs_per_cell());
  const dealii::Point<2> x(grains.reference_x[grain], grains.reference_y[grain]);
  const auto place = locator.find(x);
  const dealii::DoFHandler<2>::active_cell_iterator cell(
      &solid.dof_handler().get_triangulation(), place.cell->level(), place.cell->index(),
      &solid.dof_handler());
  cell->get_dof_indices(dofs);
  dealii::FEValues<2> values(fe, dealii::Quadrature<2>(place.unit),
                             dealii::update_values | dealii::update_gradients);
  values.reinit(cell);
  const continuum::PointEvaluation vertex = solid.vertex_values(x);
  GrainTie tie{grain, {}};
  for (unsigned int k = 0; k < fe.base_element(0).n_dofs_per_cell(); ++k)
  {
    const unsigned int c = fe.component_to_system_index(0, k);
    GrainTie::Node node{
        static_cast<std::uint32_t>(dofs[c]),
        static_cast<std::uint32_t>(dofs[fe.component_to_system_index(1, k)]),
        values.shape_value(c, 0), values.shape_grad(c, 0)[0],
        values.shape_grad(c, 0)[1]};
    for (std::size_t v = 0; v < vertex.value.size(); ++v)
      if (vertex.dof_x[v] == node.dof_x)
        node.mass_share = vertex.value[v];
    tie.nodes.push_back(node);
  }
  return tie;
}
} // namespace

GrainTies::GrainTies(const discrete::Grains &grains,
                     const continuum::ElasticSolid &solid,
                     std::vector<std::int32_t> tied)
    : communicator_(solid.dof_handler().get_communicator())
{
  if (tied.empty())
    return;
  std::sort(tied.begin(), tied.end());
  tied.erase(std::unique(tied.begin(), tied.end()), tied.end());
  const continuum::PointLocator locator(solid.dof_handler().get_triangulation());
  ties_ = looked_up<GrainTie>(grains, solid, tied, [&](const std::int32_t grain)
                              { return make_tie(grains, solid, locator, grain); });
  for (GrainTie &tie : ties_)
  {
    std::vector<GrainTie::Node> own;
    for (GrainTie::Node node : tie.nodes)
      if (solid.locally_owned().is_element(node.dof_x))
      {
        node.dof_x = solid.partitioner().global_to_local(node.dof_x);
        node.dof_y = solid.partitioner().global_to_local(node.dof_y);
        own.push_back(node);
      }
    tie.nodes = std::move(own);
  }
}

void GrainTies::hold(discrete::Grains &grains) const
{
  for (const GrainTie &tie : ties_)
    grains.inverse_mass[tie.grain] = grains.inverse_inertia[tie.grain] = 0.;
}

void GrainTies::move_forces(discrete::Grains &grains, continuum::Vector &mesh_force) const
{
  double *const F = mesh_force.begin();
  for (const GrainTie &tie : ties_)
  {
    double &fx = grains.force_x[tie.grain], &fy = grains.force_y[tie.grain],
           &torque = grains.torque[tie.grain];
    for (const GrainTie::Node &node : tie.nodes)
    {
      const auto turn = turn_of(node);
      F[node.dof_x] += node.value * fx + turn[0] * torque;
      F[node.dof_y] += node.value * fy + turn[1] * torque;
    }
    fx = fy = torque = 0.;
  }
}

void GrainTies::follow(discrete::Grains &grains,
                       const continuum::Vector &mesh_velocity) const
{
  if (ties_.empty())
    return;
  const double *const V = mesh_velocity.begin();
  std::vector<double> share(3 * ties_.size(), 0.); // velocity, spin
  for (std::size_t t = 0; t < ties_.size(); ++t)
    for (const GrainTie::Node &node : ties_[t].nodes)
    {
      const auto turn = turn_of(node);
      share[3 * t] += node.value * V[node.dof_x];
      share[3 * t + 1] += node.value * V[node.dof_y];
      share[3 * t + 2] += turn[0] * V[node.dof_x] + turn[1] * V[node.dof_y];
    }
  const std::vector<double> all = summed_with_equal_bits(share, communicator_);
  for (std::size_t t = 0; t < ties_.size(); ++t)
  {
    grains.velocity_x[ties_[t].grain] = all[3 * t];
    grains.velocity_y[ties_[t].grain] = all[3 * t + 1];
    grains.spin[ties_[t].grain] = all[3 * t + 2];
  }
}

std::vector<double> GrainTies::absolute_row_sums(const discrete::Grains &grains,
                                                 const discrete::Joints &joints,
                                                 const std::size_t n_dofs) const
{
  std::map<std::int32_t, const GrainTie *> tie_of;
  for (const GrainTie &tie : ties_)
    tie_of[tie.grain] = &tie;
  std::vector<double> sums(n_dofs, 0.);
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::array<std::int32_t, 2> ends{{joints.first[j], joints.second[j]}};
    if (tie_of.count(ends[0]) == 0 && tie_of.count(ends[1]) == 0)
      continue;
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    for (int r = 0; r < 3; ++r)
    {
      std::map<std::uint32_t, double> of_dof;
      double of_grains = 0.; // sum of absolute entries; rotations in radii
      for (int e = 0; e < 2; ++e)
      {
        const double *const q = rows[r].data() + 3 * e;
        const auto tie = tie_of.find(ends[e]);
        if (tie == tie_of.end())
          of_grains +=
              std::abs(q[0]) + std::abs(q[1]) + std::abs(q[2]) / grains.radius[ends[e]];
        else
          for (const GrainTie::Node &node : tie->second->nodes)
          {
            const auto turn = turn_of(node);
            of_dof[node.dof_x] += q[0] * node.value + q[2] * turn[0];
            of_dof[node.dof_y] += q[1] * node.value + q[2] * turn[1];
          }
      }
      double all = of_grains;
      for (const auto &entry : of_dof)
        all += std::abs(entry.second);
      for (const auto &[dof, entry] : of_dof)
        sums[dof] += stiffness[r] * std::abs(entry) * all;
    }
  }
  return sums;
}

void TiedGrains::run(const Stage, const Clock &)
{
  ties_.move_forces(grains_.grains, mesh_.force);
}
} // namespace antiform::coupling

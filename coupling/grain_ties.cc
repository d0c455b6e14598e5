#include "coupling/grain_ties.h"

#include "continuum/point_locator.h"
#include "coupling/grain_components.h"
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

GrainTies::GrainTies(const discrete::Grains &grains,
                     const continuum::ElasticSolid &solid,
                     std::vector<std::int32_t> tied)
{
  if (tied.empty())
    return;
  std::sort(tied.begin(), tied.end());
  tied.erase(std::unique(tied.begin(), tied.end()), tied.end());
  const auto &triangulation = solid.dof_handler().get_triangulation();
  const continuum::PointLocator locator(triangulation);
  const auto &fe = solid.fe();
  std::vector<dealii::types::global_dof_index> dofs(fe.n_dofs_per_cell());
  for (const std::int32_t i : tied)
  {
    const dealii::Point<2> x(grains.reference_x[i], grains.reference_y[i]);
    const auto place = locator.find(x);
    const dealii::DoFHandler<2>::active_cell_iterator cell(
        &triangulation, place.cell->level(), place.cell->index(), &solid.dof_handler());
    cell->get_dof_indices(dofs);
    dealii::FEValues<2> values(fe, dealii::Quadrature<2>(place.unit),
                               dealii::update_values | dealii::update_gradients);
    values.reinit(cell);
    const continuum::PointEvaluation vertex = solid.vertex_values(x);
    GrainTie tie{i, {}};
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
    ties_.push_back(std::move(tie));
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
  const double *const V = mesh_velocity.begin();
  for (const GrainTie &tie : ties_)
  {
    double vx = 0., vy = 0., spin = 0.;
    for (const GrainTie::Node &node : tie.nodes)
    {
      const auto turn = turn_of(node);
      vx += node.value * V[node.dof_x];
      vy += node.value * V[node.dof_y];
      spin += turn[0] * V[node.dof_x] + turn[1] * V[node.dof_y];
    }
    grains.velocity_x[tie.grain] = vx;
    grains.velocity_y[tie.grain] = vy;
    grains.spin[tie.grain] = spin;
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

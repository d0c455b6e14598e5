#include "coupling/grain_balance.h"

#include "coupling/static_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace antiform::coupling
{
namespace
{
using discrete::Grains;
using discrete::Joints;

/// Tensile force at which an element breaks, in the mean of the breakable joints [N].
double mean_element_strength(const Joints &joints)
{
  double sum = 0.;
  std::size_t n = 0;
  for (const discrete::JointGroup &group : joints.groups)
  {
    const discrete::BondConstants law = discrete::constants(group.law);
    if (!law.breakable)
      continue;
    n += group.end - group.begin;
    for (std::size_t j = group.begin; j < group.end; ++j)
      sum += law.tensile_strength * 2. * joints.half_length[j] / law.n_elements *
             (joints.weight.empty() ? 1. : joints.weight[j]);
  }
  return n > 0 ? sum / static_cast<double>(n) : 0.;
}

/// Of a joint, over sigma_b / k_n, for displacements of no unknown beyond 1 m, rotations
/// at the rim.
double most_deformation(const Grains &grains, const Joints &joints)
{
  double most = 0.;
  for (const discrete::JointGroup &group : joints.groups)
  {
    const discrete::BondConstants law = discrete::constants(group.law);
    if (!law.breakable || !(law.tensile_strength > 0.))
      continue;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      const double rim =
          std::min(grains.radius[joints.first[j]], grains.radius[joints.second[j]]);
      most = std::max(most, joints.stiffness[j] / law.tensile_strength *
                                (2. * std::sqrt(2.) +
                                 (joints.length[j] + 2. * joints.half_length[j]) / rim));
    }
  }
  return most;
}

Eigen::Index index(const std::size_t grain, const unsigned int component)
{
  return static_cast<Eigen::Index>(3 * grain + component);
}
} // namespace

GrainBalance::GrainBalance(GrainState &state,
                           const std::vector<PrescribedMotion> &prescribed,
                           std::vector<GrainLoad> loads)
    : GrainBalance(state, prescribed, std::move(loads), 0)
{
  assemble();
}

GrainBalance::GrainBalance(GrainState &state,
                           const std::vector<PrescribedMotion> &prescribed,
                           std::vector<GrainLoad> loads,
                           const std::size_t n_more,
                           std::vector<OperatorSpring> operator_springs)
    : state_(state)
    , loads_(std::move(loads))
    , operator_springs_(std::move(operator_springs))
{
  const Grains &grains = state.grains;
  const auto n = static_cast<Eigen::Index>(3 * grains.size() + n_more);
  prescribed_ = rate_ = residual_ = support_ = Eigen::VectorXd::Zero(n);
  dead_loads_ = Eigen::VectorXd::Zero(n);
  levers_ = Eigen::VectorXd::Ones(n);
  element_strength_ = mean_element_strength(state.joints);
  most_deformation_ = most_deformation(grains, state.joints);
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    levers_[index(i, 2)] = grains.radius[i];
    if (state.joints.grain_begin[i] == state.joints.grain_begin[i + 1])
      prescribed_.segment<3>(index(i, 0)).setOnes();
  }
  for (const GrainLoad &load : loads_)
  {
    if (prescribed_[index(load.grain, 0)] > 0.)
      throw std::invalid_argument("grain " + std::to_string(load.grain) +
                                  " carries a load but no joint: nothing balances it");
    dead_loads_.segment<3>(index(load.grain, 0)) +=
        Eigen::Vector3d(load.force.x, load.force.y, load.torque);
  }
  for (const PrescribedMotion &motion : prescribed)
  {
    prescribed_[index(motion.grain, motion.component)] = 1.;
    rate_[index(motion.grain, motion.component)] = motion.rate;
  }
}

void GrainBalance::assemble(const std::vector<Eigen::Triplet<double>> &springs)
{
  const Joints &joints = state_.joints;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(22 * joints.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n_unknowns());
  const auto add =
      [&](const Eigen::Index row, const Eigen::Index column, const double value)
  {
    if (prescribed_[row] > 0.)
      return;
    if (prescribed_[column] > 0.)
      right[row] -= value * rate_[column];
    else if (row >= column)
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    for (unsigned int a = 0; a < 6; ++a)
      for (unsigned int b = 0; b < 6; ++b)
      {
        double value = 0.;
        for (unsigned int r = 0; r < 3; ++r)
          value += rows[r][a] * stiffness[r] * rows[r][b];
        add(index(a < 3 ? joints.first[j] : joints.second[j], a % 3),
            index(b < 3 ? joints.first[j] : joints.second[j], b % 3), value);
      }
  }
  for (const Eigen::Triplet<double> &spring : springs)
    add(spring.row(), spring.col(), spring.value());
  for (const OperatorSpring &spring : operator_springs_)
  {
    const Eigen::Index i = index(spring.grain, spring.component);
    add(i, i, spring.stiffness);
  }
  for (Eigen::Index i = 0; i < n_unknowns(); ++i)
    if (prescribed_[i] > 0.)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.);
  matrix_.resize(n_unknowns(), n_unknowns());
  matrix_.setFromTriplets(entries.begin(), entries.end());
  factor_.emplace(matrix_);
  is_precision_chosen_ = false;
  tangent_ = solve(right) + rate_;
}

void GrainBalance::add_forces(const discrete::StepTime &now,
                              std::vector<discrete::Crack> *cracks,
                              const bool keep_forces)
{
  Grains &grains = state_.grains;
  compute_joint_forces(grains, state_.joints, now, cracks, keep_forces);
  if (keep_forces)
  {
    double sum = 0.;
    for (const discrete::JointForce &force : state_.joints.force)
      sum += std::sqrt(force.x * force.x + force.y * force.y); // hypot is slow
    carried_ = sum / static_cast<double>(state_.joints.size());
    most_carried_ = std::max(most_carried_, carried_);
  }
  for (const GrainLoad &load : loads_)
  {
    grains.force_x[load.grain] += load.force.x;
    grains.force_y[load.grain] += load.force.y;
    grains.torque[load.grain] += load.torque;
  }
  add_outer_forces();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    double *const force[3] = {&grains.force_x[i], &grains.force_y[i], &grains.torque[i]};
    for (unsigned int c = 0; c < 3; ++c)
      if (prescribed_[index(i, c)] > 0.)
      {
        support_[index(i, c)] = -*force[c];
        *force[c] = 0.;
      }
  }
}

const Eigen::VectorXd &GrainBalance::residual()
{
  add_forces({}, nullptr, true);
  const Grains &grains = state_.grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
    residual_.segment<3>(index(i, 0)) << grains.force_x[i], grains.force_y[i],
        grains.torque[i];
  return residual_;
}

BalanceRatios GrainBalance::ratios_with(const double further) const
{
  const Grains &grains = state_.grains;
  double sum = further, largest = further, n_free = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const double force[3] = {grains.force_x[i], grains.force_y[i],
                             grains.torque[i] / grains.radius[i]};
    for (unsigned int c = 0; c < 3; ++c)
      if (prescribed_[index(i, c)] == 0.)
      {
        sum += std::abs(force[c]);
        largest = std::max(largest, std::abs(force[c]));
        n_free += 1.;
      }
  }
  return over_joint_forces(sum / std::max(1., n_free), largest);
}

BalanceRatios GrainBalance::over_joint_forces(const double mean,
                                              const double largest) const
{
  if (largest == 0.)
    return {};
  const double carried = reference_force();
  return {mean / carried, largest / carried,
          element_strength_ > 0. ? largest / element_strength_ : 0.};
}

double GrainBalance::reference_force() const
{
  return std::max(carried_, 0.05 * most_carried_);
}

double GrainBalance::allowed_force(const BalanceRatios &limits) const
{
  const double by_joints = limits.largest * reference_force();
  return element_strength_ > 0.
             ? std::min(by_joints, limits.of_strength * element_strength_)
             : by_joints;
}

void GrainBalance::add_outer_forces_on(const Grains &,
                                       const std::vector<std::int32_t> &,
                                       const std::size_t,
                                       Eigen::VectorXd &) const
{
}

double GrainBalance::conjugate_force() const
{
  return support_.dot(rate_);
}

Eigen::VectorXd GrainBalance::solve(const Eigen::VectorXd &r) const
{
  return factor_->solve((prescribed_.array() > 0.).select(0., r));
}

Eigen::VectorXd GrainBalance::correction(const Eigen::VectorXd &r)
{
  constexpr double most_left = 0.01; // of an error
  if (!is_precision_chosen_)
    factor_->round_for_corrections(matrix_, most_left);
  is_precision_chosen_ = true;
  return factor_->correction((prescribed_.array() > 0.).select(0., r));
}

void GrainBalance::move(const Eigen::VectorXd &increment)
{
  Grains &grains = state_.grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    grains.displacement_x[i] += increment[index(i, 0)];
    grains.displacement_y[i] += increment[index(i, 1)];
    grains.rotation[i] += increment[index(i, 2)];
  }
}

double GrainBalance::load_work(const Eigen::VectorXd &increment) const
{
  return loads_.empty() ? 0. : dead_loads_.dot(increment);
}

double GrainBalance::load_potential() const
{
  const Grains &grains = state_.grains;
  double work = 0.;
  for (const GrainLoad &load : loads_)
    work += load.force.x * grains.displacement_x[load.grain] +
            load.force.y * grains.displacement_y[load.grain] +
            load.torque * grains.rotation[load.grain];
  return work;
}

double GrainBalance::deformation(const Eigen::VectorXd &increment,
                                 const double negligible) const
{
  const double bound =
      most_deformation_ * increment.cwiseProduct(levers_).cwiseAbs().maxCoeff();
  if (bound <= negligible)
    return bound;
  const Joints &joints = state_.joints;
  double worst = 0.;
  for (const discrete::JointGroup &group : joints.groups)
  {
    const discrete::BondConstants law = discrete::constants(group.law);
    if (!law.breakable || !(law.tensile_strength > 0.))
      continue;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      const auto rows = joint_rows(joints, j);
      double d[3]; // gap, shear, rotation
      for (unsigned int r = 0; r < 3; ++r)
      {
        d[r] = 0.;
        for (unsigned int a = 0; a < 6; ++a)
          d[r] += rows[r][a] *
                  increment[index(a < 3 ? joints.first[j] : joints.second[j], a % 3)];
      }
      const double deformation =
          std::sqrt(d[0] * d[0] + d[1] * d[1]) + joints.half_length[j] * std::abs(d[2]);
      worst = std::max(worst, deformation * joints.stiffness[j] / law.tensile_strength);
    }
  }
  return worst;
}
} // namespace antiform::coupling

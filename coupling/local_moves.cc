#include "coupling/local_moves.h"

#include "discrete/joint_damage.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling
{
namespace
{
using discrete::DamagedJoints;
using discrete::Grains;
using discrete::Joints;

void copy_record(const DamagedJoints &from,
                 const std::size_t k,
                 const int n_elements,
                 DamagedJoints &to,
                 const std::size_t l)
{
  for (int e = 0; e < n_elements; ++e)
  {
    to.set_bond(l, e, from.bond(k, e));
    to.set_slip(l, e, from.slip(k, e));
  }
  to.removed[l] = from.removed[k];
  to.gap[l] = from.gap[k];
  to.shear[l] = from.shear[k];
  to.rotation[l] = from.rotation[k];
  to.slip_energy[l] = from.slip_energy[k];
  to.fracture_energy[l] = from.fracture_energy[k];
  to.force[l] = from.force[k];
}

int n_elements(const Joints &joints, const std::size_t group)
{
  return discrete::constants(joints.groups[group].law).n_elements;
}

/// Entries @p numbers of @p all, or nothing where there are none.
void copy_some(const std::vector<double> &all,
               const std::vector<std::int32_t> &numbers,
               std::vector<double> &some)
{
  some.resize(all.empty() ? 0 : numbers.size());
  for (std::size_t k = 0; k < some.size(); ++k)
    some[k] = all[numbers[k]];
}
} // namespace

LocalMoves::LocalMoves(GrainBalance &body,
                       const LocalSettings &settings,
                       const double mean_diameter)
    : body_(body)
    , settings_(settings)
    , diameter_(mean_diameter)
    , local_(body.state().grains.size(), -1)
{
  patch_.joints.groups = body.state().joints.groups;
}

LocalResult LocalMoves::relax(const discrete::LoadedElement &first,
                              const discrete::StepTime &now,
                              const double allowed)
{
  gather(first.joint);
  factorise();
  LocalResult result;
  evaluate();
  balance(settings_.share * allowed, result);
  while (result.breaks < settings_.most_breaks &&
         break_next(now, result.breaks == 0 ? &first : nullptr))
  {
    ++result.breaks;
    evaluate();
    balance(settings_.share * allowed, result);
  }
  give_back();
  return result;
}

void LocalMoves::gather(const std::size_t joint)
{
  gather_members(joint);
  gather_joints();
  copy_grains();
  copy_joints();
}

/// The grains within the radius, as far as joints lead to them.
void LocalMoves::gather_members(const std::size_t joint)
{
  const Grains &grains = body_.state().grains;
  const Joints &joints = body_.state().joints;
  const double radius = settings_.radius * diameter_;
  grains_ = {joints.first[joint], joints.second[joint]};
  centre_ = 0.5 * (grains.reference(grains_[0]) + grains.reference(grains_[1]));
  Vec2 least = centre_, most = centre_;
  local_[grains_[0]] = local_[grains_[1]] = 0;
  for (std::size_t m = 0; m < grains_.size(); ++m)
  {
    const std::int32_t i = grains_[m];
    const Vec2 place = grains.reference(i);
    least = {std::min(least.x, place.x), std::min(least.y, place.y)};
    most = {std::max(most.x, place.x), std::max(most.y, place.y)};
    for (std::int32_t l = joints.grain_begin[i]; l < joints.grain_begin[i + 1]; ++l)
    {
      const std::int32_t j = joints.grain_joint[l], other = joints.first[j] == i
                                                                ? joints.second[j]
                                                                : joints.first[j];
      if (local_[other] < 0 && norm(grains.reference(other) - centre_) <= radius)
      {
        local_[other] = 0;
        grains_.push_back(other);
      }
    }
  }
  // Along the longer side: the band of the operator is then narrow.
  const std::vector<double> &along =
      most.x - least.x > most.y - least.y ? grains.reference_x : grains.reference_y;
  std::sort(grains_.begin(), grains_.end(),
            [&](const std::int32_t one, const std::int32_t two)
            { return along[one] != along[two] ? along[one] < along[two] : one < two; });
  n_members_ = grains_.size();
  for (std::size_t m = 0; m < n_members_; ++m)
    local_[grains_[m]] = static_cast<std::int32_t>(m);
}

/// All joints of the patch's own grains, and the ring that they reach.
void LocalMoves::gather_joints()
{
  const Joints &joints = body_.state().joints;
  joints_.clear();
  for (std::size_t m = 0; m < n_members_; ++m)
  {
    const std::int32_t i = grains_[m];
    for (std::int32_t l = joints.grain_begin[i]; l < joints.grain_begin[i + 1]; ++l)
    {
      const std::int32_t j = joints.grain_joint[l], other = joints.first[j] == i
                                                                ? joints.second[j]
                                                                : joints.first[j];
      if (local_[other] < 0)
      {
        local_[other] = static_cast<std::int32_t>(grains_.size());
        grains_.push_back(other);
      }
      // A joint of two members is met twice.
      if (joints.first[j] == i || local_[other] >= static_cast<std::int32_t>(n_members_))
        joints_.push_back(j);
    }
  }
  std::sort(joints_.begin(), joints_.end());
}

void LocalMoves::copy_grains()
{
  const Grains &all = body_.state().grains;
  Grains &grains = patch_.grains;
  for (std::vector<double> Grains::*field :
       {&Grains::reference_x, &Grains::reference_y, &Grains::radius,
        &Grains::displacement_x, &Grains::displacement_y, &Grains::rotation})
    copy_some(all.*field, grains_, grains.*field);
  for (std::vector<double> Grains::*field :
       {&Grains::velocity_x, &Grains::velocity_y, &Grains::spin, &Grains::force_x,
        &Grains::force_y, &Grains::torque})
    (grains.*field).assign(grains_.size(), 0.);

  const auto n = static_cast<Eigen::Index>(3 * n_members_);
  is_free_.resize(n);
  levers_.resize(n);
  loads_.resize(n);
  for (std::size_t m = 0; m < n_members_; ++m)
  {
    const auto here = static_cast<Eigen::Index>(3 * m);
    const auto there = static_cast<Eigen::Index>(3 * grains_[m]);
    is_free_.segment<3>(here) = 1. - body_.prescribed().segment<3>(there).array();
    levers_.segment<3>(here) = body_.levers().segment<3>(there);
    loads_.segment<3>(here) = body_.dead_loads().segment<3>(there);
  }
}

void LocalMoves::copy_joints()
{
  const Joints &all = body_.state().joints;
  Joints &joints = patch_.joints;
  const std::size_t n = joints_.size();
  for (std::vector<double> Joints::*field :
       {&Joints::normal_x, &Joints::normal_y, &Joints::length, &Joints::lever_difference,
        &Joints::stiffness, &Joints::half_length, &Joints::weight,
        &Joints::tension_factor, &Joints::cohesion_factor, &Joints::initial_gap,
        &Joints::initial_shear, &Joints::initial_rotation})
    copy_some(all.*field, joints_, joints.*field);
  joints.first.resize(n);
  joints.second.resize(n);
  joints.damage.assign(n, -1);
  joints.would_break.assign(n, 0);
  joints.force.resize(n);
  joints.damaged.clear();
  std::size_t j = 0;
  for (std::size_t g = 0; g < all.groups.size(); ++g)
  {
    joints.groups[g].begin = j;
    for (; j < n && static_cast<std::size_t>(joints_[j]) < all.groups[g].end; ++j)
    {
      joints.first[j] = local_[all.first[joints_[j]]];
      joints.second[j] = local_[all.second[joints_[j]]];
      if (const std::int32_t k = all.damage[joints_[j]]; k >= 0)
      {
        joints.damage[j] = static_cast<std::int32_t>(joints.damaged.size());
        const std::size_t l = joints.damaged.append(j, g, n_elements(all, g));
        copy_record(all.damaged, k, n_elements(all, g), joints.damaged, l);
      }
    }
    joints.groups[g].end = j;
  }
  joints.finish(grains_.size());
}

/// The operator's part that belongs to the patch's own grains.
void LocalMoves::factorise()
{
  const Joints &joints = patch_.joints;
  const auto n = static_cast<std::int32_t>(n_members_);
  std::int32_t apart = 0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.first[j] < n && joints.second[j] < n)
      apart = std::max(apart, std::abs(joints.first[j] - joints.second[j]));
  factor_.reset(3 * n, 3 * apart + 2);
  const Eigen::SparseMatrix<double> &matrix = body_.matrix();
  for (std::int32_t m = 0; m < n; ++m)
    for (int c = 0; c < 3; ++c)
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, 3 * grains_[m] + c); it;
           ++it)
      {
        const Eigen::Index grain = it.row() / 3;
        if (grain >= static_cast<Eigen::Index>(local_.size()) || local_[grain] < 0 ||
            local_[grain] >= n)
          continue;
        const Eigen::Index row = 3 * local_[grain] + it.row() % 3, column = 3 * m + c;
        factor_.entry(std::max(row, column), std::min(row, column)) += it.value();
      }
  factor_.factorise(); // a part of a factor that exists
}

void LocalMoves::evaluate()
{
  compute_joint_forces(patch_.grains, patch_.joints, {}, nullptr, false);
  residual_ = loads_;
  for (std::size_t m = 0; m < n_members_; ++m)
    residual_.segment<3>(static_cast<Eigen::Index>(3 * m)) += Eigen::Vector3d(
        patch_.grains.force_x[m], patch_.grains.force_y[m], patch_.grains.torque[m]);
  body_.add_outer_forces_on(patch_.grains, local_, n_members_, residual_);
  residual_ = residual_.cwiseProduct(is_free_);
}

double LocalMoves::worst() const
{
  return residual_.cwiseQuotient(levers_).cwiseAbs().maxCoeff();
}

void LocalMoves::balance(const double allowed, LocalResult &result)
{
  anderson_.reset();
  double last = worst();
  for (int c = 0; last > allowed && c < settings_.most_corrections; ++c)
  {
    Eigen::VectorXd step = factor_.solve(residual_).cwiseProduct(levers_);
    step = anderson_.increment(step).cwiseQuotient(levers_);
    for (std::size_t m = 0; m < n_members_; ++m)
    {
      const auto first = static_cast<Eigen::Index>(3 * m);
      patch_.grains.displacement_x[m] += step[first];
      patch_.grains.displacement_y[m] += step[first + 1];
      patch_.grains.rotation[m] += step[first + 2];
    }
    const Eigen::VectorXd before = residual_;
    evaluate();
    result.held += 0.5 * (before + residual_).dot(step);
    result.load_work += loads_.dot(step);
    ++result.corrections;
    const double now = worst();
    if (now > last)
      anderson_.reset();
    last = now;
  }
}

/// Break @p first, or else the most loaded bond of the core; false where it is not over.
bool LocalMoves::break_next(const discrete::StepTime &now,
                            const discrete::LoadedElement *first)
{
  const discrete::LoadedElement *next = nullptr;
  const std::vector<discrete::LoadedElement> over =
      discrete::overstressed_elements(patch_.grains, patch_.joints);
  for (const discrete::LoadedElement &element : over)
  {
    const std::size_t j = element.joint;
    const Vec2 place = 0.5 * (patch_.grains.reference(patch_.joints.first[j]) +
                              patch_.grains.reference(patch_.joints.second[j]));
    if (first != nullptr
            ? static_cast<std::size_t>(joints_[j]) == first->joint &&
                  element.element == first->element
            : norm(place - centre_) <= settings_.core * diameter_ &&
                  (next == nullptr || element.factor.value > next->factor.value))
      next = &element;
  }
  if (next == nullptr)
    return false;
  std::vector<discrete::Crack> &cracks = body_.state().cracks;
  discrete::break_elements(patch_.grains, patch_.joints, {*next}, now, cracks);
  cracks.back().joint = static_cast<std::size_t>(joints_[cracks.back().joint]);
  cracks.back().grain = static_cast<std::size_t>(grains_[cracks.back().grain]);
  return true;
}

void LocalMoves::give_back()
{
  Grains &grains = body_.state().grains;
  Joints &joints = body_.state().joints;
  for (std::size_t m = 0; m < n_members_; ++m)
  {
    grains.displacement_x[grains_[m]] = patch_.grains.displacement_x[m];
    grains.displacement_y[grains_[m]] = patch_.grains.displacement_y[m];
    grains.rotation[grains_[m]] = patch_.grains.rotation[m];
  }
  const DamagedJoints &damaged = patch_.joints.damaged;
  for (std::size_t k = 0; k < damaged.size(); ++k)
  {
    const std::size_t j = joints_[damaged.joint[k]];
    const auto record = joints.damage[j] < 0 ? discrete::add_damaged(joints, j)
                                             : static_cast<std::size_t>(joints.damage[j]);
    copy_record(damaged, k, n_elements(joints, damaged.group[k]), joints.damaged, record);
  }
  for (const std::int32_t i : grains_)
    local_[i] = -1;
}
} // namespace antiform::coupling

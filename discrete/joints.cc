#include "discrete/joints.h"

#include "discrete/joint_kernel.h"
#include "discrete/joint_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
void Joints::begin_group(const JointLaw &law, const int layer, const std::string &name)
{
  JointGroup group;
  group.begin = group.end = size();
  group.law = law;
  group.layer = layer;
  group.name = name;
  groups.push_back(group);
}

double joint_stiffness(const double radius_i,
                       const double radius_j,
                       const double modulus_i,
                       const double modulus_j)
{
  return 1. / (radius_i / modulus_i + radius_j / modulus_j);
}

void Joints::add(const Grains &grains,
                 const std::int32_t i,
                 const std::int32_t j,
                 const double modulus_i,
                 const double modulus_j)
{
  assert(!groups.empty() && i != j);
  const Vec2 branch = grains.position(j) - grains.position(i);
  const double distance = norm(branch);
  // A joint's normal is the direction of its branch; rounding takes it over below this.
  if (!(distance > 1e-9 * std::min(grains.radius[i], grains.radius[j])))
    throw std::invalid_argument(
        "Joints: the centres of grains " + std::to_string(i) + " and " +
        std::to_string(j) + " coincide at (" + std::to_string(grains.position(i).x) +
        ", " + std::to_string(grains.position(i).y) +
        ") m: a joint between them has no direction. Take one of them out.");
  first.push_back(i);
  second.push_back(j);
  normal_x.push_back(branch.x / distance);
  normal_y.push_back(branch.y / distance);
  length.push_back(distance);
  // The contact point is in the middle of the gap (or overlap): r = R + gap/2.
  lever_difference.push_back(grains.radius[j] - grains.radius[i]);
  stiffness.push_back(
      joint_stiffness(grains.radius[i], grains.radius[j], modulus_i, modulus_j));
  half_length.push_back(constants(groups.back().law).radius_multiplier *
                        std::min(grains.radius[i], grains.radius[j]));
  damage.push_back(-1);
  would_break.push_back(0);
  force.push_back({0., 0., 0., 0.});
  groups.back().end = size();
}

void Joints::finish(const std::size_t n_grains)
{
  grain_begin.assign(n_grains + 1, 0);
  for (std::size_t j = 0; j < size(); ++j)
  {
    ++grain_begin[first[j] + 1];
    ++grain_begin[second[j] + 1];
  }
  for (std::size_t i = 0; i < n_grains; ++i)
    grain_begin[i + 1] += grain_begin[i];
  grain_joint.resize(2 * size());
  std::vector<std::int32_t> next(grain_begin.begin(), grain_begin.end() - 1);
  for (std::size_t j = 0; j < size(); ++j)
    for (const std::int32_t i : {first[j], second[j]})
      grain_joint[next[i]++] = static_cast<std::int32_t>(j);
  work.parts.clear();
}

std::size_t Joints::group_number(const std::size_t joint) const
{
  std::size_t g = 0;
  while (g + 1 < groups.size() && joint >= groups[g].end)
    ++g;
  return g;
}

namespace
{
JointDeformation deformation(const Grains &grains,
                             const Joints &joints,
                             const std::size_t j,
                             const double time_back)
{
  const std::size_t one = joints.first[j], two = joints.second[j];
  const auto difference = [&](const std::vector<double> &u, const std::vector<double> &v)
  { return (u[two] - time_back * v[two]) - (u[one] - time_back * v[one]); };
  const double rotation1 = grains.rotation[one] - time_back * grains.spin[one];
  const double rotation2 = grains.rotation[two] - time_back * grains.spin[two];
  const JointGeometry<double> at =
      joint_geometry(InstalledFrame<double>{joints.normal_x[j], joints.normal_y[j],
                                            joints.length[j], joints.lever_difference[j]},
                     half_angles(rotation1, rotation2),
                     difference(grains.displacement_x, grains.velocity_x),
                     difference(grains.displacement_y, grains.velocity_y));
  JointDeformation d{at.gap, at.shear, rotation2 - rotation1};
  if (!joints.initial_gap.empty())
  {
    d.gap += joints.initial_gap[j];
    d.shear += joints.initial_shear[j];
    d.rotation += joints.initial_rotation[j];
  }
  return d;
}
} // namespace

JointDeformation
deformation(const Grains &grains, const Joints &joints, const std::size_t j)
{
  return deformation(grains, joints, j, 0.);
}

JointDeformation deformation_before(const Grains &grains,
                                    const Joints &joints,
                                    const std::size_t j,
                                    const double dt)
{
  return deformation(grains, joints, j, dt);
}

StiffnessSums
stiffness_sums(const Grains &grains, const Joints &joints, const bool weighted)
{
  StiffnessSums sums{std::vector<double>(grains.size(), 0.),
                     std::vector<double>(grains.size(), 0.)};
  for (const JointGroup &group : joints.groups)
  {
    const BondConstants bond = constants(group.law);
    // Rotation: as the whole interface of a flat joint, whatever share of it elements
    // without a moment of their own leave out.
    const double bending_factor = bond.moment_factor > 0. ? 1. / 12. : 0.;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      const double full = 2. * joints.half_length[j];
      double normal = joints.stiffness[j] * full;
      if (weighted && !joints.weight.empty())
        normal *= joints.weight[j];
      const double shear = normal / bond.stiffness_ratio;
      const double bending = normal * full * full * bending_factor;
      for (const int side : {0, 1})
      {
        const std::size_t i = side == 0 ? joints.first[j] : joints.second[j];
        const double lever = 0.5 * (joints.length[j] +
                                    (side == 0 ? -1. : 1.) * joints.lever_difference[j]);
        sums.translation[i] += normal + shear;
        sums.rotation[i] += shear * lever * lever + bending;
      }
    }
  }
  return sums;
}
} // namespace antiform::discrete

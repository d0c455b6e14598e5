#include "discrete/joint_damage.h"
#include "discrete/joint_kernel.h"
#include "discrete/joints.h"
#include "discrete/threading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
namespace
{
IntactKernelInput kernel_input(Joints &joints,
                               const JointGroup &group,
                               const std::vector<GrainLine> &lines,
                               const bool look_at_strengths)
{
  const FlatJoint &law = group.law;
  const auto pointer = [](const std::vector<double> &v)
  { return v.empty() ? nullptr : v.data(); };
  IntactKernelInput in{};
  in.grains = lines.data();
  in.first = joints.first.data();
  in.second = joints.second.data();
  in.normal_x = joints.normal_x.data();
  in.normal_y = joints.normal_y.data();
  in.length = joints.length.data();
  in.lever_difference = joints.lever_difference.data();
  in.stiffness = joints.stiffness.data();
  in.half_length = joints.half_length.data();
  in.weight = pointer(joints.weight);
  in.initial_gap = pointer(joints.initial_gap);
  in.initial_shear = pointer(joints.initial_shear);
  in.initial_rotation = pointer(joints.initial_rotation);
  in.shear_ratio = 1. / law.stiffness_ratio;
  const double n = law.n_elements;
  in.moment_factor = (law.element_moment ? 1. : 1. - 1. / (n * n)) / 12.;
  in.outer_centroid = 1. - 1. / n;
  constexpr double none = std::numeric_limits<double>::infinity();
  // An unbreakable group without strengths is not looked at.
  const bool tested = look_at_strengths &&
                      (law.breakable || law.tensile_strength > 0. || law.cohesion > 0.);
  in.tensile_strength = tested ? law.tensile_strength : none;
  in.cohesion = tested ? law.cohesion : none;
  in.tan_friction = tested ? law.tan_friction : 0.;
  in.force = joints.force.data();
  return in;
}

/// Deformation of a joint one step ago, from the half-step velocities that led here.
JointDeformation deformation_before(const Grains &grains,
                                    const Joints &joints,
                                    const std::size_t j,
                                    const double dt)
{
  Grains pair;
  for (const std::int32_t i : {joints.first[j], joints.second[j]})
  {
    pair.add(grains.reference(i), grains.radius[i], 1., 0);
    pair.displacement_x.back() = grains.displacement_x[i] - dt * grains.velocity_x[i];
    pair.displacement_y.back() = grains.displacement_y[i] - dt * grains.velocity_y[i];
    pair.rotation.back() = grains.rotation[i] - dt * grains.spin[i];
  }
  Joints one;
  one.first = {0};
  one.second = {1};
  one.normal_x = {joints.normal_x[j]};
  one.normal_y = {joints.normal_y[j]};
  one.length = {joints.length[j]};
  one.lever_difference = {joints.lever_difference[j]};
  if (!joints.initial_gap.empty())
  {
    one.initial_gap = {joints.initial_gap[j]};
    one.initial_shear = {joints.initial_shear[j]};
    one.initial_rotation = {joints.initial_rotation[j]};
  }
  return deformation(pair, one, 0);
}

/// First breaks of joints that the vector kernel found over a strength, in joint order.
void break_intact(const Grains &grains,
                  Joints &joints,
                  const JointGroup &group,
                  const std::vector<std::int32_t> &over,
                  const StepTime &now,
                  std::vector<Crack> &cracks)
{
  for (const std::int32_t j : over)
  {
    if (joints.damage[j] >= 0)
      continue; // its slot is overwritten by the full law
    if (!group.law.breakable)
    {
      joints.would_break[j] = 1;
      continue;
    }
    const std::size_t n_before = cracks.size();
    DamagedJoint damaged = make_damaged(joints, j);
    const JointDeformation before = deformation_before(grains, joints, j, now.dt);
    evaluate_damaged(grains, joints, damaged, deformation(grains, joints, j), before, now,
                     &cracks);
    if (cracks.size() == n_before)
      continue; // over by a rounding of the kernel's order of operations: not over
    joints.damage[j] = static_cast<std::int32_t>(joints.damaged.size());
    joints.damaged.push_back(damaged);
  }
}

} // namespace

void evaluate_broken_joints(const Grains &grains,
                            Joints &joints,
                            const StepTime &now,
                            std::vector<Crack> *new_cracks)
{
  const auto n = static_cast<std::int64_t>(joints.damaged.size());
  std::vector<std::vector<Crack>> found(n);
#pragma omp parallel for schedule(static) if (n > 64)
  for (std::int64_t k = 0; k < n; ++k)
  {
    DamagedJoint &damaged = joints.damaged[k];
    if (damaged.removed)
      continue;
    const JointDeformation before{damaged.gap, damaged.shear, damaged.rotation};
    evaluate_damaged(grains, joints, damaged, deformation(grains, joints, damaged.joint),
                     before, now, new_cracks != nullptr ? &found[k] : nullptr);
  }
  if (new_cracks != nullptr)
    for (const std::vector<Crack> &some : found)
      new_cracks->insert(new_cracks->end(), some.begin(), some.end());
}

namespace
{
JointForce sum(const JointForce *force, const std::int32_t *next, const std::int32_t *end)
{
  JointForce total{0., 0., 0., 0.};
  for (; next != end; ++next)
  {
    const JointForce &one = force[*next];
    total.x += one.x;
    total.y += one.y;
    total.torque1 += one.torque1;
    total.torque2 += one.torque2;
  }
  return total;
}
} // namespace

void sum_joint_forces(Grains &grains, Joints &joints)
{
  for (const DamagedJoint &damaged : joints.damaged)
    joints.force[damaged.joint] = damaged.force;
  const auto n = static_cast<std::int64_t>(grains.size());
  const std::int32_t *const begin = joints.grain_begin.data();
  const std::int32_t *const second = joints.grain_second.data();
  const std::int32_t *const joint = joints.grain_joint.data();
  const JointForce *const force = joints.force.data();
  double *const x = grains.force_x.data(), *const y = grains.force_y.data();
  double *const torque = grains.torque.data();
#pragma omp parallel for schedule(static) if (n >= threads_from_grains)
  for (std::int64_t i = 0; i < n; ++i)
  {
    // Whole records are added, without a branch on the end: half of the time is saved.
    const JointForce as_first = sum(force, joint + begin[i], joint + second[i]);
    const JointForce as_second = sum(force, joint + second[i], joint + begin[i + 1]);
    x[i] = as_second.x - as_first.x;
    y[i] = as_second.y - as_first.y;
    torque[i] = as_first.torque1 + as_second.torque2;
  }
}

void evaluate_bonds(const Grains &grains,
                    Joints &joints,
                    const StepTime &now,
                    std::vector<Crack> *new_cracks)
{
  const KernelLevel &level = kernel_level();
  const auto n_grains = static_cast<std::int64_t>(grains.size());
  constexpr auto block_size = static_cast<std::int64_t>(intact_block);
  static thread_local std::vector<GrainLine> lines; // scratch: refilled at every call
  lines.resize(grains.size());
  GrainLine *const line = lines.data();
  std::vector<IntactKernelInput> input;
  for (const JointGroup &group : joints.groups)
    input.push_back(kernel_input(joints, group, lines, new_cracks != nullptr));
  std::vector<std::vector<std::int32_t>> over(joints.groups.size());

  // One parallel region: threads wait for one another between lines and joints only.
#pragma omp parallel if (n_grains >= threads_from_grains)
  {
#pragma omp for schedule(static)
    for (std::int64_t block = 0; block < n_grains; block += 256)
      level.lines(grains.displacement_x.data(), grains.displacement_y.data(),
                  grains.rotation.data(), line, block, std::min(block + 256, n_grains));
    for (std::size_t g = 0; g < joints.groups.size(); ++g)
    {
      const auto begin = static_cast<std::int64_t>(joints.groups[g].begin);
      const auto end = static_cast<std::int64_t>(joints.groups[g].end);
#pragma omp for schedule(static) nowait
      for (std::int64_t block = begin; block < end; block += block_size)
      {
        std::int32_t block_over[intact_block];
        const std::size_t n =
            level.intact(input[g], block, std::min(block + block_size, end), block_over);
        if (n > 0)
        {
#pragma omp critical(antiform_over)
          over[g].insert(over[g].end(), block_over, block_over + n);
        }
      }
    }
  }
  for (std::vector<std::int32_t> &some : over)
    std::sort(some.begin(), some.end());

  if (new_cracks != nullptr)
    for (std::size_t g = 0; g < joints.groups.size(); ++g)
      if (!over[g].empty())
        break_intact(grains, joints, joints.groups[g], over[g], now, *new_cracks);
}

void compute_joint_forces(Grains &grains,
                          Joints &joints,
                          const StepTime &now,
                          std::vector<Crack> *new_cracks)
{
  evaluate_broken_joints(grains, joints, now, new_cracks);
  evaluate_bonds(grains, joints, now, new_cracks);
  sum_joint_forces(grains, joints);
}

JointEnergies joint_energies(const Grains &grains, const Joints &joints)
{
  JointEnergies energies;
  for (const JointGroup &group : joints.groups)
  {
    const double n = group.law.n_elements;
    const double moment_factor =
        (group.law.element_moment ? 1. : 1. - 1. / (n * n)) / 12.;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      if (joints.damage[j] >= 0)
        continue;
      const JointDeformation d = deformation(grains, joints, j);
      const double full = 2. * joints.half_length[j];
      energies.strain += 0.5 * joints.stiffness[j] * full *
                         (joints.weight.empty() ? 1. : joints.weight[j]) *
                         (d.gap * d.gap + d.shear * d.shear / group.law.stiffness_ratio +
                          full * full * moment_factor * d.rotation * d.rotation);
    }
  }
  for (const DamagedJoint &damaged : joints.damaged)
  {
    energies.strain += strain_energy(joints, damaged);
    energies.slip += damaged.slip_energy;
    energies.fracture += damaged.fracture_energy;
  }
  return energies;
}

std::string joint_kernel_level()
{
  return kernel_level().name;
}
} // namespace antiform::discrete

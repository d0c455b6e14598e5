#include "discrete/brittle_bond.h"
#include "discrete/joint_damage.h"
#include "discrete/joint_kernel.h"
#include "discrete/joints.h"
#include "discrete/threading.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
IntactKernelInput intact_input(const Joints &joints,
                               const JointGroup &group,
                               const bool look_at_strengths)
{
  const BondConstants law = constants(group.law);
  const auto pointer = [](const std::vector<double> &v)
  { return v.empty() ? nullptr : v.data(); };
  IntactKernelInput in{};
  in.grains = joints.work.lines.data();
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
  in.tension_factor = pointer(joints.tension_factor);
  in.cohesion_factor = pointer(joints.cohesion_factor);
  in.shear_ratio = 1. / law.stiffness_ratio;
  in.moment_factor = law.moment_factor;
  in.tension_arm = law.tension_arm;
  in.coulomb_arm = law.coulomb_arm;
  constexpr double none = std::numeric_limits<double>::infinity();
  // An unbreakable group without strengths is not looked at.
  const bool tested = look_at_strengths &&
                      (law.breakable || law.tensile_strength > 0. || law.cohesion > 0.);
  in.tensile_strength = tested ? law.tensile_strength : none;
  in.cohesion = tested ? law.cohesion : none;
  in.tan_friction = tested ? law.tan_friction : 0.;
  return in;
}

void fill_lines(const Grains &grains, Joints &joints)
{
  const KernelLevel &level = kernel_level();
  const auto n_grains = static_cast<std::int64_t>(grains.size());
  joints.work.lines.resize(grains.size());
  GrainLine *const lines = joints.work.lines.data();
#pragma omp parallel for schedule(static) if (n_grains >= threads_from_grains)
  for (std::int64_t block = 0; block < n_grains; block += 256)
    level.lines(grains.displacement_x.data(), grains.displacement_y.data(),
                grains.rotation.data(), lines, block, std::min(block + 256, n_grains));
  joints.work.lines_filled = true;
}

DamagedKernelInput damaged_input(Joints &joints, const bool look_at_strengths)
{
  const auto pointer = [](const std::vector<double> &v)
  { return v.empty() ? nullptr : v.data(); };
  std::vector<ElementConstants> &laws = joints.work.laws;
  laws.clear();
  for (const JointGroup &group : joints.groups)
    laws.push_back(is_brittle(group.law) // their records are removed: not looked at
                       ? element_constants({}, false)
                       : element_constants(group.flat(), look_at_strengths));
  DamagedJoints &damaged = joints.damaged;
  DamagedKernelInput in{};
  in.grains = joints.work.lines.data();
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
  in.tension_factor = pointer(joints.tension_factor);
  in.cohesion_factor = pointer(joints.cohesion_factor);
  in.laws = laws.data();
  in.n_elements = damaged.n_elements();
  in.joint = damaged.joint.data();
  in.group = damaged.group.data();
  in.removed = damaged.removed.data();
  in.bond = damaged.bonds();
  in.slip = damaged.slips();
  in.gap = damaged.gap.data();
  in.shear = damaged.shear.data();
  in.turn = damaged.rotation.data();
  in.slip_energy = damaged.slip_energy.data();
  in.force = damaged.force.data();
  return in;
}

void evaluate_broken_joints(const Grains &grains,
                            Joints &joints,
                            const StepTime &now,
                            std::vector<Crack> *new_cracks)
{
  DamagedJoints &damaged = joints.damaged;
  if (damaged.size() == 0)
    return;
  const KernelLevel &level = kernel_level();
  fill_lines(grains, joints);
  const DamagedKernelInput in = damaged_input(joints, new_cracks != nullptr);
  const auto n_lots = static_cast<std::int64_t>((damaged.size() + 3) / 4);
  std::vector<std::int32_t> &events = joints.work.events;
  events.clear();
#pragma omp parallel for schedule(static) if (n_lots > 128)
  for (std::int64_t lot = 0; lot < n_lots; ++lot)
    if (level.damaged(in, 4 * lot))
    {
#pragma omp critical(antiform_events)
      events.push_back(static_cast<std::int32_t>(lot));
    }
  // Where something breaks, in order of damage.
  std::sort(events.begin(), events.end());
  for (const std::int32_t lot : events)
    for (std::size_t k = 4 * lot; k < std::min<std::size_t>(4 * lot + 4, damaged.size());
         ++k)
      if (!damaged.removed[k])
        evaluate_damaged(grains, joints, damaged, k,
                         {damaged.gap[k], damaged.shear[k], damaged.rotation[k]}, now,
                         new_cracks);
}

namespace
{
/// The block of group @p g that begins at joint @p begin, if the part has to do with it.
void add_block(const Joints &joints,
               const std::size_t g,
               const std::size_t begin,
               JointPart &part)
{
  const std::size_t end = std::min(begin + intact_block, joints.groups[g].end);
  std::size_t n_own = 0, first = part.end, reach = part.begin;
  for (std::size_t j = begin; j < end; ++j)
    for (const std::int32_t i : {joints.first[j], joints.second[j]})
      if (part.has(i))
      {
        ++n_own;
        first = std::min(first, static_cast<std::size_t>(i));
        reach = std::max(reach, static_cast<std::size_t>(i) + 1);
      }
  if (n_own > 0)
    part.blocks.push_back({static_cast<std::int32_t>(begin),
                           static_cast<std::int32_t>(end), static_cast<std::int32_t>(g),
                           n_own < 2 * (end - begin), reach, first});
}

/// Blocks of joints and who works on them. Grains are shared out by their joints.
void make_parts(Joints &joints, const std::size_t n_grains, const std::size_t n_parts)
{
  std::vector<JointPart> &parts = joints.work.parts;
  parts.assign(n_parts, {});
  std::size_t grain = 0;
  for (std::size_t p = 0; p < n_parts; ++p)
  {
    parts[p].begin = grain;
    const std::size_t share = 2 * joints.size() * (p + 1) / n_parts;
    while (
        grain < n_grains &&
        (p + 1 == n_parts || static_cast<std::size_t>(joints.grain_begin[grain]) < share))
      ++grain;
    parts[p].end = grain;
  }
  for (JointPart &part : parts)
    for (std::size_t g = 0; g < joints.groups.size(); ++g)
      for (std::size_t j = joints.groups[g].begin; j < joints.groups[g].end;
           j += intact_block)
        add_block(joints, g, j, part);
  for (JointPart &part : parts)
  {
    std::size_t reach = part.begin, done = part.end;
    for (JointBlock &block : part.blocks)
      block.reach = reach = std::max(reach, block.reach);
    for (auto block = part.blocks.rbegin(); block != part.blocks.rend(); ++block)
    {
      std::swap(block->done, done); // it had its own first grain
      done = std::min(done, block->done);
    }
  }
}

/// As the kernel does, for the grains of @p part only.
void sum_own(const Joints &joints,
             const JointPart &part,
             const JointBlock &block,
             const JointForce *force,
             GrainSum *sums)
{
  for (std::int32_t j = block.begin; j < block.end; ++j)
  {
    const JointForce &f = force[j - block.begin];
    if (part.has(joints.first[j]))
    {
      GrainSum &sum = sums[joints.first[j]];
      sum.x -= f.x;
      sum.y -= f.y;
      sum.torque += f.torque1;
    }
    if (part.has(joints.second[j]))
    {
      GrainSum &sum = sums[joints.second[j]];
      sum.x += f.x;
      sum.y += f.y;
      sum.torque += f.torque2;
    }
  }
}

/// Forces of a block's joints, intact ones from the kernel, the others from their
/// records; intact ones over a strength are noted in the part that has their first grain.
void block_forces(const KernelLevel &level,
                  const Joints &joints,
                  const JointBlock &block,
                  JointPart &part,
                  JointForce *force)
{
  const std::int32_t *const damage = joints.damage.data();
  std::int32_t n_damaged = 0;
  if (joints.damaged.size() > 0)
    for (std::int32_t j = block.begin; j < block.end; ++j)
      n_damaged += damage[j] >= 0 ? 1 : 0;
  if (n_damaged < block.end - block.begin)
  {
    std::int32_t over[intact_block];
    const std::size_t n_over = level.intact(joints.work.inputs[block.group], block.begin,
                                            block.end, force, over);
    for (std::size_t k = 0; k < n_over; ++k)
      if (damage[over[k]] < 0 && part.has(joints.first[over[k]]))
        part.over.emplace_back(over[k], force[over[k] - block.begin]);
  }
  if (n_damaged > 0)
    for (std::int32_t j = block.begin; j < block.end; ++j)
      if (damage[j] >= 0)
        force[j - block.begin] = joints.damaged.force[damage[j]];
}

void sum_part(const KernelLevel &level,
              Grains &grains,
              Joints &joints,
              JointPart &part,
              const bool keep_forces)
{
  GrainSum *const sums = joints.work.sums.data();
  std::size_t begun = part.begin, finished = part.begin;
  const auto begin_sums = [&](const std::size_t end)
  {
    for (; begun < end; ++begun)
      sums[begun] = {0., 0., 0., 0.};
  };
  const auto finish_sums = [&](const std::size_t end)
  {
    begin_sums(end);
    double *const x = grains.force_x.data(), *const y = grains.force_y.data();
    double *const torque = grains.torque.data();
    for (; finished < end; ++finished)
    {
      x[finished] = sums[finished].x;
      y[finished] = sums[finished].y;
      torque[finished] = sums[finished].torque;
    }
  };

  part.over.clear();
  for (const JointBlock &block : part.blocks)
  {
    alignas(64) JointForce force[intact_block];
    block_forces(level, joints, block, part, force);
    begin_sums(block.reach);
    if (block.shared)
      sum_own(joints, part, block, force, sums);
    else
      level.sum(joints.first.data() + block.begin, joints.second.data() + block.begin,
                force, block.end - block.begin, sums);
    if (keep_forces)
      for (std::int32_t j = block.begin; j < block.end; ++j)
        if (part.has(joints.first[j]))
          joints.force[j] = force[j - block.begin];
    finish_sums(block.done);
  }
  finish_sums(part.end);
}

/// Put @p now in the place of the force @p before of joint @p j.
void replace_force(Grains &grains,
                   const Joints &joints,
                   const std::size_t j,
                   const JointForce &before,
                   const JointForce &now)
{
  const std::size_t one = joints.first[j], two = joints.second[j];
  grains.force_x[one] -= now.x - before.x;
  grains.force_y[one] -= now.y - before.y;
  grains.torque[one] += now.torque1 - before.torque1;
  grains.force_x[two] += now.x - before.x;
  grains.force_y[two] += now.y - before.y;
  grains.torque[two] += now.torque2 - before.torque2;
}

/// First break of joint @p j, which the kernel found over a strength, if it breaks.
void break_intact(Grains &grains,
                  Joints &joints,
                  const std::size_t j,
                  const JointForce &intact,
                  const StepTime &now,
                  const bool keep_forces,
                  std::vector<Crack> &cracks)
{
  const JointLaw &law = joints.group_of(j).law;
  if (!constants(law).breakable)
  {
    joints.would_break[j] = 1;
    return;
  }
  const std::size_t n_before = cracks.size();
  const std::size_t k = add_damaged(joints, j);
  const JointDeformation before = deformation_before(grains, joints, j, now.dt);
  if (is_brittle(law))
    break_bond(grains, joints, law, k, before, now, cracks);
  else
    evaluate_damaged(grains, joints, joints.damaged, k, before, now, &cracks);
  if (cracks.size() == n_before)
  {
    // Over by a rounding of the kernel's order of operations: not over.
    joints.damaged.pop_back();
    joints.damage[j] = -1;
    return;
  }
  replace_force(grains, joints, j, intact, joints.damaged.force[k]);
  if (keep_forces)
    joints.force[j] = joints.damaged.force[k];
}
} // namespace

void evaluate_bonds(Grains &grains,
                    Joints &joints,
                    const StepTime &now,
                    std::vector<Crack> *new_cracks,
                    const bool keep_forces)
{
  const KernelLevel &level = kernel_level();
  const auto n_grains = static_cast<std::int64_t>(grains.size());
  const bool threaded = n_grains >= threads_from_grains;
  JointWork &work = joints.work;
  const std::size_t n_parts =
      threaded ? static_cast<std::size_t>(omp_get_max_threads()) : 1;
  if (work.parts.size() != n_parts || work.sums.size() != grains.size())
    make_parts(joints, grains.size(), n_parts);
  work.sums.resize(grains.size());
  if (!work.lines_filled)
    fill_lines(grains, joints);
  work.lines_filled = false; // the grains will have moved
  work.inputs.clear();
  for (const JointGroup &group : joints.groups)
    work.inputs.push_back(intact_input(joints, group, new_cracks != nullptr));

#pragma omp parallel for schedule(static, 1) if (threaded)
  for (std::size_t p = 0; p < n_parts; ++p)
    sum_part(level, grains, joints, work.parts[p], keep_forces);

  work.over.clear();
  for (const JointPart &part : work.parts)
    work.over.insert(work.over.end(), part.over.begin(), part.over.end());
  std::sort(work.over.begin(), work.over.end(),
            [](const auto &a, const auto &b) { return a.first < b.first; });
  if (new_cracks != nullptr)
    for (const auto &[j, force] : work.over)
      break_intact(grains, joints, j, force, now, keep_forces, *new_cracks);
}

void compute_joint_forces(Grains &grains,
                          Joints &joints,
                          const StepTime &now,
                          std::vector<Crack> *new_cracks,
                          const bool keep_forces)
{
  evaluate_broken_joints(grains, joints, now, new_cracks);
  evaluate_bonds(grains, joints, now, new_cracks, keep_forces);
}

JointEnergies joint_energies(const Grains &grains, const Joints &joints)
{
  JointEnergies energies;
  for (const JointGroup &group : joints.groups)
  {
    const BondConstants bond = constants(group.law);
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      if (joints.damage[j] >= 0)
        continue;
      const JointDeformation d = deformation(grains, joints, j);
      const double full = 2. * joints.half_length[j];
      energies.strain += 0.5 * joints.stiffness[j] * full *
                         (joints.weight.empty() ? 1. : joints.weight[j]) *
                         (d.gap * d.gap + d.shear * d.shear / bond.stiffness_ratio +
                          full * full * bond.moment_factor * d.rotation * d.rotation);
    }
  }
  energies.strain += released_energy(grains, joints);
  for (std::size_t k = 0; k < joints.damaged.size(); ++k)
  {
    energies.strain += strain_energy(joints, joints.damaged, k);
    energies.slip += joints.damaged.slip_energy[k];
    energies.fracture += joints.damaged.fracture_energy[k];
  }
  return energies;
}

std::string joint_kernel_level()
{
  return kernel_level().name;
}
} // namespace antiform::discrete

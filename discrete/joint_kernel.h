#pragma once

#include "discrete/joints.h"

#include <cstddef>

namespace antiform::discrete
{
/// What a joint reads of a grain, one cache line: gathered once a joint, twice a grain.
struct alignas(64) GrainLine
{
  double x, y;     ///< displacement [m]
  double rotation; ///< [rad]
  double unused;
  double half_cos, half_sin; ///< of half the rotation
  double unused_too[2];
};

/// Where the forces on a grain are summed up.
struct alignas(32) GrainSum
{
  double x, y, torque, unused;
};

/// Constants of a group and bare pointers into the joints' arrays.
struct IntactKernelInput
{
  const GrainLine *grains;
  const std::int32_t *first, *second;
  const double *normal_x, *normal_y, *length, *lever_difference, *stiffness, *half_length;
  const double *weight;                                         ///< or null
  const double *initial_gap, *initial_shear, *initial_rotation; ///< or null
  const double *tension_factor, *cohesion_factor;               ///< or null
  double shear_ratio;                                           ///< 1 / kappa
  double moment_factor;    ///< 1/12, or (1 - 1/N^2)/12 without element moments
  double tension_arm;      ///< of the bending stress in the test of tension, over R
  double coulomb_arm;      ///< the same in the Coulomb test
  double tensile_strength; ///< infinity where strengths are not looked at
  double cohesion;
  double tan_friction;
};

/// Of group @p group. The grain lines are those of the joints' work: fill_lines().
/// \param look_at_strengths or none is reached
IntactKernelInput
intact_input(const Joints &joints, const JointGroup &group, bool look_at_strengths);

/// Forces of the intact joints begin .. end - 1 of a group, at most intact_block of them:
/// @p force[0] is that of joint begin.
/// \return number of entries written to @p over: joints beyond a strength, ascending
using IntactKernel = std::size_t (*)(const IntactKernelInput &input,
                                     std::size_t begin,
                                     std::size_t end,
                                     JointForce *force,
                                     std::int32_t *over);
/// Fill grain lines begin .. end - 1.
using LineKernel = void (*)(const double *x,
                            const double *y,
                            const double *rotation,
                            GrainLine *lines,
                            std::size_t begin,
                            std::size_t end);
/// Add the forces of @p n joints to their grains' sums, joint by joint.
using SumKernel = void (*)(const std::int32_t *first,
                           const std::int32_t *second,
                           const JointForce *force,
                           std::size_t n,
                           GrainSum *sums);

/// Law of the elements of a group's joints.
struct ElementConstants
{
  double shear_ratio; ///< 1 / kappa
  double n_elements;
  double moment; ///< 1, or 0 without element moments
  double residual_friction, residual_cohesion;
  double tensile_strength, cohesion, tan_friction; ///< infinity, 0: not looked at
};
/// @p look_at_strengths where the group's joints are breakable.
ElementConstants element_constants(const FlatJoint &law, bool look_at_strengths);

/// Bare pointers for the full law; the state is that of DamagedJoints.
struct DamagedKernelInput
{
  const GrainLine *grains;
  const std::int32_t *first, *second;
  const double *normal_x, *normal_y, *length, *lever_difference, *stiffness, *half_length;
  const double *weight;                                         ///< or null
  const double *initial_gap, *initial_shear, *initial_rotation; ///< or null
  const double *tension_factor, *cohesion_factor;               ///< or null
  const ElementConstants *laws;                                 ///< per group
  int n_elements; ///< room for them in the state
  const std::int32_t *joint, *group;
  const unsigned char *removed;
  const Bond *bond;
  double *slip, *gap, *shear, *turn, *slip_energy;
  JointForce *force;
};

/// @p look_at_strengths: breaks are wanted. The grain lines are those of the joints'
/// work: fill_lines().
DamagedKernelInput damaged_input(Joints &joints, bool look_at_strengths);
/// Fill the grain lines of @p joints.work.
void fill_lines(const Grains &grains, Joints &joints);

/// The full law for four damaged joints, from number @p begin on. Nothing is changed, and
/// true returned, if a bond of one of them is over a strength or a joint parts for good:
/// evaluate_damaged() must take these four then.
using DamagedKernel = bool (*)(const DamagedKernelInput &input, std::size_t begin);

/// One component of the motion of damped grains; see GrainDamping.
struct DampedKick
{
  double alpha, dt;
  const double *force;  ///< that accelerates
  double *force_before; ///< of the last step, becomes this one's; null: local damping
  const double *inverse_mass; ///< or of inertia
  double *velocity;           ///< kicked by force and damping
  double *damping;            ///< force of the last step, then of this one
};
/// Damp and kick entries begin .. end - 1. \return power of the damping forces of the
/// last step and of this one together, with the velocities before the kick [W]
using DampedKickKernel = double (*)(const DampedKick &in,
                                    std::size_t begin,
                                    std::size_t end);

/// Joints of one call: their forces fit the first cache.
constexpr std::size_t intact_block = 64;

/// The kernels of one vector level: joint_kernel_level.cc and motion_kernel_level.cc are
/// compiled once per level.
struct KernelLevel
{
  const char *name;
  IntactKernel intact;
  LineKernel lines;
  SumKernel sum;
  DamagedKernel damaged;
  DampedKickKernel damped_kick;
};
namespace level_baseline
{
KernelLevel kernel_level();
}
namespace level_x86_64_v3
{
KernelLevel kernel_level();
}
namespace level_x86_64_v4
{
KernelLevel kernel_level();
}

/// The level that this processor supports; ANTIFORM_KERNEL_LEVEL in the environment (the
/// name of a lower level) overrides, for tests.
const KernelLevel &kernel_level();
/// All levels that this processor supports, lowest first.
std::vector<KernelLevel> supported_kernel_levels();
} // namespace antiform::discrete

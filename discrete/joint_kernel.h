#pragma once

#include "discrete/joints.h"

#include <cstddef>

namespace antiform::discrete
{
/// What a joint reads of a grain, one cache line: gathered once a joint, twice a grain.
struct alignas(64) GrainLine
{
  double x, y;               ///< displacement [m]
  double rotation;           ///< [rad]
  double half_cos, half_sin; ///< of half the rotation
  double unused[3];
};

/// Constants of a group and bare pointers into the joints' arrays.
struct IntactKernelInput
{
  const GrainLine *grains;
  const std::int32_t *first, *second;
  const double *normal_x, *normal_y, *length, *lever_difference, *stiffness, *half_length;
  const double *weight;                                         ///< or null
  const double *initial_gap, *initial_shear, *initial_rotation; ///< or null
  double shear_ratio;                                           ///< 1 / kappa
  double moment_factor;    ///< 1/12, or (1 - 1/N^2)/12 without element moments
  double outer_centroid;   ///< 1 - 1/N: centroid of the outer element over R
  double tensile_strength; ///< infinity where strengths are not looked at
  double cohesion;
  double tan_friction;
  JointForce *force;
};

/// Forces of the intact joints begin .. end - 1 of a group, at most intact_block of them.
/// \return number of entries written to @p over: joints beyond a strength, ascending
using IntactKernel = std::size_t (*)(const IntactKernelInput &input,
                                     std::size_t begin,
                                     std::size_t end,
                                     std::int32_t *over);
/// Fill grain lines begin .. end - 1.
using LineKernel = void (*)(const double *x,
                            const double *y,
                            const double *rotation,
                            GrainLine *lines,
                            std::size_t begin,
                            std::size_t end);

/// Joints of one call: their columns, their grains and their results fit the first cache.
constexpr std::size_t intact_block = 64;

/// The kernels of one vector level; this translation unit is compiled once per level.
struct KernelLevel
{
  const char *name;
  IntactKernel intact;
  LineKernel lines;
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

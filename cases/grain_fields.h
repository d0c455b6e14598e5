#pragma once

#include "coupling/static_system.h"
#include "discrete/joint_tangent.h"

#include <string>

namespace antiform::cases
{
/// Forces of joint @p j, all bonds whole, in a linear static state [N], weighted.
discrete::JointTension tension_in(const discrete::Joints &joints,
                                  std::size_t j,
                                  const coupling::StaticSolution &state);

/// Grains at their places with radius, region, and @p factor times displacement and
/// rotation of @p state.
void write_static_grains(const std::string &path,
                         const discrete::Grains &grains,
                         const coupling::StaticSolution &state,
                         double factor);

/// Joints with normal (tension positive) and shear force of @p factor times @p state [N],
/// as of the whole joint where grains and mesh share it, and their group.
void write_static_joints(const std::string &path,
                         const discrete::Grains &grains,
                         const discrete::Joints &joints,
                         const coupling::StaticSolution &state,
                         double factor);
} // namespace antiform::cases

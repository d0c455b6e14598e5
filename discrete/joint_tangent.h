#pragma once

#include "discrete/grains.h"
#include "discrete/joints.h"

#include <array>

namespace antiform::discrete
{
/// Over the dofs x, y, rotation of a joint's first grain, then of its second.
using JointMatrix = std::array<std::array<double, 6>, 6>;

/// Normal and shear force of a joint, tension positive, weighted [N].
struct JointTension
{
  double normal = 0.; ///< F
  double shear = 0.;  ///< S
};

/// F and S of an intact joint at deformation @p d, as its kernel computes them.
JointTension
intact_tension(const Joints &joints, std::size_t j, const JointDeformation &d);

/// Geometric stiffness of a joint at rest, both grains where it was installed, that
/// carries F and S: second derivatives F d2g + S d2u_s [N/m], [N], [N m]. Symmetric for
/// every F and S: both are derivatives of a potential (docs/theory/coupled_buckling.md).
JointMatrix
geometric_stiffness_at_rest(const Joints &joints, std::size_t j, const JointTension &T);

/// Tangent stiffness -df/dq of joint @p j at the present state of its grains, at any
/// rotation, prestress included. Intact: the derivative of the kernel's forces. Damaged:
/// bonded elements and the closed parts of broken ones, which stick to one another; that
/// is the derivative while nothing slides, and stiffer than a joint that goes on sliding,
/// whose own tangent is not symmetric. Parted joints: 0. Symmetric throughout.
JointMatrix tangent_stiffness(const Grains &grains, const Joints &joints, std::size_t j);
} // namespace antiform::discrete

#pragma once

#include "discrete/joints.h"

#include <cmath>

namespace antiform::discrete::test
{
/// Force of an intact joint straight from its definition: positions of the grains, the
/// two faces, their mean frame. Extended precision stands in for the kernel's freedom
/// from cancellation; nothing else is clever here. In double precision it is what a
/// benchmark compares with.
template <class Real = long double>
JointForce
plain_joint_force(const Grains &grains, const Joints &joints, const std::size_t j)
{
  const std::size_t one = joints.first[j], two = joints.second[j];
  const FlatJoint &law = joints.group_of(j).flat();
  const Real turn1 = grains.rotation[one], turn2 = grains.rotation[two];
  const Real turn = (turn1 + turn2) / 2, theta = turn2 - turn1;
  const Real d0 = joints.length[j], n0x = joints.normal_x[j], n0y = joints.normal_y[j];
  const Real lx =
      d0 * n0x + (Real(grains.displacement_x[two]) - Real(grains.displacement_x[one]));
  const Real ly =
      d0 * n0y + (Real(grains.displacement_y[two]) - Real(grains.displacement_y[one]));
  const Real nx = std::cos(turn) * n0x - std::sin(turn) * n0y;
  const Real ny = std::sin(turn) * n0x + std::cos(turn) * n0y;
  const Real tx = -ny, ty = nx;
  const Real r1 = (d0 - joints.lever_difference[j]) / 2;
  const Real r2 = (d0 + joints.lever_difference[j]) / 2;

  // The faces, seen from the first grain's centre.
  const Real c1 = std::cos(turn1), s1 = std::sin(turn1), c2 = std::cos(turn2),
             s2 = std::sin(turn2);
  const Real face1_x = r1 * (c1 * n0x - s1 * n0y), face1_y = r1 * (s1 * n0x + c1 * n0y);
  const Real face2_x = lx - r2 * (c2 * n0x - s2 * n0y);
  const Real face2_y = ly - r2 * (s2 * n0x + c2 * n0y);
  const Real jump_x = face2_x - face1_x, jump_y = face2_y - face1_y;
  const Real gap = jump_x * nx + jump_y * ny, shear = jump_x * tx + jump_y * ty;

  Real elastic_gap = gap, elastic_shear = shear, elastic_rotation = theta;
  if (!joints.initial_gap.empty())
  {
    elastic_gap += joints.initial_gap[j];
    elastic_shear += joints.initial_shear[j];
    elastic_rotation += joints.initial_rotation[j];
  }
  const Real R = joints.half_length[j], k_n = joints.stiffness[j];
  const Real k_s = k_n / law.stiffness_ratio;
  const Real weight = joints.weight.empty() ? 1. : joints.weight[j];
  Real F = 0, S = 0, M = 0;
  for (int e = 0; e < law.n_elements; ++e)
  {
    const Real l = 2 * R / law.n_elements, s = -R + (e + Real(0.5)) * l;
    const Real force = k_n * l * (elastic_gap - elastic_rotation * s);
    F += force;
    M += s * force -
         (law.element_moment ? k_n * elastic_rotation * l * l * l / 12 : Real(0));
    S += k_s * l * elastic_shear;
  }
  F *= weight;
  S *= weight;
  M *= weight;

  const Real fx = -F * nx - S * tx, fy = -F * ny - S * ty;
  const Real middle_x = (face1_x + face2_x) / 2, middle_y = (face1_y + face2_y) / 2;
  const Real torque1 = -(middle_x * fy - middle_y * fx) - M;
  const Real torque2 = (middle_x - lx) * fy - (middle_y - ly) * fx + M;
  return {static_cast<double>(fx), static_cast<double>(fy), static_cast<double>(torque1),
          static_cast<double>(torque2)};
}
} // namespace antiform::discrete::test

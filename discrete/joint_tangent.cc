#include "discrete/joint_tangent.h"

#include <cassert>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// Where a joint is: its mean frame, the branch in it, and half the relative rotation.
struct Frame
{
  Vec2 normal, tangent;
  double along, across; ///< L.n, L.t [m]
  double face_cos, face_sin;
};

Frame frame_at_rest(const Joints &joints, const std::size_t j)
{
  const Vec2 n{joints.normal_x[j], joints.normal_y[j]};
  return {n, {-n.y, n.x}, joints.length[j], 0., 1., 0.};
}

Frame present_frame(const Grains &grains, const Joints &joints, const std::size_t j)
{
  const auto one = static_cast<std::size_t>(joints.first[j]),
             two = static_cast<std::size_t>(joints.second[j]);
  const double turn = 0.5 * (grains.rotation[one] + grains.rotation[two]),
               half = 0.5 * (grains.rotation[two] - grains.rotation[one]);
  const double c = std::cos(turn), s = std::sin(turn);
  const Vec2 n0{joints.normal_x[j], joints.normal_y[j]};
  const Vec2 n{c * n0.x - s * n0.y, s * n0.x + c * n0.y}, t{-n.y, n.x};
  const Vec2 L = joints.length[j] * n0 +
                 Vec2{grains.displacement_x[two] - grains.displacement_x[one],
                      grains.displacement_y[two] - grains.displacement_y[one]};
  return {n, t, dot(L, n), dot(L, t), std::cos(half), std::sin(half)};
}

/// First derivatives of gap and shear.
struct Gradients
{
  std::array<double, 6> gap, shear;
};
Gradients gradients(const Joints &joints, const std::size_t j, const Frame &at)
{
  const double d = 0.5 * joints.length[j] * at.face_sin,
               r = 0.5 * joints.lever_difference[j] * at.face_cos;
  const Vec2 &n = at.normal, &t = at.tangent;
  return {{-n.x, -n.y, 0.5 * at.across - d, n.x, n.y, 0.5 * at.across + d},
          {-t.x, -t.y, r - 0.5 * at.along, t.x, t.y, -r - 0.5 * at.along}};
}

/// Second derivatives F d2g + S d2u_s.
JointMatrix geometric(const Joints &joints,
                      const std::size_t j,
                      const Frame &at,
                      const JointTension &T)
{
  JointMatrix G{};
  // The frame turns by half of either rotation: dn = t/2, dt = -n/2.
  const Vec2 pull = 0.5 * T.normal * at.tangent - 0.5 * T.shear * at.normal;
  for (const std::size_t rotation : {2, 5})
    for (const std::size_t grain : {0, 1})
    {
      const double sign = grain == 0 ? -1. : 1.;
      G[3 * grain][rotation] = G[rotation][3 * grain] = sign * pull.x;
      G[3 * grain + 1][rotation] = G[rotation][3 * grain + 1] = sign * pull.y;
    }
  const double both = -0.25 * (T.normal * at.along + T.shear * at.across),
               apart = 0.25 * (T.normal * joints.length[j] * at.face_cos +
                               T.shear * joints.lever_difference[j] * at.face_sin);
  G[2][2] = G[5][5] = both + apart;
  G[2][5] = G[5][2] = both - apart;
  return G;
}

/// Weighted stiffness of gap, shear and rotation [N/m], [N/m], [N m].
std::array<double, 3> stiffness(const Joints &joints, const std::size_t j)
{
  const BondConstants bond = constants(joints.group_of(j).law);
  const double full = 2. * joints.half_length[j];
  const double normal =
      joints.stiffness[j] * full * (joints.weight.empty() ? 1. : joints.weight[j]);
  return {normal, normal / bond.stiffness_ratio,
          normal * full * full * bond.moment_factor};
}
} // namespace

JointTension
intact_tension(const Joints &joints, const std::size_t j, const JointDeformation &d)
{
  const auto k = stiffness(joints, j);
  return {k[0] * d.gap, k[1] * d.shear};
}

JointMatrix geometric_stiffness_at_rest(const Joints &joints,
                                        const std::size_t j,
                                        const JointTension &T)
{
  return geometric(joints, j, frame_at_rest(joints, j), T);
}

JointMatrix
tangent_stiffness(const Grains &grains, const Joints &joints, const std::size_t j)
{
  assert(joints.damage[j] < 0);
  const Frame at = present_frame(grains, joints, j);
  const auto k = stiffness(joints, j);
  const Gradients of = gradients(joints, j, at);
  JointMatrix K =
      geometric(joints, j, at, intact_tension(joints, j, deformation(grains, joints, j)));
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      K[a][b] += k[0] * of.gap[a] * of.gap[b] + k[1] * of.shear[a] * of.shear[b];
  // theta = rotation of the second less that of the first
  K[2][2] += k[2];
  K[5][5] += k[2];
  K[2][5] -= k[2];
  K[5][2] -= k[2];
  return K;
}
} // namespace antiform::discrete

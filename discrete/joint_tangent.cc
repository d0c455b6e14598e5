#include "discrete/joint_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
namespace
{
/// Where a joint is: its mean frame, the branch in it, and half the relative rotation.
struct JointFrame
{
  Vec2 normal, tangent;
  double along, across; ///< L.n, L.t [m]
  double face_cos, face_sin;
};

JointFrame frame_at_rest(const Joints &joints, const std::size_t j)
{
  const Vec2 n{joints.normal_x[j], joints.normal_y[j]};
  return {n, {-n.y, n.x}, joints.length[j], 0., 1., 0.};
}

JointFrame present_frame(const Grains &grains, const Joints &joints, const std::size_t j)
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
struct JointGradients
{
  std::array<double, 6> gap, shear;
};
JointGradients gradients(const Joints &joints, const std::size_t j, const JointFrame &at)
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
                      const JointFrame &at,
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
/// Forces of a joint and their derivatives by gap, shear and rotation, weighted.
struct JointResponse
{
  JointTension tension;
  double gap = 0., shear = 0.;             ///< dF/dg, dS/du_s [N/m]
  double gap_rotation = 0., rotation = 0.; ///< dF/dtheta [N], -dM/dtheta [N m]
};

JointResponse
intact_response(const Joints &joints, const std::size_t j, const JointDeformation &d)
{
  const auto k = stiffness(joints, j);
  return {{k[0] * d.gap, k[1] * d.shear}, k[0], k[1], 0., k[2]};
}

/// The elements' sums: what is bonded, and what is closed of the others.
JointResponse
damaged_response(const Joints &joints, const std::size_t j, const JointDeformation &d)
{
  const auto record = static_cast<std::size_t>(joints.damage[j]);
  JointResponse sum;
  if (joints.damaged.removed[record] != 0)
    return sum;
  const FlatJoint &law = joints.group_of(j).flat();
  const double weight = joints.weight.empty() ? 1. : joints.weight[j];
  const double kn = weight * joints.stiffness[j], ks = kn / law.stiffness_ratio;
  const double R = joints.half_length[j], element = 2. * R / law.n_elements;
  const double infinite = std::numeric_limits<double>::infinity();
  // Faces touch where g - theta s < 0.
  const double root = d.rotation != 0. ? d.gap / d.rotation
                      : d.gap < 0.     ? -infinite
                                       : infinite;
  for (int e = 0; e < law.n_elements; ++e)
  {
    double a = e * element - R, b = a + element;
    if (joints.damaged.bond(record, e) != Bond::bonded)
    {
      if (d.rotation < 0.)
        b = std::clamp(root, a, b);
      else
        a = std::clamp(root, a, b);
    }
    const double length = b - a, centre = 0.5 * (a + b);
    const double second =
        centre * centre + (law.element_moment ? length * length / 12. : 0.);
    sum.tension.normal += kn * length * (d.gap - d.rotation * centre);
    sum.tension.shear += ks * length * (d.shear - joints.damaged.slip(record, e));
    sum.gap += kn * length;
    sum.shear += ks * length;
    sum.gap_rotation -= kn * length * centre;
    sum.rotation += kn * length * second;
  }
  return sum;
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
  const JointFrame at = present_frame(grains, joints, j);
  const JointGradients of = gradients(joints, j, at);
  const JointDeformation d = deformation(grains, joints, j);
  const JointResponse r = joints.damage[j] < 0 ? intact_response(joints, j, d)
                                               : damaged_response(joints, j, d);
  JointMatrix K = geometric(joints, j, at, r.tension);
  constexpr std::array<double, 6> rotation{{0., 0., -1., 0., 0., 1.}};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      K[a][b] += r.gap * of.gap[a] * of.gap[b] + r.shear * of.shear[a] * of.shear[b] +
                 r.gap_rotation * (of.gap[a] * rotation[b] + rotation[a] * of.gap[b]) +
                 r.rotation * rotation[a] * rotation[b];
  return K;
}
} // namespace antiform::discrete

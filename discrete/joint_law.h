#pragma once

// The formulas of docs/theory/flat_joint.md, once: for one joint (V = double) or for four
// (V = Lanes), the same operations in the same order. Internal linkage: see lanes.h.

#include "discrete/lanes.h"

namespace antiform::discrete
{
namespace
{
/// Round to the nearest integer by the mantissa's last bit; |x| < 2^51.
template <class V>
inline V nearest(const V x)
{
  constexpr double magic = 6755399441055744.; // 1.5 * 2^52
  return (x + magic) - magic;
}

/// Sine and cosine: reduction to |r| <= pi/4 in three parts of pi/2, then minimax
/// polynomials (Cephes); error below 1 ulp or so for |angle| < 1e5.
template <class V>
inline void sine_cosine(const V angle, V &sine, V &cosine)
{
  const V quarter = nearest(angle * 0.63661977236758134308);
  const V r =
      ((angle - quarter * 1.57079625129699707031) - quarter * 7.54978941586159635336e-8) -
      quarter * 5.39030285815811905290e-15;
  const V z = r * r;
  const V s = r + r * z *
                      (-1.66666666666666307295e-1 +
                       z * (8.33333333332211858878e-3 +
                            z * (-1.98412698295895385996e-4 +
                                 z * (2.75573136213857245213e-6 +
                                      z * (-2.50507477628578072866e-8 +
                                           z * 1.58962301576546568060e-10)))));
  const V c = 1. - 0.5 * z +
              z * z *
                  (4.16666666666665929218e-2 +
                   z * (-1.38888888888730564116e-3 +
                        z * (2.48015872888517045348e-5 +
                             z * (-2.75573141792967388112e-7 +
                                  z * (2.08757008419747316778e-9 -
                                       z * 1.13585365213876817300e-11)))));
  const V quadrant = quarter - 4. * nearest(0.25 * quarter); // -2, -1, 0, 1 or 2
  const V squared = quadrant * quadrant;
  const auto odd = squared == 1., turned = squared == 4.;
  const V sine_part = select(odd, c, s), cosine_part = select(odd, s, c);
  sine = select(turned | (quadrant == -1.), -sine_part, sine_part);
  cosine = select(turned | (quadrant == 1.), -cosine_part, cosine_part);
}

/// Of half the rotations of a joint's two grains.
template <class V>
struct HalfAngles
{
  V cos1, sin1, cos2, sin2;
};
template <class V>
inline HalfAngles<V> half_angles(const V rotation1, const V rotation2)
{
  HalfAngles<V> half;
  sine_cosine<V>(0.5 * rotation1, half.sin1, half.cos1);
  sine_cosine<V>(0.5 * rotation2, half.sin2, half.cos2);
  return half;
}

/// Where the joint was installed.
template <class V>
struct InstalledFrame
{
  V normal_x, normal_y, length, lever_difference;
};

/// Where it is: mean frame, faces theta/2 to either side of it, and the jump between
/// their middles, prestress not included.
template <class V>
struct JointGeometry
{
  V normal_x, normal_y; ///< tangent: -normal_y, normal_x
  V face_cos, face_sin; ///< of theta/2
  V gap, shear;
};
template <class V>
inline JointGeometry<V> joint_geometry(const InstalledFrame<V> &at,
                                       const HalfAngles<V> &half,
                                       const V ux,
                                       const V uy)
{
  const V cos_cos = half.cos1 * half.cos2, sin_sin = half.sin1 * half.sin2;
  const V cos_sin = half.cos1 * half.sin2, sin_cos = half.sin1 * half.cos2;
  const V frame_cos = cos_cos - sin_sin, frame_sin = sin_cos + cos_sin;
  JointGeometry<V> now;
  now.face_cos = cos_cos + sin_sin;
  now.face_sin = cos_sin - sin_cos;
  now.normal_x = frame_cos * at.normal_x - frame_sin * at.normal_y;
  now.normal_y = frame_sin * at.normal_x + frame_cos * at.normal_y;
  now.gap = ux * now.normal_x + uy * now.normal_y - 2. * at.length * sin_sin;
  now.shear = (uy * now.normal_x - ux * now.normal_y) - at.length * frame_sin -
              at.lever_difference * now.face_sin;
  return now;
}

/// Resultants F, S, M of a joint.
template <class V>
struct JointResultant
{
  V normal, shear, moment;
};

/// Force on the second grain, -F n - S t, and the torques: it acts at the middle of the
/// faces.
template <class V>
struct GrainForces
{
  V x, y, torque1, torque2;
};
template <class V>
inline GrainForces<V> grain_forces(const JointResultant<V> &sum,
                                   const InstalledFrame<V> &at,
                                   const JointGeometry<V> &now)
{
  const V F = sum.normal, S = sum.shear;
  const V half_gap = 0.5 * now.gap, half_shear = 0.5 * now.shear;
  const V r1 = 0.5 * (at.length - at.lever_difference);
  const V r2 = 0.5 * (at.length + at.lever_difference);
  return {S * now.normal_y - F * now.normal_x, -(F * now.normal_y) - S * now.normal_x,
          (r1 * now.face_cos + half_gap) * S - (half_shear - r1 * now.face_sin) * F -
              sum.moment,
          (r2 * now.face_cos + half_gap) * S - (half_shear + r2 * now.face_sin) * F +
              sum.moment};
}

// --- elements
// ---------------------------------------------------------------------------

/// Constants of a joint that its elements obey.
template <class V>
struct ElementLaw
{
  V normal_stiffness; ///< k_n [Pa/m]
  V shear_stiffness;  ///< k_s [Pa/m]
  V shear_compliance; ///< 1 / k_s [m/Pa]
  V half_length;      ///< R [m]
  V n_elements;
  V element_length; ///< 2 R / N [m]
  V moment;         ///< 1, or 0 without element moments
  V residual_friction, residual_cohesion;
  V tensile_strength, cohesion, tan_friction; ///< infinity, 0: not looked at
};

/// Deformation that the law sees, prestress included: g(s) = gap - rotation s. The faces
/// touch, g(s) < 0, between closed_from and closed_to.
template <class V>
struct Deformation
{
  V gap, shear, rotation;
  V closed_from, closed_to; ///< along the joint's line, which they may be beyond [m]
};
template <class V>
inline Deformation<V> seen_by_law(const V gap, const V shear, const V rotation)
{
  const V infinite = V{} + __builtin_inf(), root = gap / rotation;
  const auto falls = rotation > 0., rises = rotation < 0.;
  const V elsewhere = select(rises | (gap < 0.), -infinite, infinite);
  return {gap, shear, rotation, select(falls, root, elsewhere),
          select(rises, root, infinite)};
}

/// A stretch of the joint's line, from its centre along the tangent.
template <class V>
struct Stretch
{
  V a, b;
};
/// Element @p e; an empty one at the end where the joint has fewer.
template <class V>
inline Stretch<V> element(const ElementLaw<V> &law, const double e)
{
  const V R = law.half_length, l = law.element_length;
  return {select(law.n_elements <= e, R, e * l - R),
          select(law.n_elements <= e + 1., R, (e + 1.) * l - R)};
}

/// The part of an element whose faces touch.
template <class V>
inline Stretch<V> closed_part(const Stretch<V> &element, const Deformation<V> &d)
{
  const V a = smaller<V>(larger<V>(d.closed_from, element.a), element.b);
  return {a, larger<V>(smaller<V>(d.closed_to, element.b), a)};
}

/// Normal force and moment of a stretch that carries k_n g(s).
template <class V>
struct NormalResultant
{
  V force, moment;
};
template <class V>
inline NormalResultant<V> normal_resultant(const ElementLaw<V> &law,
                                           const Deformation<V> &d,
                                           const Stretch<V> &part)
{
  const V length = part.b - part.a, centre = 0.5 * (part.a + part.b);
  const V stiffness = law.normal_stiffness * length;
  const V force = stiffness * (d.gap - d.rotation * centre);
  return {force, centre * force - law.moment * stiffness * d.rotation *
                                      (length * length * (1. / 12.))};
}

/// What a broken element rubs in a step.
template <class V>
struct Friction
{
  V force;      ///< shear force [N]
  V slip;       ///< plastic slip after the step [m]
  V dissipated; ///< [J]
};
/// \param before,now        deformation at the last step and at this
/// \param old_active,active closed length then and now
/// \param slip              plastic slip then
/// \param limit             of the shear force now; not looked at where @p held
/// The force is k_s times closed length times elastic slip. What closes further carries
/// nothing at first; what opens gives up its share, as sliding under a vanishing limit.
/// An element that closes within the step sticks from there on. An open one has the limit
/// 0 and ends with no elastic slip.
template <class V, class Mask>
inline Friction<V> friction(const ElementLaw<V> &law,
                            const Stretch<V> &whole,
                            const Deformation<V> &before,
                            const Deformation<V> &now,
                            const V old_active,
                            const V active,
                            const V slip,
                            const V limit,
                            const Mask held)
{
  V old_shear = before.shear, start = slip;
  const auto closes = (old_active == 0.) & (active > 0.);
  if (any(closes))
  {
    const V old_gap = smaller<V>(before.gap - before.rotation * whole.a,
                                 before.gap - before.rotation * whole.b);
    const V new_gap =
        smaller<V>(now.gap - now.rotation * whole.a, now.gap - now.rotation * whole.b);
    const V closing =
        now.shear - new_gap / (new_gap - old_gap) * (now.shear - before.shear);
    old_shear = select(closes, closing, old_shear);
    start = select(closes, closing, start);
  }

  constexpr double nothing = 1e-200; // instead of dividing by 0
  const V inverse = 1. / larger<V>(active, V{} + nothing);
  const V old_elastic = old_shear - start;
  const V elastic =
      old_elastic * select(active > old_active, old_active * inverse, V{} + 1.);
  const V trial = elastic + (now.shear - old_shear);
  const V most =
      select(held, V{} + __builtin_inf(), limit * inverse * law.shear_compliance);
  const V stays = larger<V>(smaller<V>(trial, most), -most);

  const V stiffness = law.shear_stiffness * active;
  const V given_up = law.shear_stiffness * old_active * old_elastic * old_elastic -
                     stiffness * elastic * elastic;
  const V rubbed = (absolute(stiffness * elastic) + limit) * absolute(trial - stays);
  return {stiffness * stays, select(held, slip, now.shear - stays),
          0.5 * (given_up + rubbed)};
}

/// What the elements of a joint add up to.
template <class V>
struct ElementSums
{
  V normal{}, shear{}, moment{};
  V dissipated{};
  decltype(V{} > V{}) any_bonded{}; ///< bonds are left
  decltype(V{} > V{}) over{};       ///< one of them is over a strength
};

/// Element @p whole of a joint in this step, its bond being as it is. @p just_broken:
/// what of it is closed was closed at the last step as well. \return its plastic slip
/// after the step
template <bool just_broken, class V, class Mask>
inline V add_element(const ElementLaw<V> &law,
                     const Stretch<V> &whole,
                     const Mask bonded,
                     const Deformation<V> &before,
                     const Deformation<V> &now,
                     const V slip,
                     ElementSums<V> &sums)
{
  const Stretch<V> closed = closed_part(whole, now);
  const Stretch<V> old_closed = closed_part(whole, before);
  const Stretch<V> part{select(bonded, whole.a, closed.a),
                        select(bonded, whole.b, closed.b)};
  const V active = part.b - part.a;
  const V old_active =
      just_broken ? active : select(bonded, active, old_closed.b - old_closed.a);
  const NormalResultant<V> normal = normal_resultant(law, now, part);
  const V limit =
      law.residual_friction * absolute(normal.force) + law.residual_cohesion * active;
  const Friction<V> rubbing =
      friction(law, whole, before, now, old_active, active, slip, limit, bonded);

  const V stress =
      law.normal_stiffness * (now.gap - now.rotation * (0.5 * (whole.a + whole.b)));
  const V shear_stress = law.shear_stiffness * (now.shear - slip);
  sums.over |=
      bonded & ((stress >= law.tensile_strength) |
                (absolute(shear_stress) + stress * law.tan_friction > law.cohesion));
  sums.any_bonded |= bonded;
  sums.normal += normal.force;
  sums.shear += rubbing.force;
  sums.moment += normal.moment;
  sums.dissipated += rubbing.dissipated;
  return rubbing.slip;
}

/// Whether a joint without bonds is over for good: its faces are half their length
/// further apart than they were made (@p made: max(0, initial gap)), or have slid off one
/// another.
template <class V>
inline auto parts(const ElementLaw<V> &law,
                  const ElementSums<V> &sums,
                  const Deformation<V> &now,
                  const V made)
{
  const V R = law.half_length;
  const V smallest = smaller<V>(now.gap - now.rotation * R, now.gap + now.rotation * R);
  return (!sums.any_bonded) & ((smallest > made + R) | (absolute(now.shear) > 2. * R));
}
} // namespace
} // namespace antiform::discrete

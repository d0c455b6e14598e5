#pragma once

#include "discrete/joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

// The full law of damaged joints as plainly as it can be written: a record with vectors a
// joint, an element at a time, libm's sines. Twin of the vector kernel.
namespace antiform::discrete::test
{
struct PlainDamagedJoint
{
  std::size_t joint = 0;
  std::vector<Bond> bond;   ///< per element
  std::vector<double> slip; ///< plastic slip p per element: tau = k_s (u_s - p) [m]
  std::vector<double> shear_stress;  ///< force over full element area [Pa]
  std::vector<double> normal_stress; ///< mean over the full element [Pa]
  double gap = 0.;                   ///< at the last evaluation [m]
  double shear = 0.;                 ///< u_s at the last evaluation [m]
  double rotation = 0.;              ///< at the last evaluation [rad]
  double slip_energy = 0.;           ///< dissipated by sliding so far, weighted [J]
  double fracture_energy = 0.;       ///< lost with broken elements so far, weighted [J]
  bool removed = false;              ///< faces parted for good; contact may take over
  JointForce force{0., 0., 0., 0.};  ///< of the last evaluation
};

struct ElementPlace
{
  double a, b; ///< ends along the tangent from the joint's centre [m]
};

inline ElementPlace
element_place(const Joints &joints, const std::size_t joint, const int n, const int e)
{
  const double R = joints.half_length[joint], l = 2. * R / n;
  return {-R + e * l, e + 1 == n ? R : -R + (e + 1) * l};
}

/// Share of the step, from its start, at which a quantity that goes linearly from @p old
/// to @p now reaches @p limit; infinity when it does not, 0 when it was there already.
inline double share_at_limit(const double old, const double now, const double limit)
{
  if (now < limit)
    return std::numeric_limits<double>::infinity();
  return old >= limit ? 0. : (limit - old) / (now - old);
}

/// Mean stresses over an element for a trial deformation.
struct TrialStress
{
  double normal, shear;
};
inline TrialStress bonded_stress(const Joints &joints,
                                 const FlatJoint &law,
                                 const std::size_t j,
                                 const ElementPlace &place,
                                 const double slip,
                                 const JointDeformation &d)
{
  const double k = joints.stiffness[j], centre = 0.5 * (place.a + place.b);
  return {k * (d.gap - d.rotation * centre), k / law.stiffness_ratio * (d.shear - slip)};
}

/// Shear of a broken element that is closed over @p active of its length now and was over
/// @p old_active at the last step, its normal force being @p normal_force now. The force
/// is k_s times closed length times elastic slip. What closes further carries nothing at
/// first; what opens gives up its share, as sliding under a vanishing limit.
struct Rub
{
  double force = 0.;      ///< [N]
  double dissipated = 0.; ///< [J]
};
inline Rub rub(const double k_s,
               const double limit,
               const double active,
               const double old_active,
               const double shear,
               const double old_shear,
               double &slip)
{
  Rub result;
  double stretch = old_shear - slip;
  const double stored = 0.5 * k_s * old_active * stretch * stretch;
  if (active > old_active)
    stretch *= old_active / active;
  const double old_force = std::abs(k_s * active * stretch);
  result.dissipated = stored - 0.5 * k_s * active * stretch * stretch;
  slip = old_shear - stretch;
  if (active == 0.)
  {
    slip = shear; // open: carries nothing, remembers where it stands
    return result;
  }
  result.force = k_s * active * (shear - slip);
  if (std::abs(result.force) > limit)
  {
    const double increment = (std::abs(result.force) - limit) / (k_s * active);
    slip += std::copysign(increment, result.force);
    result.force = std::copysign(limit, result.force);
    result.dissipated += 0.5 * (old_force + limit) * increment;
  }
  return result;
}

/// Which strength a bonded element passes in this step, and passes first.
inline Bond
break_mode(const FlatJoint &law, const TrialStress &old, const TrialStress &now)
{
  const double tension = share_at_limit(old.normal, now.normal, law.tensile_strength);
  // Coulomb: |tau| + sigma tan(phi) = c; |tau| is linear between states of one sign, and
  // a change of sign within a step that also breaks is beyond any stable step's reach.
  const double excess_old = std::abs(old.shear) + old.normal * law.tan_friction;
  const double excess_now = std::abs(now.shear) + now.normal * law.tan_friction;
  const double shear = excess_now > law.cohesion
                           ? share_at_limit(excess_old, excess_now, law.cohesion)
                           : std::numeric_limits<double>::infinity();
  if (std::isinf(tension) && std::isinf(shear))
    return Bond::bonded;
  return tension <= shear ? Bond::broken_in_tension : Bond::broken_in_shear;
}
/// What an element gives to its joint.
struct ElementForce
{
  double normal = 0., shear = 0., moment = 0.;
};

/// An element's two evaluations: what it carries, and what it would have carried
/// unbroken.
struct Evaluation
{
  ElementForce force;
  double energy = 0.;
};
inline Evaluation bonded_element(const double k_n,
                                 const double k_s,
                                 const ElementPlace &place,
                                 const double slip,
                                 const JointDeformation &d,
                                 const bool element_moment)
{
  const ElementResultant normal =
      element_resultant(k_n, d.gap, d.rotation, place.a, place.b, true, element_moment);
  const double full = place.b - place.a, shear = k_s * full * (d.shear - slip);
  return {{normal.normal_force, shear, normal.moment},
          normal.strain_energy + 0.5 * shear * shear / (k_s * full)};
}

/// \param[in,out] slip of the element
/// \param[out] dissipated by sliding in this step
inline Evaluation broken_element(const double k_n,
                                 const double k_s,
                                 const FlatJoint &law,
                                 const ElementPlace &place,
                                 const JointDeformation &now,
                                 const JointDeformation &before,
                                 const bool just_broken,
                                 double &slip,
                                 double &dissipated)
{
  const auto resultant = [&](const JointDeformation &d)
  {
    return element_resultant(k_n, d.gap, d.rotation, place.a, place.b, false,
                             law.element_moment);
  };
  const ElementResultant normal = resultant(now);
  const double active = normal.active_length;
  const double old_active = just_broken ? active : resultant(before).active_length;
  double old_shear = before.shear;
  if (old_active == 0. && active > 0.)
  {
    // Closes within the step: sticks from there on.
    const double old_gap = std::min(before.gap - before.rotation * place.a,
                                    before.gap - before.rotation * place.b);
    const double new_gap =
        std::min(now.gap - now.rotation * place.a, now.gap - now.rotation * place.b);
    old_shear = now.shear - new_gap / (new_gap - old_gap) * (now.shear - before.shear);
    slip = old_shear;
  }
  const double limit = law.residual_friction * std::abs(normal.normal_force) +
                       law.residual_cohesion * active;
  const Rub friction = rub(k_s, limit, active, old_active, now.shear, old_shear, slip);
  dissipated = friction.dissipated;
  const double energy =
      normal.strain_energy +
      (active > 0. ? 0.5 * friction.force * friction.force / (k_s * active) : 0.);
  return {{normal.normal_force, friction.force, normal.moment}, energy};
}

/// Energy that a break in this step takes: the drop, less the work that the lost force
/// did not do in the second half of the step (the trapezoidal rule of the stepping loop).
inline double fracture_energy(const Evaluation &unbroken,
                              const Evaluation &broken,
                              const JointDeformation &now,
                              const JointDeformation &before)
{
  const ElementForce &u = unbroken.force, &b = broken.force;
  return unbroken.energy - broken.energy -
         0.5 * ((u.normal - b.normal) * (now.gap - before.gap) +
                (u.shear - b.shear) * (now.shear - before.shear) -
                (u.moment - b.moment) * (now.rotation - before.rotation));
}

/// Force on the second grain, -F n - S t, and torques: it acts at the middle of the
/// faces.
inline JointForce on_grains(const Grains &grains,
                            const Joints &joints,
                            const std::size_t j,
                            const ElementForce &sum,
                            const JointDeformation &now)
{
  const std::size_t one = joints.first[j], two = joints.second[j];
  const double turn = 0.5 * (grains.rotation[one] + grains.rotation[two]);
  const Vec2 n = rotated({joints.normal_x[j], joints.normal_y[j]}, turn);
  const double half = 0.5 * (grains.rotation[two] - grains.rotation[one]);
  const double face_cos = std::cos(half), face_sin = std::sin(half);
  const double r1 = 0.5 * (joints.length[j] - joints.lever_difference[j]);
  const double r2 = 0.5 * (joints.length[j] + joints.lever_difference[j]);
  double gap = now.gap, shear = now.shear; // levers are geometric: without prestress
  if (!joints.initial_gap.empty())
  {
    gap -= joints.initial_gap[j];
    shear -= joints.initial_shear[j];
  }
  const double F = sum.normal, S = sum.shear, M = sum.moment;
  return {S * n.y - F * n.x, -F * n.y - S * n.x,
          (r1 * face_cos + 0.5 * gap) * S - (0.5 * shear - r1 * face_sin) * F - M,
          (r2 * face_cos + 0.5 * gap) * S - (0.5 * shear + r2 * face_sin) * F + M};
}
inline double plain_strain_energy(const Joints &joints, const PlainDamagedJoint &damaged)
{
  if (damaged.removed)
    return 0.;
  const std::size_t j = damaged.joint;
  const FlatJoint &law = joints.group_of(j).flat();
  const double k_n = joints.stiffness[j], k_s = k_n / law.stiffness_ratio;
  double energy = 0.;
  for (int e = 0; e < law.n_elements; ++e)
  {
    const ElementPlace place = element_place(joints, j, law.n_elements, e);
    const ElementResultant normal =
        element_resultant(k_n, damaged.gap, damaged.rotation, place.a, place.b,
                          damaged.bond[e] == Bond::bonded, law.element_moment);
    energy += normal.strain_energy;
    const double full = place.b - place.a, tau = damaged.shear_stress[e];
    if (normal.active_length > 0.)
      energy += 0.5 * tau * tau * full * full / (k_s * normal.active_length);
  }
  return energy * (joints.weight.empty() ? 1. : joints.weight[j]);
}

inline PlainDamagedJoint plain_damaged(const Joints &joints, const std::size_t joint)
{
  const int n = joints.group_of(joint).flat().n_elements;
  PlainDamagedJoint damaged;
  damaged.joint = joint;
  damaged.bond.assign(n, Bond::bonded);
  damaged.slip.assign(n, 0.);
  damaged.shear_stress.assign(n, 0.);
  damaged.normal_stress.assign(n, 0.);
  return damaged;
}

inline void plain_evaluate(const Grains &grains,
                           const Joints &joints,
                           PlainDamagedJoint &damaged,
                           const JointDeformation &now,
                           const JointDeformation &before,
                           const StepTime &time,
                           std::vector<Crack> *cracks)
{
  const std::size_t j = damaged.joint;
  const FlatJoint &law = joints.group_of(j).flat();
  const double weight = joints.weight.empty() ? 1. : joints.weight[j];
  const double k_n = joints.stiffness[j], k_s = k_n / law.stiffness_ratio;
  ElementForce sum;
  bool any_bonded = false;
  double smallest_gap = std::numeric_limits<double>::infinity();

  for (int e = 0; e < law.n_elements; ++e)
  {
    const ElementPlace place = element_place(joints, j, law.n_elements, e);
    double &slip = damaged.slip[e];
    Evaluation element;
    Bond mode = damaged.bond[e];
    if (mode == Bond::bonded)
    {
      element = bonded_element(k_n, k_s, place, slip, now, law.element_moment);
      if (cracks != nullptr && law.breakable)
        mode = break_mode(law, bonded_stress(joints, law, j, place, slip, before),
                          bonded_stress(joints, law, j, place, slip, now));
    }
    if (mode != Bond::bonded)
    {
      const bool just_broken = damaged.bond[e] == Bond::bonded;
      double dissipated = 0.;
      const Evaluation broken = broken_element(k_n, k_s, law, place, now, before,
                                               just_broken, slip, dissipated);
      if (just_broken)
      {
        damaged.fracture_energy += weight * fracture_energy(element, broken, now, before);
        damaged.bond[e] = mode;
        Crack crack;
        crack.step = time.step;
        crack.joint = j;
        crack.element = e;
        crack.mode = mode;
        cracks->push_back(crack);
      }
      else
        damaged.slip_energy += weight * dissipated;
      element = broken;
    }

    const double full = place.b - place.a;
    damaged.shear_stress[e] = element.force.shear / full;
    damaged.normal_stress[e] = element.force.normal / full;
    sum.normal += weight * element.force.normal;
    sum.shear += weight * element.force.shear;
    sum.moment += weight * element.force.moment;
    any_bonded = any_bonded || mode == Bond::bonded;
    smallest_gap = std::min({smallest_gap, now.gap - now.rotation * place.a,
                             now.gap - now.rotation * place.b});
  }

  damaged.gap = now.gap;
  damaged.shear = now.shear;
  damaged.rotation = now.rotation;
  // Parted for good: the faces are half their length further apart than they were made,
  // or have slid off one another.
  const double R = joints.half_length[j];
  const double made = joints.initial_gap.empty() ? 0. : joints.initial_gap[j];
  if (!any_bonded &&
      (smallest_gap > std::max(0., made) + R || std::abs(now.shear) > 2. * R))
  {
    damaged.fracture_energy += plain_strain_energy(joints, damaged);
    damaged.removed = true;
    damaged.force = {0., 0., 0., 0.};
    return;
  }
  damaged.force = on_grains(grains, joints, j, sum, now);
}
} // namespace antiform::discrete::test

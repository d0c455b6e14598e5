#include "discrete/joint_damage.h"

#include "discrete/joint_kernel.h"
#include "discrete/joint_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
ElementConstants element_constants(const FlatJoint &law, const bool look_at_strengths)
{
  const bool tested = look_at_strengths && law.breakable;
  constexpr double none = std::numeric_limits<double>::infinity();
  return {1. / law.stiffness_ratio,     static_cast<double>(law.n_elements),
          law.element_moment ? 1. : 0., law.residual_friction,
          law.residual_cohesion,        tested ? law.tensile_strength : none,
          tested ? law.cohesion : none, tested ? law.tan_friction : 0.};
}

namespace
{
ElementLaw<double> element_law(const Joints &joints,
                               const std::size_t j,
                               const FlatJoint &flat,
                               const bool look_at_strengths)
{
  const ElementConstants c = element_constants(flat, look_at_strengths);
  ElementLaw<double> law;
  law.normal_stiffness = joints.stiffness[j];
  law.shear_stiffness = law.normal_stiffness * c.shear_ratio;
  law.shear_compliance = 1. / law.shear_stiffness;
  law.half_length = joints.half_length[j];
  law.n_elements = c.n_elements;
  law.element_length = 2. * law.half_length / law.n_elements;
  law.moment = c.moment;
  law.residual_friction = c.residual_friction;
  law.residual_cohesion = c.residual_cohesion;
  law.tensile_strength = c.tensile_strength;
  law.cohesion = c.cohesion;
  law.tan_friction = c.tan_friction;
  if (!joints.tension_factor.empty())
  {
    law.tensile_strength *= joints.tension_factor[j];
    law.cohesion *= joints.cohesion_factor[j];
  }
  return law;
}

} // namespace

double share_at_limit(const double old, const double now, const double limit)
{
  if (now < limit)
    return std::numeric_limits<double>::infinity();
  return old >= limit ? 0. : (limit - old) / (now - old);
}

Crack make_crack(const Grains &grains,
                 const Joints &joints,
                 const std::size_t j,
                 const int e,
                 const double a,
                 const double b,
                 const Bond mode,
                 const StepTime &time)
{
  const std::size_t one = joints.first[j], two = joints.second[j];
  const double turn = 0.5 * (grains.rotation[one] + grains.rotation[two]);
  const Vec2 installed_normal{joints.normal_x[j], joints.normal_y[j]};
  const Vec2 normal = rotated(installed_normal, turn), tangent = perpendicular(normal);
  const double r1 = 0.5 * (joints.length[j] - joints.lever_difference[j]);
  const double r2 = 0.5 * (joints.length[j] + joints.lever_difference[j]);
  const double s = 0.5 * (a + b);
  const Vec2 face1 =
      grains.position(one) + r1 * rotated(installed_normal, grains.rotation[one]);
  const Vec2 face2 =
      grains.position(two) + -r2 * rotated(installed_normal, grains.rotation[two]);

  Crack crack;
  crack.step = time.step;
  crack.time = time.time;
  crack.place = 0.5 * (face1 + face2) + s * tangent;
  crack.reference_place =
      grains.reference(one) + r1 * installed_normal + s * perpendicular(installed_normal);
  crack.orientation = std::atan2(tangent.y, tangent.x);
  if (crack.orientation <= -0.5 * M_PI)
    crack.orientation += M_PI;
  else if (crack.orientation > 0.5 * M_PI)
    crack.orientation -= M_PI;
  crack.length = b - a;
  crack.mode = mode;
  crack.layer = joints.group_of(j).layer;
  crack.joint = j;
  crack.grain = one;
  crack.element = e;
  return crack;
}

namespace
{
/// Mean stresses over a bonded element.
struct MeanStress
{
  double normal, shear;
};
MeanStress bonded_stress(const ElementLaw<double> &law,
                         const Stretch<double> &place,
                         const double slip,
                         const Deformation<double> &d)
{
  return {law.normal_stiffness * (d.gap - d.rotation * (0.5 * (place.a + place.b))),
          law.shear_stiffness * (d.shear - slip)};
}

/// Which strength a bonded element passes in this step, and passes first.
Bond break_mode(const ElementLaw<double> &law,
                const MeanStress &old,
                const MeanStress &now)
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

/// Energy stored in an element [J].
double element_energy(const ElementLaw<double> &law,
                      const Stretch<double> &place,
                      const Deformation<double> &d,
                      const double slip,
                      const bool bonded)
{
  const ElementResultant normal = element_resultant(
      law.normal_stiffness, d.gap, d.rotation, place.a, place.b, bonded, law.moment > 0.);
  const double stretch = d.shear - slip;
  return normal.strain_energy +
         0.5 * law.shear_stiffness * normal.active_length * stretch * stretch;
}

/// Energy that a break in this step takes: the @p drop, less the work that the lost force
/// did not do in the second half of the step (the trapezoidal rule of the stepping loop).
double fracture_energy(const double drop,
                       const ElementSums<double> &unbroken,
                       const ElementSums<double> &broken,
                       const Deformation<double> &now,
                       const Deformation<double> &before)
{
  return drop -
         0.5 * ((unbroken.normal - broken.normal) * (now.gap - before.gap) +
                (unbroken.shear - broken.shear) * (now.shear - before.shear) -
                (unbroken.moment - broken.moment) * (now.rotation - before.rotation));
}
} // namespace

BondedElement bonded_element(const Joints &joints,
                             const std::size_t j,
                             const int e,
                             const JointDeformation &d)
{
  const ElementLaw<double> law = element_law(joints, j, joints.group_of(j).flat(), true);
  const Stretch<double> place = element(law, e);
  // A bonded element has no slip.
  const MeanStress stress =
      bonded_stress(law, place, 0., seen_by_law(d.gap, d.shear, d.rotation));
  return {stress.normal, stress.shear,     law.tensile_strength,
          law.cohesion,  law.tan_friction, place.a,
          place.b};
}

std::size_t add_damaged(Joints &joints, const std::size_t joint)
{
  const std::size_t g = joints.group_number(joint);
  joints.damage[joint] = static_cast<std::int32_t>(joints.damaged.size());
  return joints.damaged.append(joint, g, constants(joints.groups[g].law).n_elements);
}

void evaluate_damaged(const Grains &grains,
                      const Joints &joints,
                      DamagedJoints &damaged,
                      const std::size_t k,
                      const JointDeformation &before_step,
                      const StepTime &time,
                      std::vector<Crack> *cracks)
{
  const std::size_t j = damaged.joint[k], one = joints.first[j], two = joints.second[j];
  const FlatJoint &flat = joints.groups[damaged.group[k]].flat();
  const ElementLaw<double> law = element_law(joints, j, flat, cracks != nullptr);
  const double weight = joints.weight.empty() ? 1. : joints.weight[j];
  const Deformation<double> before =
      seen_by_law(before_step.gap, before_step.shear, before_step.rotation);
  const JointDeformation d = deformation(grains, joints, j);
  const Deformation<double> now = seen_by_law(d.gap, d.shear, d.rotation);
  ElementSums<double> sums;

  for (int e = 0; e < flat.n_elements; ++e)
  {
    const Stretch<double> place = element(law, e);
    const double slip = damaged.slip(k, e);
    bool bonded = damaged.bond(k, e) == Bond::bonded;
    ElementSums<double> carries;
    double new_slip = add_element<false>(law, place, bonded, before, now, slip, carries);
    const Bond mode = bonded ? break_mode(law, bonded_stress(law, place, slip, before),
                                          bonded_stress(law, place, slip, now))
                             : damaged.bond(k, e);
    if (bonded && mode != Bond::bonded)
    {
      bonded = false;
      ElementSums<double> broken;
      new_slip = add_element<true>(law, place, bonded, before, now, slip, broken);
      const double drop = element_energy(law, place, now, slip, true) -
                          element_energy(law, place, now, new_slip, false);
      damaged.fracture_energy[k] +=
          weight * fracture_energy(drop, carries, broken, now, before);
      damaged.set_bond(k, e, mode);
      cracks->push_back(make_crack(grains, joints, j, e, place.a, place.b, mode, time));
      carries = broken;
      carries.dissipated = 0.; // it is in the fracture energy
    }
    damaged.set_slip(k, e, new_slip);
    sums.normal += carries.normal;
    sums.shear += carries.shear;
    sums.moment += carries.moment;
    sums.dissipated += carries.dissipated;
    sums.any_bonded |= bonded;
  }

  damaged.slip_energy[k] += weight * sums.dissipated;
  damaged.gap[k] = now.gap;
  damaged.shear[k] = now.shear;
  damaged.rotation[k] = now.rotation;
  const double made =
      joints.initial_gap.empty() ? 0. : std::max(0., joints.initial_gap[j]);
  if (parts(law, sums, now, made))
  {
    damaged.fracture_energy[k] += strain_energy(joints, damaged, k);
    damaged.removed[k] = 1;
    damaged.force[k] = {0., 0., 0., 0.};
    return;
  }
  const InstalledFrame<double> at{joints.normal_x[j], joints.normal_y[j],
                                  joints.length[j], joints.lever_difference[j]};
  const JointGeometry<double> place =
      joint_geometry(at, half_angles(grains.rotation[one], grains.rotation[two]),
                     grains.displacement_x[two] - grains.displacement_x[one],
                     grains.displacement_y[two] - grains.displacement_y[one]);
  const JointResultant<double> resultant{weight * sums.normal, weight * sums.shear,
                                         weight * sums.moment};
  const GrainForces<double> f = grain_forces(resultant, at, place);
  damaged.force[k] = {f.x, f.y, f.torque1, f.torque2};
}

double
strain_energy(const Joints &joints, const DamagedJoints &damaged, const std::size_t k)
{
  if (damaged.removed[k])
    return 0.;
  const std::size_t j = damaged.joint[k];
  const FlatJoint &flat = joints.groups[damaged.group[k]].flat();
  const ElementLaw<double> law = element_law(joints, j, flat, false);
  double energy = 0.;
  for (int e = 0; e < flat.n_elements; ++e)
    energy +=
        element_energy(law, element(law, e),
                       seen_by_law(damaged.gap[k], damaged.shear[k], damaged.rotation[k]),
                       damaged.slip(k, e), damaged.bond(k, e) == Bond::bonded);
  return energy * (joints.weight.empty() ? 1. : joints.weight[j]);
}

void break_element(const Grains &grains,
                   Joints &joints,
                   const std::size_t joint,
                   const int element,
                   const Bond mode)
{
  const JointDeformation now = deformation(grains, joints, joint);
  if (joints.damage[joint] < 0)
    add_damaged(joints, joint);
  DamagedJoints &damaged = joints.damaged;
  const std::size_t k = joints.damage[joint];
  evaluate_damaged(grains, joints, damaged, k, now, {}, nullptr);
  const double before = strain_energy(joints, damaged, k);
  const double rubbed = damaged.slip_energy[k];
  damaged.set_bond(k, element, mode);
  evaluate_damaged(grains, joints, damaged, k, now, {}, nullptr);
  damaged.slip_energy[k] = rubbed; // what slips at the break is in the fracture energy
  damaged.fracture_energy[k] += before - strain_energy(joints, damaged, k);
}
} // namespace antiform::discrete

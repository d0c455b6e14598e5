#include "discrete/brittle_bond.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
namespace
{
/// Stresses that the strengths are compared with, and the force on the whole joint.
struct BondLoad
{
  double tension, coulomb; ///< [Pa]
  double normal, shear, moment;
  double energy;
};
BondLoad bond_load(const Joints &joints,
                   const BondConstants &bond,
                   const std::size_t j,
                   const JointDeformation &d)
{
  const double k = joints.stiffness[j], R = joints.half_length[j], full = 2. * R;
  const double edge = std::abs(k * d.rotation) * R;
  const double k_s = k / bond.stiffness_ratio;
  const double k_m = k * full * full * full * bond.moment_factor;
  BondLoad load{};
  load.tension = k * d.gap + edge * bond.tension_arm;
  load.coulomb =
      std::abs(k_s * d.shear) + (k * d.gap + edge * bond.coulomb_arm) * bond.tan_friction;
  load.normal = k * full * d.gap;
  load.shear = k_s * full * d.shear;
  load.moment = -k_m * d.rotation;
  load.energy = 0.5 * (k * full * d.gap * d.gap + k_s * full * d.shear * d.shear +
                       k_m * d.rotation * d.rotation);
  return load;
}

LinearContact contact_of(const ContactBond &law)
{
  LinearContact contact;
  contact.effective_modulus = law.effective_modulus;
  contact.stiffness_ratio = law.stiffness_ratio;
  contact.friction = law.residual_friction;
  return contact;
}

/// The contact that a contact bond leaves: it goes on from the bond's opening, so that no
/// force appears where a bond has turned far, and from its shear within friction.
Contact contact_left(const Grains &grains,
                     const Joints &joints,
                     const LinearContact &law,
                     const std::size_t j,
                     const double gap,
                     const double shear)
{
  Contact contact;
  contact.first = std::min(joints.first[j], joints.second[j]);
  contact.second = std::max(joints.first[j], joints.second[j]);
  const std::int32_t i = contact.first, k = contact.second;
  const double r1 = grains.radius[i], r2 = grains.radius[k];
  contact.gap = gap;
  contact.reference_gap = norm(grains.position(k) - grains.position(i)) - r1 - r2 - gap;
  if (contact.gap < 0.)
  {
    contact.normal_force = -normal_stiffness(law, r1, r2) * contact.gap;
    const double limit = law.friction * contact.normal_force;
    contact.shear_force = std::clamp(shear, -limit, limit);
  }
  return contact;
}

JointForce force_of(const Grains &grains,
                    const Joints &joints,
                    const Contact &contact,
                    const std::size_t j)
{
  const std::int32_t i = contact.first, k = contact.second;
  const Vec2 branch = grains.position(k) - grains.position(i);
  const double distance = norm(branch);
  const Vec2 n = (1. / distance) * branch;
  const Vec2 force = contact.normal_force * n - contact.shear_force * perpendicular(n);
  const double arm =
      grains.radius[i] + 0.5 * (distance - grains.radius[i] - grains.radius[k]);
  const double torque_i = arm * contact.shear_force;
  const double torque_k = (distance - arm) * contact.shear_force;
  if (joints.first[j] == i)
    return {force.x, force.y, torque_i, torque_k};
  return {-force.x, -force.y, torque_k, torque_i};
}

double strain_energy(const Contact &contact, const double k_n, const double ratio)
{
  return 0.5 *
         (contact.normal_force * contact.normal_force +
          ratio * contact.shear_force * contact.shear_force) /
         k_n;
}
} // namespace

void break_bond(const Grains &grains,
                Joints &joints,
                const JointLaw &law,
                const std::size_t record,
                const JointDeformation &before,
                const StepTime &time,
                std::vector<Crack> &cracks)
{
  DamagedJoints &damaged = joints.damaged;
  const std::size_t j = damaged.joint[record];
  BondConstants bond = constants(law);
  if (!joints.tension_factor.empty())
  {
    bond.tensile_strength *= joints.tension_factor[j];
    bond.cohesion *= joints.cohesion_factor[j];
  }
  const JointDeformation now = deformation(grains, joints, j);
  const BondLoad old = bond_load(joints, bond, j, before);
  const BondLoad load = bond_load(joints, bond, j, now);
  const double tension = share_at_limit(old.tension, load.tension, bond.tensile_strength);
  const double coulomb = load.coulomb > bond.cohesion
                             ? share_at_limit(old.coulomb, load.coulomb, bond.cohesion)
                             : std::numeric_limits<double>::infinity();
  if (std::isinf(tension) && std::isinf(coulomb))
    return;
  const Bond mode = tension <= coulomb ? Bond::broken_in_tension : Bond::broken_in_shear;

  damaged.set_bond(record, 0, mode);
  damaged.gap[record] = now.gap;
  damaged.shear[record] = now.shear;
  damaged.rotation[record] = now.rotation;
  damaged.removed[record] = 1;
  // Forces that stay, along the joint's axes, and the energy in them.
  double kept_normal = 0., kept_shear = 0., kept = 0.;
  if (const auto *const glued = std::get_if<ContactBond>(&law))
  {
    const LinearContact contact_law = contact_of(*glued);
    const Contact contact =
        contact_left(grains, joints, contact_law, j, now.gap, load.shear);
    const double k_n = normal_stiffness(contact_law, grains.radius[contact.first],
                                        grains.radius[contact.second]);
    kept_normal = -contact.normal_force;
    kept_shear = contact.shear_force;
    kept = strain_energy(contact, k_n, contact_law.stiffness_ratio);
    damaged.force[record] = force_of(grains, joints, contact, j);
    joints.released.push_back({contact, static_cast<std::int32_t>(record)});
  }
  const double weight = joints.weight.empty() ? 1. : joints.weight[j];
  // The drop, less the work that the lost force did not do in the second half of the
  // step.
  damaged.fracture_energy[record] =
      weight * (load.energy - kept -
                0.5 * ((load.normal - kept_normal) * (now.gap - before.gap) +
                       (load.shear - kept_shear) * (now.shear - before.shear) -
                       load.moment * (now.rotation - before.rotation)));
  const double R = joints.half_length[j];
  cracks.push_back(make_crack(grains, joints, j, 0, -R, R, mode, time));
}

double released_energy(const Grains &grains, const Joints &joints)
{
  double energy = 0.;
  for (const auto &[contact, record] : joints.released)
  {
    const JointGroup &group = joints.groups[joints.damaged.group[record]];
    const LinearContact law = contact_of(std::get<ContactBond>(group.law));
    const double k_n = normal_stiffness(law, grains.radius[contact.first],
                                        grains.radius[contact.second]);
    energy += strain_energy(contact, k_n, law.stiffness_ratio);
  }
  return energy;
}
} // namespace antiform::discrete

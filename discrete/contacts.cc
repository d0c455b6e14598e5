#include "discrete/contacts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
namespace
{
bool before(const Contact &a, const Contact &b)
{
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// A joint between two grains, if there is one, and what it lets the contact do.
struct JointOfPair
{
  enum class State
  {
    none,
    holds,   ///< no contact
    released ///< removed, or with the contact beside it: the contact knows its gap
  };
  State state = State::none;
  double installed_gap = 0.;
};
JointOfPair joint_of_pair(const Grains &grains,
                          const Joints &joints,
                          const std::int32_t i,
                          const std::int32_t j)
{
  if (joints.grain_begin.empty())
    return {};
  for (std::int32_t k = joints.grain_begin[i]; k < joints.grain_begin[i + 1]; ++k)
  {
    const std::int32_t joint = joints.grain_joint[k];
    if (joints.first[joint] != j && joints.second[joint] != j)
      continue;
    const std::int32_t damage = joints.damage[joint];
    const bool removed = damage >= 0 && joints.damaged.removed[damage] != 0;
    const bool beside = has_contact_beside(joints.group_of(joint).law);
    return {removed || beside ? JointOfPair::State::released : JointOfPair::State::holds,
            joints.length[joint] - grains.radius[i] - grains.radius[j]};
  }
  return {};
}

/// The pair's bond has broken in this step, and its contact is about to be taken over.
bool waits(const Joints &joints, const std::int32_t i, const std::int32_t j)
{
  return std::any_of(joints.released.begin(), joints.released.end(),
                     [&](const Joints::Released &r)
                     { return r.contact.first == i && r.contact.second == j; });
}

double reference_gap(const Contacts &contacts, const std::int32_t i, const std::int32_t j)
{
  const auto found = std::lower_bound(
      contacts.installed.begin(), contacts.installed.end(), std::make_pair(i, j),
      [](const Contacts::Installed &a, const std::pair<std::int32_t, std::int32_t> &b)
      { return std::make_pair(a.first, a.second) < b; });
  if (found != contacts.installed.end() && found->first == i && found->second == j)
    return found->reference_gap;
  return 0.;
}
} // namespace

double
normal_stiffness(const LinearContact &law, const double radius_1, const double radius_2)
{
  return 2. * std::min(radius_1, radius_2) * law.effective_modulus /
         (radius_1 + radius_2);
}

const LinearContact &Contacts::law(const Grains &grains, const Contact &contact) const
{
  const int a = grains.region[contact.first], b = grains.region[contact.second];
  for (const ContactGroup &group : groups)
    if ((group.region_i == a && group.region_j == b) ||
        (group.region_i == b && group.region_j == a))
      return group.law;
  throw std::logic_error("no contact law for this pair of regions");
}

void search_contacts(const Grains &grains,
                     const Joints &joints,
                     Contacts &contacts,
                     PairOwner *const owner)
{
  // A reference gap above zero lets a pair touch before its disks do.
  double reach = contacts.margin;
  for (const Contacts::Installed &pair : contacts.installed)
    reach = std::max(reach, pair.reference_gap + contacts.margin);
  const auto installed_gap = [&](const std::size_t j)
  {
    return joints.length[j] - grains.radius[joints.first[j]] -
           grains.radius[joints.second[j]];
  };
  for (std::size_t k = 0; k < joints.damaged.size(); ++k)
    if (joints.damaged.removed[k])
      reach = std::max(reach, installed_gap(joints.damaged.joint[k]) + contacts.margin);
  for (const JointGroup &group : joints.groups)
    for (std::size_t j = group.begin; has_contact_beside(group.law) && j < group.end; ++j)
      reach = std::max(reach, installed_gap(j) + contacts.margin);

  std::vector<Contact> found;
  for (const ContactGroup &group : contacts.groups)
    for (const auto &[i, j] : pairs_within(grains, reach, group.region_i, group.region_j))
    {
      const JointOfPair joint = joint_of_pair(grains, joints, i, j);
      if (joint.state == JointOfPair::State::holds || waits(joints, i, j))
        continue;
      if (owner != nullptr && owner->takes(i, j))
        continue;
      Contact contact;
      contact.first = i;
      contact.second = j;
      contact.reference_gap = joint.state == JointOfPair::State::released
                                  ? joint.installed_gap
                                  : reference_gap(contacts, i, j);
      const double distance = norm(grains.position(j) - grains.position(i));
      // A contact pushes along the branch; of no length, it would push with a NaN.
      if (!(distance > 0.))
        throw std::invalid_argument("Contacts: the centres of grains " +
                                    std::to_string(i) + " and " + std::to_string(j) +
                                    " coincide: nothing tells which way they push each "
                                    "other. Take one of them out.");
      contact.gap =
          distance - grains.radius[i] - grains.radius[j] - contact.reference_gap;
      if (contact.gap <= contacts.margin)
        found.push_back(contact);
    }
  std::sort(found.begin(), found.end(), before);

  auto old = contacts.contacts.begin();
  for (Contact &contact : found)
  {
    for (; old != contacts.contacts.end() && before(*old, contact); ++old)
      contacts.lost_energy += old->slip_energy + old->dashpot_energy;
    if (old != contacts.contacts.end() && !before(contact, *old))
      contact = *old++;
  }
  for (; old != contacts.contacts.end(); ++old)
    contacts.lost_energy += old->slip_energy + old->dashpot_energy;
  contacts.contacts = std::move(found);
  contacts.search_x = grains.displacement_x;
  contacts.search_y = grains.displacement_y;
}

void take_released(Joints &joints, Contacts &contacts)
{
  for (const auto &[contact, record] : joints.released)
  {
    contacts.contacts.insert(std::lower_bound(contacts.contacts.begin(),
                                              contacts.contacts.end(), contact, before),
                             contact);
    joints.damaged.force[record] = {0., 0., 0., 0.};
  }
  joints.released.clear();
}

bool needs_search(const Grains &grains, const Contacts &contacts)
{
  if (contacts.search_x.size() != grains.size())
    return true;
  const double limit = 0.25 * contacts.margin * contacts.margin;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const double x = grains.displacement_x[i] - contacts.search_x[i];
    const double y = grains.displacement_y[i] - contacts.search_y[i];
    if (x * x + y * y > limit)
      return true;
  }
  return false;
}

void add_contact_forces(Grains &grains, Contacts &contacts, const double dt)
{
  for (Contact &contact : contacts.contacts)
  {
    const std::int32_t i = contact.first, j = contact.second;
    const Vec2 branch = grains.position(j) - grains.position(i);
    const double r1 = grains.radius[i], r2 = grains.radius[j];
    const double reach = r1 + r2 + contact.reference_gap;
    const double squared = dot(branch, branch);
    if (squared >= reach * reach)
    {
      contact.gap = std::sqrt(squared) - reach;
      if (contact.shear_force != 0.) // slides out under a vanishing limit
      {
        const LinearContact &law = contacts.law(grains, contact);
        contact.slip_energy += 0.5 * contact.shear_force * contact.shear_force *
                               law.stiffness_ratio / normal_stiffness(law, r1, r2);
      }
      contact.shear_force = contact.normal_force = 0.;
      continue;
    }
    const double distance = std::sqrt(squared);
    const Vec2 n = (1. / distance) * branch, t = perpendicular(n);
    const double gap = distance - reach;
    const double arm1 = r1 + 0.5 * (distance - r1 - r2), arm2 = distance - arm1;
    // Velocity of 2 against 1 at the contact point.
    const Vec2 relative = grains.velocity(j) - grains.velocity(i);
    const double normal_rate = dot(relative, n);
    const double shear_rate =
        dot(relative, t) - arm1 * grains.spin[i] - arm2 * grains.spin[j];

    const LinearContact &law = contacts.law(grains, contact);
    const double k_n = normal_stiffness(law, r1, r2), k_s = k_n / law.stiffness_ratio;
    const double normal = -k_n * gap;
    // Of the step in which it closes, only the part after closing shears it.
    const double closed = contact.gap > 0. ? gap / (gap - contact.gap) : 1.;
    double shear = 0.;
    if (law.friction > 0.)
    {
      const double trial = contact.shear_force + k_s * shear_rate * dt * closed;
      const double limit = law.friction * normal;
      shear = std::abs(trial) > limit ? std::copysign(limit, trial) : trial;
      if (shear != trial)
        contact.slip_energy += 0.5 * (std::abs(contact.shear_force) + limit) *
                               (std::abs(trial) - limit) / k_s;
    }
    contact.gap = gap;
    contact.normal_force = normal;
    contact.shear_force = shear;

    double push = normal, drag = shear;
    if (law.normal_dashpot > 0. || law.shear_dashpot > 0.)
    {
      const double m = 1. / (grains.inverse_mass[i] + grains.inverse_mass[j]);
      const double damper_n = 2. * law.normal_dashpot * std::sqrt(m * k_n) * normal_rate;
      const double damper_s = 2. * law.shear_dashpot * std::sqrt(m * k_s) * shear_rate;
      push -= damper_n;
      if (!law.tension_in_dashpot && push < 0.)
        push = 0.;
      drag += damper_s;
      contact.dashpot_energy +=
          ((normal - push) * normal_rate + damper_s * shear_rate) * dt;
    }
    const Vec2 force = push * n - drag * t; // on the second grain
    grains.force_x[j] += force.x;
    grains.force_y[j] += force.y;
    grains.force_x[i] -= force.x;
    grains.force_y[i] -= force.y;
    grains.torque[i] += arm1 * drag;
    grains.torque[j] += arm2 * drag;
  }
}

ContactEnergies contact_energies(const Grains &grains, const Contacts &contacts)
{
  ContactEnergies energies;
  energies.slip = contacts.lost_energy;
  for (const Contact &contact : contacts.contacts)
  {
    const LinearContact &law = contacts.law(grains, contact);
    const double k_n = normal_stiffness(law, grains.radius[contact.first],
                                        grains.radius[contact.second]);
    energies.strain +=
        0.5 * contact.normal_force * contact.normal_force / k_n +
        0.5 * contact.shear_force * contact.shear_force * law.stiffness_ratio / k_n;
    energies.slip += contact.slip_energy;
    energies.dashpot += contact.dashpot_energy;
  }
  return energies;
}
} // namespace antiform::discrete

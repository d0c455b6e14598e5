#include "discrete/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
namespace
{
std::vector<PairStiffness>
stiff_pairs(const Grains &grains, const Joints &joints, const Contacts &contacts)
{
  std::vector<PairStiffness> pairs;
  pairs.reserve(joints.size() + contacts.contacts.size());
  for (const JointGroup &group : joints.groups)
  {
    const BondConstants bond = constants(group.law);
    // As the whole interface of a flat joint, whatever share of it elements without a
    // moment of their own leave out.
    const double bending_factor = bond.moment_factor > 0. ? 1. / 12. : 0.;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      if (joints.damage[j] >= 0 && joints.damaged.removed[joints.damage[j]] != 0)
        continue;
      const double full = 2. * joints.half_length[j];
      const double normal =
          joints.stiffness[j] * full * (joints.weight.empty() ? 1. : joints.weight[j]);
      const double difference = joints.lever_difference[j];
      pairs.push_back({joints.first[j], joints.second[j], normal,
                       normal / bond.stiffness_ratio,
                       normal * full * full * bending_factor,
                       0.5 * (joints.length[j] - difference),
                       0.5 * (joints.length[j] + difference)});
    }
  }
  for (const Contact &contact : contacts.contacts)
  {
    const LinearContact &law = contacts.law(grains, contact);
    const double r1 = grains.radius[contact.first], r2 = grains.radius[contact.second];
    const double normal = normal_stiffness(law, r1, r2);
    const double shear = law.friction > 0. ? normal / law.stiffness_ratio : 0.;
    const double half_gap = 0.5 * contact.reference_gap; // the levers when they touch
    pairs.push_back(
        {contact.first, contact.second, normal, shear, 0., r1 + half_gap, r2 + half_gap});
  }
  return pairs;
}
} // namespace

double stable_step(const Grains &grains,
                   const Joints &joints,
                   const Contacts &contacts,
                   const std::vector<double> &extra,
                   const std::vector<PairStiffness> &more)
{
  std::vector<PairStiffness> pairs = stiff_pairs(grains, joints, contacts);
  pairs.insert(pairs.end(), more.begin(), more.end());
  std::vector<double> translation(grains.size(), 0.), rotation(grains.size(), 0.);
  for (const PairStiffness &pair : pairs)
  {
    translation[pair.first] += pair.translation();
    translation[pair.second] += pair.translation();
    rotation[pair.first] += pair.rotation(pair.lever1);
    rotation[pair.second] += pair.rotation(pair.lever2);
  }
  if (!extra.empty())
    for (std::size_t i = 0; i < grains.size(); ++i)
      translation[i] += extra[i];

  // Pair b has the share k_b / sum(k) of its grains' inertia, so that 1 / share of mass
  // is sum(k) / (k_b m). Normal motion, and shear with rotation, are uncoupled modes of
  // it.
  double largest = 0.;
  for (const PairStiffness &pair : pairs)
  {
    const std::int32_t i = pair.first, j = pair.second;
    const double moving = (translation[i] * grains.inverse_mass[i] +
                           translation[j] * grains.inverse_mass[j]) /
                          pair.translation();
    largest = std::max(largest, pair.normal * moving);
    if (pair.shear > 0.)
      largest = std::max(largest, pair.shear * moving +
                                      rotation[i] * grains.inverse_inertia[i] +
                                      rotation[j] * grains.inverse_inertia[j]);
  }
  if (!extra.empty())
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (extra[i] > 0.)
        largest = std::max(largest, translation[i] * grains.inverse_mass[i]);
  return largest > 0. ? 2. / std::sqrt(largest) : std::numeric_limits<double>::infinity();
}

double
stable_step(const Grains &grains, const Joints &joints, const std::vector<double> &extra)
{
  return stable_step(grains, joints, Contacts{}, extra);
}
} // namespace antiform::discrete

#include "discrete/joint_events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace antiform::discrete
{
LoadFactor load_factor(const BondedElement &element)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double left = element.cohesion - element.normal * element.tan_friction;
  const double shear = left > 0. ? std::abs(element.shear) / left : infinite;
  const double tension = element.tensile_strength > 0.
                             ? element.normal / element.tensile_strength
                             : (element.normal >= 0. ? infinite : 0.);
  return tension >= shear ? LoadFactor{tension, Bond::broken_in_tension}
                          : LoadFactor{shear, Bond::broken_in_shear};
}

namespace
{
/// Call @p action with each joint that can still break, and the number of its elements.
template <class Action>
void for_breakable(const Joints &joints, const Action &action)
{
  for (const JointGroup &group : joints.groups)
  {
    const BondConstants law = constants(group.law);
    if (!law.breakable)
      continue;
    if (is_brittle(group.law))
      throw std::invalid_argument(
          "joints '" + group.name +
          "' break as a whole: only elements of flat joints can "
          "be listed by their load");
    for (std::size_t j = group.begin; j < group.end; ++j)
      if (joints.damage[j] < 0 || !joints.damaged.removed[joints.damage[j]])
        action(j, law.n_elements);
  }
}

bool is_bonded(const Joints &joints, const std::size_t j, const int e)
{
  return joints.damage[j] < 0 ||
         joints.damaged.bond(joints.damage[j], e) == Bond::bonded;
}

/// Step after which a quantity that is @p value now and changes at @p rate reaches
/// @p limit; infinity when it never does.
double step_to(const double value, const double rate, const double limit)
{
  if (value >= limit)
    return 0.;
  return rate > 0. ? (limit - value) / rate : std::numeric_limits<double>::infinity();
}

/// The same for a bonded element that is at @p now and, a step @p probe later, @p then.
double
step_to_break(const BondedElement &now, const BondedElement &then, const double probe)
{
  const double normal_rate = (then.normal - now.normal) / probe;
  const double shear_rate = (then.shear - now.shear) / probe;
  double step = step_to(now.normal, normal_rate, now.tensile_strength);
  for (const double sign : {-1., 1.})
    step = std::min(step, step_to(sign * now.shear + now.normal * now.tan_friction,
                                  sign * shear_rate + normal_rate * now.tan_friction,
                                  now.cohesion));
  return step;
}
} // namespace

std::vector<LoadedElement> overstressed_elements(const Grains &grains,
                                                 const Joints &joints)
{
  std::vector<LoadedElement> over;
  for_breakable(joints,
                [&](const std::size_t j, const int n)
                {
                  const JointDeformation d = deformation(grains, joints, j);
                  for (int e = 0; e < n; ++e)
                  {
                    if (!is_bonded(joints, j, e))
                      continue;
                    const LoadFactor factor =
                        load_factor(bonded_element(joints, j, e, d));
                    if (factor.value >= 1.)
                      over.push_back({j, e, factor,
                                      0.5 * (grains.position(joints.first[j]) +
                                             grains.position(joints.second[j]))});
                  }
                });
  return over;
}

std::vector<double>
steps_to_break(const Grains &grains, const Joints &joints, const double probe)
{
  std::vector<double> steps;
  for_breakable(joints,
                [&](const std::size_t j, const int n)
                {
                  const JointDeformation now = deformation(grains, joints, j);
                  const JointDeformation then =
                      deformation_before(grains, joints, j, -probe);
                  for (int e = 0; e < n; ++e)
                    if (is_bonded(joints, j, e))
                    {
                      const double step = step_to_break(
                          bonded_element(joints, j, e, now),
                          bonded_element(joints, j, e, then), std::abs(probe));
                      if (std::isfinite(step))
                        steps.push_back(step);
                    }
                });
  return steps;
}

std::vector<LoadedElement> local_maxima(std::vector<LoadedElement> elements,
                                        const double radius)
{
  std::stable_sort(elements.begin(), elements.end(),
                   [](const LoadedElement &one, const LoadedElement &two)
                   { return one.factor.value > two.factor.value; });
  std::vector<LoadedElement> taken;
  for (const LoadedElement &element : elements)
    if (std::none_of(taken.begin(), taken.end(),
                     [&](const LoadedElement &other)
                     { return norm(other.place - element.place) < radius; }))
      taken.push_back(element);
  return taken;
}

void break_elements(const Grains &grains,
                    Joints &joints,
                    const std::vector<LoadedElement> &elements,
                    const StepTime &now,
                    std::vector<Crack> &cracks)
{
  for (const LoadedElement &broken : elements)
  {
    const BondedElement place =
        bonded_element(joints, broken.joint, broken.element,
                       deformation(grains, joints, broken.joint));
    break_element(grains, joints, broken.joint, broken.element, broken.factor.mode);
    cracks.push_back(make_crack(grains, joints, broken.joint, broken.element, place.a,
                                place.b, broken.factor.mode, now));
  }
}
} // namespace antiform::discrete

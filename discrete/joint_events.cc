#include "discrete/joint_events.h"

#include "discrete/joint_kernel.h"

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
/// Whether elements of the group's joints can break.
bool is_breakable(const JointGroup &group)
{
  if (!constants(group.law).breakable)
    return false;
  if (is_brittle(group.law))
    throw std::invalid_argument("joints '" + group.name +
                                "' break as a whole: only elements of flat joints can "
                                "be listed by their load");
  return true;
}

/// Call @p action with each joint that can still break, and the number of its elements.
template <class Action>
void for_breakable(const Joints &joints, const Action &action)
{
  for (const JointGroup &group : joints.groups)
    if (is_breakable(group))
      for (std::size_t j = group.begin; j < group.end; ++j)
        if (joints.damage[j] < 0 || !joints.damaged.removed[joints.damage[j]])
          action(j, constants(group.law).n_elements);
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

namespace
{
/// Those of joint @p j, which has @p n elements.
void add_overstressed(const Grains &grains,
                      const Joints &joints,
                      const std::size_t j,
                      const int n,
                      std::vector<LoadedElement> &over)
{
  const std::int32_t k = joints.damage[j];
  if (k >= 0 && joints.damaged.removed[k])
    return;
  bool any_bonded = false;
  for (int e = 0; e < n; ++e)
    any_bonded |= is_bonded(joints, j, e);
  if (!any_bonded)
    return;
  const JointDeformation d = deformation(grains, joints, j);
  for (int e = 0; e < n; ++e)
  {
    if (!is_bonded(joints, j, e))
      continue;
    const LoadFactor factor = load_factor(bonded_element(joints, j, e, d));
    if (factor.value >= 1.)
      over.push_back({j, e, factor,
                      0.5 * (grains.position(joints.first[j]) +
                             grains.position(joints.second[j]))});
  }
}
} // namespace

std::vector<LoadedElement> overstressed_elements(const Grains &grains, Joints &joints)
{
  const KernelLevel &level = kernel_level();
  fill_lines(grains, joints);
  joints.work.lines_filled = false; // the grains will have moved when they are used next
  std::vector<LoadedElement> over;
  for (const JointGroup &group : joints.groups)
  {
    if (!is_breakable(group))
      continue;
    const IntactKernelInput input = intact_input(joints, group, true);
    const int n = constants(group.law).n_elements;
    for (std::size_t begin = group.begin; begin < group.end; begin += intact_block)
    {
      const std::size_t end = std::min(begin + intact_block, group.end);
      alignas(64) JointForce force[intact_block];
      std::int32_t beyond[intact_block];
      const std::size_t n_beyond = level.intact(input, begin, end, force, beyond);
      std::size_t next = 0;
      for (std::size_t j = begin; j < end; ++j)
      {
        const bool is_beyond =
            next < n_beyond && static_cast<std::size_t>(beyond[next]) == j;
        next += is_beyond ? 1 : 0;
        if (is_beyond || joints.damage[j] >= 0)
          add_overstressed(grains, joints, j, n, over);
      }
    }
  }
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

#include "discrete/smooth_joints.h"

#include "discrete/joint_damage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::discrete
{
namespace
{
bool before(const SmoothContact &a, const SmoothContact &b)
{
  if (a.fracture != b.fracture)
    return a.fracture < b.fracture;
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// Length of each fracture that its pairs cover: between the outermost places where a
/// branch crosses it, and a half of the mean spacing beyond either; of a single pair, its
/// own @p width [m].
std::vector<double> covered_length(const Grains &grains,
                                   const SmoothJoints &joints,
                                   const std::vector<double> &width)
{
  const std::size_t n = joints.fractures.size();
  std::vector<double> low(n, std::numeric_limits<double>::max()), high(n, 0.);
  std::vector<double> count(n, 0.);
  for (const SmoothContact &c : joints.contacts)
  {
    const Fracture &fracture = joints.fractures[c.fracture];
    const Vec2 along = (1. / fracture.length()) * (fracture.end - fracture.begin);
    const Vec2 place =
        crossing(fracture, grains.reference(c.first), grains.reference(c.second));
    const double s = dot(place - fracture.begin, along);
    low[c.fracture] = std::min(low[c.fracture], s);
    high[c.fracture] = std::max(high[c.fracture], s);
    count[c.fracture] += 1.;
  }
  std::vector<double> length(n, 0.);
  for (std::size_t f = 0; f < n; ++f)
  {
    const double covered =
        count[f] > 1. ? (high[f] - low[f]) * count[f] / (count[f] - 1.) : width[f];
    length[f] = std::min(joints.fractures[f].length(), covered);
  }
  return length;
}

/// The pair where it stands, without stress; no area yet.
SmoothContact pair_across(const Grains &grains,
                          const std::vector<Fracture> &fractures,
                          const std::int32_t f,
                          const std::int32_t i,
                          const std::int32_t j)
{
  const Fracture &fracture = fractures[f];
  SmoothContact c;
  c.first = i;
  c.second = j;
  c.fracture = f;
  const Vec2 along = fracture.end - fracture.begin;
  const Vec2 n = (1. / norm(along)) * perpendicular(along);
  if (dot(grains.reference(j) - grains.reference(i), n) < 0.)
    std::swap(c.first, c.second);
  c.normal_x = n.x;
  c.normal_y = n.y;
  return c;
}

void set_stiffness(const SmoothJoint &law,
                   const double stiffness,
                   const double ratio,
                   SmoothContact &c)
{
  c.normal_stiffness = law.normal_stiffness > 0. ? law.normal_stiffness : stiffness;
  c.shear_stiffness = law.shear_stiffness > 0. ? law.shear_stiffness : stiffness / ratio;
}

double narrow(const Grains &grains, const SmoothContact &c)
{
  return 2. * std::min(grains.radius[c.first], grains.radius[c.second]);
}

struct Frame
{
  Vec2 normal, tangent, branch;
};
Frame frame(const Grains &grains, const SmoothContact &c)
{
  const double turn = 0.5 * (grains.rotation[c.first] + grains.rotation[c.second]);
  const Vec2 n = rotated({c.normal_x, c.normal_y}, turn);
  return {n, perpendicular(n), grains.position(c.second) - grains.position(c.first)};
}

double strain_energy(const SmoothContact &c)
{
  return 0.5 * c.area *
         (c.normal_stress * c.normal_stress / c.normal_stiffness +
          c.shear_stress * c.shear_stress / c.shear_stiffness);
}
} // namespace

SmoothJoints make_smooth_joints(const Grains &grains,
                                std::vector<Fracture> fractures,
                                const std::vector<CrossedPair> &pairs)
{
  SmoothJoints joints;
  joints.fractures = std::move(fractures);
  std::vector<double> width(joints.fractures.size(), 0.);
  for (const CrossedPair &pair : pairs)
  {
    const std::int32_t f =
        crossed_by(joints.fractures, grains.reference(pair.first),
                   grains.reference(pair.second));
    SmoothContact c = pair_across(grains, joints.fractures, f, pair.first, pair.second);
    const Frame at = frame(grains, c);
    c.distance = dot(at.branch, at.normal);
    c.origin = dot(at.branch, at.tangent);
    c.area = narrow(grains, c);
    const SmoothJoint &law = joints.fractures[f].law;
    set_stiffness(law, pair.stiffness, pair.ratio, c);
    c.bonded = law.bonded;
    width[f] += c.area;
    joints.contacts.push_back(c);
  }
  std::sort(joints.contacts.begin(), joints.contacts.end(), before);
  const std::vector<double> length = covered_length(grains, joints, width);
  for (std::size_t f = 0; f < width.size(); ++f)
    joints.area_ratio.push_back(width[f] > 0. ? length[f] / width[f] : 1.);
  for (SmoothContact &c : joints.contacts)
    c.area *= joints.area_ratio[c.fracture];
  return joints;
}

namespace
{
struct Stresses
{
  double normal, shear; ///< [Pa]
};

/// Which strength the bonded joint passes in this step, and passes first.
Bond break_mode(const SmoothJoint &law, const Stresses &old, const Stresses &now)
{
  const double tension = share_at_limit(old.normal, now.normal, law.tensile_strength);
  const double excess = std::abs(now.shear) + now.normal * law.tan_friction;
  const double shear =
      excess > law.cohesion
          ? share_at_limit(std::abs(old.shear) + old.normal * law.tan_friction, excess,
                           law.cohesion)
          : std::numeric_limits<double>::infinity();
  if (std::isinf(tension) && std::isinf(shear))
    return Bond::bonded;
  return tension <= shear ? Bond::broken_in_tension : Bond::broken_in_shear;
}

/// Coulomb friction and dilation of the unbonded joint; books what sliding dissipates.
void slide(const SmoothJoint &law, SmoothContact &c, const double old_shear_stress)
{
  const double elastic = c.normal_stiffness * (c.gap - c.dilation);
  if (elastic >= 0.)
  {
    // Open: the shear is given up as under a vanishing limit, and begins anew where it
    // closes.
    c.slip_energy +=
        0.5 * c.area * old_shear_stress * old_shear_stress / c.shear_stiffness;
    c.slip = c.shear;
    c.normal_stress = c.shear_stress = 0.;
    return;
  }
  c.normal_stress = elastic;
  c.shear_stress = c.shear_stiffness * (c.shear - c.slip);
  const double limit = -law.friction * elastic;
  const double excess = std::abs(c.shear_stress) - limit;
  if (excess <= 0.)
    return;
  const double increment = excess / c.shear_stiffness;
  const double opening = law.tan_dilation * increment;
  c.slip += std::copysign(increment, c.shear_stress);
  c.shear_stress = std::copysign(limit, c.shear_stress);
  c.dilation += opening;
  c.normal_stress = elastic - c.normal_stiffness * opening;
  // What opens the joint against its pressure is not dissipated.
  c.slip_energy += c.area * (0.5 * (std::abs(old_shear_stress) + limit) * increment +
                             0.5 * (elastic + c.normal_stress) * opening);
}

Crack make_crack(const Grains &grains,
                 const SmoothContact &c,
                 const Frame &f,
                 const Bond mode,
                 const StepTime &now)
{
  Crack crack;
  crack.step = now.step;
  crack.time = now.time;
  const double share =
      grains.radius[c.first] / (grains.radius[c.first] + grains.radius[c.second]);
  crack.place = grains.position(c.first) + share * f.branch;
  crack.reference_place =
      grains.reference(c.first) +
      share * (grains.reference(c.second) - grains.reference(c.first));
  crack.orientation = std::atan2(f.tangent.y, f.tangent.x);
  if (crack.orientation <= -0.5 * M_PI)
    crack.orientation += M_PI;
  else if (crack.orientation > 0.5 * M_PI)
    crack.orientation -= M_PI;
  crack.length = c.area;
  crack.mode = mode;
  crack.layer = grains.region[c.first];
  crack.joint = no_joint;
  crack.grain = c.first;
  return crack;
}

void evaluate(const Grains &grains,
              const SmoothJoint &law,
              const Frame &f,
              const StepTime &now,
              SmoothContact &c,
              std::vector<Crack> *cracks)
{
  const double old_gap = c.gap, old_shear = c.shear;
  const Stresses old{c.normal_stress, c.shear_stress};
  c.gap = dot(f.branch, f.normal) - c.distance;
  c.shear = dot(f.branch, f.tangent) - c.origin;
  if (!c.bonded)
  {
    slide(law, c, old.shear);
    return;
  }
  const Stresses whole{c.normal_stiffness * c.gap, c.shear_stiffness * c.shear};
  c.normal_stress = whole.normal;
  c.shear_stress = whole.shear;
  const Bond mode = cracks != nullptr ? break_mode(law, old, whole) : Bond::bonded;
  if (mode == Bond::bonded)
    return;
  const double before = strain_energy(c);
  c.bonded = false;
  cracks->push_back(make_crack(grains, c, f, mode, now));
  const double dissipated = c.slip_energy;
  slide(law, c, whole.shear);
  c.slip_energy = dissipated; // of the break's own step it all is fracture
  // The drop, less the work that the lost force did not do in the second half of the
  // step.
  c.fracture_energy += before - strain_energy(c) -
                       0.5 * c.area *
                           ((whole.normal - c.normal_stress) * (c.gap - old_gap) +
                            (whole.shear - c.shear_stress) * (c.shear - old_shear));
}

void add_force(Grains &grains, const SmoothContact &c, const Frame &f)
{
  const Vec2 force = -c.area * (c.normal_stress * f.normal + c.shear_stress * f.tangent);
  const double torque = -0.5 * c.area *
                        (c.normal_stress * dot(f.branch, f.tangent) -
                         c.shear_stress * dot(f.branch, f.normal));
  grains.force_x[c.second] += force.x;
  grains.force_y[c.second] += force.y;
  grains.force_x[c.first] -= force.x;
  grains.force_y[c.first] -= force.y;
  grains.torque[c.first] += torque;
  grains.torque[c.second] += torque;
}
} // namespace

void add_smooth_joint_forces(Grains &grains,
                             SmoothJoints &joints,
                             const StepTime &now,
                             std::vector<Crack> *cracks)
{
  for (SmoothContact &c : joints.contacts)
  {
    const Frame f = frame(grains, c);
    evaluate(grains, joints.fractures[c.fracture].law, f, now, c, cracks);
    add_force(grains, c, f);
  }
}

Vec2 force_on_second(const Grains &grains, const SmoothContact &c)
{
  const Frame f = frame(grains, c);
  return -c.area * (c.normal_stress * f.normal + c.shear_stress * f.tangent);
}

JointEnergies smooth_joint_energies(const SmoothJoints &joints)
{
  JointEnergies energies;
  energies.slip = joints.lost_slip;
  energies.fracture = joints.lost_fracture;
  for (const SmoothContact &c : joints.contacts)
  {
    energies.strain += strain_energy(c);
    energies.slip += c.slip_energy;
    energies.fracture += c.fracture_energy;
  }
  return energies;
}

std::vector<PairStiffness> pair_stiffness(const Grains &grains,
                                          const SmoothJoints &joints)
{
  std::vector<PairStiffness> pairs;
  for (const SmoothContact &c : joints.contacts)
  {
    // 1/2 A (k_n gap^2 + k_s shear^2) is at most that of an isotropic spring, in which
    // the mean rotation turns the whole branch.
    const double k = c.area * std::max(c.normal_stiffness, c.shear_stiffness);
    const double lever = 0.5 * norm(grains.position(c.second) - grains.position(c.first));
    pairs.push_back({c.first, c.second, k, k, 0., lever, lever});
  }
  return pairs;
}

SmoothJointSearch::SmoothJointSearch(const Grains &grains,
                                     SmoothJoints &joints,
                                     const double margin)
    : grains_(grains)
    , joints_(joints)
{
  const auto parted = [&](const SmoothContact &c)
  {
    const auto disk_gap = [&](const double distance)
    { return distance - grains.radius[c.first] - grains.radius[c.second]; };
    const double installed =
        disk_gap(std::sqrt(c.distance * c.distance + c.origin * c.origin));
    const double now =
        disk_gap(norm(grains.position(c.second) - grains.position(c.first)));
    return !c.bonded && now > std::max(0., installed) + margin;
  };
  std::vector<SmoothContact> kept;
  for (const SmoothContact &c : joints.contacts)
    if (parted(c))
    {
      joints.lost_slip += c.slip_energy;
      joints.lost_fracture += c.fracture_energy + strain_energy(c);
    }
    else
    {
      kept.push_back(c);
      held_.emplace_back(std::min(c.first, c.second), std::max(c.first, c.second));
    }
  joints.contacts = std::move(kept);
  std::sort(held_.begin(), held_.end());
}

bool SmoothJointSearch::takes(const std::int32_t i, const std::int32_t j)
{
  if (std::binary_search(held_.begin(), held_.end(),
                         std::make_pair(std::min(i, j), std::max(i, j))))
    return true;
  const std::int32_t f =
      crossed_by(joints_.fractures, grains_.reference(i), grains_.reference(j));
  if (f < 0)
    return false;
  const double distance = norm(grains_.position(j) - grains_.position(i));
  if (distance < grains_.radius[i] + grains_.radius[j])
  {
    SmoothContact c = pair_across(grains_, joints_.fractures, f, i, j);
    const Frame at = frame(grains_, c);
    c.distance = dot(at.branch, at.normal);
    c.origin = dot(at.branch, at.tangent);
    c.area = narrow(grains_, c) * joints_.area_ratio[f];
    set_stiffness(joints_.fractures[f].law,
                  joint_stiffness(grains_.radius[i], grains_.radius[j],
                                  joints_.modulus[grains_.region[i]],
                                  joints_.modulus[grains_.region[j]]),
                  joints_.stiffness_ratio, c);
    born_.push_back(c);
  }
  return true;
}

void SmoothJointSearch::finish()
{
  joints_.contacts.insert(joints_.contacts.end(), born_.begin(), born_.end());
  std::sort(joints_.contacts.begin(), joints_.contacts.end(), before);
}
} // namespace antiform::discrete

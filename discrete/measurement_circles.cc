#include "discrete/measurement_circles.h"

#include "discrete/packing_quality.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// The sums of the Love-Weber stress: minus force on the second end times branch.
class StressSum
{
public:
  explicit StressSum(const MeasurementCircle &circle)
      : circle_(circle)
  {
  }

  /// @p force acts at the end @p b of the line from @p a.
  void add(const Vec2 &a, const Vec2 &b, const Vec2 &force)
  {
    const double share = share_inside(a, b, circle_);
    if (share == 0.)
      return;
    const Vec2 inside = share * (b - a);
    sum_.xx -= force.x * inside.x;
    sum_.yy -= force.y * inside.y;
    sum_.xy -= 0.5 * (force.x * inside.y + force.y * inside.x);
  }

  PlaneTensor mean() const
  {
    const double area = M_PI * circle_.radius * circle_.radius;
    return {sum_.xx / area, sum_.yy / area, sum_.xy / area};
  }

private:
  MeasurementCircle circle_;
  PlaneTensor sum_;
};

/// Symmetric part of the gradient G of the field v = v0 + G (x - x0) that fits best.
class GradientFit
{
public:
  explicit GradientFit(const Vec2 &origin)
      : origin_(origin)
  {
  }

  void add(const Vec2 &place, const Vec2 &value)
  {
    const Vec2 x = place - origin_;
    n_ += 1.;
    x_ += x;
    v_ += value;
    xx_ += x.x * x.x;
    xy_ += x.x * x.y;
    yy_ += x.y * x.y;
    xvx_ += x.x * value;
    xvy_ += x.y * value;
  }

  /// Zero when the places lie on a line or are fewer than three.
  PlaneTensor symmetric_gradient() const
  {
    if (n_ < 3.)
      return {};
    const double cxx = xx_ - x_.x * x_.x / n_, cxy = xy_ - x_.x * x_.y / n_,
                 cyy = yy_ - x_.y * x_.y / n_;
    const double determinant = cxx * cyy - cxy * cxy;
    if (!(determinant > 1e-12 * cxx * cyy))
      return {};
    const Vec2 along_x = xvx_ - (x_.x / n_) * v_, along_y = xvy_ - (x_.y / n_) * v_;
    const Vec2 d_dx = (1. / determinant) * (cyy * along_x - cxy * along_y);
    const Vec2 d_dy = (1. / determinant) * (cxx * along_y - cxy * along_x);
    return {d_dx.x, d_dy.y, 0.5 * (d_dx.y + d_dy.x)};
  }

private:
  Vec2 origin_;
  double n_ = 0., xx_ = 0., xy_ = 0., yy_ = 0.;
  Vec2 x_, v_;
  Vec2 xvx_, xvy_; ///< sums of x times v, y times v
};

bool is_in(const Vec2 &point, const MeasurementCircle &circle)
{
  const Vec2 d = point - circle.centre;
  return dot(d, d) < circle.radius * circle.radius;
}

/// Part of the lens of grains @p i and @p j that lies in the circle.
double lens_inside(const Grains &grains,
                   const std::size_t i,
                   const std::size_t j,
                   const MeasurementCircle &circle)
{
  const Disk a{grains.position(i), grains.radius[i]},
      b{grains.position(j), grains.radius[j]};
  const double distance = norm(b.centre - a.centre);
  const double whole = lens_area(a.radius, b.radius, distance);
  if (whole == 0.)
    return 0.;
  const auto far_point = [&](const Disk &d)
  { return norm(d.centre - circle.centre) + d.radius; };
  if (std::min(far_point(a), far_point(b)) <= circle.radius)
    return whole;
  return common_area({a, b, {circle.centre, circle.radius}});
}
} // namespace

double share_inside(const Vec2 &a, const Vec2 &b, const MeasurementCircle &circle)
{
  const Vec2 d = b - a, from = a - circle.centre;
  // |from + s d|^2 = R^2
  const double dd = dot(d, d), half = dot(from, d),
               rest = dot(from, from) - circle.radius * circle.radius;
  if (dd == 0.)
    return rest < 0. ? 1. : 0.;
  const double square = half * half - dd * rest;
  if (square <= 0.)
    return 0.;
  const double root = std::sqrt(square);
  const double enters = std::max(0., (-half - root) / dd);
  const double leaves = std::min(1., (-half + root) / dd);
  return std::max(0., leaves - enters);
}

double common_area(const std::vector<Disk> &disks)
{
  // Green's theorem: half of the integral of x dy - y dx over the arcs that bound it.
  const Vec2 origin = disks[0].centre;
  double area = 0.;
  for (std::size_t k = 0; k < disks.size(); ++k)
  {
    const Vec2 c = disks[k].centre - origin;
    const double r = disks[k].radius;
    std::vector<double> cuts{0., 2. * M_PI};
    for (std::size_t m = 0; m < disks.size(); ++m)
    {
      if (m == k)
        continue;
      const Vec2 to = disks[m].centre - disks[k].centre;
      const double distance = norm(to), other = disks[m].radius;
      if (distance >= r + other || distance <= std::abs(r - other))
        continue;
      const double middle = std::atan2(to.y, to.x);
      const double half = std::acos(std::clamp(
          (distance * distance + r * r - other * other) / (2. * distance * r), -1., 1.));
      for (const double angle : {middle - half, middle + half})
        cuts.push_back(angle - 2. * M_PI * std::floor(angle / (2. * M_PI)));
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t n = 0; n + 1 < cuts.size(); ++n)
    {
      const double from = cuts[n], to = cuts[n + 1], middle = 0.5 * (from + to);
      const Vec2 point = disks[k].centre + r * Vec2{std::cos(middle), std::sin(middle)};
      bool bounds = to > from;
      for (std::size_t m = 0; m < disks.size() && bounds; ++m)
        bounds = m == k || norm(point - disks[m].centre) < disks[m].radius;
      if (bounds)
        area += 0.5 * r *
                (r * (to - from) + c.x * (std::sin(to) - std::sin(from)) -
                 c.y * (std::cos(to) - std::cos(from)));
    }
  }
  return area;
}

MeasurementCircle follow(const Grains &grains, const MeasurementCircle &reference)
{
  Vec2 sum;
  double n = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (is_in(grains.reference(i), reference))
    {
      sum += Vec2{grains.displacement_x[i], grains.displacement_y[i]};
      n += 1.;
    }
  if (n == 0.)
    return reference;
  return {reference.centre + (1. / n) * sum, reference.radius};
}

namespace
{
/// A joint that is not removed holds the pair.
bool is_jointed(const Joints *joints, const std::int32_t i, const std::int32_t j)
{
  if (joints == nullptr || joints->grain_begin.empty())
    return false;
  for (std::int32_t k = joints->grain_begin[i]; k < joints->grain_begin[i + 1]; ++k)
  {
    const std::int32_t joint = joints->grain_joint[k], damage = joints->damage[joint];
    if ((joints->first[joint] == j || joints->second[joint] == j) &&
        (damage < 0 || joints->damaged.removed[damage] == 0))
      return true;
  }
  return false;
}
} // namespace

CircleMeasure measure(const Grains &grains,
                      const ForceCarriers &carriers,
                      const MeasurementCircle &circle)
{
  CircleMeasure result;
  StressSum stress(circle);
  GradientFit strain(circle.centre), rate(circle.centre);
  double solid = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 place = grains.position(i);
    const double distance = norm(place - circle.centre);
    if (distance >= circle.radius + grains.radius[i])
      continue;
    solid += lens_area(grains.radius[i], circle.radius, distance);
    if (distance >= circle.radius)
      continue;
    ++result.grains;
    const Vec2 moved{grains.displacement_x[i], grains.displacement_y[i]};
    strain.add(grains.reference(i), moved);
    rate.add(place, grains.velocity(i));
  }

  std::size_t ends = 0; // of joints and contacts, at grains in the circle
  // @p again: the two are linked already
  const auto link = [&](const std::size_t i, const std::size_t j, const bool counts,
                        const bool again = false)
  {
    const Vec2 a = grains.position(i), b = grains.position(j);
    if (std::min(norm(a - circle.centre), norm(b - circle.centre)) >
        circle.radius + grains.radius[i] + grains.radius[j])
      return false;
    if (again)
      return true;
    if (counts)
      ends += (is_in(a, circle) ? 1 : 0) + (is_in(b, circle) ? 1 : 0);
    solid -= lens_inside(grains, i, j, circle);
    return true;
  };
  if (carriers.joints != nullptr)
  {
    const Joints &joints = *carriers.joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const std::size_t one = joints.first[j], two = joints.second[j];
      if (joints.damage[j] >= 0 && joints.damaged.removed[joints.damage[j]] != 0)
        continue;
      if (link(one, two, true) && !joints.force.empty())
        stress.add(grains.position(one), grains.position(two),
                   {joints.force[j].x, joints.force[j].y});
    }
  }
  if (carriers.contacts != nullptr)
    for (const Contact &contact : carriers.contacts->contacts)
    {
      const std::size_t one = contact.first, two = contact.second;
      if (!link(one, two, contact.normal_force > 0.,
                is_jointed(carriers.joints, contact.first, contact.second)) ||
          contact.normal_force == 0.)
        continue;
      const Vec2 a = grains.position(one), b = grains.position(two);
      const Vec2 n = (1. / norm(b - a)) * (b - a);
      stress.add(a, b, contact.normal_force * n - contact.shear_force * perpendicular(n));
    }
  if (carriers.smooth != nullptr)
    for (const SmoothContact &contact : carriers.smooth->contacts)
    {
      const std::size_t one = contact.first, two = contact.second;
      const bool acts = contact.bonded || contact.normal_stress < 0.;
      if (link(one, two, acts) && acts)
        stress.add(grains.position(one), grains.position(two),
                   force_on_second(grains, contact));
    }
  for (const std::vector<Wall> *walls : carriers.walls)
    for (const Wall &wall : *walls)
      for (const WallContact &contact : wall.contacts)
      {
        const Vec2 centre = grains.position(contact.grain);
        const double height = dot(centre - wall.point, wall.normal) - wall.displacement;
        stress.add(centre - height * wall.normal, centre,
                   wall_force(wall, contact, grains) * wall.normal);
      }

  result.stress = stress.mean();
  result.strain = strain.symmetric_gradient();
  result.strain_rate = rate.symmetric_gradient();
  result.porosity = 1. - solid / (M_PI * circle.radius * circle.radius);
  if (result.grains > 0)
    result.coordination_number =
        static_cast<double>(ends) / static_cast<double>(result.grains);
  return result;
}
} // namespace antiform::discrete

#include "discrete/packing_quality.h"

#include "discrete/floaters.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// Area between a chord and its arc: x = distance of the chord from the centre.
double segment_area(const double radius, const double x)
{
  return radius * radius * std::acos(x / radius) -
         x * std::sqrt(std::max(0., radius * radius - x * x));
}
} // namespace

double lens_area(const double radius_1, const double radius_2, const double distance)
{
  if (distance >= radius_1 + radius_2)
    return 0.;
  if (distance <= std::abs(radius_1 - radius_2))
    return M_PI * std::pow(std::min(radius_1, radius_2), 2);
  const double x =
      (distance * distance + radius_1 * radius_1 - radius_2 * radius_2) / (2. * distance);
  return segment_area(radius_1, x) + segment_area(radius_2, distance - x);
}

PackingQuality packing_quality(const std::vector<Disk> &disks,
                               const Confinement &confinement,
                               const double area,
                               const double gap)
{
  const ContactState contacts = Relaxation(disks, confinement).state();
  const double n = static_cast<double>(disks.size());
  double solid = 0., diameters = 0., smallest = disks[0].radius;
  for (const Disk &d : disks)
  {
    solid += M_PI * d.radius * d.radius;
    diameters += 2. * d.radius;
    smallest = std::min(smallest, d.radius);
  }
  double f11 = 0., f22 = 0.;
  const std::vector<DiskPair> bonds = disk_pairs(disks, confinement.period, gap);
  for (const DiskPair &p : bonds)
  {
    const Vec2 d = branch(disks, p);
    const double square = dot(d, d);
    f11 += d.x * d.x / square;
    f22 += d.y * d.y / square;
    solid -= lens_area(disks[p.first].radius, disks[p.second].radius, std::sqrt(square));
  }

  PackingQuality q;
  q.grains = disks.size();
  q.porosity = 1. - solid / area;
  q.coordination_number = 2. * static_cast<double>(bonds.size()) / n;
  q.touching_coordination = 2. * static_cast<double>(contacts.touching) / n;
  q.floaters = floaters(disks, confinement.period, gap).size();
  q.mean_overlap = contacts.mean_overlap / (diameters / n);
  q.largest_overlap = contacts.largest_overlap / smallest;
  q.fabric_anisotropy =
      bonds.empty() ? 0. : std::abs(f11 - f22) / static_cast<double>(bonds.size());
  q.unbalanced_ratio = contacts.unbalanced_ratio;
  return q;
}
} // namespace antiform::discrete

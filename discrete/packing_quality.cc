#include "discrete/packing_quality.h"

#include "discrete/floaters.h"
#include "discrete/measurement_circles.h"

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

double jammed_solid_area(const double area, const double perimeter)
{
  // Measured: solid fraction far from walls, and the void that a frictionless wall makes
  // along its length.
  return 0.845 * area - 0.08 * perimeter;
}

double stress_variation(const std::vector<Disk> &disks,
                        const std::vector<Vec2> &outline,
                        const double mean_diameter)
{
  constexpr double largest_circle = 5.;
  double perimeter = 0.;
  for (std::size_t k = 0; k < outline.size(); ++k)
    perimeter += norm(outline[(k + 1) % outline.size()] - outline[k]);
  const double mean_width = 2. * area(outline) / perimeter;
  const double radius = std::min(largest_circle, 0.4 * mean_width);
  const PolygonEdges edges(outline, radius);

  std::vector<Disk> scaled = disks;
  for (Disk &d : scaled)
    d = {(1. / mean_diameter) * d.centre, d.radius / mean_diameter};
  std::vector<MeasurementCircle> circles;
  for (const Disk &d : scaled)
    if (edges.depth(d.centre) >= radius &&
        std::all_of(circles.begin(), circles.end(),
                    [&](const MeasurementCircle &other)
                    { return norm(other.centre - d.centre) >= 2. * radius; }))
      circles.push_back({d.centre, radius});
  if (circles.size() < 3)
    return 0.;

  std::vector<double> pressure(circles.size(), 0.);
  for (const DiskPair &p : disk_pairs(scaled, {0., 0.}, 0.))
  {
    const Disk &a = scaled[p.first], &b = scaled[p.second];
    const double distance = norm(b.centre - a.centre),
                 overlap = std::max(0., a.radius + b.radius - distance);
    for (std::size_t k = 0; k < circles.size(); ++k)
      pressure[k] += overlap * distance * share_inside(a.centre, b.centre, circles[k]);
  }
  double mean = 0., square = 0.;
  const double n = static_cast<double>(pressure.size());
  for (const double p : pressure)
    mean += p / n;
  for (const double p : pressure)
    square += (p - mean) * (p - mean) / (n - 1.);
  return mean > 0. ? std::sqrt(square) / mean : 0.;
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

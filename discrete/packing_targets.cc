// What a packing is asked for beyond being dense: porosity, coordination number.
#include "discrete/disk_pairs.h"
#include "discrete/packing.h"
#include "discrete/packing_error.h"
#include "discrete/packing_quality.h"
#include "discrete/polygon_edges.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
namespace
{
constexpr double shrink_tolerance = 0.01;
constexpr double porosity_tolerance = 0.005;
constexpr double narrowest_gap = 0.02; // over the mean radius, while packing
constexpr double margin = 1.1;         // largest radius after the settling of floaters

/// Largest radius over mean diameter.
double settled_radius(const PackingParameters &p)
{
  return margin * p.radius_ratio / (1. + p.radius_ratio);
}

/// Installation gap ratio of the dense packing whose disks will shrink by @p shrink: what
/// two of the largest disks part by is allowed for.
double dense_gap_ratio(const PackingParameters &p, const double shrink)
{
  return p.installation_gap_ratio * shrink - 4. * (1. - shrink) * settled_radius(p);
}

/// Least factor of the radii for which neighbours stay bonded.
double least_shrink(const PackingParameters &p)
{
  return (narrowest_gap + 4. * settled_radius(p)) /
         (p.installation_gap_ratio + 4. * settled_radius(p));
}

double perimeter(const std::vector<Vec2> &polygon)
{
  double sum = 0.;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    sum += norm(polygon[(k + 1) % polygon.size()] - polygon[k]);
  return sum;
}

std::string number(const double x)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}
} // namespace

PorosityRange
porosity_range(const double area, const double perimeter, const PackingParameters &p)
{
  const double d = p.mean_diameter;
  const double solid = jammed_solid_area(area / (d * d), perimeter / d) * d * d / area;
  return {1. - solid, 1. - solid * std::pow(least_shrink(p), 2)};
}

/// Disks jam at one porosity, whatever one does without friction. A looser packing is a
/// jammed one of larger disks that all shrink about their centres: neighbours stay
/// neighbours, at gaps that the bonds bridge.
Packing pack_polygon(const std::vector<Vec2> &polygon,
                     const PackingParameters &parameters)
{
  if (parameters.porosity == 0.)
    return pack_jammed(polygon, parameters);
  const double region = std::abs(area(polygon)), rim = perimeter(polygon);
  const PorosityRange range = porosity_range(region, rim, parameters);
  double jammed = range.least, shrink = 1.;
  Packing packing;
  for (int trial = 0; trial < 3; ++trial)
  {
    // The larger disks see a narrower region: trial after trial takes that in.
    const double planned =
        std::min(1., std::sqrt((1. - parameters.porosity) / (1. - jammed)));
    PackingParameters dense = parameters;
    dense.porosity = 0.;
    dense.mean_diameter /= planned;
    dense.installation_gap_ratio = dense_gap_ratio(parameters, planned);
    if (dense.installation_gap_ratio < 0.5 * narrowest_gap)
      throw std::invalid_argument(
          "this packing reaches porosities of " + number(jammed) + " to " +
          number(1. - (1. - jammed) * std::pow(least_shrink(parameters), 2)) +
          "; looser, its grains would lose their bonds. Give one within, or a larger "
          "installation gap.");
    packing = pack_jammed(polygon, dense);
    jammed = packing.quality.porosity;
    shrink = std::sqrt((1. - parameters.porosity) / (1. - jammed));
    if (std::abs(std::min(1., shrink) / planned - 1.) < shrink_tolerance)
      break;
  }
  if (parameters.porosity < jammed - porosity_tolerance)
    throw std::invalid_argument(
        "the grains jam at a porosity of " + number(jammed) +
        "; denser, they would overlap. Give at least that, or 0.");
  const double variation = packing.quality.stress_variation;
  for (Disk &d : packing.disks)
    d.radius *= std::min(1., shrink);
  packing.quality =
      polygon_quality(packing.disks, polygon, parameters.mean_diameter,
                      0.5 * parameters.installation_gap_ratio * parameters.mean_diameter);
  packing.quality.stress_variation = variation;
  if (packing.quality.floaters > 0)
    throw PackingError("grains have fewer than three neighbours within the installation "
                       "gap; give less porosity or a larger installation gap: grains",
                       static_cast<double>(packing.quality.floaters), 0.);
  return packing;
}

double gap_for_coordination(const std::vector<Disk> &disks,
                            const double coordination_number,
                            const double mean_radius)
{
  constexpr double least = 0.01, most = 1.; // mean radii
  std::vector<double> gaps;
  for (const DiskPair &p : disk_pairs(disks, {0., 0.}, most * mean_radius))
    gaps.push_back(norm(branch(disks, p)) - disks[p.first].radius -
                   disks[p.second].radius);
  std::sort(gaps.begin(), gaps.end());
  const auto n = static_cast<double>(disks.size());
  const auto wanted =
      static_cast<std::size_t>(std::llround(0.5 * coordination_number * n));
  const auto at_least = static_cast<std::size_t>(
      std::upper_bound(gaps.begin(), gaps.end(), least * mean_radius) - gaps.begin());
  if (wanted < at_least || wanted >= gaps.size())
    throw std::invalid_argument(
        "this packing reaches coordination numbers of " +
        number(2. * static_cast<double>(at_least) / n) + " to " +
        number(2. * static_cast<double>(gaps.size()) / n) +
        " with installation gaps of 0.01 to 1 mean radii. Give one within.");
  // Between the last pair that is bonded and the first that is not.
  return std::max(least * mean_radius, 0.5 * (gaps[wanted - 1] + gaps[wanted]));
}

PackingQuality polygon_quality(const std::vector<Disk> &disks,
                               const std::vector<Vec2> &polygon,
                               const double mean_diameter,
                               const double gap)
{
  std::vector<Vec2> outline = polygon;
  if (area(outline) < 0.)
    std::reverse(outline.begin() + 1, outline.end());
  const Vec2 origin = outline[0];
  for (Vec2 &v : outline)
    v = (1. / mean_diameter) * (v - origin);
  std::vector<Disk> scaled = disks;
  for (Disk &d : scaled)
    d = {(1. / mean_diameter) * (d.centre - origin), d.radius / mean_diameter};
  const PolygonEdges edges(outline, 1.5);
  return packing_quality(scaled, {{0., 0.}, &edges}, area(outline), gap / mean_diameter);
}
} // namespace antiform::discrete

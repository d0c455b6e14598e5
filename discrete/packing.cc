#include "discrete/packing.h"
#include "discrete/packing_error.h"
#include "discrete/floaters.h"
#include "discrete/packing_quality.h"
#include "discrete/random.h"
#include "discrete/relaxation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace antiform::discrete
{
namespace
{
// Lengths are in mean diameters within this file.

// The cloud is compressed by this before it is let out to the target overlap: a packing
// that is approached from above is jammed all the way.
constexpr double first_compression = 0.02;
constexpr double coarse_tolerance = 1e-2;   // unbalanced ratio of the compressed cloud
constexpr double halfway = 5.;              // mean overlap over target
constexpr double approach_tolerance = 2e-3; // on the way to the target overlap
constexpr double search_tolerance = 1e-3;   // while radii are sought
constexpr double final_tolerance = 1e-6;
constexpr double parted = 0.05;            // mean overlap over target: not jammed
constexpr double overlap_tolerance = 0.03; // of the target overlap
// Gaps may change by this between the search and the final state.
constexpr double gap_margin = 0.01;
// The largest overlap is mostly six to eight times the mean one; where it exceeds this
// part of the smallest radius, its disks give way.
constexpr double largest_overlap = 0.0095;
constexpr double diameter_tolerance = 0.01; // of the mean diameter
constexpr double largest_radius = 1.;       // no radius ratio and growth gives more

/// Where disks may lie, in mean diameters.
struct Vessel
{
  Confinement confinement;
  double area;
  double perimeter;
  Vec2 low, high;                          ///< bounds
  std::function<bool(const Vec2 &)> holds; ///< may a centre be here?
};

void check(const PackingParameters &p)
{
  const auto refuse = [](const std::string &what)
  { throw std::invalid_argument("Packing: " + what); };
  if (!(p.mean_diameter > 0.))
    refuse("'mean diameter' is " + std::to_string(p.mean_diameter) + " m; give one > 0.");
  if (!(p.radius_ratio >= 1. && p.radius_ratio <= 3.))
    refuse("'radius ratio' (largest over smallest) is " + std::to_string(p.radius_ratio) +
           "; give one in [1, 3].");
  if (!(p.target_overlap > 0. && p.target_overlap <= 5e-4))
    refuse("'target overlap' (mean overlap over mean diameter) is " +
           std::to_string(p.target_overlap) + "; give one in (0, 0.0005].");
  // Contacts that carry no force are known to some digits only.
  if (!(p.installation_gap_ratio >= 0.01 && p.installation_gap_ratio <= 1.))
    refuse("'installation gap ratio' (gap over mean radius) is " +
           std::to_string(p.installation_gap_ratio) + "; give one in [0.01, 1].");
}

double mean_diameter(const std::vector<Disk> &disks)
{
  double sum = 0.;
  for (const Disk &d : disks)
    sum += 2. * d.radius;
  return sum / static_cast<double>(disks.size());
}

double smallest_radius(const std::vector<Disk> &disks)
{
  double smallest = disks[0].radius;
  for (const Disk &d : disks)
    smallest = std::min(smallest, d.radius);
  return smallest;
}

/// Centres of an even cover of the vessel (the additive sequence of the plastic number,
/// shifted and jittered at random): no region starts with more than its share, so that
/// the relaxation need not carry disks along a layer.
std::vector<Disk> cloud(const Vessel &vessel,
                        const std::size_t n,
                        const double ratio,
                        const std::uint64_t seed)
{
  constexpr double plastic = 1.32471795724474602596;
  Random place(seed, 1), size(seed, 2);
  const Vec2 start = {place.uniform(), place.uniform()};
  const Vec2 extent = vessel.high - vessel.low;
  std::vector<Disk> disks;
  const double smallest = 1. / (1. + ratio);
  for (double k = 0.; disks.size() < n; ++k)
  {
    const double a = start.x + k / plastic, b = start.y + k / (plastic * plastic);
    const Vec2 even =
        vessel.low + Vec2{extent.x * (a - std::floor(a)), extent.y * (b - std::floor(b))};
    if (!vessel.holds(even))
      continue;
    const Vec2 jittered = even + Vec2{place.uniform() - 0.5, place.uniform() - 0.5};
    disks.push_back({vessel.holds(jittered) ? jittered : even,
                     smallest * (1. + (ratio - 1.) * size.uniform())});
  }
  // Neighbours in space are neighbours in memory, here and in all that uses the grains:
  // strips of two diameters across the longer side, swept along the shorter.
  const bool along_x = extent.x >= extent.y;
  const auto place_in_order = [&](const Disk &d)
  {
    const Vec2 c = along_x ? d.centre : Vec2{d.centre.y, d.centre.x};
    return std::make_pair(std::floor(0.5 * c.x), c.y);
  };
  std::sort(disks.begin(), disks.end(),
            [&](const Disk &a, const Disk &b)
            { return place_in_order(a) < place_in_order(b); });
  return disks;
}

double overlap_ratio(const Relaxation &relaxation, const ContactState &state)
{
  return state.mean_overlap / mean_diameter(relaxation.disks());
}

/// Scale all radii until the mean overlap is the target, with the disks nearly at rest.
void install_overlap(Relaxation &relaxation, const double target)
{
  double slope = 0.5; // of mean overlap over relative change of the radii
  double previous = 0., change = 0., aim = target;
  for (int trial = 0; trial < 100; ++trial)
  {
    const double tolerance = aim > 1.5 * target ? approach_tolerance : search_tolerance;
    const double overlap =
        overlap_ratio(relaxation, relaxation.relax(tolerance, parted * target));
    if (std::abs(overlap / target - 1.) < overlap_tolerance)
      return;
    // A secant whose slope is trusted within limits: contacts open and close on the way.
    if (change != 0. && (overlap - previous) / change > 0.2)
      slope = std::min((overlap - previous) / change, 1.5);
    // Let out by steps of two thirds, not at once: the last contacts must not be lost.
    aim = std::max(target, overlap / 3.);
    change = (aim - overlap) / slope;
    previous = overlap;
    relaxation.scale(1. + change);
  }
  throw PackingError("the wanted overlap is not found; give another seed", previous,
                     target);
}

/// Settle floaters, pass by pass, until there is none; @p rest brings the packing to rest
/// after each.
template <class Rest>
void remove_floaters(Relaxation &relaxation,
                     std::vector<double> &growth,
                     const double gap,
                     const Rest &rest)
{
  for (int pass = 0; pass < 200; ++pass)
  {
    std::vector<Disk> disks = relaxation.disks();
    const FloaterChange change =
        settle_floaters(disks, growth, relaxation.confinement(), gap);
    if (change.grown + change.swollen + change.deleted == 0)
      return;
    if (disks.empty())
      throw PackingError(
          "no grain of the region has three neighbours within the installation gap; give "
          "smaller grains or a larger installation gap: grains left",
          0., 1.);
    relaxation.replace(std::move(disks));
    rest();
  }
  throw PackingError(
      "floaters keep appearing; give another seed or a larger "
      "installation gap",
      static_cast<double>(
          floaters(relaxation.disks(), relaxation.confinement().period, gap).size()),
      0.);
}

/// Shrink the disks that overlap another one or an edge too much, by half of the overlap
/// in all. Such contacts belong to a few disks that are wedged on their own: less
/// pressure everywhere would not relieve them. Returns whether there were any.
bool ease_overlaps(Relaxation &relaxation)
{
  std::vector<Disk> disks = relaxation.disks();
  const Confinement &confinement = relaxation.confinement();
  const double limit = largest_overlap * smallest_radius(disks);
  bool eased = false;
  for (const DiskPair &p : disk_pairs(disks, confinement.period, 0.))
  {
    const double overlap =
        disks[p.first].radius + disks[p.second].radius - norm(branch(disks, p));
    if (overlap > limit)
    {
      disks[p.first].radius -= 0.25 * overlap;
      disks[p.second].radius -= 0.25 * overlap;
      eased = true;
    }
  }
  if (confinement.edges != nullptr)
    for (Disk &d : disks)
    {
      const double overlap = d.radius - confinement.edges->depth(d.centre);
      if (overlap > limit)
      {
        d.radius -= 0.5 * overlap;
        eased = true;
      }
    }
  if (eased)
    relaxation.replace(std::move(disks));
  return eased;
}

std::vector<Disk>
jammed(const Vessel &vessel, const std::size_t n, const PackingParameters &p)
{
  Relaxation relaxation(cloud(vessel, n, p.radius_ratio, p.seed), vessel.confinement);
  relaxation.scale(1. + first_compression);
  relaxation.relax(coarse_tolerance, parted * p.target_overlap);
  // While the packing is compressed, contacts are many: a swelling or lost grain disturbs
  // its neighbours only. So most floaters are settled before the last contacts open; the
  // gaps that will open until then are allowed for.
  std::vector<double> growth(n, 1.);
  const double gap = 0.5 * p.installation_gap_ratio;
  const auto settle = [&](const double opening, const double tolerance)
  {
    remove_floaters(relaxation, growth, std::max(0.5 * gap, gap - opening),
                    [&] { relaxation.relax(tolerance, parted * p.target_overlap); });
  };
  settle(2. * first_compression, coarse_tolerance);
  install_overlap(relaxation, halfway * p.target_overlap);
  settle(first_compression, approach_tolerance);

  const double target = p.target_overlap;
  const auto install = [&] { install_overlap(relaxation, target); };
  for (int pass = 0; pass < 50; ++pass)
  {
    install();
    remove_floaters(relaxation, growth, std::max(0.8 * gap, gap - gap_margin), install);
    if (ease_overlaps(relaxation))
      continue;
    const double overlap =
        overlap_ratio(relaxation, relaxation.relax(final_tolerance, parted * target));
    if (std::abs(overlap / target - 1.) < 2. * overlap_tolerance &&
        floaters(relaxation.disks(), vessel.confinement.period, gap).empty() &&
        !ease_overlaps(relaxation))
      return relaxation.disks();
  }
  throw PackingError("no state of rest without floaters and large overlaps is found; "
                     "give another seed",
                     relaxation.state().unbalanced_ratio, final_tolerance);
}

/// Pack with the number of disks that gives the mean diameter asked for.
std::vector<Disk> pack(const Vessel &vessel, const PackingParameters &p)
{
  const double smallest = 1. / (1. + p.radius_ratio);
  const double mean_square =
      smallest * smallest * (1. + p.radius_ratio + p.radius_ratio * p.radius_ratio) / 3.;
  double wanted = jammed_solid_area(vessel.area, vessel.perimeter) / (M_PI * mean_square);
  std::vector<Disk> best;
  double best_error = 0.;
  for (int trial = 0; trial < 4; ++trial)
  {
    const auto n = static_cast<std::size_t>(std::max(1., std::round(wanted)));
    std::vector<Disk> disks = jammed(vessel, n, p);
    const double diameter = mean_diameter(disks);
    const double error = std::abs(diameter - 1.);
    if (best.empty() || error < best_error)
    {
      best = std::move(disks);
      best_error = error;
    }
    if (error < diameter_tolerance)
      break;
    wanted = static_cast<double>(n) * diameter * diameter;
    if (static_cast<std::size_t>(std::max(1., std::round(wanted))) == n)
      break;
  }
  return best;
}

/// To metres, and the figures.
PackingQuality
finish(std::vector<Disk> &disks, const Vessel &vessel, const PackingParameters &p)
{
  PackingQuality quality = packing_quality(disks, vessel.confinement, vessel.area,
                                           0.5 * p.installation_gap_ratio);
  for (Disk &d : disks)
    d = {p.mean_diameter * d.centre, p.mean_diameter * d.radius};
  return quality;
}
} // namespace

Packing pack_jammed(const std::vector<Vec2> &polygon, const PackingParameters &parameters)
{
  check(parameters);
  if (!is_simple(polygon))
    throw std::invalid_argument(
        "Packing: the polygon of the grain region is not simple (" +
        std::to_string(polygon.size()) +
        " vertices): edges cross, or a vertex occurs twice.");
  std::vector<Vec2> outline = polygon;
  if (area(outline) < 0.)
    std::reverse(outline.begin() + 1, outline.end());
  // About the first vertex: far from the origin the overlaps would lose digits.
  const Vec2 origin = outline[0];
  Vec2 low, high;
  for (Vec2 &v : outline)
  {
    v = (1. / parameters.mean_diameter) * (v - origin);
    low = {std::min(low.x, v.x), std::min(low.y, v.y)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y)};
  }
  const PolygonEdges edges(outline, 1.5 * largest_radius);
  const Vessel vessel = {{{0., 0.}, &edges},
                         area(outline),
                         edges.perimeter(),
                         low,
                         high,
                         [&](const Vec2 &v) { return contains(outline, v); }};
  // The mean width of a strip is twice its area over its perimeter.
  if (2. * vessel.area < vessel.perimeter)
    throw std::invalid_argument(
        "Packing: the grain region is " +
        std::to_string(2. * vessel.area / vessel.perimeter * parameters.mean_diameter) +
        " m wide in the mean, less than one grain diameter of " +
        std::to_string(parameters.mean_diameter) + " m; give smaller grains.");

  Packing packing;
  packing.disks = pack(vessel, parameters);
  for (const Disk &d : packing.disks)
    if (!contains(outline, d.centre) ||
        edges.depth(d.centre) < 0.99 * std::min(d.radius, 1.))
      throw PackingError("a grain does not fit between the edges of its region; give "
                         "smaller grains",
                         edges.depth(d.centre), d.radius);
  packing.quality = finish(packing.disks, vessel, parameters);
  packing.quality.stress_variation =
      stress_variation(packing.disks, outline, parameters.mean_diameter);
  for (Disk &d : packing.disks)
    d.centre += origin;
  return packing;
}

PeriodicTile pack_periodic(const Vec2 &size, const PackingParameters &parameters)
{
  check(parameters);
  const Vec2 period = (1. / parameters.mean_diameter) * size;
  if (!(period.x >= 4. && period.y >= 4.))
    throw std::invalid_argument(
        "Packing: the periodic tile of " + std::to_string(size.x) + " m x " +
        std::to_string(size.y) + " m is less than 4 grain diameters of " +
        std::to_string(parameters.mean_diameter) + " m wide.");
  const Vessel vessel = {
      {period, nullptr}, period.x * period.y, 0., {0., 0.}, period, [&](const Vec2 &v) {
        return v.x >= 0. && v.y >= 0. && v.x < period.x && v.y < period.y;
      }};
  PeriodicTile tile;
  tile.size = size;
  tile.disks = pack(vessel, parameters);
  tile.quality = finish(tile.disks, vessel, parameters);
  for (Disk &d : tile.disks)
  {
    d.centre.x -= size.x * std::floor(d.centre.x / size.x);
    d.centre.y -= size.y * std::floor(d.centre.y / size.y);
    // Rounding puts a tiny negative coordinate on the far side itself.
    if (d.centre.x >= size.x)
      d.centre.x = 0.;
    if (d.centre.y >= size.y)
      d.centre.y = 0.;
  }
  return tile;
}
} // namespace antiform::discrete

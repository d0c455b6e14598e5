#include "discrete/floaters.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace antiform::discrete
{
namespace
{
constexpr double largest_growth = 1.5;
// A floater is moved at most this far (in mean diameters): it stays in its void.
constexpr double longest_move = 0.5;
// Neighbours of a floater that it or another moved floater can come to touch.
constexpr double neighbourhood = 2.;
// A grown floater stays short of touching by this: it carries no force yet.
constexpr double clearance = 1e-9;

// A floater that cannot be given a place of its own swells where it is, by at least and
// at most this factor a pass; the relaxation that follows makes room.
constexpr double least_swelling = 1.02;
constexpr double most_swelling = 1.1;

/// Neighbours of one disk, moved to the image that is next to it.
std::vector<std::vector<std::pair<std::int32_t, Vec2>>>
neighbour_lists(const std::vector<Disk> &disks,
                const std::vector<std::int32_t> &of,
                const Vec2 &period)
{
  std::vector<std::int32_t> slot(disks.size(), -1);
  for (std::size_t k = 0; k < of.size(); ++k)
    slot[of[k]] = static_cast<std::int32_t>(k);
  std::vector<std::vector<std::pair<std::int32_t, Vec2>>> lists(of.size());
  for (const DiskPair &p : disk_pairs(disks, period, neighbourhood))
  {
    if (slot[p.first] >= 0)
      lists[slot[p.first]].emplace_back(p.second, p.shift);
    if (slot[p.second] >= 0)
      lists[slot[p.second]].emplace_back(p.first, -p.shift);
  }
  return lists;
}

bool fits(const Disk &disk,
          const std::vector<Disk> &around,
          const Confinement &confinement)
{
  for (const Disk &other : around)
    if (norm(other.centre - disk.centre) < disk.radius + other.radius - clearance)
      return false;
  return confinement.edges == nullptr ||
         confinement.edges->depth(disk.centre) >= disk.radius - clearance;
}

/// The smallest disk that touches three of @p around, is no smaller than @p disk and at
/// most @p limit in radius, and fits. Its radius is 0 when there is none.
Disk grown(const Disk &disk,
           const double limit,
           const std::vector<Disk> &around,
           const Confinement &confinement)
{
  std::vector<Disk> near;
  for (const Disk &other : around)
    if (norm(other.centre - disk.centre) - other.radius < limit + longest_move)
      near.push_back(other);
  Disk best{{0., 0.}, 0.};
  for (std::size_t a = 0; a < near.size(); ++a)
    for (std::size_t b = a + 1; b < near.size(); ++b)
      for (std::size_t c = b + 1; c < near.size(); ++c)
        for (const Disk &candidate : tangent_circles(near[a], near[b], near[c]))
          if (candidate.radius >= disk.radius && candidate.radius <= limit &&
              (best.radius == 0. || candidate.radius < best.radius) &&
              norm(candidate.centre - disk.centre) <= longest_move &&
              fits(candidate, around, confinement))
            best = candidate;
  return best;
}

/// Factor by which @p disk must swell for a third neighbour to be within @p gap, a pass's
/// share of it.
double swelling(const Disk &disk, const std::vector<Disk> &around, const double gap)
{
  if (around.size() < 3)
    return most_swelling;
  std::vector<double> gaps;
  for (const Disk &other : around)
    gaps.push_back(norm(other.centre - disk.centre) - disk.radius - other.radius);
  std::nth_element(gaps.begin(), gaps.begin() + 2, gaps.end());
  const double wanted = least_swelling + std::max(0., gaps[2] - gap) / disk.radius;
  return std::min(wanted, most_swelling);
}
} // namespace

std::vector<Disk> tangent_circles(const Disk &a, const Disk &b, const Disk &c)
{
  // |x - x_k| = r + r_k. The differences to the first equation are linear in x and r:
  // x = x_a + u + r v; put into the first, they leave a quadratic in r.
  const Vec2 p = b.centre - a.centre, q = c.centre - a.centre;
  const double determinant = cross(p, q);
  if (std::abs(determinant) < 1e-12)
    return {};
  const auto solve = [&](const double e, const double f) {
    return Vec2{(e * q.y - f * p.y) / determinant, (f * p.x - e * q.x) / determinant};
  };
  const double ra = a.radius, rb = b.radius, rc = c.radius;
  const Vec2 u =
      solve(0.5 * (dot(p, p) + ra * ra - rb * rb), 0.5 * (dot(q, q) + ra * ra - rc * rc));
  const Vec2 v = solve(ra - rb, ra - rc);
  const double k2 = dot(v, v) - 1., k1 = dot(u, v) - ra, k0 = dot(u, u) - ra * ra;
  std::vector<double> roots;
  if (std::abs(k2) < 1e-12)
    roots = {-0.5 * k0 / k1};
  else if (k1 * k1 - k2 * k0 >= 0.)
  {
    const double root = std::sqrt(k1 * k1 - k2 * k0);
    roots = {(-k1 - root) / k2, (-k1 + root) / k2};
  }
  std::vector<Disk> circles;
  for (const double r : roots)
    if (r > 0. && r + ra > 0. && r + rb > 0. && r + rc > 0.)
      circles.push_back({a.centre + u + r * v, r});
  return circles;
}

std::vector<std::int32_t>
floaters(const std::vector<Disk> &disks, const Vec2 &period, const double gap)
{
  const std::vector<int> count = pair_count(disks.size(), disk_pairs(disks, period, gap));
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < disks.size(); ++i)
    if (count[i] < 3)
      found.push_back(static_cast<std::int32_t>(i));
  return found;
}

FloaterChange settle_floaters(std::vector<Disk> &disks,
                              std::vector<double> &growth,
                              const Confinement &confinement,
                              const double gap)
{
  const std::vector<std::int32_t> floating = floaters(disks, confinement.period, gap);
  const auto lists = neighbour_lists(disks, floating, confinement.period);
  std::vector<bool> deleted(disks.size(), false);
  FloaterChange change;
  std::vector<Disk> around;
  for (std::size_t k = 0; k < floating.size(); ++k)
  {
    const std::int32_t i = floating[k];
    around.clear();
    for (const auto &[j, shift] : lists[k])
      if (!deleted[j])
        around.push_back({disks[j].centre + shift, disks[j].radius});
    const double limit = disks[i].radius * largest_growth / growth[i];
    const Disk better = grown(disks[i], limit, around, confinement);
    const double factor = swelling(disks[i], around, gap);
    if (better.radius > 0.)
    {
      growth[i] *= better.radius / disks[i].radius;
      disks[i] = {better.centre, better.radius - clearance};
      ++change.grown;
    }
    else if (growth[i] * factor <= largest_growth)
    {
      growth[i] *= factor;
      disks[i].radius *= factor;
      ++change.swollen;
    }
    else
    {
      deleted[i] = true;
      ++change.deleted;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < disks.size(); ++i)
    if (!deleted[i])
    {
      disks[kept] = disks[i];
      growth[kept++] = growth[i];
    }
  disks.resize(kept);
  growth.resize(kept);
  return change;
}
} // namespace antiform::discrete

#include "cases/fracture_pattern.h"

#include "cases/grain_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace antiform::cases
{
using discrete::Crack;

namespace
{
constexpr double joined = 1.5; ///< reach from crack to crack over the mean diameter
constexpr double trunk = 0.2;  ///< least extent of a fracture over the thickness

bool is_of_layer_in_tension(const Crack &crack)
{
  return is_layer(crack.layer) && crack.mode == discrete::Bond::broken_in_tension;
}

/// Which group each point belongs to, those within @p reach of each other joined.
std::vector<std::size_t> group_points(const std::vector<Vec2> &points, const double reach)
{
  std::vector<std::size_t> parent(points.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::pair<long, long>, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const long x = std::lround(std::floor(points[i].x / reach)),
               y = std::lround(std::floor(points[i].y / reach));
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        if (const auto near = cells.find({x + dx, y + dy}); near != cells.end())
          for (const std::size_t j : near->second)
            if (norm(points[i] - points[j]) <= reach)
              parent[root(i)] = root(j);
    cells[{x, y}].push_back(i);
  }
  std::vector<std::size_t> group(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    group[i] = root(i);
  return group;
}

double mean_spacing(const std::vector<double> &places)
{
  return (places.back() - places.front()) / (static_cast<double>(places.size()) - 1.);
}
} // namespace

std::vector<double> fracture_places(const std::vector<Crack> &cracks,
                                    const double diameter,
                                    const double thickness)
{
  std::vector<Vec2> points;
  for (const Crack &crack : cracks)
    if (is_of_layer_in_tension(crack))
      points.push_back(crack.reference_place);
  const std::vector<std::size_t> group = group_points(points, joined * diameter);

  struct Extent
  {
    Vec2 least{HUGE_VAL, HUGE_VAL}, greatest{-HUGE_VAL, -HUGE_VAL};
    double sum_x = 0., n = 0.;
  };
  std::map<std::size_t, Extent> extents;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    Extent &e = extents[group[i]];
    e.least = {std::min(e.least.x, points[i].x), std::min(e.least.y, points[i].y)};
    e.greatest = {std::max(e.greatest.x, points[i].x),
                  std::max(e.greatest.y, points[i].y)};
    e.sum_x += points[i].x;
    e.n += 1.;
  }
  std::vector<double> places;
  for (const auto &[number, e] : extents)
    if (norm(e.greatest - e.least) + diameter >= trunk * thickness)
      places.push_back(e.sum_x / e.n);
  std::sort(places.begin(), places.end());
  return places;
}

double share_across(const std::vector<Crack> &cracks, const SectionGeometry &geometry)
{
  double across = 0., all = 0.;
  const double half = 0.5 * geometry.diameter();
  for (const Crack &crack : cracks)
  {
    if (!is_of_layer_in_tension(crack))
      continue;
    const double x = crack.reference_place.x;
    const double dip =
        std::atan((geometry.axis(x + half) - geometry.axis(x - half)) / (2. * half));
    all += crack.length;
    if (std::abs(std::sin(crack.orientation - dip)) > M_SQRT1_2)
      across += crack.length;
  }
  return all > 0. ? across / all : 0.;
}

FoldMechanism mechanism_of(const double growth)
{
  if (growth < 2.)
    return FoldMechanism::crushes;
  return growth < 10. ? FoldMechanism::folds_and_cracks : FoldMechanism::buckles;
}

void report_fold(const std::vector<Crack> &cracks,
                 const SectionGeometry &geometry,
                 const FoldAtPeak &peak,
                 Summary &summary)
{
  auto &results = summary.results;
  const std::vector<double> places =
      fracture_places(cracks, geometry.diameter(), geometry.thickness());
  results["tension_fractures"] = {static_cast<double>(places.size()), "-"};
  if (places.size() > 1)
    results["crack_spacing"] = {mean_spacing(places), "m"};
  if (!cracks.empty())
    results["cracks_across_share"] = {share_across(cracks, geometry), "-"};
  results["cracks_tensile_at_peak"] = {peak.n_tensile, "-"};
  results["cracks_shear_at_peak"] = {peak.n_shear, "-"};
  if (!(geometry.amplitude() > 0.))
    return;
  const double growth = peak.amplitude / geometry.amplitude();
  results["fold_amplitude_at_peak"] = {peak.amplitude, "m"};
  results["limb_dip_at_peak"] = {peak.limb_dip, "deg"};
  results["fold_growth_at_peak"] = {growth, "-"};
  results["mechanism"] = {static_cast<double>(mechanism_of(growth)), "-"};
}
} // namespace antiform::cases

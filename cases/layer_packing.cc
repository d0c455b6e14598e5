#include "cases/layer_packing.h"

#include "cases/declarations.h"
#include "cases/packing_cache.h"

#include <cstdio>
#include <functional>
#include <stdexcept>

namespace antiform::cases
{
using namespace discrete;

namespace
{
std::vector<double *> figures(PackingQuality &q)
{
  return {&q.porosity,         &q.coordination_number, &q.touching_coordination,
          &q.mean_overlap,     &q.largest_overlap,     &q.fabric_anisotropy,
          &q.stress_variation, &q.unbalanced_ratio};
}

/// Everything that decides about the disks, as text.
std::string key_of(const PackingParameters &p,
                   const std::vector<Vec2> &region,
                   const std::string &what)
{
  std::string key = what + " " + std::to_string(packing_version);
  for (const double number : {p.mean_diameter, p.radius_ratio, p.target_overlap,
                              p.installation_gap_ratio, p.porosity})
    key += " " + exact_text(number);
  key += " " + std::to_string(p.seed);
  for (const Vec2 &v : region)
    key += " " + exact_text(v.x) + " " + exact_text(v.y);
  return key;
}

/// Disks and quality as they were kept, or as @p make gives them.
Packing kept_or_made(const std::string &key,
                     const std::function<Packing()> &make,
                     const Progress &progress)
{
  const PackingCache cache(PackingCache::default_directory());
  constexpr std::size_t n_figures = 9;
  std::string complaint;
  const std::optional<std::vector<double>> kept = cache.find(key, complaint);
  if (!complaint.empty())
    progress(complaint);
  Packing packing;
  PackingQuality &q = packing.quality;
  if (kept && kept->size() > n_figures && (kept->size() - n_figures) % 3 == 0)
  {
    std::size_t k = 0;
    for (double *figure : figures(q))
      *figure = (*kept)[k++];
    q.floaters = static_cast<std::size_t>((*kept)[k++]);
    for (; k < kept->size(); k += 3)
      packing.disks.push_back({{(*kept)[k], (*kept)[k + 1]}, (*kept)[k + 2]});
    q.grains = packing.disks.size();
    progress("packing of " + std::to_string(q.grains) + " grains taken from '" +
             cache.file(key) + "'");
    return packing;
  }
  packing = make();
  std::vector<double> numbers;
  for (const double *figure : figures(q))
    numbers.push_back(*figure);
  numbers.push_back(static_cast<double>(q.floaters));
  for (const Disk &d : packing.disks)
    numbers.insert(numbers.end(), {d.centre.x, d.centre.y, d.radius});
  cache.store(key, numbers);
  return packing;
}

/// Pack with @p p; what the packing refuses is a problem of the deck's @p entry.
Packing pack(const PackingParameters &p,
             const std::vector<Vec2> &outline,
             const Progress &progress)
{
  try
  {
    return kept_or_made(
        key_of(p, outline, "polygon"), [&] { return pack_polygon(outline, p); },
        progress);
  }
  catch (const std::invalid_argument &error)
  {
    if (p.porosity == 0.)
      throw;
    throw InputError(
        {"'Layer/Porosity' is " + exact_text(p.porosity) + ": " + error.what()});
  }
}
} // namespace

PackingParameters packing_parameters(const Parameters &p, const int seed)
{
  PackingParameters packing;
  packing.mean_diameter = p.grain_diameter();
  packing.radius_ratio = p.layer.radius_ratio;
  packing.installation_gap_ratio = p.layer.installation_gap;
  packing.seed = static_cast<std::uint64_t>(seed);
  return packing;
}

LayerPacking make_layer_packing(const Parameters &p,
                                const SectionGeometry &geometry,
                                const Progress &progress)
{
  const std::vector<Vec2> outline = geometry.layer_outline();
  const double mean_radius = 0.5 * p.grain_diameter();
  PackingParameters wanted = packing_parameters(p, p.layer.seed);
  wanted.porosity = p.layer.porosity;
  LayerPacking layer;
  layer.packing = pack(wanted, outline, progress);
  layer.installation_gap = p.layer.installation_gap * mean_radius;
  if (p.layer.coordination_number == 0.)
    return layer;
  // A gap less than the one that floaters were settled by may make floaters anew: then
  // the packing is made for that gap.
  for (int trial = 0; trial < 3; ++trial)
  {
    try
    {
      layer.installation_gap = gap_for_coordination(
          layer.packing.disks, p.layer.coordination_number, mean_radius);
    }
    catch (const std::invalid_argument &error)
    {
      throw InputError({"'Layer/Coordination number' is " +
                        exact_text(p.layer.coordination_number) + ": " + error.what()});
    }
    const double variation = layer.packing.quality.stress_variation;
    layer.packing.quality = polygon_quality(layer.packing.disks, outline,
                                            p.grain_diameter(), layer.installation_gap);
    layer.packing.quality.stress_variation = variation;
    if (layer.packing.quality.floaters == 0 || trial == 2)
      break;
    wanted.installation_gap_ratio = layer.installation_gap / mean_radius;
    layer.packing = pack(wanted, outline, progress);
  }
  return layer;
}

void report_packing(const PackingQuality &quality, std::map<std::string, Result> &results)
{
  results["porosity"] = {quality.porosity, "-"};
  results["coordination_number"] = {quality.coordination_number, "-"};
  results["floaters"] = {static_cast<double>(quality.floaters), "-"};
  results["fabric_anisotropy"] = {quality.fabric_anisotropy, "-"};
  results["largest_overlap"] = {quality.largest_overlap, "-"};
  if (quality.stress_variation > 0.)
    results["packing_stress_variation"] = {quality.stress_variation, "-"};
}

std::string packing_text(const PackingQuality &q)
{
  char text[240];
  std::snprintf(text, sizeof text,
                "porosity %.4f, coordination number %.3f, %zu floaters, fabric "
                "anisotropy %.3f, stress variation %.3f, largest overlap %.4f of the "
                "smallest radius",
                q.porosity, q.coordination_number, q.floaters, q.fabric_anisotropy,
                q.stress_variation, q.largest_overlap);
  return text;
}

PeriodicTile make_tile(const Parameters &p, const Progress &progress)
{
  const PackingParameters parameters = packing_parameters(p, p.layer.seed + 1000);
  const double side = p.matrix.tile_size * p.grain_diameter();
  PeriodicTile tile;
  tile.size = {side, side};
  const Packing packing = kept_or_made(
      key_of(parameters, {tile.size}, "tile"),
      [&]
      {
        const PeriodicTile made = pack_periodic(tile.size, parameters);
        return Packing{made.disks, made.quality};
      },
      progress);
  tile.disks = packing.disks;
  tile.quality = packing.quality;
  return tile;
}
} // namespace antiform::cases

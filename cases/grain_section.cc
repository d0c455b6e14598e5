#include "cases/grain_section.h"

#include "cases/beds.h"
#include "cases/fracture_list.h"
#include "cases/layer_packing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace antiform::cases
{
using namespace discrete;

namespace
{
FlatJoint matrix_law(const Parameters &p)
{
  FlatJoint law;
  law.stiffness_ratio = p.layer.joint.stiffness_ratio;
  law.n_elements = p.layer.joint.n_elements;
  law.radius_multiplier = p.layer.joint.radius_multiplier;
  law.element_moment = p.layer.joint.element_moment;
  law.tensile_strength = p.matrix.tensile_strength;
  law.cohesion = p.matrix.cohesion;
  law.tan_friction = p.matrix.tan_friction;
  law.residual_friction = p.matrix.residual_friction;
  law.breakable = p.matrix.breakable;
  return law;
}

/// Disks of layer and matrix before they get their numbers.
struct Placed
{
  Disk disk;
  int region;
  int tile_grain; ///< -1: not a copy
};

/// Copies of the tile in the matrix. A copy whose centre lies in the layer, or that would
/// cover a layer grain by more than 0.3 of the sum of radii, is left out: the cut is by
/// centres, which keeps the density at the rims.
std::vector<Placed> place_matrix(const MatrixRock &rock,
                                 const SectionGeometry &geometry,
                                 const std::vector<Disk> &layer,
                                 const std::function<bool(const Vec2 &)> &holds)
{
  const double bin = 2. * geometry.diameter();
  std::vector<std::vector<std::size_t>> bins(
      static_cast<std::size_t>(geometry.length() / bin) + 2);
  const auto bin_of = [&](const double x)
  {
    return static_cast<std::size_t>(std::clamp((x - geometry.x_min()) / bin, 0.,
                                               static_cast<double>(bins.size() - 1)));
  };
  for (std::size_t i = 0; i < layer.size(); ++i)
    bins[bin_of(layer[i].centre.x)].push_back(i);
  const auto covers_layer = [&](const Disk &disk)
  {
    const std::size_t middle = bin_of(disk.centre.x);
    for (std::size_t b = middle > 0 ? middle - 1 : 0;
         b <= std::min(middle + 1, bins.size() - 1); ++b)
      for (const std::size_t i : bins[b])
        if (norm(layer[i].centre - disk.centre) < 0.7 * (layer[i].radius + disk.radius))
          return true;
    return false;
  };

  std::vector<Placed> placed;
  const Vec2 period = rock.tile.size;
  const auto first_x = static_cast<int>(std::floor(geometry.x_min() / period.x));
  const auto last_x = static_cast<int>(std::floor(geometry.x_max() / period.x));
  const auto first_y = static_cast<int>(std::floor(geometry.base() / period.y));
  const auto last_y = static_cast<int>(std::floor(geometry.surface() / period.y));
  for (int ix = first_x; ix <= last_x; ++ix)
    for (int iy = first_y; iy <= last_y; ++iy)
      for (std::size_t k = 0; k < rock.tile.disks.size(); ++k)
      {
        const Disk &disk = rock.tile.disks[k];
        const Vec2 c = disk.centre + Vec2{ix * period.x, iy * period.y};
        if (c.x < geometry.x_min() || c.x > geometry.x_max() || c.y < geometry.base() ||
            c.y > geometry.surface())
          continue;
        if (c.y > geometry.layer_bottom(c.x) && c.y < geometry.layer_top(c.x))
          continue;
        const Disk copy{c, disk.radius};
        if (holds(c) && !covers_layer(copy))
          placed.push_back({copy, matrix_region, static_cast<int>(k)});
      }
  return placed;
}

/// Keep what is connected with the first grain of the layer through the pairs.
std::vector<char>
connected_grains(const std::size_t n,
                 const std::vector<std::pair<std::int32_t, std::int32_t>> &pairs,
                 const Grains &grains)
{
  std::vector<std::int32_t> parent(n);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto &[i, j] : pairs)
    parent[root(i)] = root(j);
  std::int32_t layer = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (is_layer(grains.region[i]))
    {
      layer = static_cast<std::int32_t>(i);
      break;
    }
  std::vector<char> keep(n);
  for (std::size_t i = 0; i < n; ++i)
    keep[i] = root(static_cast<std::int32_t>(i)) == root(layer) ? 1 : 0;
  return keep;
}

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

struct AllPairs
{
  /// Of the grains of each bed, then of each two beds.
  struct OfBeds
  {
    int one, other;
    Pairs pairs;
  };
  std::vector<OfBeds> layer;
  Pairs interface, matrix;

  Pairs all() const
  {
    Pairs any;
    for (const OfBeds &beds : layer)
      any.insert(any.end(), beds.pairs.begin(), beds.pairs.end());
    any.insert(any.end(), interface.begin(), interface.end());
    any.insert(any.end(), matrix.begin(), matrix.end());
    return any;
  }
};
AllPairs find_pairs(const Grains &grains,
                    const Parameters &p,
                    const double layer_gap,
                    const double matrix_gap)
{
  AllPairs all;
  const auto add = [&](const int one, const int other)
  {
    all.layer.push_back({one, other,
                         pairs_within(grains, layer_gap, bed_region(one),
                                      bed_region(other))});
  };
  for (int bed = 0; bed < p.n_beds(); ++bed)
    add(bed, bed);
  for (int one = 0; one < p.n_beds(); ++one)
    for (int other = one + 1; other < p.n_beds(); ++other)
      add(one, other);
  all.interface = pairs_with_matrix(grains, matrix_gap, p);
  all.matrix = pairs_within(grains, matrix_gap, matrix_region, matrix_region);
  return all;
}

/// Number the grains by x, so that neighbours in space are neighbours in memory.
void number_grains(std::vector<Placed> placed, const Parameters &p, GrainSection &section)
{
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed &a, const Placed &b)
                   { return a.disk.centre.x < b.disk.centre.x; });
  section.state.grains = {};
  section.tile_grain.clear();
  for (const Placed &one : placed)
  {
    section.state.grains.add(one.disk.centre, one.disk.radius,
                             is_layer(one.region) ? p.bed(bed_of(one.region)).grain_density
                                                  : p.matrix.grain_density,
                             one.region);
    section.tile_grain.push_back(one.tile_grain);
  }
}

/// Joints between the pairs; those across a fracture are left to smooth joints.
void bond(GrainSection &section,
          const Parameters &p,
          const AllPairs &pairs,
          std::vector<Fracture> fractures)
{
  const Grains &grains = section.state.grains;
  Joints &joints = section.state.joints;
  std::vector<CrossedPair> crossed;
  const auto add = [&](const Pairs &list, const JointLaw &law, const int region,
                       const std::string &name, const std::vector<double> &modulus)
  {
    joints.begin_group(law, region, name);
    for (const auto &[i, j] : list)
    {
      const double one = modulus[grains.region[i]], two = modulus[grains.region[j]];
      if (!fractures.empty() &&
          crossed_by(fractures, grains.reference(i), grains.reference(j)) >= 0)
        crossed.push_back(
            {i, j, joint_stiffness(grains.radius[i], grains.radius[j], one, two),
             constants(law).stiffness_ratio});
      else
        joints.add(grains, i, j, one, two);
    }
  };
  std::vector<double> bonds = section.modulus; // without the contacts beside them
  for (int bed = 0; bed < p.n_beds(); ++bed)
    bonds[bed_region(bed)] = joint_modulus(p.bed(bed).law());
  for (const AllPairs::OfBeds &beds : pairs.layer)
    if (beds.one == beds.other)
      add(beds.pairs, p.bed(beds.one).law(), bed_region(beds.one),
          p.n_beds() == 1 ? "layer" : "bed " + std::to_string(beds.one + 1), bonds);
    else if (!beds.pairs.empty())
    {
      const bool first = p.bed(beds.one).joint.tensile_strength <=
                         p.bed(beds.other).joint.tensile_strength;
      add(beds.pairs, joint_between(p.bed(beds.one), p.bed(beds.other)),
          bed_region(first ? beds.one : beds.other), "bedding", bonds);
    }
  if (section.matrix)
  {
    const FlatJoint &law = section.matrix->law;
    if (p.matrix.interface == "cemented")
      add(pairs.interface, law, matrix_region, "interface", section.modulus);
    add(pairs.matrix, law, matrix_region, "matrix", section.modulus);
  }
  joints.finish(grains.size());
  if (!p.has_smooth_joints())
    return;
  section.smooth = make_smooth_joints(grains, std::move(fractures), crossed);
  section.smooth->modulus = section.modulus;
  section.smooth->stiffness_ratio = constants(p.layer.law()).stiffness_ratio;
}
} // namespace

std::vector<std::pair<std::int32_t, std::int32_t>>
pairs_with_matrix(const Grains &grains, const double gap, const Parameters &p)
{
  Pairs all;
  for (int bed = 0; bed < p.n_beds(); ++bed)
  {
    const Pairs pairs = pairs_within(grains, gap, bed_region(bed), matrix_region);
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

MatrixRock make_matrix_rock(const Parameters &p, const Progress &progress)
{
  MatrixRock rock;
  rock.tile = make_tile(p, progress);
  rock.installation_gap = p.layer.installation_gap * 0.5 * p.grain_diameter();
  try
  {
    rock.law = match_moduli(rock.tile, rock.installation_gap, matrix_law(p),
                            p.matrix_modulus(), p.matrix.poisson_ratio);
  }
  catch (const std::invalid_argument &error)
  {
    throw InputError({"'Matrix / Poisson ratio' is " +
                      std::to_string(p.matrix.poisson_ratio) + ": " + error.what()});
  }
  rock.response = homogenise(rock.tile, rock.installation_gap, rock.law);
  rock.bulk_density = p.matrix.grain_density * rock.response.density_factor;
  return rock;
}

GrainSection make_grains(const Parameters &p,
                         const SectionGeometry &geometry,
                         const std::function<bool(const Vec2 &)> &holds,
                         const Progress &progress)
{
  GrainSection section;
  section.modulus.resize(
      std::max<std::size_t>(bed_region(p.n_beds() - 1) + 1, p.has("matrix") ? 2 : 1), 0.);
  for (int bed = 0; bed < p.n_beds(); ++bed)
    section.modulus[bed_region(bed)] =
        joint_modulus(p.bed(bed).law()) +
        (has_contact_beside(p.bed(bed).law()) ? p.bed(bed).grain_contact().effective_modulus
                                              : 0.);
  section.mean_radius = 0.5 * p.grain_diameter();
  std::vector<Placed> placed;
  progress("packing the layer");
  const LayerPacking packed = make_layer_packing(p, geometry, progress);
  const Packing &layer = packed.packing;
  section.layer_quality = layer.quality;
  const BedPlanes planes(p, geometry);
  for (const Disk &disk : layer.disks)
    placed.push_back({disk, bed_region(planes.bed_at(disk.centre)), -1});
  const double layer_gap = packed.installation_gap;
  section.installation_gap = layer_gap;
  double matrix_gap = 0.;
  if (geometry.has_matrix() && !p.has_surface_interface())
  {
    progress("packing the matrix");
    section.matrix = make_matrix_rock(p, progress);
    section.modulus[matrix_region] = section.matrix->law.effective_modulus;
    matrix_gap = section.matrix->installation_gap;
    for (const Placed &one : place_matrix(*section.matrix, geometry, layer.disks, holds))
      placed.push_back(one);
  }

  number_grains(placed, p, section);
  const Grains &all = section.state.grains;
  AllPairs pairs = find_pairs(all, p, layer_gap, matrix_gap);
  const std::vector<char> keep = connected_grains(all.size(), pairs.all(), all);
  section.removed_grains =
      static_cast<std::size_t>(std::count(keep.begin(), keep.end(), char(0)));
  if (section.removed_grains > 0)
  {
    std::vector<Placed> kept;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (keep[i] != 0)
        kept.push_back(
            {{all.reference(i), all.radius[i]}, all.region[i], section.tile_grain[i]});
    number_grains(kept, p, section);
    pairs = find_pairs(all, p, layer_gap, matrix_gap);
  }
  progress("bonding");
  std::vector<Fracture> fractures;
  if (p.has("fractures"))
    fractures = make_fractures(p, geometry);
  if (p.has("beds") && p.beds.interface == "frictional")
  {
    SmoothJoint bedding;
    bedding.friction = p.beds.friction;
    const std::vector<Fracture> traces = planes.traces(bedding);
    fractures.insert(fractures.end(), traces.begin(), traces.end());
    section.n_bedding_traces = traces.size();
  }
  bond(section, p, pairs, std::move(fractures));
  const auto seed = static_cast<std::uint64_t>(p.layer.seed);
  for (int bed = 0; bed < p.n_beds(); ++bed) // its group has its number
  {
    if (p.bed(bed).scatter.any())
      scatter_strengths(section.state.joints, bed, p.bed(bed).scatter, seed);
    if (p.has_unbonded_joints())
      unbond_some(section.state.joints, bed, p.bed(bed).types, section.mean_radius, seed);
  }
  return section;
}

void find_contacts(GrainSection &section, Contacts &contacts)
{
  const Grains &grains = section.state.grains;
  if (!section.smooth)
  {
    search_contacts(grains, section.state.joints, contacts);
    return;
  }
  SmoothJointSearch fractures(grains, *section.smooth, contacts.margin);
  search_contacts(grains, section.state.joints, contacts, &fractures);
  fractures.finish();
}

namespace
{
/// Two walls that face each other.
std::vector<Wall>
wall_pair(const GrainSection &section, const Vec2 &one, const Vec2 &other)
{
  const Vec2 normal = (1. / norm(other - one)) * (other - one);
  std::vector<Wall> walls(2);
  walls[0].point = one;
  walls[0].normal = normal;
  walls[1].point = other;
  walls[1].normal = -normal;
  // The first row of grains, cut or not, stands at the wall stress-free.
  const double d = 2. * section.mean_radius;
  for (Wall &wall : walls)
    install_wall_contacts(section.state.grains, wall, d, 0.3 * d, section.modulus);
  return walls;
}
} // namespace

std::vector<Wall> make_walls(const GrainSection &section, const SectionGeometry &geometry)
{
  return wall_pair(section, {geometry.x_min(), 0.}, {geometry.x_max(), 0.});
}

std::vector<Wall> make_side_walls(const GrainSection &section,
                                  const SectionGeometry &geometry)
{
  const double half = 0.5 * geometry.thickness();
  return wall_pair(section, {0., -half}, {0., half});
}

std::vector<std::pair<std::int32_t, double>> base_grains(const GrainSection &section,
                                                         const SectionGeometry &geometry)
{
  const Grains &grains = section.state.grains;
  std::vector<std::pair<std::int32_t, double>> base;
  double width = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (grains.reference_y[i] - geometry.base() <= geometry.diameter())
    {
      base.emplace_back(static_cast<std::int32_t>(i), 2. * grains.radius[i]);
      width += 2. * grains.radius[i];
    }
  for (auto &[i, share] : base)
    share *= geometry.length() / width;
  return base;
}

std::vector<std::pair<std::int32_t, double>>
surface_grains(const GrainSection &section, const SectionGeometry &geometry)
{
  const Grains &grains = section.state.grains;
  const auto n = static_cast<std::size_t>(20. * geometry.length() / geometry.diameter());
  const double width = geometry.length() / static_cast<double>(n);
  std::vector<std::int32_t> highest(n, -1);
  std::vector<double> height(n, -1e300);
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const double x = grains.reference_x[i], r = grains.radius[i];
    const auto begin = static_cast<long>((x - r - geometry.x_min()) / width);
    const auto end = static_cast<long>((x + r - geometry.x_min()) / width);
    for (long k = std::max(0l, begin); k <= std::min(long(n) - 1, end); ++k)
    {
      const double s = geometry.x_min() + (static_cast<double>(k) + 0.5) * width - x;
      if (std::abs(s) >= r)
        continue;
      const double top = grains.reference_y[i] + std::sqrt(r * r - s * s);
      if (top > height[k])
      {
        height[k] = top;
        highest[k] = static_cast<std::int32_t>(i);
      }
    }
  }
  std::vector<double> share(grains.size(), 0.);
  for (std::size_t k = 0; k < n; ++k)
    if (highest[k] >= 0)
      share[highest[k]] += width;
  std::vector<std::pair<std::int32_t, double>> chain;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (share[i] > 0.)
      chain.emplace_back(static_cast<std::int32_t>(i), share[i]);
  return chain;
}
} // namespace antiform::cases

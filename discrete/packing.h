#pragma once

#include "discrete/vec2.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace antiform::discrete
{
/// Raised whenever the same parameters give other disks than before: packings that were
/// kept are then of no use.
constexpr int packing_version = 1;

/// What a random packing of polydisperse disks is made from (Potyondy & Cundall 2004 in
/// spirit: cloud, relaxation of overlaps, installed stress, floaters).
struct PackingParameters
{
  double mean_diameter = 1.;  ///< arithmetic mean over grains [m]
  double radius_ratio = 1.66; ///< R_max / R_min, radii uniform by number [-]
  /// Mean overlap over mean diameter that stands for the locked-in pressure [-].
  double target_overlap = 5e-4;
  /// Largest gap that will be bonded, over the mean radius [-]; floaters are counted on
  /// it.
  double installation_gap_ratio = 0.3;
  double porosity = 0.; ///< wanted [-]; 0: as dense as disks jam
  std::uint64_t seed = 1;
};

struct Disk
{
  Vec2 centre;   ///< [m]
  double radius; ///< [m]
};

/// The figures by which a packing is judged (docs/theory/packing.md).
struct PackingQuality
{
  std::size_t grains = 0;
  double porosity = 0.;              ///< overlap lenses counted once [-]
  double coordination_number = 0.;   ///< 2 bonds / grains, with the installation gap [-]
  double touching_coordination = 0.; ///< 2 touching pairs / grains [-]
  std::size_t floaters = 0;          ///< grains with fewer than three bonds
  double mean_overlap = 0.;          ///< over touching pairs, over the mean diameter [-]
  double largest_overlap = 0.;       ///< over the smallest radius [-]
  double fabric_anisotropy = 0.;     ///< |F11 - F22| of the contact normals [-]
  /// Standard deviation over mean of the pressure in circles, in the state in which the
  /// disks jammed [-]; 0 where fewer than three circles fit.
  double stress_variation = 0.;
  double unbalanced_ratio = 0.; ///< mean force on a grain over mean contact force [-]
};

/// Pack disks into a simple polygon (counter-clockwise or clockwise) with frictionless
/// edges. Same seed, same bits, for any number of threads. Throws std::invalid_argument
/// when the polygon is not simple, or too thin for one grain.
struct Packing
{
  std::vector<Disk> disks;
  PackingQuality quality;
};
Packing pack_polygon(const std::vector<Vec2> &polygon,
                     const PackingParameters &parameters);
/// The same as dense as disks jam, whatever porosity is wanted.
Packing pack_jammed(const std::vector<Vec2> &polygon,
                    const PackingParameters &parameters);

/// Porosities that disks of this size can be packed to in a region of this @p area [m^2]
/// and @p perimeter [m]: jammed by their contacts up to bonded across their gaps. The
/// first is an estimate, good to 0.015.
struct PorosityRange
{
  double least, most;
};
PorosityRange
porosity_range(double area, double perimeter, const PackingParameters &parameters);

/// The gap [m] up to which @p disks of mean radius @p mean_radius must be bonded for the
/// wanted number of bonds a disk (to 1 / number of disks). Throws std::invalid_argument
/// with the range that gaps of 0.01 to 1 mean radii reach when it lies outside.
double gap_for_coordination(const std::vector<Disk> &disks,
                            double coordination_number,
                            double mean_radius);

/// The figures of disks in a polygon whose pairs up to @p gap [m] are bonded.
/// \param mean_diameter asked for [m]
PackingQuality polygon_quality(const std::vector<Disk> &disks,
                               const std::vector<Vec2> &polygon,
                               double mean_diameter,
                               double gap);

/// A packing that repeats with the periods @p size; disks lie in [0, size.x) x [0,
/// size.y).
struct PeriodicTile
{
  Vec2 size;
  std::vector<Disk> disks;
  PackingQuality quality;
};
PeriodicTile pack_periodic(const Vec2 &size, const PackingParameters &parameters);

/// Signed area, distance and containment for polygons (CGAL predicates, exact).
bool is_simple(const std::vector<Vec2> &polygon);
bool contains(const std::vector<Vec2> &polygon, const Vec2 &point);
double area(const std::vector<Vec2> &polygon); ///< positive for counter-clockwise
} // namespace antiform::discrete

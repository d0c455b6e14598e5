#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "coupling/grain_components.h"
#include "discrete/homogenise.h"
#include "discrete/packing.h"
#include "discrete/walls.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// Regions of grains, as Grains::region has them.
enum Region
{
  layer_region = 0, ///< or its lowest bed; the other beds follow the matrix
  matrix_region = 1
};
inline int bed_region(const int bed)
{
  return bed == 0 ? int(layer_region) : matrix_region + bed;
}
inline int bed_of(const int region)
{
  return region == layer_region ? 0 : region - matrix_region;
}
inline bool is_layer(const int region)
{
  return region != matrix_region;
}

/// The matrix as grains: a periodic tile with the wanted moduli.
struct MatrixRock
{
  discrete::PeriodicTile tile;
  discrete::TileResponse response;
  discrete::FlatJoint law;
  double installation_gap = 0.; ///< [m]
  double bulk_density = 0.;     ///< [kg/m^3]
};

/// All grains of a scene, bonded where they stand.
struct GrainSection
{
  coupling::GrainState state;
  discrete::PackingQuality layer_quality;
  std::optional<MatrixRock> matrix;
  std::optional<discrete::SmoothJoints> smooth; ///< of fractures, then of the bedding
  std::size_t n_bedding_traces = 0;             ///< the last ones of those fractures
  std::vector<int> tile_grain;    ///< grain of the tile that a matrix grain copies; -1
  std::vector<double> modulus;    ///< E* by region, contact and bond together [Pa]
  double installation_gap = 0.;   ///< [m]
  double mean_radius = 0.;        ///< asked for [m]
  std::size_t removed_grains = 0; ///< matrix grains without a path to the rest
};

using Progress = std::function<void(const std::string &)>;

/// Pack the tile and find the law that gives it the deck's moduli. Throws InputError when
/// the Poisson ratio is out of a disk packing's reach.
MatrixRock make_matrix_rock(const Parameters &parameters, const Progress &progress);

/// Pack, place and bond the grains. Matrix grains are the copies of the tile whose
/// centres satisfy @p holds and lie in the matrix; those without a path of joints to the
/// layer are left out.
GrainSection make_grains(const Parameters &parameters,
                         const SectionGeometry &geometry,
                         const std::function<bool(const Vec2 &)> &holds,
                         const Progress &progress);

/// Pairs of a grain of the layer and one of the matrix at most @p gap [m] apart,
/// ascending.
std::vector<std::pair<std::int32_t, std::int32_t>>
pairs_with_matrix(const discrete::Grains &grains, double gap, const Parameters &parameters);

/// Candidates of the section's contacts, fractures having the first say. Throws
/// std::invalid_argument for grains whose centres coincide.
void find_contacts(GrainSection &section, discrete::Contacts &contacts);

/// End walls at both sides, stress-free where grains stand.
std::vector<discrete::Wall> make_walls(const GrainSection &section,
                                       const SectionGeometry &geometry);

/// Walls along the sides of a specimen, likewise.
std::vector<discrete::Wall> make_side_walls(const GrainSection &section,
                                            const SectionGeometry &geometry);

/// Grains within one diameter of the base, with their share of its width [m].
std::vector<std::pair<std::int32_t, double>> base_grains(const GrainSection &section,
                                                         const SectionGeometry &geometry);

/// Grains that see the sky, with their share of its width [m]; the shares add up to the
/// section's length.
std::vector<std::pair<std::int32_t, double>>
surface_grains(const GrainSection &section, const SectionGeometry &geometry);
} // namespace antiform::cases

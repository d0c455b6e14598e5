#include "coupling/grain_places.h"

#include "continuum/point_locator.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace antiform::coupling
{
namespace
{
dealii::Point<2> centre(const discrete::Grains &grains, const std::int32_t grain)
{
  return {grains.reference_x[grain], grains.reference_y[grain]};
}

GrainPlace look_up(const discrete::Grains &grains,
                   const continuum::ElasticSolid &solid,
                   const std::int32_t grain)
{
  const dealii::Point<2> x = centre(grains, grain);
  GrainPlace place{grain, solid.shape_values(x), solid.vertex_values(x), {}};
  for (const auto dof : place.vertex.dof_x)
    place.corners.push_back(solid.support_point(dof));
  return place;
}

constexpr unsigned int nobody = std::numeric_limits<unsigned int>::max();
} // namespace

std::vector<unsigned int> lookers(const discrete::Grains &grains,
                                  const continuum::ElasticSolid &solid,
                                  const std::vector<std::int32_t> &which)
{
  const continuum::PointLocator locator(solid.dof_handler().get_triangulation());
  std::vector<unsigned int> rank(which.size(), nobody);
  for (std::size_t k = 0; k < which.size(); ++k)
    if (const dealii::Point<2> x = centre(grains, which[k]); locator.contains(x))
      rank[k] = locator.find(x).cell->subdomain_id();
  // On an edge between cells of several ranks these may name different ones.
  std::vector<unsigned int> least(rank.size());
  dealii::Utilities::MPI::min(rank, solid.dof_handler().get_communicator(), least);
  for (std::size_t k = 0; k < which.size(); ++k)
    if (least[k] == nobody)
      throw std::out_of_range("grain " + std::to_string(which[k]) + " at (" +
                              std::to_string(grains.reference_x[which[k]]) + ", " +
                              std::to_string(grains.reference_y[which[k]]) +
                              ") m lies outside of the mesh.");
  return least;
}

std::vector<GrainPlace> grain_places(const discrete::Grains &grains,
                                     const continuum::ElasticSolid &solid,
                                     const std::vector<std::int32_t> &which)
{
  return looked_up<GrainPlace>(grains, solid, which, [&](const std::int32_t grain)
                               { return look_up(grains, solid, grain); });
}
} // namespace antiform::coupling

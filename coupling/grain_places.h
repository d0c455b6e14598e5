#pragma once

#include "continuum/elastic_solid.h"
#include "discrete/grains.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>

#include <boost/serialization/vector.hpp>

#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// The mesh around the centre of a grain at rest.
struct GrainPlace
{
  std::int32_t grain = 0;
  continuum::PointEvaluation shape, vertex; ///< as shape_values() and vertex_values()
  std::vector<dealii::Point<2>> corners;    ///< places of the dofs of `vertex` [m]

  template <class Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive & grain & corners;
    for (continuum::PointEvaluation *const e : {&shape, &vertex})
      archive & e->dof_x & e->dof_y & e->value;
  }
};

/// The rank that looks up the place of each grain: that of the cell around it. Throws
/// std::out_of_range on all ranks if a grain lies outside of the mesh. Collective.
std::vector<unsigned int> lookers(const discrete::Grains &grains,
                                  const continuum::ElasticSolid &solid,
                                  const std::vector<std::int32_t> &which);

/// What @p look_up gives for each grain (a std::int32_t), in their order and the same on
/// every rank: one rank looks it up and tells all. Throws as lookers(); on one rank as
/// @p look_up. Collective.
template <class Item, class LookUp>
std::vector<Item> looked_up(const discrete::Grains &grains,
                            const continuum::ElasticSolid &solid,
                            const std::vector<std::int32_t> &which,
                            const LookUp &look_up)
{
  namespace mpi = dealii::Utilities::MPI;
  const MPI_Comm communicator = solid.dof_handler().get_communicator();
  std::vector<Item> items;
  if (mpi::n_mpi_processes(communicator) == 1)
  {
    items.reserve(which.size());
    for (const std::int32_t grain : which)
      items.push_back(look_up(grain));
    return items;
  }
  const std::vector<unsigned int> looker = lookers(grains, solid, which);
  for (std::size_t k = 0; k < which.size(); ++k)
    if (looker[k] == mpi::this_mpi_process(communicator))
      items.push_back(look_up(which[k]));
  auto of_rank = mpi::all_gather(communicator, items);
  items.clear();
  std::vector<std::size_t> next(of_rank.size(), 0);
  for (const unsigned int rank : looker)
    items.push_back(std::move(of_rank[rank][next[rank]++]));
  return items;
}

/// Places of the given grains, as looked_up().
std::vector<GrainPlace> grain_places(const discrete::Grains &grains,
                                     const continuum::ElasticSolid &solid,
                                     const std::vector<std::int32_t> &which);
} // namespace antiform::coupling

#include "coupling/multiplier_space.h"

#include <deal.II/base/point.h>

#include <algorithm>
#include <map>

namespace antiform::coupling
{
namespace
{
std::string name_of(const std::string &what, const double x, const double y)
{
  return what + " (" + std::to_string(x) + " m, " + std::to_string(y) + " m)";
}

/// A row while it grows.
struct Row
{
  double mass = 0.;
  std::map<std::int32_t, double> grains; // by overlap grain
  std::map<std::uint32_t, double> nodes; // by x dof
  std::uint32_t vertex = 0; // x dof; its rank owns the multiplier
  std::string name;
};

/// Give the share @p m of overlap grain @p index to a row.
void add_grain(Row &row,
               const std::int32_t index,
               const double m,
               const continuum::PointEvaluation &shape)
{
  row.mass += m;
  row.grains[index] += m;
  for (std::size_t k = 0; k < shape.value.size(); ++k)
    row.nodes[static_cast<std::uint32_t>(shape.dof_x[k])] -= m * shape.value[k];
}

/// Sums of the vertices' rows, by coarse vertex.
std::vector<Row> coarsened_rows(const std::map<std::uint32_t, Row> &rows,
                                const CoarseVertices &coarse)
{
  std::vector<Row> sums(coarse.size);
  auto shares = coarse.shares.begin();
  std::vector<double> largest(coarse.size, 0.);
  for (const auto &vertex : rows)
  {
    const Row &row = vertex.second;
    for (const CoarseVertices::Share &share : *shares++)
    {
      Row &sum = sums[share.coarse];
      sum.mass += share.value * row.mass;
      for (const auto &[grain, m] : row.grains)
        sum.grains[grain] += share.value * m;
      for (const auto &[node, m] : row.nodes)
        sum.nodes[node] += share.value * m;
      if (share.value > largest[share.coarse]) // the nearest vertex gives the name
      {
        sum.vertex = row.vertex;
        sum.name = "coarse " + row.name;
      }
      largest[share.coarse] = std::max(largest[share.coarse], share.value);
    }
  }
  return sums;
}
/// Rows of the mesh' vertices, by x dof: a fixed order.
std::map<std::uint32_t, Row> vertex_rows(const discrete::Grains &grains,
                                         const std::vector<GrainPlace> &places)
{
  std::map<std::uint32_t, Row> rows;
  std::map<std::uint32_t, dealii::Point<2>> corners;
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const GrainPlace &place = places[k];
    for (std::size_t a = 0; a < place.vertex.value.size(); ++a)
    {
      const auto dof = static_cast<std::uint32_t>(place.vertex.dof_x[a]);
      add_grain(rows[dof], static_cast<std::int32_t>(k),
                grains.mass[place.grain] * place.vertex.value[a], place.shape);
      corners.emplace(dof, place.corners[a]);
    }
  }
  for (auto &[dof, row] : rows)
  {
    row.vertex = dof;
    row.name = name_of("vertex", corners[dof][0], corners[dof][1]);
  }
  return rows;
}

std::vector<Row> grain_rows(const discrete::Grains &grains,
                            const std::vector<GrainPlace> &places)
{
  std::vector<Row> rows(places.size());
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const GrainPlace &place = places[k];
    const Vec2 x = grains.reference(place.grain);
    rows[k].vertex = static_cast<std::uint32_t>(place.vertex.dof_x[0]);
    rows[k].name = name_of("grain " + std::to_string(place.grain), x.x, x.y);
    add_grain(rows[k], static_cast<std::int32_t>(k), grains.mass[place.grain],
              place.shape);
  }
  return rows;
}

CoarseVertices coarsened(const std::map<std::uint32_t, Row> &rows,
                         const discrete::Grains &grains,
                         const std::vector<GrainPlace> &places,
                         const continuum::ElasticSolid &solid)
{
  std::vector<std::uint32_t> vertices;
  for (const auto &row : rows)
    vertices.push_back(row.first);
  double diameters = 0.;
  for (const GrainPlace &place : places)
    diameters += 2. * grains.radius[place.grain];
  // Two cells of one diameter, whose size a deck gives by the mean that it asks for and
  // that a packing meets within some percents, are to count as two diameters.
  return coarsened_vertices(solid, vertices,
                            1.9 * diameters / static_cast<double>(places.size()));
}

/// The nodes of this rank that grains lie around, by global x dof, with their local dofs.
std::map<std::uint32_t, std::array<std::uint32_t, 2>>
own_nodes(const continuum::ElasticSolid &solid, const std::vector<GrainPlace> &places)
{
  std::map<std::uint32_t, std::array<std::uint32_t, 2>> nodes;
  for (const GrainPlace &place : places)
    for (std::size_t k = 0; k < place.shape.value.size(); ++k)
      if (const auto x = place.shape.dof_x[k]; solid.locally_owned().is_element(x))
        nodes[static_cast<std::uint32_t>(x)] = {
            solid.partitioner().global_to_local(x),
            solid.partitioner().global_to_local(place.shape.dof_y[k])};
  return nodes;
}
} // namespace

ConstraintRows constraint_rows(const discrete::Grains &grains,
                               const continuum::ElasticSolid &solid,
                               const std::vector<GrainPlace> &places,
                               const double smallest_mass,
                               const MultiplierSpace space)
{
  std::vector<Row> rows;
  double least = smallest_mass;
  if (space == MultiplierSpace::per_grain)
  {
    rows = grain_rows(grains, places);
    least = 0.;
  }
  else
  {
    std::map<std::uint32_t, Row> by_vertex = vertex_rows(grains, places);
    if (space == MultiplierSpace::coarsened)
    {
      const CoarseVertices coarse = coarsened(by_vertex, grains, places, solid);
      rows = coarsened_rows(by_vertex, coarse);
      least *= coarse.cells;
    }
    else
      for (auto &vertex : by_vertex)
        rows.push_back(std::move(vertex.second));
  }

  ConstraintRows result;
  for (const GrainPlace &place : places)
    result.overlap_grains.push_back(place.grain);
  std::map<std::uint32_t, std::int32_t> node_index;
  for (const auto &[dof_x, dofs] : own_nodes(solid, places))
  {
    node_index[dof_x] = static_cast<std::int32_t>(result.node_dofs.size());
    result.node_dofs.push_back(dofs);
  }
  for (Row &row : rows)
  {
    if (row.mass <= least)
      continue;
    for (const auto &[grain, m] : row.grains)
      result.grains.add(grain, m);
    result.grains.close_row();
    for (const auto &[node, m] : row.nodes)
      if (const auto own = node_index.find(node); own != node_index.end())
        result.nodes.add(own->second, m);
    result.nodes.close_row();
    result.names.push_back(std::move(row.name));
    result.is_own.push_back(solid.locally_owned().is_element(row.vertex));
  }
  return result;
}
} // namespace antiform::coupling

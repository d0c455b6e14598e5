#include "coupling/multiplier_space.h"

#include <deal.II/base/point.h>

#include <algorithm>
#include <map>

namespace antiform::coupling
{
namespace
{
dealii::Point<2> to_point(const Vec2 &v)
{
  return {v.x, v.y};
}

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
        sum.name = "coarse " + row.name;
      largest[share.coarse] = std::max(largest[share.coarse], share.value);
    }
  }
  return sums;
}
} // namespace

ConstraintRows constraint_rows(const discrete::Grains &grains,
                               const continuum::ElasticSolid &solid,
                               const OverlapWeight &weight,
                               const double smallest_mass,
                               const MultiplierSpace space,
                               const std::vector<bool> &is_left_out)
{
  ConstraintRows result;
  std::map<std::uint32_t, Row> by_vertex; // by x dof of the vertex: a fixed order
  std::vector<Row> rows;
  std::map<std::uint32_t, std::uint32_t> y_of_x;
  double diameters = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Vec2 x = grains.reference(i);
    if (!weight.in_overlap(x) || (!is_left_out.empty() && is_left_out[i]))
      continue;
    const auto index = static_cast<std::int32_t>(result.overlap_grains.size());
    result.overlap_grains.push_back(static_cast<std::int32_t>(i));
    diameters += 2. * grains.radius[i];
    const continuum::PointEvaluation shape = solid.shape_values(to_point(x));
    for (std::size_t k = 0; k < shape.value.size(); ++k)
      y_of_x[static_cast<std::uint32_t>(shape.dof_x[k])] =
          static_cast<std::uint32_t>(shape.dof_y[k]);
    if (space == MultiplierSpace::per_grain)
    {
      rows.emplace_back();
      rows.back().name = name_of("grain " + std::to_string(i), x.x, x.y);
      add_grain(rows.back(), index, grains.mass[i], shape);
      continue;
    }
    const continuum::PointEvaluation vertex = solid.vertex_values(to_point(x));
    for (std::size_t a = 0; a < vertex.value.size(); ++a)
      add_grain(by_vertex[static_cast<std::uint32_t>(vertex.dof_x[a])], index,
                grains.mass[i] * vertex.value[a], shape);
  }
  std::vector<std::uint32_t> vertices;
  for (auto &[dof, row] : by_vertex)
  {
    const dealii::Point<2> p = solid.support_point(dof);
    row.name = name_of("vertex", p[0], p[1]);
    vertices.push_back(dof);
  }
  double least = space == MultiplierSpace::per_grain ? 0. : smallest_mass;
  if (space == MultiplierSpace::coarsened)
  {
    // Two cells of one diameter, whose size a deck gives by the mean that it asks for and
    // that a packing meets within some percents, are to count as two diameters.
    const CoarseVertices coarse = coarsened_vertices(
        solid, vertices,
        1.9 * diameters / static_cast<double>(result.overlap_grains.size()));
    rows = coarsened_rows(by_vertex, coarse);
    least *= coarse.cells;
  }
  else
    for (auto &vertex : by_vertex)
      rows.push_back(std::move(vertex.second));

  std::map<std::uint32_t, std::int32_t> node_index;
  for (const auto &[dof_x, dof_y] : y_of_x)
  {
    node_index[dof_x] = static_cast<std::int32_t>(result.node_dofs.size());
    result.node_dofs.push_back({dof_x, dof_y});
  }
  for (Row &row : rows)
  {
    if (row.mass <= least)
      continue;
    for (const auto &[grain, m] : row.grains)
      result.grains.add(grain, m);
    result.grains.close_row();
    for (const auto &[node, m] : row.nodes)
      result.nodes.add(node_index[node], m);
    result.nodes.close_row();
    result.names.push_back(std::move(row.name));
  }
  return result;
}
} // namespace antiform::coupling

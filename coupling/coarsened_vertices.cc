#include "coupling/multiplier_space.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>
#include <deal.II/grid/cell_id.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace antiform::coupling
{
namespace
{
/// Column and row of a vertex among the lines of the mesh, by walking from cell to cell.
using Place = std::array<int, 2>;
using Corners = std::array<std::uint32_t, 4>; ///< x dofs, counter-clockwise

/// Places of vertices by x dof [m].
using Points = std::map<std::uint32_t, dealii::Point<2>>;

/// A cell as its rank knows it.
struct GivenCell
{
  int level = 0;
  dealii::CellId id;
  Corners corners{};
  std::array<dealii::Point<2>, 4> points;

  template <class Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive & level & id & corners & points;
  }
  bool operator<(const GivenCell &other) const
  {
    return std::tie(level, id) < std::tie(other.level, other.id);
  }
};

/// This rank's cells all of whose vertices are given.
std::vector<GivenCell> own_cells_between(const continuum::ElasticSolid &solid,
                                    const std::vector<std::uint32_t> &vertices)
{
  const std::set<std::uint32_t> known(vertices.begin(), vertices.end());
  std::vector<GivenCell> cells;
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    GivenCell own;
    constexpr std::array<unsigned int, 4> counter_clockwise{{0, 1, 3, 2}};
    bool all = true;
    for (unsigned int v = 0; v < 4; ++v)
    {
      own.corners[v] =
          static_cast<std::uint32_t>(cell->vertex_dof_index(counter_clockwise[v], 0));
      own.points[v] = solid.support_point(own.corners[v]);
      all = all && known.count(own.corners[v]) > 0;
    }
    if (!all)
      continue;
    own.level = cell->level();
    own.id = cell->id();
    cells.push_back(own);
  }
  return cells;
}

/// Those of all ranks, in an order that does not depend on the ranks.
std::vector<GivenCell> cells_between(const continuum::ElasticSolid &solid,
                                const std::vector<std::uint32_t> &vertices)
{
  namespace mpi = dealii::Utilities::MPI;
  std::vector<GivenCell> cells = own_cells_between(solid, vertices);
  const MPI_Comm communicator = solid.dof_handler().get_communicator();
  if (mpi::n_mpi_processes(communicator) == 1)
    return cells;
  const auto of_ranks = mpi::all_gather(communicator, cells);
  cells.clear();
  for (const std::vector<GivenCell> &of_rank : of_ranks)
    cells.insert(cells.end(), of_rank.begin(), of_rank.end());
  std::sort(cells.begin(), cells.end());
  return cells;
}

[[noreturn]] void refuse_mesh(const dealii::Point<2> &p)
{
  throw std::invalid_argument(
      "bridging domain: the mesh of the overlap has no rows and columns of cells at (" +
      std::to_string(p[0]) + " m, " + std::to_string(p[1]) +
      " m), so that its multipliers cannot be coarsened; make the cells at least two "
      "grain diameters large instead");
}

/// A connected part of the overlap's mesh.
struct Patch
{
  std::map<std::uint32_t, Place> place;
  std::vector<Corners> cells;
};

/// Let the corners of @p cell follow from two of them that have their places.
/// \return whether there were two
bool place_corners(const Points &points,
                   const Corners &cell,
                   std::map<std::uint32_t, Place> &place)
{
  for (unsigned int v = 0; v < 4; ++v)
  {
    const auto one = place.find(cell[v]), two = place.find(cell[(v + 1) % 4]);
    if (one == place.end() || two == place.end())
      continue;
    // The cell lies to the left of its edge.
    const Place a = one->second, b = two->second, in{{a[1] - b[1], b[0] - a[0]}};
    if (std::abs(in[0]) + std::abs(in[1]) != 1)
      refuse_mesh(points.at(cell[v]));
    const Place opposite{{b[0] + in[0], b[1] + in[1]}},
        last{{a[0] + in[0], a[1] + in[1]}};
    for (const auto &[corner, wanted] :
         {std::pair{cell[(v + 2) % 4], opposite}, std::pair{cell[(v + 3) % 4], last}})
      if (place.try_emplace(corner, wanted).first->second != wanted)
        refuse_mesh(points.at(corner));
    return true;
  }
  return false;
}

std::vector<Patch> patches_of(const Points &points, const std::vector<Corners> &cells)
{
  std::map<std::uint32_t, std::vector<std::size_t>> at_vertex;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const std::uint32_t v : cells[c])
      at_vertex[v].push_back(c);
  std::vector<bool> is_done(cells.size(), false);
  std::vector<Patch> patches;
  for (std::size_t seed = 0; seed < cells.size(); ++seed)
  {
    if (is_done[seed])
      continue;
    Patch patch;
    patch.place[cells[seed][0]] = {{0, 0}};
    patch.place[cells[seed][1]] = {{1, 0}};
    std::vector<std::size_t> open{seed};
    while (!open.empty())
    {
      const std::size_t c = open.back();
      open.pop_back();
      if (is_done[c] || !place_corners(points, cells[c], patch.place))
        continue; // touched at one corner so far; a cell beside it will come back to it
      is_done[c] = true;
      patch.cells.push_back(cells[c]);
      for (const std::uint32_t v : cells[c])
        for (const std::size_t next : at_vertex[v])
          if (!is_done[next])
            open.push_back(next);
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

/// Where the lines of one direction lie, by the mean length of the edges between them
/// [m].
std::map<int, double> line_positions(const Points &points,
                                     const Patch &patch,
                                     const unsigned int direction)
{
  std::map<int, std::pair<double, int>> gap; // from line i to i + 1: sum, number
  for (const Corners &cell : patch.cells)
    for (unsigned int v = 0; v < 4; ++v)
    {
      const std::uint32_t one = cell[v], two = cell[(v + 1) % 4];
      const int a = patch.place.at(one)[direction], b = patch.place.at(two)[direction];
      if (a == b)
        continue;
      auto &[sum, n] = gap[std::min(a, b)];
      sum += points.at(one).distance(points.at(two));
      ++n;
    }
  std::map<int, double> position;
  double at = 0.;
  for (const auto &[line, edges] : gap)
  {
    position.try_emplace(line, at);
    at += edges.first / edges.second;
    position[line + 1] = at;
  }
  return position;
}

/// Weights of the kept lines at each line; the outermost lines are kept.
using LineShares = std::map<int, std::vector<std::pair<int, double>>>;
LineShares line_shares(const std::map<int, double> &position, const double spacing)
{
  std::vector<std::pair<int, double>> kept;
  for (const auto &line : position)
    if (kept.empty() || line.second - kept.back().second >= (1. - 1e-6) * spacing)
      kept.push_back(line);
  if (kept.size() > 1)
    kept.back() = *position.rbegin();
  LineShares shares;
  std::size_t k = 0;
  for (const auto &[line, at] : position)
  {
    while (k + 2 < kept.size() && at >= kept[k + 1].second)
      ++k;
    if (kept.size() == 1)
      shares[line] = {{kept[0].first, 1.}};
    else
    {
      const double s = (at - kept[k].second) / (kept[k + 1].second - kept[k].second);
      shares[line] = {{kept[k].first, 1. - s}, {kept[k + 1].first, s}};
    }
  }
  return shares;
}

double ratio(const LineShares &shares)
{
  std::set<int> kept;
  for (const auto &line : shares)
    for (const auto &share : line.second)
      kept.insert(share.first);
  return static_cast<double>(shares.size() - 1) /
         std::max(1., static_cast<double>(kept.size()) - 1.);
}
} // namespace

CoarseVertices coarsened_vertices(const continuum::ElasticSolid &solid,
                                  const std::vector<std::uint32_t> &vertices,
                                  const double spacing)
{
  CoarseVertices coarse;
  coarse.shares.resize(vertices.size());
  coarse.cells = 0.;
  std::map<std::uint32_t, std::size_t> number;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    number[vertices[v]] = v;
  Points points;
  std::vector<Corners> cells;
  for (const GivenCell &cell : cells_between(solid, vertices))
  {
    cells.push_back(cell.corners);
    for (unsigned int v = 0; v < 4; ++v)
      points[cell.corners[v]] = cell.points[v];
  }
  const std::vector<Patch> patches = patches_of(points, cells);
  for (const Patch &patch : patches)
  {
    const std::array<LineShares, 2> lines{
        {line_shares(line_positions(points, patch, 0), spacing),
         line_shares(line_positions(points, patch, 1), spacing)}};
    std::map<Place, std::int32_t> coarse_number;
    for (const auto &[vertex, place] : patch.place)
    {
      std::vector<CoarseVertices::Share> &shares = coarse.shares[number.at(vertex)];
      if (!shares.empty())
        refuse_mesh(points.at(vertex)); // two patches meet in a point
      for (const auto &[i, wx] : lines[0].at(place[0]))
        for (const auto &[j, wy] : lines[1].at(place[1]))
          if (wx * wy > 1e-12)
          {
            const auto entry = coarse_number.try_emplace(
                Place{{i, j}}, static_cast<std::int32_t>(coarse.size));
            coarse.size += entry.second ? 1 : 0;
            shares.push_back({entry.first->second, wx * wy});
          }
    }
    coarse.cells += ratio(lines[0]) * ratio(lines[1]);
  }
  coarse.cells /= static_cast<double>(std::max<std::size_t>(1, patches.size()));
  return coarse;
}
} // namespace antiform::coupling

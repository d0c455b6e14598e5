#pragma once

#include "continuum/elastic_solid.h"
#include "coupling/grain_places.h"
#include "discrete/grains.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Sparse rows: entries begin[r] .. begin[r+1] - 1 of row r.
struct SparseRows
{
  std::vector<std::int32_t> begin{0};
  std::vector<std::int32_t> column;
  std::vector<double> value;

  std::size_t n_rows() const { return begin.size() - 1; }
  void add(const std::int32_t c, const double v)
  {
    column.push_back(c);
    value.push_back(v);
  }
  void close_row() { begin.push_back(static_cast<std::int32_t>(column.size())); }
};

/// What the multipliers of a bridging domain demand (docs/theory/bridging.md, 2).
enum class MultiplierSpace
{
  /// One multiplier a vertex of the mesh: the mean of the grains around it follows.
  mesh,
  /// One a vertex of a coarser mesh, made of the lines of the mesh that are at least 1.9
  /// grain diameters apart: for cells smaller than that, whose own vertices share their
  /// grains. The same as `mesh` for larger cells.
  coarsened,
  /// One a grain, which follows the mesh exactly. For lattices; on random packings it
  /// freezes the scatter about the mean field.
  per_grain
};

/// The constraint g = C_D d + C_C U of a bridging domain. Rows of the x components; those
/// of y have the same values. Every row's values over grains and nodes sum to zero. Every
/// rank has all rows, with all grains, but only the nodes that it owns.
struct ConstraintRows
{
  std::vector<std::int32_t> overlap_grains; ///< ascending; the columns of `grains`
  SparseRows grains;                        ///< C_D [kg]
  SparseRows nodes; ///< C_C [kg]; node k has the dofs node_dofs[k]
  std::vector<std::array<std::uint32_t, 2>> node_dofs; ///< x, y; local indices
  std::vector<std::string> names;                      ///< of the rows, for messages
  std::vector<bool> is_own; ///< whether the row's vertex, so its multiplier, is of here
};

/// \param places        of the grains that take part in the constraint, ascending
/// \param smallest_mass a vertex of the mesh is a multiplier when the grains give it more
///                      than this [kg]; on a coarser mesh in proportion to its cells
/// Throws std::invalid_argument for `coarsened` on a mesh that has no rows and columns.
/// Collective.
ConstraintRows constraint_rows(const discrete::Grains &grains,
                               const continuum::ElasticSolid &solid,
                               const std::vector<GrainPlace> &places,
                               double smallest_mass,
                               MultiplierSpace space);

/// The coarser mesh as interpolation: vertex functions N'_c = sum_v P_cv N_v, which add
/// up to one like the N_v.
struct CoarseVertices
{
  struct Share
  {
    std::int32_t coarse; ///< number of the coarse vertex
    double value;        ///< P_cv
  };
  std::vector<std::vector<Share>> shares; ///< of each given vertex; they sum to 1
  std::size_t size = 0;                   ///< coarse vertices
  double cells = 1.; ///< cells of the mesh in one of the coarser, mean [-]
};
/// Collective.
/// \param vertices x dofs of vertices, the same on all ranks
/// \param spacing  least distance of lines kept [m]
CoarseVertices coarsened_vertices(const continuum::ElasticSolid &solid,
                                  const std::vector<std::uint32_t> &vertices,
                                  double spacing);
} // namespace antiform::coupling

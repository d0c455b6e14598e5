#pragma once

#include <deal.II/distributed/tria.h>

#include <limits>
#include <vector>

namespace antiform::continuum
{
struct RefinementOptions
{
  /// Share of the sum of all indicators that the halved cells hold (Doerfler 1996), in
  /// (0, 1]; little: fewer cells, more solves.
  double bulk_share = 0.5;
  /// Cells are halved only as long as they stay below so many. Neighbours that must
  /// follow may pass it by a few.
  double max_cells = std::numeric_limits<double>::infinity();
};

/// Halve the sides of the cells with the largest indicators. Others follow, so that
/// neighbours are at most one level apart and faces that lie on one another without being
/// joined (boundary::inner) have the same nodes. Which cells is decided by values, of
/// which those within 1e-6 count as equal: the same on any number of ranks, and on both
/// sides of a symmetric section. Spaces and solids on the mesh are to be made anew.
/// \param indicators squared errors, >= 0, one for each active cell that this rank owns,
///                   in cell order
/// \return whether any cell was halved: false where all indicators are 0 or the limit is
///         reached
/// Throws std::invalid_argument on all ranks for other sizes, values or options.
/// Collective.
bool refine(dealii::parallel::distributed::Triangulation<2> &triangulation,
            const std::vector<double> &indicators,
            const RefinementOptions &options);

/// Halve cells until faces that lie on one another have the same nodes: after a
/// refinement of one's own. Collective.
void match_interfaces(dealii::parallel::distributed::Triangulation<2> &triangulation);
} // namespace antiform::continuum

#pragma once
// Meshes with hanging nodes for the tests of continuum/.
#include "support/solid_fixtures.h"

#include <functional>

namespace antiform::testing
{
/// Halve the sides of the cells whose centre @p is_fine.
inline void refine_where(Triangulation &triangulation,
                         const std::function<bool(const Point<2> &)> &is_fine)
{
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && is_fine(cell->center()))
      cell->set_refine_flag();
  triangulation.execute_coarsening_and_refinement();
}
} // namespace antiform::testing

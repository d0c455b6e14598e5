#pragma once

#include <deal.II/distributed/tria.h>

#include <functional>
#include <vector>

namespace antiform::continuum
{
/// A strip of a geological section between two curves y(x). Strips that share a curve
/// (same number of columns always holds) share their nodes.
struct Strip
{
  std::function<double(double)> lower; ///< y of the lower face at x [m]
  std::function<double(double)> upper; ///< y of the upper face at x [m]
  /// Heights of the row boundaries as fractions of the strip's height: 0 = first < ...
  /// < 1.
  std::vector<double> rows;
  unsigned int material = 0;
  bool joined_to_previous = false; ///< lower face is the upper face of the strip before
};

/// Boundary ids that make_section() sets.
namespace boundary
{
constexpr unsigned int left = 0, right = 1, bottom = 2, top = 3, inner = 4;
}

/// Row boundaries (fractions) of a strip of @p height [m] whose cells start with
/// @p cell [m] at the lower (or, @p fine_at_top, the upper) face, stay so for @p uniform
/// [m] and then grow by at most @p growth from row to row up to @p largest [m].
std::vector<double> graded_rows(double height,
                                double cell,
                                double uniform,
                                double growth,
                                double largest,
                                bool fine_at_top);

/// Quadrilateral mesh of the strips, @p n_columns equal columns over [x_min, x_max];
/// strips are listed from the lowest to the highest. Boundary ids: left and right sides;
/// the lower face of the first strip is bottom, the upper face of the last one top, other
/// free faces (beside a gap between strips) inner.
void make_section(dealii::parallel::distributed::Triangulation<2> &triangulation,
                  double x_min,
                  double x_max,
                  unsigned int n_columns,
                  const std::vector<Strip> &strips);
} // namespace antiform::continuum

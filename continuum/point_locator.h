#pragma once

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <string>
#include <vector>

namespace antiform::continuum
{
/// Finds the cell around a point among the cells that this rank knows (its own and the
/// ghosts), by square buckets over their bounding box. Vertices must not move afterwards.
class PointLocator
{
public:
  explicit PointLocator(const dealii::Triangulation<2> &triangulation);

  struct Place
  {
    dealii::Triangulation<2>::active_cell_iterator cell;
    dealii::Point<2> unit; ///< coordinates in the cell, in [0,1]^2 up to 1e-8
  };

  /// The place of a point; on a shared edge the first cell in cell order. Throws
  /// std::out_of_range if the point lies outside all cells by more than 1e-8 of a cell.
  Place find(const dealii::Point<2> &point) const;
  bool contains(const dealii::Point<2> &point) const;

private:
  /// Index into cells_ of the cell that holds the point best, and how far outside of it
  /// the point lies, in unit coordinates (0: inside; infinite: no cell near).
  struct Candidate
  {
    std::size_t cell = 0;
    dealii::Point<2> unit;
    double outside;
  };
  Candidate nearest(const dealii::Point<2> &point) const;
  std::array<int, 2> bucket(const dealii::Point<2> &point) const;

  std::vector<dealii::Triangulation<2>::active_cell_iterator> cells_;
  std::vector<std::array<dealii::Point<2>, 4>> corners_; ///< of cells_[i]
  dealii::Point<2> lower_, upper_;                       ///< of all known cells
  std::array<int, 2> n_buckets_{};
  std::array<double, 2> bucket_size_{};
  std::vector<std::size_t>
      bucket_start_;                 ///< bucket b holds members_[start[b]...start[b+1])
  std::vector<std::size_t> members_; ///< indices into cells_, ascending in a bucket
};
} // namespace antiform::continuum

#include "continuum/refinement.h"

#include "continuum/by_place.h"
#include "continuum/require.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
using namespace dealii;
using Triangulation = parallel::distributed::Triangulation<2>;

namespace
{
/// Indicators that differ by less of themselves are of cells alike.
constexpr double alike = 1e-6;

/// All ranks' indicators from the largest down.
std::vector<double> sorted(const Triangulation &triangulation,
                           const std::vector<double> &indicators)
{
  bool wrong = indicators.size() != triangulation.n_locally_owned_active_cells();
  for (const double value : indicators)
    wrong |= !(value >= 0. && std::isfinite(value));
  const MPI_Comm communicator = triangulation.get_communicator();
  if (Utilities::MPI::max(wrong ? 1 : 0, communicator) != 0)
    throw std::invalid_argument("refinement: indicators must be numbers >= 0, one for "
                                "each active cell that a rank owns.");
  std::vector<double> all;
  for (const auto &part : Utilities::MPI::all_gather(communicator, indicators))
    all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), std::greater<>());
  return all;
}

/// Cells with this indicator or more hold the bulk; infinite if none may be halved.
double threshold(const std::vector<double> &all, const RefinementOptions &options)
{
  constexpr double none = std::numeric_limits<double>::infinity();
  double sum = 0., bulk = 0.;
  for (const double value : all)
    sum += value;
  if (sum == 0.)
    return none;
  std::size_t n = 0;
  while (n < all.size() && bulk < options.bulk_share * sum)
    bulk += all[n++];
  while (n < all.size() && all[n] >= (1. - alike) * all[n - 1])
    ++n;
  // Each halved cell adds three; what is alike is halved together or not at all.
  const double room = (options.max_cells - static_cast<double>(all.size())) / 3.;
  while (n > 0 && static_cast<double>(n) > room)
  {
    --n;
    while (n > 0 && all[n] >= (1. - alike) * all[n - 1])
      --n;
  }
  return n > 0 ? all[n - 1] : none;
}

/// An end of an inner face.
struct FaceEnd
{
  double x, y;
  bool looks_up; ///< the face

  template <class Archive>
  void serialize(Archive &archive, unsigned int)
  {
    archive &x &y &looks_up;
  }
};

/// Call @p visit(cell, face, whether it looks up) for the inner faces of own cells.
template <class Visit>
void visit_inner_faces(const Triangulation &triangulation, const Visit &visit)
{
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == boundary::inner)
          visit(cell, face, face->center()[1] > cell->center()[1]);
}

/// Flag the cells below or above whose partner's face is halved; whether there are any.
bool flag_coarser_partners(Triangulation &triangulation)
{
  std::vector<FaceEnd> own, ends[2];
  visit_inner_faces(triangulation,
                    [&](const auto &, const auto &face, const bool looks_up)
                    {
                      for (const unsigned int v : {0, 1})
                        own.push_back({face->vertex(v)[0], face->vertex(v)[1], looks_up});
                    });
  const MPI_Comm communicator = triangulation.get_communicator();
  for (const auto &part : Utilities::MPI::all_gather(communicator, own))
    for (const FaceEnd &end : part)
      ends[end.looks_up ? 1 : 0].push_back(end);
  for (auto &side : ends)
    sort_by_place(side);

  bool any = false;
  visit_inner_faces(
      triangulation,
      [&](const auto &cell, const auto &face, const bool looks_up)
      {
        const Point<2> middle = face->center();
        const double tolerance = same_place * cell->minimum_vertex_distance();
        if (at_place(ends[looks_up ? 0 : 1], middle[0], middle[1], tolerance) != nullptr)
        {
          cell->set_refine_flag();
          any = true;
        }
      });
  return Utilities::MPI::max(any ? 1 : 0, communicator) != 0;
}
} // namespace

void match_interfaces(Triangulation &triangulation)
{
  while (flag_coarser_partners(triangulation))
    triangulation.execute_coarsening_and_refinement();
}

bool refine(Triangulation &triangulation,
            const std::vector<double> &indicators,
            const RefinementOptions &options)
{
  require(options.bulk_share > 0. && options.bulk_share <= 1., "refinement: bulk share",
          options.bulk_share, "", "in (0, 1]");
  const double least = threshold(sorted(triangulation, indicators), options);
  if (std::isinf(least))
    return false;
  std::size_t n = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && indicators[n++] >= least)
      cell->set_refine_flag();
  triangulation.execute_coarsening_and_refinement();
  match_interfaces(triangulation);
  return true;
}
} // namespace antiform::continuum

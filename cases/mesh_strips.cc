#include "cases/mesh_strips.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
namespace
{
/// Boundaries of @p n equal rows, as shares of the height.
std::vector<double> even_rows(const int n)
{
  std::vector<double> rows;
  for (int r = 0; r <= n; ++r)
    rows.push_back(static_cast<double>(r) / n);
  return rows;
}
} // namespace

std::vector<continuum::Strip> mesh_strips(const Parameters &p,
                                          const SectionGeometry &geometry)
{
  const double d = geometry.diameter(), cell = p.matrix.cell_size * d;
  const double largest = p.matrix.largest_cell * d;
  const bool layer_is_mesh = p.layer.representation == "continuum";
  const bool joined = !p.has_mesh_contact(); // else faces lie on one another
  const double uniform = p.is_bridged() ? p.bridging.overlap * d : 0.;
  const auto core_top = [&geometry](const double x) { return geometry.core_top(x); };
  const auto core_bottom = [&geometry](const double x)
  { return geometry.core_bottom(x); };
  const auto surface = [&geometry](double) { return geometry.surface(); };
  const auto base = [&geometry](double) { return geometry.base(); };

  std::vector<continuum::Strip> strips;
  if (geometry.has_matrix())
  {
    const double height = geometry.core_bottom(geometry.x_min()) - geometry.base();
    strips.push_back({base, core_bottom,
                      continuum::graded_rows(height, cell, uniform, 1.3, largest, true),
                      0, false});
  }
  if (layer_is_mesh)
  {
    const int rows =
        std::max(2, static_cast<int>(std::lround(geometry.thickness() / cell)));
    strips.push_back({core_bottom, core_top, even_rows(rows), layer_material_id,
                      geometry.has_matrix() && joined});
  }
  if (geometry.has_matrix() && !geometry.has_grain_cover())
  {
    const double height = geometry.surface() - geometry.core_top(0.);
    strips.push_back({core_top, surface,
                      p.matrix.cover_rows > 0
                          ? even_rows(p.matrix.cover_rows)
                          : continuum::graded_rows(height, cell, uniform, 1.3, largest,
                                                   false),
                      matrix_material_id, layer_is_mesh && joined});
  }
  return strips;
}

std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> make_mesh(
    const Parameters &p, const SectionGeometry &geometry, const MPI_Comm communicator)
{
  auto mesh =
      std::make_unique<dealii::parallel::distributed::Triangulation<2>>(communicator);
  continuum::make_section(*mesh, geometry.x_min(), geometry.x_max(), geometry.n_columns(),
                          mesh_strips(p, geometry));
  return mesh;
}
} // namespace antiform::cases

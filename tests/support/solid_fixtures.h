#pragma once
// Small bodies and solves for the tests of continuum/.
#include "continuum/elastic_solid.h"
#include "continuum/section_mesh.h"
#include "continuum/static_solver.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>
#include <functional>
#include <vector>

namespace antiform::testing
{
using Triangulation = dealii::parallel::distributed::Triangulation<2>;
using dealii::Point;

inline std::vector<double> even_rows(const unsigned int n)
{
  std::vector<double> rows;
  for (unsigned int i = 0; i <= n; ++i)
    rows.push_back(static_cast<double>(i) / n);
  return rows;
}

/// [0, length] x [-height/2, height/2] in even cells.
inline void make_rectangle(Triangulation &triangulation,
                           const double length,
                           const double height,
                           const unsigned int n_columns,
                           const unsigned int n_rows)
{
  continuum::Strip strip;
  strip.lower = [=](double) { return -height / 2.; };
  strip.upper = [=](double) { return height / 2.; };
  strip.rows = even_rows(n_rows);
  continuum::make_section(triangulation, 0., length, n_columns, {strip});
}

/// Unit square, n x n cells without a right angle or a pair of parallel edges inside.
inline void make_distorted_square(Triangulation &triangulation, const unsigned int n)
{
  make_rectangle(triangulation, 1., 1., n, n);
  dealii::GridTools::transform(
      [](const Point<2> &p)
      {
        const double x = p[0], y = p[1] + 0.5;
        return Point<2>(x + 0.07 * std::sin(5. * x * y) + 0.03 * y,
                        y + 0.06 * std::sin(4. * x + 3. * y));
      },
      triangulation);
}

/// Values of @p field (by place and component) in all dofs known here.
inline continuum::Vector
interpolate(const continuum::DisplacementSpace &solid,
            const std::function<double(const Point<2> &, unsigned int)> &field)
{
  auto vector = solid.make_vector();
  for (const auto dof : solid.locally_owned())
    vector(dof) = field(solid.support_point(dof), solid.component(dof));
  vector.update_ghost_values();
  return vector;
}

/// Prescribe @p field on all nodes of the outer boundary.
inline continuum::DirichletValues
prescribe_all_sides(const continuum::DisplacementSpace &solid,
                    const std::function<double(const Point<2> &, unsigned int)> &field)
{
  continuum::DirichletValues values;
  for (unsigned int side = 0; side < 4; ++side)
    for (unsigned int c = 0; c < 2; ++c)
      continuum::prescribe(
          solid, side, c, [&](const Point<2> &p) { return field(p, c); }, values);
  return values;
}

/// Hold one component of the node at @p place, if this rank knows it.
inline void hold_node(const continuum::DisplacementSpace &solid,
                      const Point<2> &place,
                      const unsigned int component,
                      continuum::DirichletValues &values)
{
  for (const auto dof : solid.locally_relevant())
    if (solid.component(dof) == component &&
        solid.support_point(dof).distance(place) < 1e-9)
      values[dof] = 0.;
}

inline continuum::Vector solve(const continuum::DisplacementSpace &solid,
                               const dealii::TrilinosWrappers::SparseMatrix &matrix,
                               const continuum::DirichletValues &values,
                               const continuum::Vector &force,
                               const continuum::StaticSolver::Options &options)
{
  auto displacement = solid.make_vector();
  continuum::StaticSolver(solid, matrix, values, options).solve(force, displacement);
  return displacement;
}

inline continuum::Vector
solve_direct(const continuum::DisplacementSpace &solid,
             const dealii::TrilinosWrappers::SparseMatrix &matrix,
             const continuum::DirichletValues &values,
             const continuum::Vector &force)
{
  continuum::StaticSolver::Options options;
  options.method = continuum::StaticSolver::Method::direct;
  return solve(solid, matrix, values, force, options);
}

/// Largest |entry| over all ranks.
inline double largest(const continuum::Vector &vector)
{
  return vector.linfty_norm();
}
} // namespace antiform::testing

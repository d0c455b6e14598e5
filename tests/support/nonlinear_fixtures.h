#pragma once
// Bodies of several laws, and a slender strip between pins, for the tests of continuum/.
#include "continuum/elastic_laws.h"
#include "continuum/nonlinear_solid.h"
#include "support/solid_fixtures.h"

#include <deal.II/lac/lapack_full_matrix.h>

#include <memory>
#include <vector>

namespace antiform::testing
{
using Law = std::shared_ptr<const continuum::MaterialLaw>;
using continuum::Vector;
using Matrix = dealii::TrilinosWrappers::SparseMatrix;

template <class T>
Law make_law(const double young_modulus, const double poisson_ratio)
{
  return std::make_shared<T>(
      continuum::LameConstants::from_young_poisson(young_modulus, poisson_ratio));
}

/// Of the node at @p place, which one rank owns; the same on all.
inline double at_node(const continuum::DisplacementSpace &space,
                      const Vector &vector,
                      const Point<2> &place,
                      const unsigned int component)
{
  double value = 0.;
  for (const auto dof : space.locally_owned())
    if (space.component(dof) == component &&
        space.support_point(dof).distance(place) < 1e-9)
      value = vector(dof);
  return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
}

/// A smooth displacement with gradients of some @p size, the same on any number of ranks
/// [m].
inline Vector wavy_field(const continuum::DisplacementSpace &space, const double size)
{
  return interpolate(space,
                     [=](const Point<2> &p, const unsigned int c)
                     {
                       return size * (c == 0 ? std::sin(2. * p[0] + p[1]) + 0.3 * p[1]
                                             : std::cos(p[0] - 3. * p[1]) - 0.4 * p[0]);
                     });
}

/// Eigenvalues of the symmetric part of a matrix among the dofs that are free, ascending;
/// the same on all ranks of its mesh.
inline std::vector<double> eigenvalues(const continuum::DisplacementSpace &space,
                                       const Matrix &matrix,
                                       const continuum::DirichletValues &held)
{
  const unsigned int n = matrix.m();
  std::vector<double> entries(static_cast<std::size_t>(n) * n, 0.), is_free(n, 0.);
  const auto prescribed = continuum::complete(space, held);
  for (const auto row : space.locally_owned())
  {
    is_free[row] = prescribed.count(row) == 0 ? 1. : 0.;
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      entries[static_cast<std::size_t>(row) * n + entry->column()] = entry->value();
  }
  const MPI_Comm communicator = space.dof_handler().get_communicator();
  dealii::Utilities::MPI::sum(entries, communicator, entries);
  dealii::Utilities::MPI::sum(is_free, communicator, is_free);

  std::vector<unsigned int> rows;
  for (unsigned int i = 0; i < n; ++i)
    if (is_free[i] > 0.)
      rows.push_back(i);
  const auto m = static_cast<unsigned int>(rows.size());
  dealii::LAPACKFullMatrix<double> dense(m, m);
  for (unsigned int i = 0; i < m; ++i)
    for (unsigned int j = 0; j < m; ++j)
      dense(i, j) = 0.5 * (entries[static_cast<std::size_t>(rows[i]) * n + rows[j]] +
                           entries[static_cast<std::size_t>(rows[j]) * n + rows[i]]);
  dealii::FullMatrix<double> vectors;
  dealii::Vector<double> values;
  dense.compute_eigenvalues_symmetric(-1e300, 1e300, 0., values, vectors);
  return {values.begin(), values.end()};
}

/// A slender strip along x in [0, length] with its axis on @p rise sin(pi x / length),
/// one row of Q2 cells, between pins at the ends of the axis. Beyond either pin a column
/// of cells of another law, to be made stiff, is a plate that spreads the pin's force.
class PinnedStrip
{
public:
  PinnedStrip(const Law &law,
              const Law &plate,
              const double length,
              const double thickness,
              const unsigned int n_columns,
              const double rise,
              const double sway = 0.)
      : length(length)
      , thickness(thickness)
      , rise_(rise)
      , triangulation_(MPI_COMM_WORLD)
  {
    const double column = length / n_columns;
    const auto face = [=](const double side)
    {
      return [=](const double x)
      {
        const double k = M_PI / length;
        const bool inside = x > 0. && x < length;
        return side * 0.5 * thickness +
               (inside ? rise * std::sin(k * x) + sway * std::sin(2. * k * x) : 0.);
      };
    };
    continuum::Strip strip;
    strip.lower = face(-1.);
    strip.upper = face(1.);
    strip.rows = {0., 1.};
    continuum::make_section(triangulation_, -column, length + column, n_columns + 2,
                            {strip});
    for (const auto &cell : triangulation_.active_cell_iterators())
      if (!cell->is_artificial())
      {
        const double x = cell->center()[0];
        cell->set_material_id(x < 0. || x > length ? 1 : 0);
      }
    solid_ = std::make_unique<continuum::NonlinearSolid>(
        triangulation_, std::vector<Law>{law, plate},
        continuum::NonlinearSolid::Options());
  }

  continuum::NonlinearSolid &solid() { return *solid_; }

  /// Displacement of the axis at the pins (x = 0 or length) or at the middle [m].
  double at_axis(const Vector &vector, const double x, const unsigned int component) const
  {
    return at_node(*solid_, vector, axis(x), component);
  }
  /// Hold the pin at x = 0 or length in one component.
  void hold_pin(const double x,
                const unsigned int component,
                continuum::DirichletValues &values) const
  {
    hold_node(*solid_, axis(x), component, values);
  }
  /// Dead load downwards on the upper face, per length along x: @p load(x) [Pa].
  Vector load_across(const std::function<double(double)> &load) const
  {
    return continuum::boundary_traction(
        *solid_, {continuum::boundary::top},
        [&](const Point<2> &p, const auto &normal)
        {
          const bool inside = p[0] > 0. && p[0] < length;
          return dealii::Tensor<1, 2>({0., inside ? -load(p[0]) * normal[1] : 0.});
        });
  }

  const double length, thickness;

private:
  /// The node of the axis there.
  Point<2> axis(const double x) const
  {
    return {x, x > 0. && x < length ? rise_ * std::sin(M_PI * x / length) : 0.};
  }

  double rise_;
  Triangulation triangulation_;
  std::unique_ptr<continuum::NonlinearSolid> solid_;
};
} // namespace antiform::testing

#include "continuum/displacement_space.h"

#include "continuum/hanging_nodes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <array>

namespace antiform::continuum
{
using namespace dealii;

DisplacementSpace::DisplacementSpace(
    const parallel::distributed::Triangulation<2> &triangulation,
    const unsigned int degree,
    std::function<double(const Point<2> &)> weight)
    : fe_(FE_Q<2>(degree), 2)
    , dof_handler_(triangulation)
    , degree_(degree)
    , weight_(std::move(weight))
    , locator_(triangulation)
{
  make_dofs();
}

void DisplacementSpace::make_dofs()
{
  dof_handler_.distribute_dofs(fe_);
  locally_owned_ = dof_handler_.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler_, locally_relevant_);
  partitioner_ = std::make_shared<Utilities::MPI::Partitioner>(
      locally_owned_, locally_relevant_, dof_handler_.get_communicator());

  const unsigned int n_local =
      partitioner_->locally_owned_size() + partitioner_->n_ghost_indices();
  components_.resize(n_local);
  support_points_.resize(n_local);
  FEValues<2> places(fe_, Quadrature<2>(fe_.get_unit_support_points()),
                     update_quadrature_points);
  std::vector<types::global_dof_index> dofs(fe_.n_dofs_per_cell());
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (!cell->is_artificial())
    {
      places.reinit(static_cast<Triangulation<2>::cell_iterator>(cell));
      cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < dofs.size(); ++i)
      {
        const unsigned int local = partitioner_->global_to_local(dofs[i]);
        components_[local] = fe_.system_to_component_index(i).first;
        support_points_[local] = places.quadrature_point(i);
      }
    }

  if (!dof_handler_.get_triangulation().has_hanging_nodes())
    return;
  // Strips of different levels that only lie on one another have none all the same.
  auto hanging = std::make_shared<HangingNodes>(*this);
  if (hanging->n_dofs() > 0)
    hanging_nodes_ = std::move(hanging);
}

void DisplacementSpace::make_continuous(Vector &displacement) const
{
  if (hanging_nodes_)
    hanging_nodes_->put_on_edges(displacement);
  else
    displacement.update_ghost_values();
}

void DisplacementSpace::couple(const std::vector<DofGroup> &groups)
{
  const MPI_Comm communicator = dof_handler_.get_communicator();
  const auto of_ranks = Utilities::MPI::all_gather(communicator, groups);
  const unsigned int own = Utilities::MPI::this_mpi_process(communicator);
  bool any = false;
  for (unsigned int rank = 0; rank < of_ranks.size(); ++rank)
    for (const DofGroup &group : of_ranks[rank])
    {
      any = true;
      const bool is_of_here = std::any_of(group.begin(), group.end(),
                                          [&](const types::global_dof_index dof)
                                          { return locally_owned_.is_element(dof); });
      if (rank == own || is_of_here)
        for (const types::global_dof_index dof : group)
          locally_relevant_.add_index(dof);
    }
  if (!any)
    return;
  couplings_.insert(couplings_.end(), groups.begin(), groups.end());
  know_places();
  if (hanging_nodes_) // they know dofs by their places in vectors
    hanging_nodes_ = std::make_shared<HangingNodes>(*this);
}

/// Vectors of what is relevant now; components and places of all that they know.
void DisplacementSpace::know_places()
{
  locally_relevant_.compress();
  const auto former = partitioner_;
  partitioner_ = std::make_shared<Utilities::MPI::Partitioner>(
      locally_owned_, locally_relevant_, dof_handler_.get_communicator());
  const unsigned int n_owned = former->locally_owned_size();
  std::array<Vector, 3> of_nodes; // component, x, y
  for (Vector &vector : of_nodes)
    vector.reinit(partitioner_);
  for (unsigned int i = 0; i < n_owned; ++i)
  {
    of_nodes[0].local_element(i) = components_[i];
    for (unsigned int c = 0; c < 2; ++c)
      of_nodes[1 + c].local_element(i) = support_points_[i][c];
  }
  for (Vector &vector : of_nodes)
    vector.update_ghost_values();
  const unsigned int n_local = n_owned + partitioner_->n_ghost_indices();
  components_.resize(n_local);
  support_points_.resize(n_local);
  for (unsigned int i = n_owned; i < n_local; ++i)
  {
    components_[i] = of_nodes[0].local_element(i) > 0.5 ? 1 : 0;
    support_points_[i] =
        Point<2>(of_nodes[1].local_element(i), of_nodes[2].local_element(i));
  }
}

unsigned int DisplacementSpace::component(const types::global_dof_index dof) const
{
  return components_[partitioner_->global_to_local(dof)];
}

Point<2> DisplacementSpace::support_point(const types::global_dof_index dof) const
{
  return support_points_[partitioner_->global_to_local(dof)];
}

PointEvaluation DisplacementSpace::shape_values(const Point<2> &point) const
{
  const auto place = locator_.find(point);
  const DoFHandler<2>::active_cell_iterator cell(&dof_handler_.get_triangulation(),
                                                 place.cell->level(), place.cell->index(),
                                                 &dof_handler_);
  std::vector<types::global_dof_index> dofs(fe_.n_dofs_per_cell());
  cell->get_dof_indices(dofs);
  const auto &scalar = fe_.base_element(0);
  PointEvaluation result;
  for (unsigned int k = 0; k < scalar.n_dofs_per_cell(); ++k)
  {
    result.dof_x.push_back(dofs[fe_.component_to_system_index(0, k)]);
    result.dof_y.push_back(dofs[fe_.component_to_system_index(1, k)]);
    result.value.push_back(scalar.shape_value(k, place.unit));
  }
  return result;
}

PointEvaluation DisplacementSpace::vertex_values(const Point<2> &point) const
{
  const auto place = locator_.find(point);
  const DoFHandler<2>::active_cell_iterator cell(&dof_handler_.get_triangulation(),
                                                 place.cell->level(), place.cell->index(),
                                                 &dof_handler_);
  PointEvaluation result;
  for (const unsigned int v : cell->vertex_indices())
  {
    result.dof_x.push_back(cell->vertex_dof_index(v, 0));
    result.dof_y.push_back(cell->vertex_dof_index(v, 1));
    result.value.push_back(GeometryInfo<2>::d_linear_shape_function(place.unit, v));
  }
  return result;
}

TrilinosWrappers::SparseMatrix DisplacementSpace::make_matrix() const
{
  TrilinosWrappers::SparsityPattern pattern(
      locally_owned_, locally_owned_, locally_relevant_, dof_handler_.get_communicator());
  DoFTools::make_sparsity_pattern(
      dof_handler_, pattern, AffineConstraints<double>(), true,
      dof_handler_.get_triangulation().locally_owned_subdomain());
  for (const DofGroup &group : couplings_)
    for (const types::global_dof_index row : group)
      pattern.add_entries(row, group.begin(), group.end());
  pattern.compress();
  TrilinosWrappers::SparseMatrix matrix;
  matrix.reinit(pattern);
  return matrix;
}
} // namespace antiform::continuum

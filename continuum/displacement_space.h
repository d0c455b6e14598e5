#pragma once

#include "continuum/point_locator.h"

#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace antiform::continuum
{
using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

/// Dofs of which each is coupled with each, by something else than a cell.
using DofGroup = std::vector<dealii::types::global_dof_index>;

/// Shape functions at a point: the field there is sum_k value[k] u[dof_x[k]], and with
/// dof_y its y component.
struct PointEvaluation
{
  std::vector<dealii::types::global_dof_index> dof_x, dof_y;
  std::vector<double> value; ///< N_k(point) [-]
};

class HangingNodes;

/// The displacements of a body: two a node of Q1 or Q2 cells, their numbers, places and
/// vectors, whatever the material. Carries the body's share w_C(x) in a bridging domain.
/// Runs on any number of ranks; on one rank a dof's local index is its global one. A mesh
/// that is refined afterwards needs a new space.
class DisplacementSpace
{
public:
  /// \param weight w_C at a point, evaluated at quadrature points; empty: 1 everywhere
  DisplacementSpace(const dealii::parallel::distributed::Triangulation<2> &triangulation,
                    unsigned int degree,
                    std::function<double(const dealii::Point<2> &)> weight = {});

  const dealii::DoFHandler<2> &dof_handler() const { return dof_handler_; }
  unsigned int degree() const { return degree_; }
  const dealii::FESystem<2> &fe() const { return fe_; }
  /// w_C at a point [-].
  double weight(const dealii::Point<2> &point) const
  {
    return weight_ ? weight_(point) : 1.;
  }
  /// x or y (0, 1) of a global dof, and the place of its node.
  unsigned int component(dealii::types::global_dof_index dof) const;
  dealii::Point<2> support_point(dealii::types::global_dof_index dof) const;

  /// Shape functions of this mesh at a point; throws std::out_of_range if the point lies
  /// outside the cells that this rank knows by more than 1e-8 of a cell.
  PointEvaluation shape_values(const dealii::Point<2> &point) const;
  /// Bilinear functions of the cell's four vertices at a point, with the dofs of those
  /// vertices: the multiplier space, also under Q2 cells. Throws as shape_values().
  PointEvaluation vertex_values(const dealii::Point<2> &point) const;
  /// Whether the point lies in a cell that this rank knows.
  bool contains(const dealii::Point<2> &point) const { return locator_.contains(point); }

  /// Nodes on the edges of larger cells; null on a mesh without any.
  const HangingNodes *hanging_nodes() const { return hanging_nodes_.get(); }
  /// Set ghosts, and put hanging nodes on their edges. Collective.
  void make_continuous(Vector &displacement) const;

  /// A ghosted vector of this body's dofs, zero.
  Vector make_vector() const { return Vector(partitioner_); }
  /// A system matrix, zero, in which the dofs of each cell and those of each group are
  /// coupled, hanging ones as if they were free. Collective.
  dealii::TrilinosWrappers::SparseMatrix make_matrix() const;

  const dealii::IndexSet &locally_owned() const { return locally_owned_; }
  const dealii::IndexSet &locally_relevant() const { return locally_relevant_; }
  const dealii::Utilities::MPI::Partitioner &partitioner() const { return *partitioner_; }

protected:
  /// Let matrices couple the dofs of each of this rank's @p groups, and vectors know them
  /// here and where one of a group is owned. Vectors and matrices made before are not of
  /// this space any more, unless no rank has a group. Collective.
  void couple(const std::vector<DofGroup> &groups);

private:
  void make_dofs();
  void know_places();

  dealii::FESystem<2> fe_;
  dealii::DoFHandler<2> dof_handler_;
  unsigned int degree_;
  std::function<double(const dealii::Point<2> &)> weight_;
  dealii::IndexSet locally_owned_, locally_relevant_;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  std::vector<unsigned char> components_;        ///< per local dof, ghosts after owned
  std::vector<dealii::Point<2>> support_points_; ///< per local dof, ghosts after owned
  PointLocator locator_;
  std::shared_ptr<const HangingNodes> hanging_nodes_;
  std::vector<DofGroup> couplings_; ///< of this rank, beyond its cells
};
} // namespace antiform::continuum

#pragma once

#include "continuum/displacement_space.h"

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <utility>
#include <vector>

namespace antiform::continuum
{
/// Nodes of refined cells on the edge of a larger one, which must follow that edge:
/// u[hanging] = sum of factor times u[master]. Masters are the edge's own nodes and never
/// hang themselves (p4est keeps neighbours within one level).
///
/// Solvers stay in the numbers of all dofs: u = C v, where v of a hanging dof is its
/// distance from the edge, 0 in every continuous field. So it is a prescribed dof like
/// any other of C^T K C, whose rows need no special care.
class HangingNodes
{
public:
  /// Collective, as all that follows but dofs() and contains().
  explicit HangingNodes(const DisplacementSpace &space);

  /// Those that this rank knows, its own and ghosts.
  const dealii::IndexSet &dofs() const { return dofs_; }
  bool contains(const dealii::types::global_dof_index dof) const
  {
    return dofs_.is_element(dof);
  }
  /// On all ranks together.
  dealii::types::global_dof_index n_dofs() const { return n_dofs_; }

  /// C, in the numbers of all dofs.
  const dealii::TrilinosWrappers::SparseMatrix &map() const { return map_; }
  /// C^T A C [as A].
  dealii::TrilinosWrappers::SparseMatrix
  reduce(const dealii::TrilinosWrappers::SparseMatrix &matrix) const;
  /// Give what acts on hanging dofs to their masters [N]; owned entries, ghosts are 0.
  void move_to_masters(Vector &force) const;
  /// Put hanging nodes on their edges; ghosts are set.
  void put_on_edges(Vector &displacement) const;

private:
  struct Follower
  {
    unsigned int dof;                                     ///< local index, owned
    std::vector<std::pair<unsigned int, double>> masters; ///< local indices, factors
  };

  dealii::IndexSet dofs_;
  dealii::types::global_dof_index n_dofs_ = 0;
  std::vector<Follower> followers_; ///< that this rank owns
  dealii::TrilinosWrappers::SparseMatrix map_;
};
} // namespace antiform::continuum

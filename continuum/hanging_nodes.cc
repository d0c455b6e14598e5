#include "continuum/hanging_nodes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

namespace antiform::continuum
{
using namespace dealii;

HangingNodes::HangingNodes(const DisplacementSpace &space)
    : dofs_(space.dof_handler().n_dofs())
{
  AffineConstraints<double> edges(space.locally_relevant());
  DoFTools::make_hanging_node_constraints(space.dof_handler(), edges);
  edges.close();

  const MPI_Comm communicator = space.dof_handler().get_communicator();
  const IndexSet &owned = space.locally_owned();
  TrilinosWrappers::SparsityPattern pattern(owned, owned, communicator);
  for (const auto dof : owned)
    pattern.add(dof, dof);
  for (const auto dof : space.locally_relevant())
    if (edges.is_constrained(dof))
    {
      dofs_.add_index(dof);
      if (!owned.is_element(dof))
        continue;
      Follower follower{space.partitioner().global_to_local(dof), {}};
      for (const auto &[master, factor] : *edges.get_constraint_entries(dof))
      {
        pattern.add(dof, master);
        follower.masters.emplace_back(space.partitioner().global_to_local(master),
                                      factor);
      }
      followers_.push_back(std::move(follower));
    }
  dofs_.compress();
  n_dofs_ = Utilities::MPI::sum<types::global_dof_index>(followers_.size(), communicator);

  pattern.compress();
  map_.reinit(pattern);
  for (const auto dof : owned)
    map_.set(dof, dof, 1.);
  for (const Follower &follower : followers_)
    for (const auto &[master, factor] : follower.masters)
      map_.set(space.partitioner().local_to_global(follower.dof),
               space.partitioner().local_to_global(master), factor);
  map_.compress(VectorOperation::insert);
}

TrilinosWrappers::SparseMatrix
HangingNodes::reduce(const TrilinosWrappers::SparseMatrix &matrix) const
{
  TrilinosWrappers::SparseMatrix half, whole;
  matrix.mmult(half, map_);
  map_.Tmmult(whole, half);
  return whole;
}

void HangingNodes::move_to_masters(Vector &force) const
{
  force.zero_out_ghost_values();
  for (const Follower &follower : followers_)
  {
    const double moved = force.local_element(follower.dof);
    for (const auto &[master, factor] : follower.masters)
      force.local_element(master) += factor * moved;
    force.local_element(follower.dof) = 0.;
  }
  force.compress(VectorOperation::add);
}

void HangingNodes::put_on_edges(Vector &displacement) const
{
  displacement.update_ghost_values();
  for (const Follower &follower : followers_)
  {
    double on_edge = 0.;
    for (const auto &[master, factor] : follower.masters)
      on_edge += factor * displacement.local_element(master);
    displacement.local_element(follower.dof) = on_edge;
  }
  displacement.update_ghost_values();
}
} // namespace antiform::continuum

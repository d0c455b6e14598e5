#pragma once

#include "continuum/displacement_space.h"

#include <vector>

namespace antiform::continuum
{
/// Forces on the surface of a body that its displacements decide and its materials know
/// nothing of: a base it rests on, the touch of its parts (NonlinearSolid::add()). Like
/// materials they may remember the last accepted step. All members are collective.
class SurfaceForce
{
public:
  virtual ~SurfaceForce() = default;

  /// Whether the tangent is symmetric whatever the state.
  virtual bool has_symmetric_tangent() const = 0;

  /// The groups of dofs that this rank's forces couple beyond the cells. None by default.
  virtual std::vector<DofGroup> couplings() const { return {}; }

  /// \param displacement   at the end of the step, ghosts set [m]
  /// \param internal_force what the nodes must be pushed with to stay there is added
  ///                       (entries of any dof known here, to be compressed) [N]
  /// \param tangent        its derivative is added (likewise) [N/m]; may be null
  /// What a step remembers is kept until the next call or accept().
  virtual void add(const Vector &displacement,
                   Vector &internal_force,
                   dealii::TrilinosWrappers::SparseMatrix *tangent) = 0;

  /// The step that was added last is done: what it remembers is where the next begins.
  virtual void accept() {}

  /// Numbers that this rank remembers from the last accepted step, for a checkpoint;
  /// null: none.
  virtual std::vector<double> *history() { return nullptr; }
};
} // namespace antiform::continuum

#pragma once

#include "continuum/direct_solver.h"
#include "continuum/displacement_space.h"
#include "continuum/errors.h"

#include <deal.II/lac/trilinos_precondition.h>

#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace antiform::continuum
{
/// Prescribed displacements [m]. A rank gives those of the dofs that it knows (its own
/// and ghosts) or of all; each dof must be given by its owner or by a rank that has it as
/// a ghost.
using DirichletValues = std::map<dealii::types::global_dof_index, double>;

/// Add to @p values the displacement @p value(place) [m] of one component (0: x, 1: y) on
/// all nodes of the boundary faces with this id, as far as this rank knows them.
void prescribe(const DisplacementSpace &solid,
               dealii::types::boundary_id boundary,
               unsigned int component,
               const std::function<double(const dealii::Point<2> &)> &value,
               DirichletValues &values);

/// The values of all dofs that this rank knows, its own and ghosts, whichever rank gave
/// them. Collective.
DirichletValues complete(const DisplacementSpace &solid, const DirichletValues &values);

/// Solves K u = f with prescribed displacements, for a matrix that does not change while
/// the loads do: preconditioner or factor are made once. Hanging nodes follow their
/// edges, and their loads go to the nodes of these.
class StaticSolver
{
public:
  enum class Method
  {
    conjugate_gradients, ///< with algebraic multigrid (ML), translations as near-null
                         ///< space
    direct               ///< DirectSolver; K may be indefinite
  };
  struct Options
  {
    Method method = Method::conjugate_gradients;
    double tolerance =
        1e-10; ///< cg: residual over right-hand side; direct: backward error
    unsigned int max_iterations = 1000;
  };

  /// Takes the whole system matrix, with foundation and geometric stiffness; a reference
  /// to it is kept. Throws std::invalid_argument, on all ranks, where a hanging node is
  /// prescribed. Collective, as all that follows.
  StaticSolver(const DisplacementSpace &solid,
               const dealii::TrilinosWrappers::SparseMatrix &matrix,
               const DirichletValues &values,
               const Options &options);
  StaticSolver(const DisplacementSpace &solid,
               const dealii::TrilinosWrappers::SparseMatrix &matrix,
               const DirichletValues &values);

  /// New values for the dofs of the constructor.
  /// Throws std::invalid_argument, on all ranks, if others are given or some are missing.
  void set_values(const DirichletValues &values);

  /// Solve for @p displacement [m] under @p force [N]; its ghosts are set on return. Its
  /// former value is where conjugate gradients start. Returns the iterations (direct: 1).
  /// Throws NumericalError on all ranks without convergence.
  unsigned int solve(const Vector &force, Vector &displacement) const;

private:
  Vector spread_values(const DirichletValues &values) const;
  const dealii::TrilinosWrappers::SparseMatrix &system() const
  {
    return continuous_ ? *continuous_ : matrix_;
  }
  void eliminate_prescribed();
  unsigned int iterate(const Vector &rhs, Vector &displacement) const;
  void verify(const Vector &rhs, const Vector &displacement) const;

  const DisplacementSpace &solid_;
  const dealii::TrilinosWrappers::SparseMatrix &matrix_;
  Options options_;
  /// C^T K C (HangingNodes), whose hanging dofs are prescribed 0; null without any.
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> continuous_;
  Vector values_;                         ///< prescribed displacement, 0 elsewhere
  std::vector<unsigned char> prescribed_; ///< per local dof, ghosts after owned
  dealii::TrilinosWrappers::SparseMatrix reduced_;
  double norm_ = 0.; ///< largest row sum of the reduced matrix [N/m]
  std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG> preconditioner_;
  std::unique_ptr<DirectSolver> direct_;
};
} // namespace antiform::continuum

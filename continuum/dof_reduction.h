#pragma once

#include "continuum/elastic_solid.h"
#include "continuum/static_solver.h"

#include <vector>

namespace antiform::continuum
{
/// One displacement that others decide: u[dof] = sum of factor times u[master]. Masters
/// are not tied themselves.
struct Tie
{
  dealii::types::global_dof_index dof;
  std::vector<std::pair<dealii::types::global_dof_index, double>> masters;
};

/// The displacements of a body as a linear map of fewer unknowns, u = T q + u0: of
/// prescribed dofs u0 is the value, tied ones follow their masters, hanging nodes the
/// edge they lie on, each other dof is one q. A form u.K u becomes q.(T^T K T) q,
/// symmetric where K is.
class DofReduction
{
public:
  /// \param values prescribed displacements, as for StaticSolver: each by the rank that
  ///               owns the dof at least
  /// \param ties   each on the rank that owns the tied dof; masters anywhere. A tied dof
  ///               must not be prescribed, nor a master of another tie. None of these
  ///               dofs may hang; edges that others hang on may be tied and prescribed
  /// Throws std::invalid_argument on all ranks. Collective.
  DofReduction(const DisplacementSpace &space,
               const DirichletValues &values,
               const std::vector<Tie> &ties);

  /// Owned unknowns of all ranks together, numbered from 0 in order of ranks.
  const dealii::IndexSet &locally_owned() const { return owned_; }
  Vector make_vector() const
  {
    return Vector(owned_, space_.dof_handler().get_communicator());
  }

  /// T^T A T [as A].
  dealii::TrilinosWrappers::SparseMatrix
  reduce(const dealii::TrilinosWrappers::SparseMatrix &matrix) const;
  /// T^T f.
  Vector reduce(const Vector &force) const;
  /// T q + u0; ghosts are set. @p homogeneous without u0.
  Vector expand(const Vector &unknowns, bool homogeneous = false) const;
  /// u0: prescribed displacements, and what ties make of them.
  const Vector &prescribed() const { return prescribed_; }

private:
  const DisplacementSpace &space_;
  dealii::IndexSet owned_;
  dealii::TrilinosWrappers::SparseMatrix map_; ///< T
  Vector prescribed_;
};

/// Displacements in equilibrium with @p force [N] on the reduced unknowns, by one direct
/// solve (KLU on one rank for small problems, else MUMPS): for a body whose parts slide
/// on one another. Throws NumericalError on all ranks where the matrix is singular.
Vector solve_reduced(const ElasticSolid &solid,
                     const DofReduction &reduction,
                     const Vector &force);
} // namespace antiform::continuum

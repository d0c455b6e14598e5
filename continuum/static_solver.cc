#include "continuum/static_solver.h"

#include "continuum/hanging_nodes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/solver_cg.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
/// Share of the load that a factor may leave unbalanced: round-off times the condition of
/// slender strips (some 1e12), and far below that of a singular matrix, 1.
constexpr double largest_rest = 1e-3;

constexpr double unset = std::numeric_limits<double>::lowest();

/// Values of the dofs known here, whichever rank gave them; `unset` for the others.
Vector spread(const DisplacementSpace &solid, const DirichletValues &values)
{
  Vector result = solid.make_vector();
  const auto &partitioner = *result.get_partitioner();
  const unsigned int n_owned = partitioner.locally_owned_size();
  for (unsigned int i = 0; i < n_owned + partitioner.n_ghost_indices(); ++i)
    result.local_element(i) = unset;
  for (const auto &[dof, value] : values)
    if (partitioner.in_local_range(dof) || partitioner.is_ghost_entry(dof))
      result.local_element(partitioner.global_to_local(dof)) = value;
  result.compress(VectorOperation::max);
  result.update_ghost_values();
  return result;
}
} // namespace

void prescribe(const DisplacementSpace &solid,
               const types::boundary_id boundary,
               const unsigned int component,
               const std::function<double(const Point<2> &)> &value,
               DirichletValues &values)
{
  const auto &fe = solid.fe();
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_face());
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f) && cell->face(f)->boundary_id() == boundary)
        {
          cell->face(f)->get_dof_indices(dofs);
          for (unsigned int i = 0; i < dofs.size(); ++i)
            if (fe.face_system_to_component_index(i, f).first == component)
              values[dofs[i]] = value(solid.support_point(dofs[i]));
        }
}

DirichletValues complete(const DisplacementSpace &solid, const DirichletValues &values)
{
  const Vector all = spread(solid, values);
  const auto &partitioner = *all.get_partitioner();
  DirichletValues result;
  const unsigned int n_local =
      partitioner.locally_owned_size() + partitioner.n_ghost_indices();
  for (unsigned int i = 0; i < n_local; ++i)
    if (all.local_element(i) != unset)
      result[partitioner.local_to_global(i)] = all.local_element(i);
  return result;
}

StaticSolver::StaticSolver(const DisplacementSpace &solid,
                           const TrilinosWrappers::SparseMatrix &matrix,
                           const DirichletValues &values)
    : StaticSolver(solid, matrix, values, Options())
{
}

StaticSolver::StaticSolver(const DisplacementSpace &solid,
                           const TrilinosWrappers::SparseMatrix &matrix,
                           const DirichletValues &values,
                           const Options &options)
    : solid_(solid)
    , matrix_(matrix)
    , options_(options)
    , values_(spread_values(values))
{
  if (solid.hanging_nodes() != nullptr)
    continuous_ = std::make_unique<TrilinosWrappers::SparseMatrix>(
        solid.hanging_nodes()->reduce(matrix));
  const unsigned int n_local =
      values_.locally_owned_size() + values_.get_partitioner()->n_ghost_indices();
  prescribed_.resize(n_local);
  for (unsigned int i = 0; i < n_local; ++i)
  {
    prescribed_[i] = values_.local_element(i) != unset;
    if (!prescribed_[i])
      values_.local_element(i) = 0.;
  }
  eliminate_prescribed();

  if (options_.method == Method::direct)
  {
    direct_ = std::make_unique<DirectSolver>(reduced_);
    return;
  }
  TrilinosWrappers::PreconditionAMG::AdditionalData settings;
  DoFTools::extract_constant_modes(solid.dof_handler(), ComponentMask(2, true),
                                   settings.constant_modes);
  settings.elliptic = true;
  settings.higher_order_elements = solid.degree() > 1;
  settings.smoother_sweeps = 2;
  settings.aggregation_threshold = 0.02;
  preconditioner_ = std::make_unique<TrilinosWrappers::PreconditionAMG>();
  preconditioner_->initialize(reduced_, settings);
}

/// As spread(), with 0 for hanging dofs.
Vector StaticSolver::spread_values(const DirichletValues &values) const
{
  Vector result = spread(solid_, values);
  if (solid_.hanging_nodes() == nullptr)
    return result;
  unsigned int n_wrong = 0;
  for (const auto dof : solid_.hanging_nodes()->dofs())
  {
    double &value = result.local_element(result.get_partitioner()->global_to_local(dof));
    n_wrong += value != unset;
    value = 0.;
  }
  if (Utilities::MPI::max(n_wrong, solid_.dof_handler().get_communicator()) > 0)
    throw std::invalid_argument(
        "static solver: a displacement is prescribed at a node that hangs on the edge of "
        "a larger cell; prescribe those of the edge.");
  return result;
}

void StaticSolver::set_values(const DirichletValues &values)
{
  Vector fresh = spread_values(values);
  unsigned int n_wrong = 0;
  for (unsigned int i = 0; i < prescribed_.size(); ++i)
  {
    n_wrong += (fresh.local_element(i) != unset) != static_cast<bool>(prescribed_[i]);
    if (!prescribed_[i])
      fresh.local_element(i) = 0.;
  }
  n_wrong = Utilities::MPI::max(n_wrong, solid_.dof_handler().get_communicator());
  if (n_wrong > 0)
    throw std::invalid_argument(
        "static solver: " + std::to_string(n_wrong) +
        " displacements are prescribed now and were not before, or "
        "the reverse; make a new solver for another set.");
  values_ = fresh;
}

/// reduced_: rows and columns of prescribed dofs emptied but for the diagonal, which
/// keeps the symmetry and the scale of the matrix.
void StaticSolver::eliminate_prescribed()
{
  reduced_.copy_from(system());
  const Epetra_CrsMatrix &matrix = reduced_.trilinos_matrix();
  // Columns may be of dofs beyond the ghosts: a hanging node's masters.
  Epetra_Vector own(matrix.DomainMap()), is_prescribed(matrix.ColMap());
  for (int i = 0; i < own.MyLength(); ++i)
    own[i] = prescribed_[i];
  is_prescribed.Import(own, Epetra_Import(matrix.ColMap(), matrix.DomainMap()), Insert);
  for (int row = 0; row < matrix.NumMyRows(); ++row)
  {
    int n = 0, *columns = nullptr;
    double *entries = nullptr;
    matrix.ExtractMyRowView(row, n, entries, columns);
    double sum = 0.;
    for (int k = 0; k < n; ++k)
    {
      if ((prescribed_[row] || is_prescribed[columns[k]] != 0.) &&
          matrix.GCID(columns[k]) != matrix.GRID(row))
        entries[k] = 0.;
      sum += std::abs(entries[k]);
    }
    norm_ = std::max(norm_, sum);
  }
  norm_ = Utilities::MPI::max(norm_, solid_.dof_handler().get_communicator());
}

unsigned int StaticSolver::solve(const Vector &force, Vector &displacement) const
{
  Vector rhs = solid_.make_vector();
  system().vmult(rhs, values_);
  if (continuous_)
  {
    Vector of_masters = force;
    solid_.hanging_nodes()->move_to_masters(of_masters);
    rhs.sadd(-1., 1., of_masters);
  }
  else
    rhs.sadd(-1., 1., force);
  for (unsigned int i = 0; i < rhs.locally_owned_size(); ++i)
    if (prescribed_[i])
    {
      const types::global_dof_index dof = rhs.get_partitioner()->local_to_global(i);
      rhs.local_element(i) = reduced_.diag_element(dof) * values_.local_element(i);
      displacement.local_element(i) = values_.local_element(i);
    }

  unsigned int iterations = 1;
  displacement.zero_out_ghost_values();
  if (direct_)
    direct_->solve(rhs, displacement);
  else
    iterations = iterate(rhs, displacement);
  verify(rhs, displacement);
  solid_.make_continuous(displacement);
  return iterations;
}

unsigned int StaticSolver::iterate(const Vector &rhs, Vector &displacement) const
{
  const double limit = options_.tolerance * rhs.l2_norm();
  SolverControl control(options_.max_iterations, limit);
  SolverCG<Vector> solver(control);
  try
  {
    solver.solve(reduced_, displacement, rhs, *preconditioner_);
  }
  catch (const SolverControl::NoConvergence &problem)
  {
    throw NumericalError("static solver",
                         "no convergence in " + std::to_string(problem.last_step) +
                             " iterations; a part without support, a load above the "
                             "buckling load, or too strong a contrast: try the direct "
                             "solver. Residual [N]",
                         problem.last_residual, limit);
  }
  return control.last_step();
}

/// Throw unless the equations hold. Conjugate gradients are asked too: the residual that
/// they carry along departs from the true one when the matrix is singular.
void StaticSolver::verify(const Vector &rhs, const Vector &displacement) const
{
  Vector residual = solid_.make_vector();
  reduced_.vmult(residual, displacement);
  residual -= rhs;
  // A singular matrix shows as a load that is not carried: the solution is then so large
  // that the backward error alone would pass it.
  const double load = rhs.l2_norm(), rest = residual.l2_norm();
  if (!(rest <= largest_rest * load)) // also for not-a-number
    DirectSolver::refuse_singular(rest / load, largest_rest);
  const double scale = load + norm_ * displacement.l2_norm();
  if (rest > options_.tolerance * scale)
    DirectSolver::refuse_singular(rest / scale, options_.tolerance);
}
} // namespace antiform::continuum

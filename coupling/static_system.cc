#include "coupling/static_system.h"

#include "continuum/errors.h"

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace antiform::coupling
{
namespace
{
/// Symmetric system in triplets, with fixed unknowns moved to the right-hand side.
struct Triplets
{
  std::vector<Eigen::Triplet<double>> entries;
  void add(const std::size_t row, const std::size_t column, const double value)
  {
    if (value != 0.)
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  }
};

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

[[noreturn]] void refuse(const double value, const double limit)
{
  throw NumericalError("static solve",
                       "the system matrix is singular: a grain or a part of the section "
                       "has no path to a support",
                       value, limit);
}

/// Estimate of the 1-norm of the inverse of a symmetric matrix (Hager 1984): the largest
/// column that a few solves find.
template <class Solve>
double inverse_norm(const Eigen::Index n, const Solve &solve)
{
  Eigen::VectorXd x = Eigen::VectorXd::Constant(n, 1. / static_cast<double>(n));
  double norm = 0.;
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    const Eigen::VectorXd y = solve(x);
    norm = std::max(norm, y.lpNorm<1>());
    const Eigen::VectorXd z =
        solve(y.unaryExpr([](const double v) { return v < 0. ? -1. : 1.; }));
    Eigen::Index largest = 0;
    if (z.cwiseAbs().maxCoeff(&largest) <= z.dot(x))
      break;
    x = Eigen::VectorXd::Unit(n, largest);
  }
  return norm;
}

std::vector<double> solve_direct(const Matrix &matrix, const Eigen::VectorXd &right)
{
  const int n = static_cast<int>(matrix.rows());
  const Epetra_MpiComm comm(MPI_COMM_SELF);
  const Epetra_Map map(n, 0, comm);
  Epetra_CrsMatrix system(Copy, map, 0);
  for (int row = 0; row < n; ++row)
  {
    const int begin = matrix.outerIndexPtr()[row], end = matrix.outerIndexPtr()[row + 1];
    system.InsertGlobalValues(row, end - begin, matrix.valuePtr() + begin,
                              matrix.innerIndexPtr() + begin);
  }
  system.FillComplete();
  Epetra_Vector b(map), x(map);
  const Epetra_LinearProblem problem(&system, &x, &b);
  // MUMPS: KLU prefers diagonal pivots, which the multipliers do not have; on random
  // packings its factors are useless (residuals up to 0.5), and fill twenty times slower.
  const std::unique_ptr<Amesos_BaseSolver> solver(
      Amesos().Create("Amesos_Mumps", problem));
  Teuchos::ParameterList parameters;
  parameters.sublist("mumps").set("ICNTL(14)", 100); // [%] space for delayed pivots
  solver->SetParameters(parameters);
  const auto solve = [&](const Eigen::VectorXd &rhs) -> Eigen::VectorXd
  {
    std::copy(rhs.data(), rhs.data() + n, &b[0]);
    if (solver->Solve() != 0)
      refuse(n, 0.);
    return Eigen::Map<const Eigen::VectorXd>(&x[0], n);
  };
  if (solver->SymbolicFactorization() != 0 || solver->NumericFactorization() != 0)
    refuse(n, 0.);
  // Pivots of round-off pass for numbers: a floating part shows in the condition only.
  const double condition = inverse_norm(n, solve) * system.NormOne();
  if (!(condition < 1e15)) // no digit of the solution would be right
    refuse(condition, 1e15);
  // Refinement: a stiffness contrast of 1e4 costs the first solution some of its digits.
  Eigen::VectorXd solution = solve(right);
  for (int pass = 0; pass < 3; ++pass)
    solution += solve(right - matrix * solution);
  return {solution.data(), solution.data() + n};
}
} // namespace

std::array<std::array<double, 6>, 3> joint_rows(const discrete::Joints &joints,
                                                const std::size_t j)
{
  const double nx = joints.normal_x[j], ny = joints.normal_y[j];
  const double r1 = 0.5 * (joints.length[j] - joints.lever_difference[j]);
  const double r2 = 0.5 * (joints.length[j] + joints.lever_difference[j]);
  return {{{-nx, -ny, 0., nx, ny, 0.},
           {ny, -nx, -r1, -ny, nx, -r2},
           {0., 0., -1., 0., 0., 1.}}};
}

std::array<double, 3> joint_stiffness(const discrete::Joints &joints, const std::size_t j)
{
  const discrete::BondConstants bond = discrete::constants(joints.group_of(j).law);
  const double full = 2. * joints.half_length[j];
  const double normal =
      joints.stiffness[j] * full * (joints.weight.empty() ? 1. : joints.weight[j]);
  return {normal, normal / bond.stiffness_ratio,
          normal * full * full * bond.moment_factor};
}

StaticSystem::StaticSystem(const discrete::Grains &grains,
                           const discrete::Joints &joints,
                           const continuum::ElasticSolid *solid,
                           const BridgingDomain *bridging)
    : grains_(grains)
    , joints_(joints)
    , solid_(solid)
    , bridging_(bridging)
{
  const std::size_t n =
      mesh_begin() + (solid != nullptr ? solid->dof_handler().n_dofs() : 0);
  spring_.assign(n, 0.);
  force_.assign(n, 0.);
}

void StaticSystem::fix_grain(const std::size_t grain,
                             const unsigned int component,
                             const double value)
{
  fixed_[index(grain, component)] = value;
}
void StaticSystem::fix_mesh(const std::size_t dof, const double value)
{
  fixed_[mesh_begin() + dof] = value;
}
void StaticSystem::add_grain_spring(const std::size_t grain,
                                    const unsigned int component,
                                    const double stiffness)
{
  spring_[index(grain, component)] += stiffness;
}
void StaticSystem::add_pair_spring(const std::size_t one,
                                   const std::size_t two,
                                   const Vec2 &normal,
                                   const double stiffness)
{
  pair_springs_.push_back({one, two, normal, stiffness});
}
StaticSystem::Terms StaticSystem::terms(const LinearForm &form) const
{
  Terms all;
  for (const LinearForm::GrainTerm &term : form.grains)
    all.emplace_back(index(term.grain, term.component), term.value);
  for (const LinearForm::MeshTerm &term : form.mesh)
    all.emplace_back(mesh_begin() + term.dof, term.value);
  return all;
}
void StaticSystem::add_spring(const LinearForm &elongation, const double stiffness)
{
  form_springs_.emplace_back(terms(elongation), stiffness);
}
void StaticSystem::add_constraint(const LinearForm &form)
{
  constraints_.push_back(terms(form));
}
void StaticSystem::add_grain_force(const std::size_t grain,
                                   const unsigned int component,
                                   const double force)
{
  force_[index(grain, component)] += force;
}
void StaticSystem::add_mesh_force(const std::size_t dof, const double force)
{
  force_[mesh_begin() + dof] += force;
}

std::vector<std::pair<std::size_t, double>>
StaticSystem::tie_row(const GrainTie &tie, const unsigned int component) const
{
  std::vector<std::pair<std::size_t, double>> row{{index(tie.grain, component), 1.}};
  for (const GrainTie::Node &node : tie.nodes)
    if (component < 2)
      row.emplace_back(mesh_begin() + (component == 0 ? node.dof_x : node.dof_y),
                       -node.value);
    else
    {
      row.emplace_back(mesh_begin() + node.dof_x, 0.5 * node.by_y);
      row.emplace_back(mesh_begin() + node.dof_y, -0.5 * node.by_x);
    }
  return row;
}

SaddlePoint StaticSystem::saddle_point() const
{
  const std::size_t n_primal = n_unknowns();
  const std::size_t n_rows = bridging_ != nullptr ? bridging_->grain_rows().n_rows() : 0;
  const std::size_t n_ties = bridging_ != nullptr ? bridging_->ties().ties().size() : 0;
  const std::size_t forms_begin = 2 * n_rows + 3 * n_ties;

  Triplets all;
  for (std::size_t j = 0; j < joints_.size(); ++j)
  {
    const auto rows = joint_rows(joints_, j);
    const auto stiffness = joint_stiffness(joints_, j);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
      {
        double value = 0.;
        for (int r = 0; r < 3; ++r)
          value += rows[r][a] * stiffness[r] * rows[r][b];
        all.add(index(a < 3 ? joints_.first[j] : joints_.second[j], a % 3),
                index(b < 3 ? joints_.first[j] : joints_.second[j], b % 3), value);
      }
  }
  for (std::size_t i = 0; i < n_primal; ++i)
    all.add(i, i, spring_[i]);
  for (const PairSpring &pair : pair_springs_)
  {
    const std::array<double, 4> row{-pair.normal.x, -pair.normal.y, pair.normal.x,
                                    pair.normal.y};
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < 4; ++b)
        all.add(index(a < 2 ? pair.one : pair.two, a % 2),
                index(b < 2 ? pair.one : pair.two, b % 2),
                pair.stiffness * row[a] * row[b]);
  }
  for (const auto &[row, stiffness] : form_springs_)
    for (const auto &[a, value_a] : row)
      for (const auto &[b, value_b] : row)
        all.add(a, b, stiffness * value_a * value_b);
  if (solid_ != nullptr)
    for (auto row = 0u; row < solid_->dof_handler().n_dofs(); ++row)
      for (auto it = solid_->stiffness().begin(row); it != solid_->stiffness().end(row);
           ++it)
        all.add(mesh_begin() + row, mesh_begin() + it->column(), it->value());

  // Each constraint row is scaled to the mean diagonal of the stiffness.
  double diagonal = 0.;
  for (const auto &entry : all.entries)
    if (entry.row() == entry.col())
      diagonal += entry.value();
  diagonal /= static_cast<double>(n_primal);
  Triplets constraint;
  if (bridging_ != nullptr)
  {
    const std::vector<std::int32_t> &overlap = bridging_->overlap_grains();
    const SparseRows &of_grains = bridging_->grain_rows(),
                     &of_mesh = bridging_->mesh_rows();
    for (std::size_t r = 0; r < n_rows; ++r)
    {
      double mass = 0.;
      for (std::int32_t k = of_grains.begin[r]; k < of_grains.begin[r + 1]; ++k)
        mass += of_grains.value[k];
      const double scale = diagonal / mass;
      for (const unsigned int c : {0u, 1u})
      {
        const std::size_t row = c * n_rows + r;
        for (std::int32_t k = of_grains.begin[r]; k < of_grains.begin[r + 1]; ++k)
          constraint.add(row, index(overlap[of_grains.column[k]], c),
                   scale * of_grains.value[k]);
        for (std::int32_t k = of_mesh.begin[r]; k < of_mesh.begin[r + 1]; ++k)
          constraint.add(row, mesh_begin() + bridging_->node_dofs()[of_mesh.column[k]][c],
                   scale * of_mesh.value[k]);
      }
    }
  }
  for (std::size_t r = 0; r < constraints_.size(); ++r)
    for (const auto &[column, value] : constraints_[r])
      constraint.add(forms_begin + r, column, diagonal * value);
  for (std::size_t t = 0; t < n_ties; ++t)
    for (const unsigned int c : {0u, 1u, 2u})
      for (const auto &[column, value] : tie_row(bridging_->ties().ties()[t], c))
        constraint.add(2 * n_rows + 3 * t + c, column, diagonal * value);

  SaddlePoint result;
  result.diagonal = diagonal;
  const auto n = static_cast<Eigen::Index>(n_primal),
             m = static_cast<Eigen::Index>(forms_begin + constraints_.size());
  result.stiffness.resize(n, n);
  result.stiffness.setFromTriplets(all.entries.begin(), all.entries.end());
  result.constraint.resize(m, n);
  result.constraint.setFromTriplets(constraint.entries.begin(), constraint.entries.end());
  return result;
}

StaticSolution StaticSystem::solve() const
{
  const SaddlePoint parts = saddle_point();
  const auto n_primal = static_cast<std::size_t>(parts.stiffness.rows());
  const std::size_t n = n_primal + static_cast<std::size_t>(parts.constraint.rows());
  Triplets all;
  for (Eigen::Index row = 0; row < parts.stiffness.rows(); ++row)
    for (Matrix::InnerIterator it(parts.stiffness, row); it; ++it)
      all.add(row, it.col(), it.value());
  for (Eigen::Index row = 0; row < parts.constraint.rows(); ++row)
    for (Matrix::InnerIterator it(parts.constraint, row); it; ++it)
    {
      all.add(n_primal + row, it.col(), it.value());
      all.add(it.col(), n_primal + row, it.value());
    }

  // Fixed unknowns: identity rows, their columns to the right-hand side.
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n_primal; ++i)
    right[static_cast<Eigen::Index>(i)] = force_[i];
  std::vector<Eigen::Triplet<double>> free;
  free.reserve(all.entries.size());
  for (const auto &entry : all.entries)
  {
    const auto row = fixed_.find(entry.row()), column = fixed_.find(entry.col());
    if (row != fixed_.end())
      continue;
    if (column != fixed_.end())
      right[entry.row()] -= entry.value() * column->second;
    else
      free.push_back(entry);
  }
  for (const auto &[i, value] : fixed_)
  {
    free.emplace_back(static_cast<int>(i), static_cast<int>(i), parts.diagonal);
    right[static_cast<Eigen::Index>(i)] = parts.diagonal * value;
  }
  Matrix matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.setFromTriplets(free.begin(), free.end());
  const std::vector<double> x = solve_direct(matrix, right);

  const Eigen::Map<const Eigen::VectorXd> solution(x.data(),
                                                   static_cast<Eigen::Index>(n));
  const double scale = std::max(right.cwiseAbs().maxCoeff(),
                                (matrix.cwiseAbs() * solution.cwiseAbs()).maxCoeff());
  StaticSolution result = solution_of(solution.head(parts.stiffness.rows()));
  result.residual =
      scale > 0. ? (matrix * solution - right).cwiseAbs().maxCoeff() / scale : 0.;
  if (!(result.residual < 1e-8))
    throw NumericalError(
        "static solve",
        "the direct solution does not satisfy its equations: part of the "
        "section has no path to a support",
        result.residual, 1e-8);
  return result;
}

StaticSolution StaticSystem::solution_of(const Eigen::VectorXd &x) const
{
  StaticSolution result;
  const auto at = [&x](const std::size_t i) { return x[static_cast<Eigen::Index>(i)]; };
  for (std::size_t i = 0; i < grains_.size(); ++i)
  {
    result.ux.push_back(at(index(i, 0)));
    result.uy.push_back(at(index(i, 1)));
    result.rotation.push_back(at(index(i, 2)));
  }
  if (solid_ != nullptr)
  {
    result.mesh = solid_->make_vector();
    for (std::size_t d = 0; d < solid_->dof_handler().n_dofs(); ++d)
      result.mesh(d) = at(mesh_begin() + d);
    result.mesh.update_ghost_values();
  }
  return result;
}
} // namespace antiform::coupling

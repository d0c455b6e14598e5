#include "coupling/static_system.h"

#include "continuum/errors.h"

#include "coupling/distributed_system.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/map.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

Eigen::VectorXd sum_over_ranks(Eigen::VectorXd share,
                               const MPI_Comm communicator)
{
  if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
    MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(share.size()), MPI_DOUBLE,
                  MPI_SUM, communicator);
  return share;
}

/// \param matrix,right shares of this rank, which has @p own_rows
/// \return the whole solution
Eigen::VectorXd solve_direct(const Matrix &matrix,
                             const Eigen::VectorXd &right,
                             const std::vector<int> &own_rows,
                             const MPI_Comm communicator)
{
  // MUMPS: KLU prefers diagonal pivots, which the multipliers do not have; on random
  // packings its factors are useless (residuals up to 0.5), and fill twenty times slower.
  DistributedSystem system(matrix, own_rows, communicator);
  const Eigen::Index n = matrix.rows();
  const auto solve = [&](Eigen::VectorXd share) -> Eigen::VectorXd
  {
    if (!system.solve(share.data()))
      refuse(static_cast<double>(n), 0.);
    return share;
  };
  if (!system.factorise())
    refuse(static_cast<double>(n), 0.);
  // Pivots of round-off pass for numbers: a floating part shows in the condition only.
  const bool first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  const auto solve_whole = [&](const Eigen::VectorXd &rhs)
  { return solve(first ? rhs : Eigen::VectorXd(Eigen::VectorXd::Zero(n))); };
  const double condition = inverse_norm(n, solve_whole) * system.norm_one();
  if (!(condition < 1e15)) // no digit of the solution would be right
    refuse(condition, 1e15);
  // Refinement: a stiffness contrast of 1e4 costs the first solution some of its digits.
  Eigen::VectorXd solution = solve(right);
  for (int pass = 0; pass < 3; ++pass)
    solution += solve(right - matrix * solution);
  return solution;
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
    , communicator_(solid != nullptr ? solid->dof_handler().get_communicator()
                                     : MPI_COMM_SELF)
    , tells_grains_(dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
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
void StaticSystem::demand_one_rank() const
{
  if (dealii::Utilities::MPI::n_mpi_processes(communicator_) > 1)
    throw std::invalid_argument("static system: linear forms are for one rank");
}
void StaticSystem::add_spring(const LinearForm &elongation, const double stiffness)
{
  demand_one_rank();
  form_springs_.emplace_back(terms(elongation), stiffness);
}
void StaticSystem::add_constraint(const LinearForm &form)
{
  demand_one_rank();
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
  std::vector<std::pair<std::size_t, double>> row;
  if (tells_grains_)
    row.emplace_back(index(tie.grain, component), 1.);
  const auto at = [this](const std::uint32_t local)
  { return mesh_begin() + solid_->partitioner().local_to_global(local); };
  for (const GrainTie::Node &node : tie.nodes)
    if (component < 2)
      row.emplace_back(at(component == 0 ? node.dof_x : node.dof_y), -node.value);
    else
    {
      row.emplace_back(at(node.dof_x), 0.5 * node.by_y);
      row.emplace_back(at(node.dof_y), -0.5 * node.by_x);
    }
  return row;
}

std::size_t StaticSystem::ties_begin() const
{
  return bridging_ != nullptr ? bridging_->n_multipliers() : 0;
}
std::size_t StaticSystem::forms_begin() const
{
  return ties_begin() +
         (bridging_ != nullptr ? 3 * bridging_->ties().ties().size() : 0);
}

SaddlePoint StaticSystem::saddle_point() const
{
  Triplets all;
  if (tells_grains_)
    all.entries = grain_stiffness();
  if (solid_ != nullptr)
    for (const auto row : solid_->locally_owned())
      for (auto it = solid_->stiffness().begin(row); it != solid_->stiffness().end(row);
           ++it)
        all.add(mesh_begin() + row, mesh_begin() + it->column(), it->value());

  double diagonal = 0.;
  for (const auto &entry : all.entries)
    if (entry.row() == entry.col())
      diagonal += entry.value();
  diagonal = dealii::Utilities::MPI::sum(diagonal, communicator_) /
             static_cast<double>(n_unknowns());

  SaddlePoint result;
  result.diagonal = diagonal;
  const auto n = static_cast<Eigen::Index>(n_unknowns());
  result.stiffness.resize(n, n);
  result.stiffness.setFromTriplets(all.entries.begin(), all.entries.end());
  result.constraint = constraint_share(diagonal);
  return result;
}

std::vector<Eigen::Triplet<double>> StaticSystem::grain_stiffness() const
{
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
  for (std::size_t i = 0; i < n_unknowns(); ++i)
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
  return all.entries;
}

SaddlePoint::Matrix StaticSystem::constraint_share(const double diagonal) const
{
  Triplets constraint;
  if (bridging_ != nullptr)
  {
    const std::vector<std::int32_t> &overlap = bridging_->overlap_grains();
    const SparseRows &of_grains = bridging_->grain_rows(),
                     &of_mesh = bridging_->mesh_rows();
    const std::size_t n_rows = of_grains.n_rows();
    for (std::size_t r = 0; r < n_rows; ++r)
    {
      double mass = 0.;
      for (std::int32_t k = of_grains.begin[r]; k < of_grains.begin[r + 1]; ++k)
        mass += of_grains.value[k];
      const double scale = diagonal / mass; // to the mean diagonal of the stiffness
      for (const unsigned int c : {0u, 1u})
      {
        const std::size_t row = c * n_rows + r;
        if (bridging_->owns_row(r))
          for (std::int32_t k = of_grains.begin[r]; k < of_grains.begin[r + 1]; ++k)
            constraint.add(row, index(overlap[of_grains.column[k]], c),
                           scale * of_grains.value[k]);
        for (std::int32_t k = of_mesh.begin[r]; k < of_mesh.begin[r + 1]; ++k)
          constraint.add(row,
                         mesh_begin() + solid_->partitioner().local_to_global(
                                            bridging_->node_dofs()[of_mesh.column[k]][c]),
                         scale * of_mesh.value[k]);
      }
    }
    const std::vector<GrainTie> &ties = bridging_->ties().ties();
    for (std::size_t t = 0; t < ties.size(); ++t)
      for (const unsigned int c : {0u, 1u, 2u})
        for (const auto &[column, value] : tie_row(ties[t], c))
          constraint.add(ties_begin() + 3 * t + c, column, diagonal * value);
  }
  for (std::size_t r = 0; r < constraints_.size(); ++r)
    for (const auto &[column, value] : constraints_[r])
      constraint.add(forms_begin() + r, column, diagonal * value);
  const std::size_t n_constraints = forms_begin() + constraints_.size();
  SaddlePoint::Matrix share(static_cast<Eigen::Index>(n_constraints),
                            static_cast<Eigen::Index>(n_unknowns()));
  share.setFromTriplets(constraint.entries.begin(), constraint.entries.end());
  return share;
}

std::map<std::size_t, double> StaticSystem::all_fixed() const
{
  if (dealii::Utilities::MPI::n_mpi_processes(communicator_) == 1)
    return fixed_;
  std::map<std::size_t, double> all;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator_, fixed_))
    all.insert(of_rank.begin(), of_rank.end());
  return all;
}

std::vector<int> StaticSystem::own_unknowns(const std::size_t n_constraints) const
{
  std::vector<int> own;
  if (tells_grains_)
    for (std::size_t i = 0; i < mesh_begin(); ++i)
      own.push_back(static_cast<int>(i));
  if (solid_ != nullptr)
    for (const auto dof : solid_->locally_owned())
      own.push_back(static_cast<int>(mesh_begin() + dof));
  const std::size_t n_rows = ties_begin() / 2;
  for (std::size_t r = 0; r < n_constraints; ++r)
    if (r < ties_begin() ? bridging_->owns_row(r % n_rows) : tells_grains_)
      own.push_back(static_cast<int>(n_unknowns() + r));
  return own;
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
  const std::map<std::size_t, double> all_fixed = this->all_fixed();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (std::size_t i = tells_grains_ ? 0 : mesh_begin(); i < n_primal; ++i)
    right[static_cast<Eigen::Index>(i)] = force_[i];
  for (const auto &fixed : all_fixed)
    right[static_cast<Eigen::Index>(fixed.first)] = 0.;
  std::vector<Eigen::Triplet<double>> free;
  free.reserve(all.entries.size());
  for (const auto &entry : all.entries)
  {
    const auto row = all_fixed.find(entry.row()), column = all_fixed.find(entry.col());
    if (row != all_fixed.end())
      continue;
    if (column != all_fixed.end())
      right[entry.row()] -= entry.value() * column->second;
    else
      free.push_back(entry);
  }
  if (tells_grains_)
    for (const auto &[i, value] : all_fixed)
    {
      free.emplace_back(static_cast<int>(i), static_cast<int>(i), parts.diagonal);
      right[static_cast<Eigen::Index>(i)] = parts.diagonal * value;
    }
  Matrix matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.setFromTriplets(free.begin(), free.end());
  const Eigen::VectorXd solution =
      solve_direct(matrix, right, own_unknowns(n - n_primal), communicator_);

  const Eigen::VectorXd load = sum_over_ranks(right, communicator_),
                        sizes =
                            sum_over_ranks(matrix.cwiseAbs() * solution.cwiseAbs(),
                                           communicator_),
                        rest =
                            sum_over_ranks(matrix * solution - right, communicator_);
  const double scale = std::max(load.cwiseAbs().maxCoeff(), sizes.maxCoeff());
  StaticSolution result = solution_of(solution.head(parts.stiffness.rows()));
  result.residual = scale > 0. ? rest.cwiseAbs().maxCoeff() / scale : 0.;
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
    for (const auto dof : solid_->locally_owned())
      result.mesh(dof) = at(mesh_begin() + dof);
    result.mesh.update_ghost_values();
  }
  return result;
}
} // namespace antiform::coupling

#include "coupling/coupled_buckling.h"

#include "continuum/errors.h"
#include "continuum/linear_buckling.h"
#include "coupling/symmetric_factor.h"

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_MultiVector.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace antiform::coupling
{
namespace
{
using Eigen::VectorXd;
using FreeEntry = Eigen::Triplet<double>;

/// K, C and G on the unknowns that no support prescribes.
struct FreeSystem
{
  SparseMatrix K, C, G;
  std::vector<Eigen::Index> unknown; ///< of each free one
  double diagonal;                   ///< to which the constraint is scaled

  FreeSystem(const StaticSystem &system, const SparseMatrix &geometric)
  {
    const SaddlePoint all = system.saddle_point();
    diagonal = all.diagonal;
    std::vector<int> number(system.n_unknowns(), -1);
    for (std::size_t i = 0; i < number.size(); ++i)
      if (system.fixed().count(i) == 0)
      {
        number[i] = static_cast<int>(unknown.size());
        unknown.push_back(static_cast<Eigen::Index>(i));
      }
    K = restricted(all.stiffness, number, true);
    C = restricted(all.constraint, number, false);
    G = restricted(geometric, number, true);
  }

  /// [K + factor G, C^T; C, 0]
  SparseMatrix saddle_point(const double factor) const
  {
    const SparseMatrix A = K + factor * G;
    const int n = static_cast<int>(A.rows()), m = static_cast<int>(C.rows());
    std::vector<FreeEntry> entries;
    for (int row = 0; row < n; ++row)
      for (SparseMatrix::InnerIterator it(A, row); it; ++it)
        entries.emplace_back(row, static_cast<int>(it.col()), it.value());
    for (int row = 0; row < m; ++row)
      for (SparseMatrix::InnerIterator it(C, row); it; ++it)
      {
        entries.emplace_back(n + row, static_cast<int>(it.col()), it.value());
        entries.emplace_back(static_cast<int>(it.col()), n + row, it.value());
      }
    SparseMatrix result(n + m, n + m);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

private:
  /// Without rows, if they are unknowns, and columns that are prescribed; rows of a
  /// constraint that has nothing left go.
  static SparseMatrix restricted(const SparseMatrix &all,
                                 const std::vector<int> &number,
                                 const bool of_unknowns)
  {
    std::vector<FreeEntry> entries;
    int n_rows = 0;
    for (Eigen::Index row = 0; row < all.rows(); ++row)
    {
      if (of_unknowns && number[static_cast<std::size_t>(row)] < 0)
        continue;
      const std::size_t before = entries.size();
      for (SparseMatrix::InnerIterator it(all, row); it; ++it)
        if (number[static_cast<std::size_t>(it.col())] >= 0)
          entries.emplace_back(n_rows, number[static_cast<std::size_t>(it.col())],
                               it.value());
      n_rows += of_unknowns || entries.size() > before;
    }
    const auto n_columns =
        std::count_if(number.begin(), number.end(), [](const int i) { return i >= 0; });
    SparseMatrix result(n_rows, n_columns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
};

/// Factor of the saddle point at a load: solves on the constraint space, counts there.
class SaddleFactor
{
public:
  SaddleFactor(const FreeSystem &free, const double factor)
      : n_(free.K.rows())
      , n_multipliers_(static_cast<int>(free.C.rows()))
      , factor_(free.saddle_point(factor))
  {
    if (factor_.n_null() > 0)
      throw NumericalError("linear buckling",
                           "the system matrix is singular on the constraint space: a "
                           "part is loose, the multiplier space is too rich, or the load "
                           "is a critical one. Pivots of round-off",
                           factor_.n_null(), 0.);
  }

  /// x with C x = 0 and (K + factor G) x = right up to C^T L.
  VectorXd solve(const VectorXd &right) const
  {
    VectorXd whole = VectorXd::Zero(n_ + n_multipliers_);
    whole.head(n_) = right;
    return factor_.solve(whole).head(n_);
  }
  /// Each multiplier brings one negative eigenvalue.
  int n_unstable() const { return factor_.n_negative() - n_multipliers_; }

private:
  Eigen::Index n_;
  int n_multipliers_;
  SymmetricFactor factor_;
};

using Map = std::function<VectorXd(const VectorXd &)>;

/// A linear map as Anasazi wants it, on one rank.
class LinearOperator : public Epetra_Operator
{
public:
  LinearOperator(const Epetra_Map &space, Map map)
      : space_(space)
      , map_(std::move(map))
  {
  }
  int Apply(const Epetra_MultiVector &x, Epetra_MultiVector &y) const override
  {
    for (int k = 0; k < x.NumVectors(); ++k)
      Eigen::Map<VectorXd>(y[k], y.MyLength()) =
          map_(Eigen::Map<const VectorXd>(x[k], x.MyLength()));
    return 0;
  }
  int SetUseTranspose(bool) override { return -1; }
  int ApplyInverse(const Epetra_MultiVector &, Epetra_MultiVector &) const override
  {
    return -1;
  }
  double NormInf() const override { return 0.; }
  const char *Label() const override { return "linear map"; }
  bool UseTranspose() const override { return false; }
  bool HasNormInf() const override { return false; }
  const Epetra_Comm &Comm() const override { return space_.Comm(); }
  const Epetra_Map &OperatorDomainMap() const override { return space_; }
  const Epetra_Map &OperatorRangeMap() const override { return space_; }

private:
  const Epetra_Map &space_;
  Map map_;
};

void ask(const std::function<bool()> &stop)
{
  if (stop && stop())
    throw continuum::BucklingStopped();
}

struct EigenPair
{
  double value;
  VectorXd vector;
};

/// Eigenpairs of @p map, symmetric in the inner product of @p K on its range, that are
/// largest in magnitude, as far as they converge.
/// \param n_free_directions of the range
std::vector<EigenPair> largest(const Map &map,
                               const SparseMatrix &K,
                               const int n_free_directions,
                               const CoupledBucklingOptions &options)
{
  const auto wanted = std::min(static_cast<int>(options.n_modes), n_free_directions / 4);
  constexpr int block = 2; // symmetric sections have pairs of nearly equal loads
  const auto n = static_cast<int>(K.rows());
  const Epetra_MpiComm comm(MPI_COMM_SELF);
  const Epetra_Map space(n, 0, comm);
  LinearOperator inverse(space, map);
  LinearOperator product(space, [&K](const VectorXd &x) -> VectorXd { return K * x; });
  auto start = Teuchos::rcp(new Epetra_MultiVector(space, block));
  for (int k = 0; k < block; ++k)
    for (int i = 0; i < n; ++i) // a wave of every length in the numbers
      (*start)[k][i] = std::sin((1. + 0.37 * k) * (0.61803398875 * i * i + i));
  inverse.Apply(*start, *start); // onto the constraint space
  using Problem = Anasazi::BasicEigenproblem<double, Epetra_MultiVector, Epetra_Operator>;
  const auto problem =
      Teuchos::rcp(new Problem(Teuchos::rcp<Epetra_Operator>(&inverse, false),
                               Teuchos::rcp<Epetra_Operator>(&product, false), start));
  problem->setHermitian(true);
  problem->setNEV(wanted);
  problem->setProblem();
  Teuchos::ParameterList settings;
  settings.set("Which", "LM");
  settings.set("Block Size", block);
  settings.set("Num Blocks",
               std::min(std::max(12, 2 * wanted + 4), n_free_directions / block - 1));
  settings.set("Maximum Restarts", static_cast<int>(options.max_restarts));
  settings.set("Convergence Tolerance", options.tolerance);
  settings.set("Verbosity", 0);
  Anasazi::BlockKrylovSchurSolMgr<double, Epetra_MultiVector, Epetra_Operator> solver(
      problem, settings);
  try
  {
    solver.solve(); // what has converged of it counts
  }
  catch (const std::logic_error &) // Anasazi: a basis that cannot be made orthogonal
  {
    throw NumericalError("linear buckling",
                         "the eigenvectors cannot be made orthogonal: the section is "
                         "nearly loose. Loads wanted",
                         wanted, 0.);
  }
  const auto &solution = problem->getSolution();
  if (solution.numVecs == 0)
    throw NumericalError("linear buckling",
                         "the lowest loads do not converge; ask for fewer modes. Loads "
                         "found",
                         0., wanted);
  std::vector<EigenPair> pairs;
  for (int k = 0; k < solution.numVecs; ++k)
    pairs.push_back({solution.Evals[static_cast<std::size_t>(k)].realpart,
                     Eigen::Map<const VectorXd>((*solution.Evecs)[k], n)});
  return pairs;
}

/// Largest eigenvalue of @p map, symmetric in the inner product of @p K, from below and
/// roughly: Lanczos with full reorthogonalisation (Parlett 1998). It ends early where the
/// space is exhausted.
double roughly_largest(const Map &map, const SparseMatrix &K)
{
  constexpr int most = 40;
  VectorXd v(K.rows());
  for (Eigen::Index i = 0; i < v.size(); ++i)
    v[i] = std::sin(0.61803398875 * static_cast<double>(i * i + i));
  v = map(v); // onto the constraint space
  std::vector<VectorXd> basis;
  std::vector<double> diagonal, beside;
  double norm = std::sqrt(v.dot(K * v)), scale = 0., last = 0.;
  int settled = 0; // steps without much gain; who calls checks by the inertia
  while (static_cast<int>(basis.size()) < most && settled < 4 && norm > 1e-10 * scale &&
         norm > 0.)
  {
    if (!basis.empty())
      beside.push_back(norm);
    basis.push_back(v / norm);
    v = map(basis.back());
    diagonal.push_back(basis.back().dot(K * v));
    for (int twice = 0; twice < 2; ++twice)
      for (const VectorXd &b : basis)
        v -= b.dot(K * v) * b;
    norm = std::sqrt(std::max(0., v.dot(K * v)));
    scale = std::max({scale, norm, std::abs(diagonal.back())});

    const auto n = static_cast<Eigen::Index>(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    small.computeFromTridiagonal(Eigen::Map<VectorXd>(diagonal.data(), n),
                                 Eigen::Map<VectorXd>(beside.data(), n - 1),
                                 Eigen::EigenvaluesOnly);
    const double before = last;
    last = small.eigenvalues()[n - 1];
    settled = last - before < 2e-3 * last ? settled + 1 : 0;
  }
  return last > 1e-10 * scale ? last : 0.; // round-off of a map without positive ones
}

/// A load below the lowest critical one, close to it: from a rough Rayleigh quotient,
/// lowered until no direction is unstable.
double load_below_all(const FreeSystem &free, const SaddleFactor &at_rest)
{
  const double inverse_factor = roughly_largest([&](const VectorXd &x) -> VectorXd
                                                { return at_rest.solve(-(free.G * x)); },
                                                free.K);
  if (!(inverse_factor > 0.))
    throw NumericalError("linear buckling",
                         "no load in this direction makes the section buckle: nothing is "
                         "in compression. Largest 1 / factor",
                         inverse_factor, 0.);
  double load = 0.97 / inverse_factor;
  while (SaddleFactor(free, load).n_unstable() > 0)
    load *= 0.9;
  return load;
}

/// The mode of a load and its free unknowns @p v, with its errors.
CoupledMode mode_of(const StaticSystem &system,
                    const FreeSystem &free,
                    const SaddleFactor &at_rest,
                    const double factor,
                    const VectorXd &v)
{
  const VectorXd x = v / v.cwiseAbs().maxCoeff();
  const VectorXd rest = x + factor * at_rest.solve(free.G * x);
  VectorXd whole = VectorXd::Zero(static_cast<Eigen::Index>(system.n_unknowns()));
  for (std::size_t i = 0; i < free.unknown.size(); ++i)
    whole[free.unknown[i]] = x[static_cast<Eigen::Index>(i)];
  const double gap = free.C.rows() > 0 ? (free.C * x).cwiseAbs().maxCoeff() : 0.;
  return {factor, system.solution_of(whole),
          std::sqrt(rest.dot(free.K * rest) / x.dot(free.K * x)), gap / free.diagonal};
}

/// Whether as many modes were found below the last as the inertia says there are.
void demand_all_lower_modes(const FreeSystem &free,
                            const std::vector<CoupledMode> &modes,
                            const double tolerance)
{
  const double below = modes.back().load_factor * (1. - std::max(1e-6, 100. * tolerance));
  const int found = static_cast<int>(std::count_if(modes.begin(), modes.end(),
                                                   [below](const CoupledMode &m)
                                                   { return m.load_factor < below; }));
  const int there = SaddleFactor(free, below).n_unstable();
  if (found != there)
    throw NumericalError("linear buckling",
                         "a lower load was missed; ask for more modes. Loads below the "
                         "last that was found",
                         there, found);
}
} // namespace

std::vector<CoupledMode> lowest_coupled_modes(const StaticSystem &system,
                                              const SparseMatrix &geometric,
                                              const CoupledBucklingOptions &options)
{
  const FreeSystem free(system, geometric);
  ask(options.stop);
  const SaddleFactor at_rest(free, 0.);
  ask(options.stop);
  if (at_rest.n_unstable() != 0)
    throw NumericalError("linear buckling",
                         "the section is unstable without load. Directions",
                         at_rest.n_unstable(), 0.);
  // (K + s G)^-1 K has the eigenvalues factor / (factor - s).
  const double shift = load_below_all(free, at_rest);
  const SaddleFactor shifted(free, shift);
  const Map map = [&](const VectorXd &x) -> VectorXd
  {
    ask(options.stop);
    return shifted.solve(free.K * x);
  };

  std::vector<CoupledMode> modes;
  for (const EigenPair &pair :
       largest(map, free.K, static_cast<int>(free.K.rows() - free.C.rows()), options))
  {
    if (std::abs(pair.value - 1.) < 1e-12)
      continue; // what the prestress does not act on: its load is infinite
    const double factor = shift * pair.value / (pair.value - 1.);
    if (factor > 0.)
      modes.push_back(mode_of(system, free, at_rest, factor, pair.vector));
  }
  if (modes.empty())
    throw NumericalError("linear buckling",
                         "none of the lowest loads converged to one above 0. Wanted", 0.,
                         options.n_modes);
  std::sort(modes.begin(), modes.end(),
            [](const CoupledMode &a, const CoupledMode &b)
            { return a.load_factor < b.load_factor; });
  demand_all_lower_modes(free, modes, options.tolerance);
  return modes;
}

int n_unstable_directions(const StaticSystem &system,
                          const SparseMatrix &geometric,
                          const double factor)
{
  return SaddleFactor(FreeSystem(system, geometric), factor).n_unstable();
}
} // namespace antiform::coupling

#include "continuum/linear_buckling.h"

#include "continuum/direct_solver.h"
#include "continuum/errors.h"

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::continuum
{
using namespace dealii;
using TrilinosMatrix = TrilinosWrappers::SparseMatrix;

namespace
{
/// x -> factor * A^-1 B x.
class InverseOperator : public Epetra_Operator
{
public:
  InverseOperator(const TrilinosMatrix &inverted,
                  const TrilinosMatrix &applied,
                  const double factor,
                  const Vector &like,
                  const std::function<bool()> &stop)
      : stop_(stop)
      , applied_(applied)
      , factor_(factor)
      , solver_(inverted)
      , rhs_(like)
      , solution_(like)
  {
  }

  int Apply(const Epetra_MultiVector &x, Epetra_MultiVector &y) const override
  {
    Epetra_MultiVector product(x.Map(), x.NumVectors());
    applied_.trilinos_matrix().Apply(x, product);
    for (int k = 0; k < x.NumVectors(); ++k)
    {
      if (stop_ && stop_())
        throw BucklingStopped();
      const double *const from = product[k];
      for (unsigned int i = 0; i < rhs_.locally_owned_size(); ++i)
        rhs_.local_element(i) = factor_ * from[i];
      solver_.solve(rhs_, solution_);
      std::copy(solution_.begin(), solution_.end(), y[k]);
    }
    return 0;
  }

  int SetUseTranspose(bool) override { return -1; }
  int ApplyInverse(const Epetra_MultiVector &, Epetra_MultiVector &) const override
  {
    return -1;
  }
  double NormInf() const override { return 0.; }
  const char *Label() const override { return "A^-1 B"; }
  bool UseTranspose() const override { return false; }
  bool HasNormInf() const override { return false; }
  const Epetra_Comm &Comm() const override { return applied_.trilinos_matrix().Comm(); }
  const Epetra_Map &OperatorDomainMap() const override
  {
    return applied_.trilinos_matrix().DomainMap();
  }
  const Epetra_Map &OperatorRangeMap() const override { return OperatorDomainMap(); }

private:
  const std::function<bool()> &stop_;
  const TrilinosMatrix &applied_;
  double factor_;
  DirectSolver solver_;
  mutable Vector rhs_, solution_;
};

using MultiVector = Epetra_MultiVector;
using Problem = Anasazi::BasicEigenproblem<double, MultiVector, Epetra_Operator>;

/// The same start whatever the number of ranks: a wave of every length in the numbers.
Teuchos::RCP<MultiVector> start_vectors(const Epetra_Map &map, const int n)
{
  auto start = Teuchos::rcp(new MultiVector(map, n));
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < map.NumMyElements(); ++i)
    {
      const double place = static_cast<double>(map.GID64(i));
      (*start)[k][i] =
          std::sin((1. + 0.37 * k) * (0.61803398875 * place * place + place));
    }
  return start;
}

/// Eigenpairs of @p inverse, symmetric in the inner product of @p K, that are largest by
/// @p which ("LR": value, "LM": magnitude), as far as they converge; throws where none
/// does.
Anasazi::Eigensolution<double, MultiVector> largest(const InverseOperator &inverse,
                                                    const TrilinosMatrix &K,
                                                    const char *const which,
                                                    const int wanted,
                                                    const BucklingOptions &options)
{
  constexpr int block = 2; // symmetric sections have pairs of nearly equal loads
  const auto product = Teuchos::rcp<Epetra_Operator>(
      const_cast<Epetra_CrsMatrix *>(&K.trilinos_matrix()), false);
  const auto problem = Teuchos::rcp(new Problem(
      Teuchos::rcp<Epetra_Operator>(const_cast<InverseOperator *>(&inverse), false),
      product, start_vectors(inverse.OperatorDomainMap(), block)));
  problem->setHermitian(true);
  problem->setNEV(wanted);
  problem->setProblem();

  Teuchos::ParameterList settings;
  settings.set("Which", which);
  settings.set("Block Size", block);
  const int fit = inverse.OperatorDomainMap().NumGlobalElements() / block - 1;
  settings.set("Num Blocks", std::min(std::max(12, 2 * wanted + 4), fit));
  settings.set("Maximum Restarts", static_cast<int>(options.max_restarts));
  settings.set("Convergence Tolerance", options.tolerance);
  settings.set("Verbosity", 0);
  Anasazi::BlockKrylovSchurSolMgr<double, MultiVector, Epetra_Operator> solver(problem,
                                                                               settings);
  try
  {
    solver.solve(); // what has converged of it counts
  }
  catch (const std::logic_error &) // Anasazi: a basis that cannot be made orthogonal
  {
    DirectSolver::refuse_singular(std::numeric_limits<double>::quiet_NaN(), 1.);
  }
  const auto &solution = problem->getSolution();
  if (solution.numVecs == 0)
    throw NumericalError("linear buckling",
                         "the lowest loads do not converge; ask for fewer modes, or see "
                         "whether a part is loose. Loads found",
                         solution.numVecs, wanted);
  return solution;
}

/// Lowest positive load factor: a Rayleigh quotient, so never too small, and with a
/// residual of 3 % a few percent too large at most.
double roughly_lowest(const TrilinosMatrix &K,
                      const TrilinosMatrix &G,
                      const Vector &like,
                      BucklingOptions options)
{
  options.tolerance = 0.03;
  const InverseOperator inverse(K, G, -1., like, options.stop);
  const double inverse_factor = largest(inverse, K, "LR", 1, options).Evals[0].realpart;
  if (!(inverse_factor > 0.))
    throw NumericalError("linear buckling",
                         "no load in this direction makes the section buckle: nothing is "
                         "in compression. Largest 1 / factor",
                         inverse_factor, 0.);
  return 1. / inverse_factor;
}
} // namespace

std::vector<BucklingMode> lowest_buckling_modes(const ElasticSolid &solid,
                                                const TrilinosMatrix &geometric,
                                                const DofReduction &reduction,
                                                const BucklingOptions &options)
{
  const TrilinosMatrix K = reduction.reduce(solid.stiffness());
  const TrilinosMatrix G = reduction.reduce(geometric);
  const Vector like = reduction.make_vector();
  // Long sections have loads within percents of one another: they part when all is
  // shifted to just below the lowest. (K + s G)^-1 K has the eigenvalues factor / (factor
  // - s).
  constexpr double below = 0.97;
  const double shift = below * roughly_lowest(K, G, like, options);
  TrilinosMatrix shifted;
  shifted.copy_from(K);
  shifted.add(shift, G);
  const int wanted =
      static_cast<int>(std::min<types::global_dof_index>(options.n_modes, K.m() / 4));
  const InverseOperator inverse(shifted, K, 1., like, options.stop);
  const auto solution = largest(inverse, K, "LM", wanted, options);

  std::vector<BucklingMode> modes;
  for (int k = 0; k < solution.numVecs; ++k)
  {
    const double value = solution.Evals[k].realpart,
                 factor = shift * value / (value - 1.);
    if (!(factor > 0.))
      continue;
    Vector unknowns = reduction.make_vector();
    std::copy_n((*solution.Evecs)[k], unknowns.locally_owned_size(), unknowns.begin());
    Vector shape = reduction.expand(unknowns, true);
    shape /= shape.linfty_norm();
    modes.push_back({factor, shape});
  }
  if (modes.empty())
    throw NumericalError("linear buckling",
                         "none of the lowest loads converged to one above 0; ask for "
                         "more modes, or see whether a part is loose. Loads found",
                         0., wanted);
  std::sort(modes.begin(), modes.end(),
            [](const BucklingMode &a, const BucklingMode &b)
            { return a.load_factor < b.load_factor; });
  for (BucklingMode &mode : modes)
    mode.shape.update_ghost_values(); // copied vectors have none
  return modes;
}
} // namespace antiform::continuum

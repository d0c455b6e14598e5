#include "coupling/elastic_factor.h"

#include "continuum/errors.h"

#include <Eigen/CholmodSupport>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace antiform::coupling
{
namespace
{
/// CHOLMOD's factor with its arrays within reach.
class Supernodal
    : public Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower>
{
public:
  const cholmod_factor &factor() const { return *m_cholmodFactor; }
};
} // namespace

/// P A P^T = L L^T. Columns of L with the same rows below lie together as a panel, dense,
/// column by column: first the triangle of the panel's own rows, then the others.
struct ElasticFactor::Factor
{
  struct Panel
  {
    int first = 0; ///< of its columns
    int n_columns = 0, n_rows = 0;
    std::ptrdiff_t rows = 0, values = 0; ///< where they begin
  };
  Supernodal cholesky;
  std::vector<Panel> panels;
  const int *rows = nullptr, *permutation = nullptr;
  const double *values = nullptr;
  std::vector<float> rounded; ///< values in single precision; empty: not wanted
  int most_rows = 0;

  void find_panels()
  {
    const cholmod_factor &L = cholesky.factor();
    const auto *super = static_cast<const int *>(L.super);
    const auto *row_begin = static_cast<const int *>(L.pi);
    const auto *value_begin = static_cast<const int *>(L.px);
    rows = static_cast<const int *>(L.s);
    permutation = static_cast<const int *>(L.Perm);
    values = static_cast<const double *>(L.x);
    for (std::size_t s = 0; s < L.nsuper; ++s)
    {
      panels.push_back({super[s], super[s + 1] - super[s],
                        row_begin[s + 1] - row_begin[s], row_begin[s], value_begin[s]});
      most_rows = std::max(most_rows, panels.back().n_rows);
    }
  }

  /// x = A^-1 b in the precision of the values of L. b is divided by @p scale before, x
  /// multiplied by it afterwards.
  template <typename Real>
  Eigen::VectorXd
  solve(const Real *L, const Eigen::VectorXd &right, const double scale) const;

private:
  template <typename Real>
  using Column = Eigen::Map<const Eigen::Matrix<Real, Eigen::Dynamic, 1>>;

  /// x = L^-1 x and x = L^-T x. \param below space for the most rows of a panel
  template <typename Real>
  void forward(const Real *L, Real *x, std::vector<Real> &below) const;
  template <typename Real>
  void backward(const Real *L, Real *x, std::vector<Real> &below) const;
};

template <typename Real>
Eigen::VectorXd ElasticFactor::Factor::solve(const Real *const L,
                                             const Eigen::VectorXd &right,
                                             const double scale) const
{
  const auto n = static_cast<std::size_t>(right.size());
  std::vector<Real> x(n), below(static_cast<std::size_t>(most_rows));
  for (std::size_t i = 0; i < n; ++i)
    x[i] = static_cast<Real>(right[permutation[i]] / scale);
  forward(L, x.data(), below);
  backward(L, x.data(), below);
  Eigen::VectorXd solution(right.size());
  for (std::size_t i = 0; i < n; ++i)
    solution[permutation[i]] = scale * static_cast<double>(x[i]);
  return solution;
}

template <typename Real>
void ElasticFactor::Factor::forward(const Real *const L,
                                    Real *const x,
                                    std::vector<Real> &below) const
{
  for (const Panel &panel : panels)
  {
    Real *const own = x + panel.first;
    const int *const others = rows + panel.rows + panel.n_columns;
    const int n_below = panel.n_rows - panel.n_columns;
    std::fill_n(below.begin(), n_below, Real(0));
    Eigen::Map<Eigen::Matrix<Real, Eigen::Dynamic, 1>> sum(below.data(), n_below);
    for (int c = 0; c < panel.n_columns; ++c)
    {
      const Real *const column = L + panel.values + c * panel.n_rows;
      own[c] /= column[c];
      for (int r = c + 1; r < panel.n_columns; ++r)
        own[r] -= own[c] * column[r];
      sum += own[c] * Column<Real>(column + panel.n_columns, n_below);
    }
    for (int r = 0; r < n_below; ++r)
      x[others[r]] -= below[r];
  }
}

template <typename Real>
void ElasticFactor::Factor::backward(const Real *const L,
                                     Real *const x,
                                     std::vector<Real> &below) const
{
  for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel)
  {
    Real *const own = x + panel->first;
    const int *const others = rows + panel->rows + panel->n_columns;
    const int n_below = panel->n_rows - panel->n_columns;
    for (int r = 0; r < n_below; ++r)
      below[r] = x[others[r]];
    const Column<Real> known(below.data(), n_below);
    for (int c = panel->n_columns - 1; c >= 0; --c)
    {
      const Real *const column = L + panel->values + c * panel->n_rows;
      Real value = own[c] - known.dot(Column<Real>(column + panel->n_columns, n_below));
      for (int r = c + 1; r < panel->n_columns; ++r)
        value -= column[r] * own[r];
      own[c] = value / column[c];
    }
  }
}

ElasticFactor::ElasticFactor(const Eigen::SparseMatrix<double> &matrix)
    : factor_(std::make_unique<Factor>())
{
  factor_->cholesky.cholmod().print = 0; // failures are exceptions
  // Nested dissection: sections are plane.
  factor_->cholesky.cholmod().nmethods = 1;
  factor_->cholesky.cholmod().method[0].ordering = CHOLMOD_METIS;
  factor_->cholesky.compute(matrix);
  if (factor_->cholesky.info() != Eigen::Success)
    throw NumericalError("elastic factor",
                         "the stiffness is not positive definite: a grain or a part of "
                         "the body has no path to a support",
                         static_cast<double>(matrix.rows()), 0.);
  factor_->find_panels();
}
ElasticFactor::~ElasticFactor() = default;
ElasticFactor::ElasticFactor(ElasticFactor &&) noexcept = default;
ElasticFactor &ElasticFactor::operator=(ElasticFactor &&) noexcept = default;

Eigen::VectorXd ElasticFactor::solve(const Eigen::VectorXd &right) const
{
  return factor_->solve(factor_->values, right, 1.);
}

void ElasticFactor::round_for_corrections(const Eigen::SparseMatrix<double> &matrix,
                                          const double most_left)
{
  constexpr int rounds = 12;
  const cholmod_factor &L = factor_->cholesky.factor();
  factor_->rounded.assign(factor_->values, factor_->values + L.xsize);
  const auto A = matrix.selfadjointView<Eigen::Lower>();
  // What is left turns, round by round, to the softest motions, of which most is left.
  std::mt19937 random(1);
  Eigen::VectorXd left(matrix.rows());
  for (double &entry : left)
    entry = static_cast<double>(random()) / 2147483648. - 1.;
  for (int k = 0; k < rounds; ++k)
  {
    const Eigen::VectorXd force = A * left;
    const double before = left.dot(force);
    left -= correction(force);
    const double after = left.dot(A * left);
    if (!(after <= most_left * most_left * before))
    {
      std::vector<float>().swap(factor_->rounded);
      return;
    }
    if (!(after > 0.))
      return;
    left /= std::sqrt(after);
  }
}

Eigen::VectorXd ElasticFactor::correction(const Eigen::VectorXd &right) const
{
  const double scale = right.cwiseAbs().maxCoeff();
  if (factor_->rounded.empty() || !(scale > 0.))
    return solve(right);
  return factor_->solve(factor_->rounded.data(), right, scale);
}

Eigen::Index ElasticFactor::size() const
{
  return factor_->cholesky.rows();
}
} // namespace antiform::coupling

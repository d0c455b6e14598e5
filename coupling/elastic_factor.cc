#include "coupling/elastic_factor.h"

#include "continuum/errors.h"

#include <Eigen/CholmodSupport>

#include <algorithm>
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
};

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
  const Factor &L = *factor_;
  const auto n = static_cast<std::size_t>(right.size());
  std::vector<double> x(n), below(static_cast<std::size_t>(L.most_rows));
  for (std::size_t i = 0; i < n; ++i)
    x[i] = right[L.permutation[i]];

  for (const Factor::Panel &panel : L.panels)
  {
    double *const own = x.data() + panel.first;
    const int *const rows = L.rows + panel.rows;
    const int n_below = panel.n_rows - panel.n_columns;
    std::fill_n(below.begin(), n_below, 0.);
    Eigen::Map<Eigen::VectorXd> sum(below.data(), n_below);
    for (int c = 0; c < panel.n_columns; ++c)
    {
      const double *const column = L.values + panel.values + c * panel.n_rows;
      own[c] /= column[c];
      for (int r = c + 1; r < panel.n_columns; ++r)
        own[r] -= own[c] * column[r];
      sum +=
          own[c] * Eigen::Map<const Eigen::VectorXd>(column + panel.n_columns, n_below);
    }
    for (int r = 0; r < n_below; ++r)
      x[rows[panel.n_columns + r]] -= below[r];
  }

  for (auto panel = L.panels.rbegin(); panel != L.panels.rend(); ++panel)
  {
    double *const own = x.data() + panel->first;
    const int *const rows = L.rows + panel->rows;
    const int n_below = panel->n_rows - panel->n_columns;
    for (int r = 0; r < n_below; ++r)
      below[r] = x[rows[panel->n_columns + r]];
    const Eigen::Map<const Eigen::VectorXd> others(below.data(), n_below);
    for (int c = panel->n_columns - 1; c >= 0; --c)
    {
      const double *const column = L.values + panel->values + c * panel->n_rows;
      double value = own[c] - others.dot(Eigen::Map<const Eigen::VectorXd>(
                                  column + panel->n_columns, n_below));
      for (int r = c + 1; r < panel->n_columns; ++r)
        value -= column[r] * own[r];
      own[c] = value / column[c];
    }
  }

  Eigen::VectorXd solution(right.size());
  for (std::size_t i = 0; i < n; ++i)
    solution[L.permutation[i]] = x[i];
  return solution;
}

Eigen::Index ElasticFactor::size() const
{
  return factor_->cholesky.rows();
}
} // namespace antiform::coupling

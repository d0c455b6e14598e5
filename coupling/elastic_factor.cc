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
    int first = 0;          ///< of its columns
    int n_columns = 0, n_rows = 0;
    std::ptrdiff_t rows = 0, values = 0; ///< where they begin
  };
  Supernodal cholesky;
  std::vector<Panel> panels;
  const int *rows = nullptr, *permutation = nullptr;
  const double *values = nullptr;
  int most_rows = 0;

  using Part = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  /// Rows of a panel below its own columns.
  Part below(const Panel &panel) const
  {
    return {values + panel.values + panel.n_columns, panel.n_rows - panel.n_columns,
            panel.n_columns, Eigen::OuterStride<>(panel.n_rows)};
  }
  /// Its own columns, of which the lower triangle counts.
  Part own(const Panel &panel) const
  {
    return {values + panel.values, panel.n_columns, panel.n_columns,
            Eigen::OuterStride<>(panel.n_rows)};
  }

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
      panels.push_back({super[s], super[s + 1] - super[s], row_begin[s + 1] - row_begin[s],
                        row_begin[s], value_begin[s]});
      most_rows = std::max(most_rows, panels.back().n_rows);
    }
  }
};

ElasticFactor::ElasticFactor(const Eigen::SparseMatrix<double> &matrix)
    : factor_(std::make_unique<Factor>())
{
  factor_->cholesky.cholmod().print = 0; // failures are exceptions
  // Nested dissection: sections are plane, and minimum degree leaves a third more.
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
  const Eigen::Index n = right.size();
  Eigen::VectorXd x(n), others(L.most_rows);
  for (Eigen::Index i = 0; i < n; ++i)
    x[i] = right[L.permutation[i]];

  for (const Factor::Panel &panel : L.panels)
  {
    const int *const rows = L.rows + panel.rows + panel.n_columns;
    const int n_below = panel.n_rows - panel.n_columns;
    auto own = x.segment(panel.first, panel.n_columns);
    const Factor::Part triangle = L.own(panel);
    for (int c = 0; c < panel.n_columns; ++c)
    {
      own[c] /= triangle(c, c);
      for (int r = c + 1; r < panel.n_columns; ++r)
        own[r] -= own[c] * triangle(r, c);
    }
    others.head(n_below).noalias() = L.below(panel) * own;
    for (int r = 0; r < n_below; ++r)
      x[rows[r]] -= others[r];
  }

  for (auto panel = L.panels.rbegin(); panel != L.panels.rend(); ++panel)
  {
    const int *const rows = L.rows + panel->rows + panel->n_columns;
    const int n_below = panel->n_rows - panel->n_columns;
    for (int r = 0; r < n_below; ++r)
      others[r] = x[rows[r]];
    auto own = x.segment(panel->first, panel->n_columns);
    own.noalias() -= L.below(*panel).transpose() * others.head(n_below);
    const Factor::Part triangle = L.own(*panel);
    for (int c = panel->n_columns - 1; c >= 0; --c)
    {
      for (int r = c + 1; r < panel->n_columns; ++r)
        own[c] -= triangle(r, c) * own[r];
      own[c] /= triangle(c, c);
    }
  }

  Eigen::VectorXd solution(n);
  for (Eigen::Index i = 0; i < n; ++i)
    solution[L.permutation[i]] = x[i];
  return solution;
}

Eigen::Index ElasticFactor::size() const
{
  return factor_->cholesky.rows();
}
} // namespace antiform::coupling

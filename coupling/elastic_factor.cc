#include "coupling/elastic_factor.h"

#include "continuum/errors.h"

#include <Eigen/CholmodSupport>

namespace antiform::coupling
{
struct ElasticFactor::Factor
{
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
};

ElasticFactor::ElasticFactor(const Eigen::SparseMatrix<double> &matrix)
    : factor_(std::make_unique<Factor>())
{
  factor_->cholesky.cholmod().print = 0; // failures are exceptions
  factor_->cholesky.compute(matrix);
  if (factor_->cholesky.info() != Eigen::Success)
    throw NumericalError("elastic factor",
                         "the stiffness is not positive definite: a grain or a part of "
                         "the body has no path to a support",
                         static_cast<double>(matrix.rows()), 0.);
}
ElasticFactor::~ElasticFactor() = default;
ElasticFactor::ElasticFactor(ElasticFactor &&) noexcept = default;
ElasticFactor &ElasticFactor::operator=(ElasticFactor &&) noexcept = default;

Eigen::VectorXd ElasticFactor::solve(const Eigen::VectorXd &right) const
{
  return factor_->cholesky.solve(right);
}

Eigen::Index ElasticFactor::size() const
{
  return factor_->cholesky.rows();
}
} // namespace antiform::coupling

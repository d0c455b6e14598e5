#include "coupling/constrained_inverse.h"

#include "continuum/errors.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace antiform::coupling
{
ConstrainedInverse::ConstrainedInverse(
    Solve solve,
    Eigen::SparseMatrix<double, Eigen::RowMajor> constraint,
    const std::vector<Pin> &pins,
    const std::function<std::string(Eigen::Index)> &name)
    : solve_(std::move(solve))
    , constraint_(std::move(constraint))
{
  factorise();
  take_off(pins, name);
}

void ConstrainedInverse::factorise()
{
  const Eigen::Index m = constraint_.rows();
  Eigen::MatrixXd schur(m, m);
  for (Eigen::Index k = 0; k < m; ++k)
  {
    const Vector row = constraint_.row(k).transpose();
    schur.col(k) = constraint_ * solve_(row);
  }
  schur_.compute(0.5 * (schur + schur.transpose()));
  const Vector pivots = schur_.matrixL().toDenseMatrix().diagonal();
  // As BridgingDomain::factorise() does, which names the vertices, by another norm.
  constexpr double limit = 1e-12;
  const double least = m > 0 ? std::pow(pivots.minCoeff() / pivots.maxCoeff(), 2) : 1.;
  if (schur_.info() != Eigen::Success || !(least > limit))
    throw NumericalError("bridged operator",
                         "multiplier space too rich: use larger cells, a wider overlap "
                         "or coarsened multipliers; smallest pivot over the largest",
                         least, limit);
}

void ConstrainedInverse::take_off(const std::vector<Pin> &pins,
                                  const std::function<std::string(Eigen::Index)> &name)
{
  const auto n = static_cast<Eigen::Index>(pins.size());
  of_pins_.resize(constraint_.cols(), n);
  take_off_.resize(n, n);
  Vector root(n); // of the pins' stiffness
  for (Eigen::Index p = 0; p < n; ++p)
  {
    const Pin &pin = pins[static_cast<std::size_t>(p)];
    pinned_.push_back(pin.unknown);
    root[p] = std::sqrt(pin.stiffness);
    of_pins_.col(p) = constrained(solve_(Vector::Unit(constraint_.cols(), pin.unknown)));
  }
  if (n == 0)
    return;
  for (Eigen::Index p = 0; p < n; ++p)
    for (Eigen::Index q = 0; q < n; ++q)
      take_off_(p, q) =
          (p == q ? 1. : 0.) -
          0.5 * root[p] * root[q] * (of_pins_(pinned_[p], q) + of_pins_(pinned_[q], p));
  // What the body itself resists with, of body and pins together.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(take_off_);
  constexpr double limit = 1e-9;
  if (!(own.eigenvalues()[0] > limit))
  {
    Eigen::Index loosest = 0;
    own.eigenvectors().col(0).cwiseAbs().maxCoeff(&loosest);
    throw NumericalError("bridged operator",
                         "the part with " + name(pinned_[loosest]) +
                             " has no path to a support, by the overlap neither; "
                             "stiffness of the body over that of a spring put there",
                         own.eigenvalues()[0], limit);
  }
  take_off_ = root.asDiagonal() * own.eigenvectors() *
              own.eigenvalues().cwiseInverse().asDiagonal() *
              own.eigenvectors().transpose() * root.asDiagonal();
}

ConstrainedInverse::Vector ConstrainedInverse::constrained(const Vector &x) const
{
  const Vector multipliers = schur_.solve(constraint_ * x);
  return x - solve_(constraint_.transpose() * multipliers);
}

ConstrainedInverse::Vector ConstrainedInverse::complete(const Vector &start) const
{
  Vector x = constrained(start);
  if (pinned_.empty())
    return x;
  Vector at_pins(static_cast<Eigen::Index>(pinned_.size()));
  for (Eigen::Index p = 0; p < at_pins.size(); ++p)
    at_pins[p] = x[pinned_[p]];
  x += of_pins_ * (take_off_ * at_pins);
  return x;
}
} // namespace antiform::coupling

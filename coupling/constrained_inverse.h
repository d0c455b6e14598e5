#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include <functional>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Inverse of a symmetric stiffness K on the displacements that keep C x = 0. K is known
/// by solves with K + sum_p k_p e_p e_p^T, which has the springs of the pins beside it
/// and is positive definite, in parts that need not know of one another (grains and
/// mesh):
///   S L = C K_s^-1 r,  x_s = K_s^-1 (r - C^T L),  S = C K_s^-1 C^T,
/// a dense Cholesky factor of the size of the multipliers, formed once; and the pins are
/// taken off by Woodbury's formula. Two solves of each part for one of the whole.
class ConstrainedInverse
{
public:
  using Vector = Eigen::VectorXd;
  using Solve = std::function<Vector(const Vector &)>;

  /// A spring of the solves that K does not have.
  struct Pin
  {
    Eigen::Index unknown = 0;
    double stiffness = 0.; ///< [N/m], [N m]
  };

  /// \param solve      K_s^-1; 0 where motion is prescribed
  /// \param constraint C, columns of prescribed unknowns too
  /// \param name       of an unknown, for messages
  /// Throws NumericalError where rows of C depend on each other, and where nothing but a
  /// pin holds a part: K is singular on the constraint space.
  ConstrainedInverse(Solve solve,
                     Eigen::SparseMatrix<double, Eigen::RowMajor> constraint,
                     const std::vector<Pin> &pins,
                     const std::function<std::string(Eigen::Index)> &name);

  /// x with C x = 0 and K x = r up to C^T L, for the free unknowns.
  Vector solve(const Vector &r) const { return complete(solve_(r)); }
  /// The same from K_s^-1 r; with prescribed motion in it, what follows from that.
  Vector complete(const Vector &start) const;

  Eigen::Index n_multipliers() const { return constraint_.rows(); }

private:
  /// The nearest in K_s that keeps the constraint.
  Vector constrained(const Vector &x) const;
  void factorise();
  void take_off(const std::vector<Pin> &pins,
                const std::function<std::string(Eigen::Index)> &name);

  Solve solve_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> constraint_;
  Eigen::LLT<Eigen::MatrixXd> schur_;
  std::vector<Eigen::Index> pinned_;
  Eigen::MatrixXd of_pins_;  ///< constrained motion under a unit force at each pin
  Eigen::MatrixXd take_off_; ///< (1 / k - P^T of_pins)^-1
};
} // namespace antiform::coupling

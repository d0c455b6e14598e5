#pragma once
// One-dimensional patch test with dense matrices, without any code of the program: a
// chain of springs 1 at distance 1, its first mass held, and cells of 8 and rigidity 1,
// whose end is pulled so that the strain is 1.
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace antiform::testing
{
struct PlainChain
{
  double offset = 0.; ///< of the masses' places
  bool cubic = false; ///< ramp
  bool per_mass = false;
  int n_overlap = 4, n_cells = 12;
  double h = 8.;

  double w_D(const double x) const
  {
    const double s = std::clamp(x / (n_overlap * h), 0., 1.);
    return cubic ? 1. - s * s * (3. - 2. * s) : 1. - s;
  }
  double rigidity(const int e) const ///< mean w_C of a cell, Simpson in 200 parts
  {
    double sum = 0.;
    for (int k = 0; k < 200; ++k)
      for (const auto &[s, w] : {std::pair{0., 1.}, {0.5, 4.}, {1., 1.}})
        sum += w / 1200. * (1. - w_D(h * (e + (k + s) / 200.)));
    return sum;
  }

  /// Largest error of the strain in springs and cells of more than 0.02 weight.
  struct Error
  {
    double chain = 0., mesh = 0.;
  };
  Error solve() const
  {
    const int n = static_cast<int>(std::floor(40. + n_overlap * h - offset + 1e-9)) + 1,
              m = n_cells + 1;
    const auto place = [this](const int i) { return i - 40. + offset; };
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
    const auto add_spring = [&K](const int a, const int b, const double k)
    {
      K(a, a) += k;
      K(b, b) += k;
      K(a, b) -= k;
      K(b, a) -= k;
    };
    for (int i = 0; i + 1 < n; ++i)
      add_spring(i, i + 1, w_D(place(i) + 0.5));
    for (int e = 0; e < n_cells; ++e)
      add_spring(n + e, n + e + 1, rigidity(e) / h);
    const Eigen::MatrixXd C = constraint(n, m);
    const auto c = C.rows();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + m + c, n + m + c);
    A << K, C.transpose(), C, Eigen::MatrixXd::Zero(c, c);
    A.row(0).setZero();
    A(0, 0) = 1.;
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n + m + c);
    f[n + m - 1] = 1.;
    const Eigen::VectorXd u = A.completeOrthogonalDecomposition().solve(f);
    Error error;
    for (int i = 0; i + 1 < n; ++i)
      if (w_D(place(i) + 0.5) > 0.02)
        error.chain = std::max(error.chain, std::abs(u[i + 1] - u[i] - 1.));
    for (int e = 0; e < n_cells; ++e)
      if (rigidity(e) > 0.02)
        error.mesh = std::max(error.mesh, std::abs((u[n + e + 1] - u[n + e]) / h - 1.));
    return error;
  }

private:
  Eigen::MatrixXd constraint(const int n, const int m) const
  {
    Eigen::MatrixXd per_mass_rows = Eigen::MatrixXd::Zero(0, n + m), N(0, m);
    for (int i = 0; i < n; ++i)
    {
      const double x = i - 40. + offset;
      if (x < -1e-9)
        continue;
      const auto r = N.rows();
      N.conservativeResize(r + 1, m);
      per_mass_rows.conservativeResize(r + 1, n + m);
      N.row(r).setZero();
      per_mass_rows.row(r).setZero();
      const int e = std::min(static_cast<int>((x + 1e-9) / h), n_cells - 1);
      N(r, e) = 1. - (x / h - e);
      N(r, e + 1) = x / h - e;
      per_mass_rows.row(r).tail(m) = -N.row(r);
      per_mass_rows(r, i) = 1.;
    }
    if (per_mass)
      return per_mass_rows;
    return N.leftCols(n_overlap + 1).transpose() * per_mass_rows;
  }
};
} // namespace antiform::testing

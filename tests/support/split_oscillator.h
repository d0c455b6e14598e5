#pragma once
// Two linear bodies with tied velocities, each with its own step, after Gravouil &
// Combescure (2001): central differences on both sides, the coarse side's free velocity
// interpolated to the fine steps, the tie solved at every fine step. A plain reference
// with dense matrices; the program has another scheme.
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace antiform::testing
{
/// M a + K u = L^T lambda, on one side of the tie.
struct TiedBody
{
  Eigen::VectorXd mass; ///< lumped
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd tie; ///< L, a row for each tied velocity
  Eigen::VectorXd u, v, a = {};

  Eigen::VectorXd free_acceleration() const
  {
    return -(stiffness * u).cwiseQuotient(mass);
  }
  /// M^-1 L^T lambda.
  Eigen::VectorXd by(const Eigen::VectorXd &lambda) const
  {
    return (tie.transpose() * lambda).cwiseQuotient(mass);
  }
  /// Half a step of L M^-1 L^T.
  Eigen::MatrixXd condensed(const double step) const
  {
    return 0.5 * step * tie * mass.cwiseInverse().asDiagonal() * tie.transpose();
  }
  /// The form that central differences of @p step conserve, in rates: 1/2 a.(M - dt^2/4
  /// K) a + 1/2 v.K v.
  double rate_energy(const double step) const
  {
    return 0.5 * a.dot(mass.cwiseProduct(a)) -
           0.125 * step * step * a.dot(stiffness * a) + 0.5 * v.dot(stiffness * v);
  }
};

class SplitOscillator
{
public:
  /// Bodies at rest in their sense: displacements and velocities obey the tie,
  /// L_coarse v + L_fine v = 0.
  SplitOscillator(TiedBody coarse, TiedBody fine, const double fine_step, const int ratio)
      : coarse_(std::move(coarse))
      , fine_(std::move(fine))
      , fine_step_(fine_step)
      , ratio_(ratio)
  {
    // Accelerations that keep the tie.
    const Eigen::VectorXd A = coarse_.free_acceleration(), a = fine_.free_acceleration();
    const Eigen::VectorXd lambda = -(coarse_.condensed(2.) + fine_.condensed(2.))
                                        .ldlt()
                                        .solve(coarse_.tie * A + fine_.tie * a);
    coarse_.a = A + coarse_.by(lambda);
    fine_.a = a + fine_.by(lambda);
    free_velocity_ = coarse_.v - 0.5 * ratio_ * fine_step_ * coarse_.by(lambda);
  }

  /// One coarse step.
  void advance()
  {
    const double dt = fine_step_, DT = ratio_ * dt;
    const Eigen::VectorXd before = coarse_.v;
    const Eigen::VectorXd free_before = free_velocity_;
    coarse_.u += DT * coarse_.v + 0.5 * DT * DT * coarse_.a;
    const Eigen::VectorXd A_free = coarse_.free_acceleration();
    const Eigen::VectorXd V_free = before + 0.5 * DT * (coarse_.a + A_free);
    const auto operator_of_tie = (coarse_.condensed(DT) + fine_.condensed(dt)).ldlt();
    Eigen::VectorXd lambda;
    for (int j = 1; j <= ratio_; ++j)
    {
      fine_.u += dt * fine_.v + 0.5 * dt * dt * fine_.a;
      const Eigen::VectorXd a_free = fine_.free_acceleration();
      const Eigen::VectorXd v_free = fine_.v + 0.5 * dt * (fine_.a + a_free);
      const double part = static_cast<double>(j) / ratio_;
      const Eigen::VectorXd V = (1. - part) * free_before + part * V_free;
      lambda = -operator_of_tie.solve(coarse_.tie * V + fine_.tie * v_free);
      fine_.a = a_free + fine_.by(lambda);
      fine_.v = v_free + 0.5 * dt * fine_.by(lambda);
    }
    coarse_.a = A_free + coarse_.by(lambda);
    free_velocity_ = V_free;
    coarse_.v = V_free + 0.5 * DT * coarse_.by(lambda);
    // Impulses that the tie has at this instant on the two sides, per unit step.
    const Eigen::VectorXd on_coarse = coarse_.mass.cwiseProduct(coarse_.a - A_free),
                          on_fine = fine_.tie.transpose() * lambda;
    imbalance_ = std::max(imbalance_, std::abs(on_coarse.sum() + on_fine.sum()) /
                                          (on_coarse.lpNorm<1>() + 1e-300));
  }

  double energy() const
  {
    return coarse_.rate_energy(ratio_ * fine_step_) + fine_.rate_energy(fine_step_);
  }
  /// Largest sum of the tie's forces on both sides over the force, for ties whose rows
  /// sum to zero.
  double imbalance() const { return imbalance_; }
  /// Largest |L_coarse v + L_fine v|.
  double gap() const
  {
    return (coarse_.tie * coarse_.v + fine_.tie * fine_.v).lpNorm<Eigen::Infinity>();
  }
  const TiedBody &coarse() const { return coarse_; }
  const TiedBody &fine() const { return fine_; }

private:
  TiedBody coarse_, fine_;
  Eigen::VectorXd free_velocity_; ///< of the coarse body, without the tie's last half step
  double fine_step_;
  int ratio_;
  double imbalance_ = 0.;
};
} // namespace antiform::testing

#pragma once

#include "support/grain_fixtures.h"

#include <Eigen/Dense>

#include <cmath>

namespace antiform::discrete::test
{
/// Highest circular frequency of the assembled motion and its mode (in the scaled
/// unknowns sqrt(m) u), from the forces alone: mass-scaled stiffness by central
/// differences, then power iteration until the Rayleigh quotient stands.
struct Mode
{
  double omega = 0.;
  std::vector<double> motion; ///< of (x, y, rotation) of each grain
};
inline double &freedom(Grains &g, const Eigen::Index i)
{
  std::vector<double> &motion =
      i % 3 == 0 ? g.displacement_x : (i % 3 == 1 ? g.displacement_y : g.rotation);
  return motion[i / 3];
}
inline double &velocity(Grains &g, const Eigen::Index i)
{
  std::vector<double> &motion =
      i % 3 == 0 ? g.velocity_x : (i % 3 == 1 ? g.velocity_y : g.spin);
  return motion[i / 3];
}
/// @p contacts: those that press, at rest and without shear; too deep to open by 1e-6.
inline Mode highest_mode(Sample sample, const Contacts &contacts = {})
{
  const Threads threads(1);
  const double h = 1e-6; // truncation 1e-12, rounding 1e-10 of the stiffness
  Grains &g = sample.grains;
  const auto n = static_cast<Eigen::Index>(3 * g.size());
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i)
    scale[i] = std::sqrt(i % 3 == 2 ? g.inverse_inertia[i / 3] : g.inverse_mass[i / 3]);
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    A.col(i).setZero();
    for (const double sign : {1., -1.})
    {
      freedom(g, i) = sign * h;
      compute_joint_forces(g, sample.joints, {}, nullptr);
      if (!contacts.contacts.empty())
      {
        // Their shear is that of a step from rest which leads here.
        Contacts pressed = contacts;
        velocity(g, i) = sign * h;
        add_contact_forces(g, pressed, 1.);
        velocity(g, i) = 0.;
      }
      for (Eigen::Index k = 0; k < n / 3; ++k)
        A.col(i).segment<3>(3 * k) -=
            sign / (2. * h) * Eigen::Vector3d(g.force_x[k], g.force_y[k], g.torque[k]);
    }
    freedom(g, i) = 0.;
  }
  const Eigen::MatrixXd symmetric = 0.5 * (A + A.transpose());
  A = scale.asDiagonal() * symmetric * scale.asDiagonal();

  // Squaring the matrix ten times makes a step of the iteration worth 1024.
  Eigen::MatrixXd power = A / A.norm();
  for (int i = 0; i < 10; ++i)
  {
    power = power * power;
    power /= power.norm();
  }
  Eigen::VectorXd v(n);
  Random random(1);
  for (Eigen::Index i = 0; i < n; ++i)
    v[i] = random(-1., 1.);
  double last = 0., now = 1.;
  while (std::abs(now - last) > 1e-13 * now)
  {
    v = (power * v).normalized();
    last = now;
    now = v.dot(A * v);
  }
  Mode mode{std::sqrt(now), {}};
  v = scale.asDiagonal() * v;
  mode.motion.assign(v.data(), v.data() + n);
  return mode;
}
} // namespace antiform::discrete::test

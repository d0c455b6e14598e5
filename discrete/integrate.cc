#include "discrete/integrate.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
double opposing(const double alpha, const double force, const double velocity)
{
  if (velocity == 0.)
    return 0.;
  return -std::copysign(alpha * std::abs(force), velocity);
}
} // namespace

void compute_damping(const Grains &grains,
                     const std::vector<double> &rx,
                     const std::vector<double> &ry,
                     const std::vector<double> &torque,
                     const double dt,
                     GrainDamping &damping)
{
  const auto n = static_cast<std::int64_t>(grains.size());
  for (std::vector<double> *v :
       {&damping.force_x, &damping.force_y, &damping.torque, &damping.energy})
    v->resize(grains.size(), 0.);
  const double alpha = damping.coefficient;
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < n; ++i)
  {
    damping.force_x[i] = opposing(alpha, rx[i], grains.velocity_x[i]);
    damping.force_y[i] = opposing(alpha, ry[i], grains.velocity_y[i]);
    damping.torque[i] = opposing(alpha, torque[i], grains.spin[i]);
    damping.energy[i] -=
        0.5 * dt *
        (damping.force_x[i] * grains.velocity_x[i] +
         damping.force_y[i] * grains.velocity_y[i] + damping.torque[i] * grains.spin[i]);
  }
}

void book_damping(const Grains &grains, const double dt, GrainDamping &damping)
{
  const auto n = static_cast<std::int64_t>(grains.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < n; ++i)
    damping.energy[i] -=
        0.5 * dt *
        (damping.force_x[i] * grains.velocity_x[i] +
         damping.force_y[i] * grains.velocity_y[i] + damping.torque[i] * grains.spin[i]);
}

void kick(Grains &grains, const double dt, const GrainDamping *damping)
{
  const auto n = static_cast<std::int64_t>(grains.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < n; ++i)
  {
    const double extra_x = damping != nullptr ? damping->force_x[i] : 0.;
    const double extra_y = damping != nullptr ? damping->force_y[i] : 0.;
    const double extra_torque = damping != nullptr ? damping->torque[i] : 0.;
    grains.velocity_x[i] += dt * grains.inverse_mass[i] * (grains.force_x[i] + extra_x);
    grains.velocity_y[i] += dt * grains.inverse_mass[i] * (grains.force_y[i] + extra_y);
    grains.spin[i] += dt * grains.inverse_inertia[i] * (grains.torque[i] + extra_torque);
  }
}

void drift(Grains &grains, const double dt)
{
  const auto n = static_cast<std::int64_t>(grains.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < n; ++i)
  {
    grains.displacement_x[i] += dt * grains.velocity_x[i];
    grains.displacement_y[i] += dt * grains.velocity_y[i];
    grains.rotation[i] += dt * grains.spin[i];
  }
}

GrainVelocities velocities(const Grains &grains)
{
  return {grains.velocity_x, grains.velocity_y, grains.spin};
}

double kinetic_energy(const Grains &grains, const GrainVelocities &before)
{
  double energy = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (grains.inverse_mass[i] > 0.)
      energy += 0.5 / grains.inverse_mass[i] *
                (before.x[i] * grains.velocity_x[i] + before.y[i] * grains.velocity_y[i]);
    if (grains.inverse_inertia[i] > 0.)
      energy += 0.5 / grains.inverse_inertia[i] * before.spin[i] * grains.spin[i];
  }
  return energy;
}

void scale_density(Grains &grains,
                   const std::vector<double> &translation_stiffness,
                   const std::vector<double> &rotation_stiffness,
                   const std::vector<double> &weight,
                   const double dt0)
{
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const double w = weight.empty() ? 1. : weight[i];
    const double m = std::max(grains.mass[i], translation_stiffness[i] * dt0 * dt0);
    const double j = std::max(grains.inertia[i], rotation_stiffness[i] * dt0 * dt0);
    grains.inverse_mass[i] = 1. / (w * m);
    grains.inverse_inertia[i] = 1. / (w * j);
  }
}
} // namespace antiform::discrete

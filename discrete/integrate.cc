#include "discrete/integrate.h"

#include "discrete/threading.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// -alpha |force| sgn(velocity), sgn(0) = 0; written for the vectoriser.
inline double opposing(const double alpha, const double force, const double velocity)
{
  const double size = alpha * std::abs(force);
  const double signed_size = velocity > 0. ? -size : size;
  return velocity == 0. ? 0. : signed_size;
}
} // namespace

// Bare pointers: they stay in registers, and the loops turn into vector code.

void compute_damping(const Grains &grains,
                     const std::vector<double> &rx,
                     const std::vector<double> &ry,
                     const std::vector<double> &torque,
                     const double dt,
                     GrainDamping &damping)
{
  for (std::vector<double> *v :
       {&damping.force_x, &damping.force_y, &damping.torque, &damping.energy})
    if (v->size() != grains.size())
      v->resize(grains.size(), 0.);
  const auto n = static_cast<std::int64_t>(grains.size());
  const double alpha = damping.coefficient;
  const double *const vx = grains.velocity_x.data(), *const vy = grains.velocity_y.data();
  const double *const spin = grains.spin.data();
  const double *const r_x = rx.data(), *const r_y = ry.data(), *const r_t = torque.data();
  double *const fx = damping.force_x.data(), *const fy = damping.force_y.data();
  double *const moment = damping.torque.data(), *const energy = damping.energy.data();
#pragma omp parallel for simd schedule(static) if (n >= threads_from_grains)
  for (std::int64_t i = 0; i < n; ++i)
  {
    const double x = opposing(alpha, r_x[i], vx[i]);
    const double y = opposing(alpha, r_y[i], vy[i]);
    const double t = opposing(alpha, r_t[i], spin[i]);
    fx[i] = x;
    fy[i] = y;
    moment[i] = t;
    energy[i] -= 0.5 * dt * (x * vx[i] + y * vy[i] + t * spin[i]);
  }
}

void book_damping(const Grains &grains, const double dt, GrainDamping &damping)
{
  const auto n = static_cast<std::int64_t>(grains.size());
  const double *const vx = grains.velocity_x.data(), *const vy = grains.velocity_y.data();
  const double *const spin = grains.spin.data();
  const double *const fx = damping.force_x.data(), *const fy = damping.force_y.data();
  const double *const moment = damping.torque.data();
  double *const energy = damping.energy.data();
#pragma omp parallel for simd schedule(static) if (n >= threads_from_grains)
  for (std::int64_t i = 0; i < n; ++i)
    energy[i] -= 0.5 * dt * (fx[i] * vx[i] + fy[i] * vy[i] + moment[i] * spin[i]);
}

namespace
{
/// v += dt M^-1 (f + d), d may be null.
void kick_component(const std::int64_t n,
                    const double dt,
                    const double *const inverse_mass,
                    const double *const force,
                    const double *const extra,
                    double *const velocity)
{
  if (extra == nullptr)
  {
#pragma omp for simd schedule(static) nowait
    for (std::int64_t i = 0; i < n; ++i)
      velocity[i] += dt * inverse_mass[i] * force[i];
    return;
  }
#pragma omp for simd schedule(static) nowait
  for (std::int64_t i = 0; i < n; ++i)
    velocity[i] += dt * inverse_mass[i] * (force[i] + extra[i]);
}
} // namespace

void kick(Grains &grains, const double dt, const GrainDamping *damping)
{
  const auto n = static_cast<std::int64_t>(grains.size());
  const double *const m = grains.inverse_mass.data();
  const double *const j = grains.inverse_inertia.data();
  const bool damped = damping != nullptr;
#pragma omp parallel if (n >= threads_from_grains)
  {
    kick_component(n, dt, m, grains.force_x.data(),
                   damped ? damping->force_x.data() : nullptr, grains.velocity_x.data());
    kick_component(n, dt, m, grains.force_y.data(),
                   damped ? damping->force_y.data() : nullptr, grains.velocity_y.data());
    kick_component(n, dt, j, grains.torque.data(),
                   damped ? damping->torque.data() : nullptr, grains.spin.data());
  }
}

void drift(Grains &grains, const double dt)
{
  const auto n = static_cast<std::int64_t>(grains.size());
  const double *const vx = grains.velocity_x.data(), *const vy = grains.velocity_y.data();
  const double *const spin = grains.spin.data();
  double *const ux = grains.displacement_x.data(), *const uy =
                                                       grains.displacement_y.data();
  double *const rotation = grains.rotation.data();
#pragma omp parallel for simd schedule(static) if (n >= threads_from_grains)
  for (std::int64_t i = 0; i < n; ++i)
  {
    ux[i] += dt * vx[i];
    uy[i] += dt * vy[i];
    rotation[i] += dt * spin[i];
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
    // Half as much again for the spins: the rotation of a grain is then no faster than
    // its translation, which lengthens the stable step by 15 %.
    const double j = std::max(grains.inertia[i], 1.5 * rotation_stiffness[i] * dt0 * dt0);
    grains.inverse_mass[i] = 1. / (w * m);
    grains.inverse_inertia[i] = 1. / (w * j);
  }
}
} // namespace antiform::discrete

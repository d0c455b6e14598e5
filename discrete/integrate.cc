#include "discrete/integrate.h"

#include "discrete/damping_law.h"
#include "discrete/joint_kernel.h"
#include "discrete/threading.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
// Bare pointers: they stay in registers, and the loops turn into vector code.

void GrainDamping::start(const std::size_t n_grains)
{
  for (std::vector<double> *v : {&force_x, &force_y, &torque})
    v->assign(n_grains, 0.);
  for (std::vector<double> *v : {&before_x, &before_y, &before_torque})
    v->assign(combined ? n_grains : 0, 0.);
  energy.assign((n_grains + damping_block - 1) / damping_block, 0.);
}

namespace
{
template <bool combined>
double damp_some(const std::int64_t n,
                 const double alpha,
                 const double *const r,
                 double *const r_before,
                 const double *const v,
                 const double *const inverse_mass,
                 double *const force)
{
  double power = 0.;
#pragma omp simd reduction(+ : power)
  for (std::int64_t i = 0; i < n; ++i)
  {
    double f;
    if (combined)
    {
      f = combined_damping(alpha, r[i], r_before[i], v[i]);
      r_before[i] = r[i];
    }
    else
      f = local_damping(alpha, r[i], v[i]);
    f = inverse_mass[i] > 0. ? f : 0.;
    power += (force[i] + f) * v[i];
    force[i] = f;
  }
  return power;
}
} // namespace

double damp(const std::int64_t n,
            const double alpha,
            const double *const r,
            double *const r_before,
            const double *const v,
            const double *const inverse_mass,
            double *const force)
{
  return r_before != nullptr
             ? damp_some<true>(n, alpha, r, r_before, v, inverse_mass, force)
             : damp_some<false>(n, alpha, r, nullptr, v, inverse_mass, force);
}

void damped_kick(Grains &grains, const double dt, GrainDamping &damping)
{
  if (damping.force_x.size() != grains.size())
    damping.start(grains.size());
  const KernelLevel &level = kernel_level();
  const auto before = [&](std::vector<double> &r)
  { return damping.combined ? r.data() : nullptr; };
  const double alpha = damping.coefficient;
  const double *const m = grains.inverse_mass.data();
  const double *const j = grains.inverse_inertia.data();
  const DampedKick components[3] = {
      {alpha, dt, grains.force_x.data(), before(damping.before_x), m,
       grains.velocity_x.data(), damping.force_x.data()},
      {alpha, dt, grains.force_y.data(), before(damping.before_y), m,
       grains.velocity_y.data(), damping.force_y.data()},
      {alpha, dt, grains.torque.data(), before(damping.before_torque), j,
       grains.spin.data(), damping.torque.data()}};
  const auto n = static_cast<std::int64_t>(grains.size());
  constexpr auto block = static_cast<std::int64_t>(damping_block);
  const std::int64_t n_blocks = (n + block - 1) / block;
#pragma omp parallel for schedule(static) if (n >= threads_from_grains)
  for (std::int64_t b = 0; b < n_blocks; ++b)
  {
    double power = 0.;
    for (const DampedKick &component : components)
      power += level.damped_kick(component, b * block, std::min(b * block + block, n));
    damping.energy[b] -= 0.5 * dt * power;
  }
}

namespace
{
/// v += dt M^-1 f.
void kick_component(const std::int64_t n,
                    const double dt,
                    const double *const inverse_mass,
                    const double *const force,
                    double *const velocity)
{
#pragma omp for simd schedule(static) nowait
  for (std::int64_t i = 0; i < n; ++i)
    velocity[i] += dt * inverse_mass[i] * force[i];
}
} // namespace

void kick(Grains &grains, const double dt)
{
  const auto n = static_cast<std::int64_t>(grains.size());
  const double *const m = grains.inverse_mass.data();
  const double *const j = grains.inverse_inertia.data();
#pragma omp parallel if (n >= threads_from_grains)
  {
    kick_component(n, dt, m, grains.force_x.data(), grains.velocity_x.data());
    kick_component(n, dt, m, grains.force_y.data(), grains.velocity_y.data());
    kick_component(n, dt, j, grains.torque.data(), grains.spin.data());
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

namespace
{
struct Inertia
{
  double mass, inertia;
};

Inertia scaled_inertia(const Grains &grains,
                       const std::size_t i,
                       const StiffnessSums &sums,
                       const std::vector<double> &weight,
                       const double dt0)
{
  const double w = weight.empty() ? 1. : weight[i];
  const double squared = dt0 * dt0;
  // Half as much again for the spins: the rotation of a grain is then no faster than
  // its translation, which lengthens the stable step by 15 %.
  return {w * std::max(grains.mass[i], sums.translation[i] * squared),
          w * std::max(grains.inertia[i], 1.5 * sums.rotation[i] * squared)};
}
} // namespace

void scale_density(Grains &grains,
                   const StiffnessSums &sums,
                   const std::vector<double> &weight,
                   const double dt0)
{
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const Inertia scaled = scaled_inertia(grains, i, sums, weight, dt0);
    grains.inverse_mass[i] = 1. / scaled.mass;
    grains.inverse_inertia[i] = 1. / scaled.inertia;
  }
}

double rescale_density(Grains &grains,
                       const StiffnessSums &sums,
                       const std::vector<double> &weight,
                       const double dt0)
{
  double lost = 0.;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (grains.inverse_mass[i] == 0.)
      continue; // its motion is prescribed
    const Inertia wanted = scaled_inertia(grains, i, sums, weight, dt0);
    const double vx = grains.velocity_x[i], vy = grains.velocity_y[i];
    lost += 0.5 * (1. / grains.inverse_mass[i] - wanted.mass) * (vx * vx + vy * vy) +
            0.5 * (1. / grains.inverse_inertia[i] - wanted.inertia) * grains.spin[i] *
                grains.spin[i];
    grains.inverse_mass[i] = 1. / wanted.mass;
    grains.inverse_inertia[i] = 1. / wanted.inertia;
  }
  return lost;
}
} // namespace antiform::discrete

#pragma once

#include "discrete/grains.h"

#include <vector>

namespace antiform::discrete
{
/// Local (non-viscous) damping of the grains (Cundall): on each degree of freedom the
/// damping force -alpha |r| sgn(v), r being the force that accelerates it. On a grain
/// that carries a multiplier r is the constrained force, not the sum of its contacts.
struct GrainDamping
{
  double coefficient = 0.;                      ///< alpha in [0, 1)
  std::vector<double> force_x, force_y, torque; ///< of this step [N], [N m]
  std::vector<double> energy;                   ///< removed so far, per grain [J]
};

/// Damping forces of this step from the accelerating forces @p rx, @p ry [N], @p torque
/// [N m] and the velocities; books the first half of their work.
void compute_damping(const Grains &grains,
                     const std::vector<double> &rx,
                     const std::vector<double> &ry,
                     const std::vector<double> &torque,
                     double dt,
                     GrainDamping &damping);
/// Second half of the work, with the velocities after kick and constraint.
void book_damping(const Grains &grains, double dt, GrainDamping &damping);

/// v += dt (force + damping) / m, likewise spins. @p damping may be null.
void kick(Grains &grains, double dt, const GrainDamping *damping);
/// u += dt v, likewise rotations.
void drift(Grains &grains, double dt);

/// Half-step velocities of all grains, kept when an energy sample is due.
struct GrainVelocities
{
  std::vector<double> x, y, spin;
};
GrainVelocities velocities(const Grains &grains);
/// Kinetic energy at the time of the positions, 1/2 m v(-).v(+), with the inertial
/// masses: the form that leapfrog conserves exactly on a linear system [J]. @p before is
/// v(-), the grains hold v(+).
double kinetic_energy(const Grains &grains, const GrainVelocities &before);

/// Inertial masses for quasi-static work: m* = w max(m, k dt0^2) with the unweighted
/// stiffness sums k, and J* = w max(J, 3/2 k_rot dt0^2). @p weight: mass weights mu (empty: 1).
void scale_density(Grains &grains,
                   const std::vector<double> &translation_stiffness,
                   const std::vector<double> &rotation_stiffness,
                   const std::vector<double> &weight,
                   double dt0);
} // namespace antiform::discrete

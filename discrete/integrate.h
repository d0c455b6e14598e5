#pragma once

#include "discrete/grains.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Non-viscous damping (Cundall) of each degree of freedom, r being the force that
/// accelerates it: on a grain that carries a multiplier the constrained force, not the
/// sum of its contacts.
///   local:    -alpha |r| sgn(v)
///   combined: alpha/2 |r| (sgn(dr/dt) - sgn(v))
/// The two are the same for a body that vibrates about a place of rest. Where it also
/// drifts faster than it vibrates, sgn(v) no longer changes: local damping leaves the
/// vibration alone and is a dry friction of alpha times its mean |r| on the drift, which
/// holds back the bending of a slender layer. Combined damping damps it all the same.
struct GrainDamping
{
  double coefficient = 0.; ///< alpha in [0, 1)
  bool combined = false;
  std::vector<double> force_x, force_y, torque;          ///< of the last step [N], [N m]
  std::vector<double> before_x, before_y, before_torque; ///< r of the last step; combined
  std::vector<double> energy; ///< removed so far, per block of grains [J]

  /// All zero for @p n_grains grains.
  void start(std::size_t n_grains);
};
/// Grains whose damping energy is summed up as one.
constexpr std::size_t damping_block = 512;

/// One component of the damping for @p n degrees of freedom of nodes.
/// \param r                the forces that accelerate, and at the last step @p r_before,
///                         which become these (combined; else null) [N]
/// \param v                velocities [m/s]
/// \param inverse_mass     no damping where it is 0
/// \param[in,out] force    damping forces, of the last step and then of this one [N]
/// \return power of the last step's forces and these together [W]
double damp(std::int64_t n,
            double alpha,
            const double *r,
            double *r_before,
            const double *v,
            const double *inverse_mass,
            double *force);

/// v += dt force / m, likewise spins.
void kick(Grains &grains, double dt);
/// The same with damping, in one pass over the grains: damping forces of this step from
/// the accelerating forces (grains.force_x and so on) and the velocities before the kick,
/// then v += dt (force + damping) / m. Books the work of half a step before and half a
/// step after the present velocities: that of the last step's damping and of this. The
/// energy is then that removed up to the time of the positions. @p dt is that of every
/// step. Grains that are held must be without force.
void damped_kick(Grains &grains, double dt, GrainDamping &damping);
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
/// stiffness sums k, and J* = w max(J, 3/2 k_rot dt0^2). @p weight: mass weights mu
/// (empty: 1).
void scale_density(Grains &grains,
                   const StiffnessSums &sums,
                   const std::vector<double> &weight,
                   double dt0);
/// The same in the course of a run, whose contacts have changed: the inertia of a
/// quasi-static run follows what a grain carries now, up and down, and velocities stay
/// (as in PFC). \return kinetic energy lost by that, less than 0 where it is gained [J]
double rescale_density(Grains &grains,
                       const StiffnessSums &sums,
                       const std::vector<double> &weight,
                       double dt0);
} // namespace antiform::discrete

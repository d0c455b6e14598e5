#pragma once

#include "discrete/contacts.h"
#include "discrete/integrate.h"
#include "discrete/joint_damage.h"
#include "discrete/joints.h"
#include "discrete/smooth_joints.h"
#include "discrete/walls.h"

#include <omp.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace antiform::discrete::test
{
/// Uniform numbers in [low, high) that are the same with every standard library.
class Random
{
public:
  explicit Random(const std::uint64_t seed)
      : engine_(seed)
  {
  }
  double operator()(const double low, const double high)
  {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  std::size_t index(const std::size_t n) { return engine_() % n; }

private:
  std::mt19937_64 engine_;
};

/// Number of threads for the time of a scope. Small samples run on one: more would only
/// wait for one another.
class Threads
{
public:
  explicit Threads(const int n)
      : before_(omp_get_max_threads())
  {
    omp_set_num_threads(n);
  }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads &) = delete;
  Threads &operator=(const Threads &) = delete;

private:
  int before_;
};

/// Grains and joints of a test, in units of its own (modulus 1e3, density 1, diameter 1
/// unless a test says otherwise).
struct Sample
{
  Grains grains;
  Joints joints;
  std::vector<Crack> cracks;
};

/// A law in the units of the samples; breaks nowhere near the deformations of the tests
/// that do not ask for breaks.
inline FlatJoint strong_law(const int n_elements = 3)
{
  FlatJoint law;
  law.effective_modulus = 1e3;
  law.stiffness_ratio = 2.2;
  law.tensile_strength = 1e9;
  law.cohesion = 1e9;
  law.tan_friction = 0.2;
  law.n_elements = n_elements;
  return law;
}

/// Triangular lattice of touching equal disks, rows along x.
inline Grains lattice(const int columns, const int rows, const double radius = 0.5)
{
  Grains grains;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      grains.add({2. * radius * (c + 0.5 * (r % 2)), std::sqrt(3.) * radius * r}, radius,
                 1., 0);
  return grains;
}

/// Lattice whose disks are shifted at random and have radii within a ratio of 1.66:
/// neighbours overlap a little or leave gaps.
inline Grains random_pack(const int columns, const int rows, const std::uint64_t seed)
{
  Random random(seed);
  Grains grains;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
    {
      const Vec2 shift{random(-0.08, 0.08), random(-0.08, 0.08)};
      grains.add(Vec2{c + 0.5 * (r % 2), 0.5 * std::sqrt(3.) * r} + shift,
                 random(0.375, 0.6225), 1., 0);
    }
  return grains;
}

/// Bond all pairs whose gap is at most @p installation_gap by one law.
inline void
bond_all(Sample &sample, const JointLaw &law, const double installation_gap = 0.15)
{
  sample.joints.begin_group(law, 0, "rock");
  for (const auto &[i, j] : pairs_within(sample.grains, installation_gap, 0, 0))
    sample.joints.add(sample.grains, i, j, joint_modulus(law), joint_modulus(law));
  sample.joints.finish(sample.grains.size());
}

/// Two grains along a direction, a gap (or overlap) apart, with one joint.
inline Sample bonded_pair(const JointLaw &law,
                          const double radius_1 = 0.5,
                          const double radius_2 = 0.5,
                          const double gap = 0.,
                          const double angle = 0.)
{
  Sample pair;
  const double distance = radius_1 + radius_2 + gap;
  pair.grains.add({0., 0.}, radius_1, 1., 0);
  pair.grains.add(rotated({distance, 0.}, angle), radius_2, 1., 0);
  pair.joints.begin_group(law, 0, "pair");
  pair.joints.add(pair.grains, 0, 1, joint_modulus(law), joint_modulus(law));
  pair.joints.finish(2);
  return pair;
}

/// Place the two grains of joint 0 so that it has the deformation @p d, the mean rotation
/// being zero.
inline void set_deformation(Sample &pair, const JointDeformation &d)
{
  const double half = 0.5 * d.rotation, d0 = pair.joints.length[0];
  const Vec2 n{pair.joints.normal_x[0], pair.joints.normal_y[0]}, t = perpendicular(n);
  // L - d0 n, with cos - 1 free of cancellation.
  const double along = d.gap - 2. * d0 * std::pow(std::sin(0.5 * half), 2);
  const double across = d.shear + pair.joints.lever_difference[0] * std::sin(half);
  const Vec2 u = along * n + across * t;
  pair.grains.displacement_x = {0., u.x};
  pair.grains.displacement_y = {0., u.y};
  pair.grains.rotation = {-half, half};
}

/// F, S, M of joint 0 from the forces on its grains, the mean rotation being zero.
struct Resultants
{
  double normal, shear, moment;
};
inline Resultants resultants(const Sample &pair, const JointDeformation &d)
{
  const Vec2 n{pair.joints.normal_x[0], pair.joints.normal_y[0]}, t = perpendicular(n);
  const Vec2 force{pair.grains.force_x[1], pair.grains.force_y[1]};
  Resultants r{-dot(force, n), -dot(force, t), 0.};
  // Torque of the force about the second grain: it acts at the middle of the two faces.
  const double half = 0.5 * d.rotation;
  const double r2 = 0.5 * (pair.joints.length[0] + pair.joints.lever_difference[0]);
  const Vec2 face = -r2 * rotated(n, half);
  const Vec2 middle = face + -0.5 * (d.gap * n + d.shear * t);
  r.moment = pair.grains.torque[1] - cross(middle, force);
  return r;
}

/// Forces for the deformation @p d of joint 0; breaks go to the sample's cracks.
inline Resultants load(Sample &pair, const JointDeformation &d, const double dt = 1.)
{
  set_deformation(pair, d);
  compute_joint_forces(pair.grains, pair.joints, {0, 0., dt}, &pair.cracks);
  return resultants(pair, d);
}

/// The terms of the energy balance [J]; strain is that of joints, contacts and walls.
struct EnergyTerms
{
  double kinetic = 0., strain = 0., slip = 0., damping = 0., dashpot = 0., fracture = 0.;
  double work = 0.; ///< of the walls
};

/// A sample with everything that the explicit step may hold, and the step itself.
struct ExplicitRun
{
  Sample sample;
  Contacts contacts;
  std::optional<SmoothJoints> smooth;
  std::vector<Wall> walls;
  GrainDamping damping;
  Vec2 gravity; ///< [m/s^2]; no part of the energy terms
  bool has_contacts = false;
  bool breaks = true;
  std::uint64_t step = 0;
  double time = 0.;
  GrainVelocities before; ///< half-step velocities before the last kick

  explicit ExplicitRun(Sample initial)
      : sample(std::move(initial))
  {
  }

  /// Forces at the present positions.
  void add_forces(const double dt)
  {
    Grains &grains = sample.grains;
    compute_joint_forces(grains, sample.joints, {step, time, dt},
                         breaks ? &sample.cracks : nullptr);
    if (has_contacts)
    {
      if (needs_search(grains, contacts))
        search();
      add_contact_forces(grains, contacts, dt);
    }
    if (smooth)
      add_smooth_joint_forces(grains, *smooth, {step, time, dt},
                              breaks ? &sample.cracks : nullptr);
    for (Wall &wall : walls)
      add_wall_forces(grains, wall);
    if (gravity.x != 0. || gravity.y != 0.)
      for (std::size_t i = 0; i < grains.size(); ++i)
      {
        grains.force_x[i] += grains.mass[i] * gravity.x;
        grains.force_y[i] += grains.mass[i] * gravity.y;
      }
  }

  void search()
  {
    if (!smooth)
    {
      search_contacts(sample.grains, sample.joints, contacts);
      return;
    }
    SmoothJointSearch fractures(sample.grains, *smooth, contacts.margin);
    search_contacts(sample.grains, sample.joints, contacts, &fractures);
    fractures.finish();
  }

  /// Forces, damping, kick; the state is then that of the time of the positions. A wall
  /// moves at constant speed: its reaction works for half a step before and after.
  void first_half(const double dt)
  {
    Grains &grains = sample.grains;
    add_forces(dt);
    if (step > 0)
      add_work(dt);
    before = velocities(grains);
    if (damping.coefficient > 0.)
      damped_kick(grains, dt, damping);
    else
      kick(grains, dt);
  }

  void second_half(const double dt)
  {
    add_work(dt);
    take_released(sample.joints, contacts);
    drift(sample.grains, dt);
    for (Wall &wall : walls)
      wall.displacement += dt * wall.velocity;
    ++step;
    time += dt;
  }

  void advance(const double dt)
  {
    first_half(dt);
    second_half(dt);
  }

  /// Energies at the time of the positions, between first_half() and second_half().
  EnergyTerms energies() const
  {
    EnergyTerms e;
    const JointEnergies joints = joint_energies(sample.grains, sample.joints);
    const ContactEnergies touching = contact_energies(sample.grains, contacts);
    e.kinetic = kinetic_energy(sample.grains, before);
    e.strain = joints.strain + touching.strain;
    e.slip = joints.slip + touching.slip;
    e.fracture = joints.fracture;
    e.dashpot = touching.dashpot;
    if (smooth)
    {
      const JointEnergies fractures = smooth_joint_energies(*smooth);
      e.strain += fractures.strain;
      e.slip += fractures.slip;
      e.fracture += fractures.fracture;
    }
    for (const double energy : damping.energy)
      e.damping += energy;
    for (const Wall &wall : walls)
    {
      e.strain += wall_energy(sample.grains, wall);
      e.work += wall.work;
    }
    return e;
  }

private:
  void add_work(const double dt)
  {
    for (Wall &wall : walls)
      wall.work += 0.5 * dt * wall.velocity * wall.reaction;
  }
};

/// Prescribe the motion of @p grain: no force accelerates it.
inline void hold(Grains &grains, const std::size_t grain)
{
  grains.inverse_mass[grain] = grains.inverse_inertia[grain] = 0.;
}

/// Random half-step velocities of at most @p speed, spins of at most @p spin.
inline void
shake(Grains &grains, const double speed, const double spin, const std::uint64_t seed)
{
  Random random(seed);
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    grains.velocity_x[i] = random(-speed, speed);
    grains.velocity_y[i] = random(-speed, speed);
    grains.spin[i] = random(-spin, spin);
  }
}
} // namespace antiform::discrete::test

#pragma once

#include "discrete/vec2.h"

#include <cstddef>
#include <string>
#include <vector>

namespace antiform::discrete
{
/// Parallel arrays: entry i is grain i, a rigid disk of unit thickness. Grains keep their
/// number for the whole run; none is ever removed after the scene is built.
///
/// Motion is kept as displacement from the reference position, not as position: the
/// joints' gaps are then differences of small numbers, and a grain that has not moved
/// has exactly zero displacement.
struct Grains
{
  // Constant after the scene is built.
  std::vector<double> reference_x; ///< [m]
  std::vector<double> reference_y; ///< [m]
  std::vector<double> radius;      ///< [m]
  std::vector<double> mass;        ///< real mass, for weight and constraints [kg]
  std::vector<double> inertia;     ///< real polar inertia [kg m^2]
  std::vector<int> region;         ///< index of the grain region (0: competent layer)

  // State, listed by the checkpoint.
  std::vector<double> displacement_x; ///< [m]
  std::vector<double> displacement_y; ///< [m]
  std::vector<double> rotation;       ///< counter-clockwise [rad], not wrapped
  std::vector<double> velocity_x;     ///< half-step velocity [m/s]
  std::vector<double> velocity_y;     ///< [m/s]
  std::vector<double> spin;           ///< half-step angular velocity [rad/s]

  // Set before the first step: inertia of the motion, weighted and scaled.
  std::vector<double> inverse_mass;    ///< 0 where the motion is prescribed [1/kg]
  std::vector<double> inverse_inertia; ///< [1/(kg m^2)]

  // Results of a step.
  std::vector<double> force_x; ///< [N]
  std::vector<double> force_y; ///< [N]
  std::vector<double> torque;  ///< [N m]

  std::size_t size() const { return radius.size(); }

  /// Append a grain at rest. @p density [kg/m^3]; its inverse mass and inertia are those
  /// of the real disk until somebody weights or scales them.
  void add(const Vec2 &centre, double radius, double density, int region);

  Vec2 reference(const std::size_t i) const { return {reference_x[i], reference_y[i]}; }
  Vec2 position(const std::size_t i) const
  {
    return {reference_x[i] + displacement_x[i], reference_y[i] + displacement_y[i]};
  }
  Vec2 velocity(const std::size_t i) const { return {velocity_x[i], velocity_y[i]}; }
};

/// Sums of contact stiffness on each grain: translation k_n A + k_s A [N/m] and rotation,
/// levers included [N m].
struct StiffnessSums
{
  std::vector<double> translation;
  std::vector<double> rotation;
};
} // namespace antiform::discrete

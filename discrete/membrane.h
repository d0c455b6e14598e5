#pragma once

#include "discrete/grains.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// The outer grains, counter-clockwise, each a neighbour of the next and the last of the
/// first: the longest boundary of the alpha shape of the grains' centres (Edelsbrunner et
/// al. 1983), whose ball of radius @p reach [m] cannot pass between them. What has come
/// off the body is left outside. Throws std::invalid_argument when the ball fits between
/// all grains.
std::vector<std::int32_t> outer_ring(const Grains &grains, double reach);

/// A flexible membrane: pressure on the segments between neighbours of a chain, half of
/// it on each of the two. A follower load: over a closed ring force and moment are zero.
struct Membrane
{
  std::vector<std::int32_t> ring;
  /// Segment k goes from ring[k] to ring[k + 1]; 0 where something else bears on it.
  std::vector<unsigned char> loaded;
};

/// Add its forces under @p pressure [Pa] to the grains.
/// \return the power of these forces at the grains' velocities [W]
double add_membrane_forces(Grains &grains, const Membrane &membrane, double pressure);

/// Power of the forces that it has at the present positions, for the present velocities.
double membrane_power(const Grains &grains, const Membrane &membrane, double pressure);

/// Area that the ring encloses [m^2].
double enclosed_area(const Grains &grains, const Membrane &membrane);
} // namespace antiform::discrete

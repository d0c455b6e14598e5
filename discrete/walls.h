#pragma once

#include "discrete/grains.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace antiform::discrete
{
/// Contact of a grain with a wall: stress-free at its reference gap, no tension, no
/// shear.
struct WallContact
{
  std::int32_t grain = 0;
  double reference_gap = 0.; ///< [m]
  double stiffness = 0.;     ///< k_n [N/m]: 2 E* (A = 2 R, L = R)
  double weight = 1.;        ///< bridging weight of the grain [-]
  double initial_gap = 0.;   ///< elastic gap that the prestress stands for, <= 0 [m]
  bool late = false;         ///< found in the course of the run
};

/// Of a wall that turns about its point, counter-clockwise positive.
struct WallTurn
{
  double rotation = 0.; ///< so far [rad]
  double spin = 0.;     ///< half-step [rad/s]
  /// On the grains about the point, of the last evaluation, weighted [N m].
  double moment = 0.;
};

/// Rigid frictionless wall: a straight line that moves along its normal. Where it turns
/// too, each grain keeps its place on it and is pushed along the normal of the unturned
/// wall: as by a wall that is just rough enough not to squeeze the grains out along it
/// (docs/theory/loading.md).
struct Wall
{
  Vec2 point;                        ///< of the wall in the reference section [m]
  Vec2 normal;                       ///< unit, into the grains
  double displacement = 0.;          ///< along the normal so far [m]
  double velocity = 0.;              ///< along the normal, half-step [m/s]
  std::optional<WallTurn> turn;      ///< empty: it does not turn
  std::vector<WallContact> contacts; ///< in the order of grains

  double reaction = 0.;           ///< pressing force of the last evaluation, weighted [N]
  double pressing_stiffness = 0.; ///< of the contacts that pressed then, weighted [N/m]
  double work = 0.;               ///< done on the grains so far [J]
};

/// Let @p wall hold every grain whose gap to it is at most @p reach [m], stress-free
/// where it stands when the gap is at most @p installation_gap, at contact otherwise.
/// \param modulus E* of each grain's region [Pa]
void install_wall_contacts(const Grains &grains,
                           Wall &wall,
                           double reach,
                           double installation_gap,
                           const std::vector<double> &modulus);

/// Let @p wall hold grains too that have come within @p reach of it since [m], at
/// contact. Grains that it holds already stay as they are.
void find_wall_contacts(const Grains &grains,
                        Wall &wall,
                        double reach,
                        const std::vector<double> &modulus);

/// Insert a contact in the order of grains.
void insert_contact(Wall &wall, const WallContact &contact);

/// Add the wall's forces to the grains; sets reaction, and the moment where it turns.
void add_wall_forces(Grains &grains, Wall &wall);

/// Part of the wall's present pressing force that grains of @p region take [N].
double region_reaction(const Grains &grains, const Wall &wall, int region);

/// Force with which @p wall presses the grain of @p contact, along its normal [N].
double wall_force(const Wall &wall, const WallContact &contact, const Grains &grains);

/// Place of @p grain on @p wall: its reference distance from the wall's point along the
/// wall, positive on the left of the normal [m].
double wall_lever(const Wall &wall, const Grains &grains, std::int32_t grain);

/// 1 for a wall whose normal has x > 0, else -1: counter-clockwise turns times it press
/// the lower side of a section between two walls.
inline double pressing_sense(const Wall &wall)
{
  return wall.normal.x > 0. ? 1. : -1.;
}

/// Elastic gap of @p contact, negative where it presses [m].
double wall_gap(const Wall &wall, const WallContact &contact, const Grains &grains);

/// Strain energy of the wall's contacts [J].
double wall_energy(const Grains &grains, const Wall &wall);

/// A wall that follows a pressure (Itasca's servo): its speed v = beta A / (K dt) (p -
/// measured), K the stiffness of the contacts that press, so that one step changes the
/// stress by the share beta of the error. Inward positive [m/s].
/// \param area     of the wall's face [m^2]
/// \param pressure wanted, compression positive [Pa]
/// \param limit    of the speed [m/s]
double servo_speed(
    const Wall &wall, double area, double pressure, double gain, double limit, double dt);
} // namespace antiform::discrete

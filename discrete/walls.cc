#include "discrete/walls.h"

#include <algorithm>
#include <cmath>

namespace antiform::discrete
{
namespace
{
/// Along the normal so far, where @p grain has its place on @p wall [m].
double way_at(const Wall &wall, const Grains &grains, const std::int32_t grain)
{
  return wall.turn ? wall.displacement - wall_lever(wall, grains, grain) *
                                             std::sin(wall.turn->rotation)
                   : wall.displacement;
}

double gap_to(const Wall &wall, const Grains &grains, const std::int32_t i)
{
  // Differences of displacements, so that nothing moves exactly when nothing has moved.
  const Vec2 displacement{grains.displacement_x[i], grains.displacement_y[i]};
  return dot(grains.reference(i) - wall.point, wall.normal) - grains.radius[i] +
         (dot(displacement, wall.normal) - way_at(wall, grains, i));
}
} // namespace

double wall_lever(const Wall &wall, const Grains &grains, const std::int32_t grain)
{
  const Vec2 left{-wall.normal.y, wall.normal.x};
  return dot(grains.reference(grain) - wall.point, left);
}

double wall_gap(const Wall &wall, const WallContact &contact, const Grains &grains)
{
  const Vec2 displacement{grains.displacement_x[contact.grain],
                          grains.displacement_y[contact.grain]};
  const double installed =
      dot(grains.reference(contact.grain) - wall.point, wall.normal) -
      grains.radius[contact.grain] - contact.reference_gap;
  return installed +
         (dot(displacement, wall.normal) - way_at(wall, grains, contact.grain)) +
         contact.initial_gap;
}

void install_wall_contacts(const Grains &grains,
                           Wall &wall,
                           const double reach,
                           const double installation_gap,
                           const std::vector<double> &modulus)
{
  wall.contacts.clear();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const double gap = gap_to(wall, grains, static_cast<std::int32_t>(i));
    if (gap > reach)
      continue;
    WallContact contact;
    contact.grain = static_cast<std::int32_t>(i);
    contact.reference_gap = gap <= installation_gap ? gap : 0.;
    contact.stiffness = 2. * modulus[grains.region[i]];
    wall.contacts.push_back(contact);
  }
}

void insert_contact(Wall &wall, const WallContact &contact)
{
  wall.contacts.insert(std::upper_bound(wall.contacts.begin(), wall.contacts.end(),
                                        contact,
                                        [](const WallContact &a, const WallContact &b)
                                        { return a.grain < b.grain; }),
                       contact);
}

void find_wall_contacts(const Grains &grains,
                        Wall &wall,
                        const double reach,
                        const std::vector<double> &modulus)
{
  std::vector<WallContact> found;
  auto held = wall.contacts.begin();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const auto grain = static_cast<std::int32_t>(i);
    while (held != wall.contacts.end() && held->grain < grain)
      ++held;
    if ((held != wall.contacts.end() && held->grain == grain) ||
        gap_to(wall, grains, grain) > reach)
      continue;
    WallContact contact;
    contact.grain = grain;
    contact.stiffness = 2. * modulus[grains.region[i]];
    contact.late = true;
    found.push_back(contact);
  }
  for (const WallContact &contact : found)
    insert_contact(wall, contact);
}

void add_wall_forces(Grains &grains, Wall &wall)
{
  wall.reaction = wall.pressing_stiffness = 0.;
  double turning = 0.; // sum of force times lever
  for (const WallContact &contact : wall.contacts)
  {
    const double gap = wall_gap(wall, contact, grains);
    if (gap >= 0.)
      continue;
    const double push = -contact.weight * contact.stiffness * gap;
    grains.force_x[contact.grain] += push * wall.normal.x;
    grains.force_y[contact.grain] += push * wall.normal.y;
    wall.reaction += push;
    wall.pressing_stiffness += contact.weight * contact.stiffness;
    if (wall.turn)
      turning += push * wall_lever(wall, grains, contact.grain);
  }
  if (wall.turn)
    wall.turn->moment = -turning * std::cos(wall.turn->rotation);
}

double region_reaction(const Grains &grains, const Wall &wall, const int region)
{
  double sum = 0.;
  for (const WallContact &contact : wall.contacts)
    if (grains.region[contact.grain] == region)
    {
      const double gap = wall_gap(wall, contact, grains);
      if (gap < 0.)
        sum -= contact.weight * contact.stiffness * gap;
    }
  return sum;
}

double wall_force(const Wall &wall, const WallContact &contact, const Grains &grains)
{
  const double gap = wall_gap(wall, contact, grains);
  return gap < 0. ? -contact.weight * contact.stiffness * gap : 0.;
}

double wall_energy(const Grains &grains, const Wall &wall)
{
  double energy = 0.;
  for (const WallContact &contact : wall.contacts)
  {
    const double gap = wall_gap(wall, contact, grains);
    if (gap < 0.)
      energy += 0.5 * contact.weight * contact.stiffness * gap * gap;
  }
  return energy;
}

double servo_speed(const Wall &wall,
                   const double area,
                   const double pressure,
                   const double gain,
                   const double limit,
                   const double dt)
{
  double stiffness = wall.pressing_stiffness;
  if (stiffness == 0.) // nothing presses yet: as if all did
    for (const WallContact &contact : wall.contacts)
      stiffness += contact.weight * contact.stiffness;
  if (stiffness == 0.)
    return 0.;
  const double speed = gain * (pressure * area - wall.reaction) / (stiffness * dt);
  return std::clamp(speed, -limit, limit);
}
} // namespace antiform::discrete

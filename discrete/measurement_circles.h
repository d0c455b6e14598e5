#pragma once

#include "discrete/contacts.h"
#include "discrete/grains.h"
#include "discrete/joints.h"
#include "discrete/packing.h"
#include "discrete/smooth_joints.h"
#include "discrete/walls.h"

#include <vector>

namespace antiform::discrete
{
/// A circle in which averages are taken, as in PFC.
struct MeasurementCircle
{
  Vec2 centre;        ///< [m]
  double radius = 0.; ///< [m]
};

/// A symmetric tensor of the plane.
struct PlaneTensor
{
  double xx = 0., yy = 0., xy = 0.;
};

/// Averages over one circle; stress and strain positive in tension and extension.
struct CircleMeasure
{
  PlaneTensor stress;              ///< [Pa]
  PlaneTensor strain;              ///< since the reference section; xy is half of gamma
  PlaneTensor strain_rate;         ///< [1/s]
  double porosity = 0.;            ///< [-]
  double coordination_number = 0.; ///< joints and touching contacts a grain [-]
  std::size_t grains = 0;          ///< with their centre in the circle
};

/// Everything that can carry force between grains; what is absent is null.
struct ForceCarriers
{
  const Joints *joints = nullptr;
  const Contacts *contacts = nullptr;
  std::vector<const std::vector<Wall> *> walls = {};
  const SmoothJoints *smooth = nullptr;
};

/// Averages over @p circle at the present positions, from the forces of the last
/// evaluation (docs/theory/measurement_circles.md). The mesh beside grains is no part of
/// them.
CircleMeasure measure(const Grains &grains,
                      const ForceCarriers &carriers,
                      const MeasurementCircle &circle);

/// The circle that follows the rock of @p reference: moved by the mean displacement of
/// the grains whose reference centre lies in it. No such grain: where it was.
MeasurementCircle follow(const Grains &grains, const MeasurementCircle &reference);

/// Part of the straight line from @p a to @p b that lies in @p circle [-].
double share_inside(const Vec2 &a, const Vec2 &b, const MeasurementCircle &circle);

/// Area common to all of @p disks, exact to round-off (two or more, none the same as
/// another).
double common_area(const std::vector<Disk> &disks);
} // namespace antiform::discrete

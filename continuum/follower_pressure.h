#pragma once

#include "continuum/displacement_space.h"
#include "continuum/loads.h"

#include <functional>

namespace antiform::continuum
{
/// Pressure that stays across the faces it acts on while they turn and stretch: of a
/// fluid, a membrane, a confinement (Bonet & Wood 2008, 6.5). For bodies of finite
/// strain; at small strain it is the dead pressure() of loads.h.
class FollowerPressure
{
public:
  /// \param pressure by place in the reference body, positive pushes in [Pa]; it moves
  ///                 with the body
  /// The space must outlive the pressure.
  FollowerPressure(const DisplacementSpace &space,
                   BoundaryIds boundaries,
                   std::function<double(const dealii::Point<2> &)> pressure);
  FollowerPressure(const DisplacementSpace &space,
                   BoundaryIds boundaries,
                   double pressure);

  /// Add @p factor times -integral p n N da over the current faces to @p force (owned
  /// entries, to be compressed) [N], and, unless it is null, subtract its derivative to
  /// the displacements from @p tangent (likewise). The derivative is not symmetric, but
  /// where a uniform pressure surrounds the body or ends at nodes that are held.
  void add(const Vector &displacement,
           double factor,
           Vector &force,
           dealii::TrilinosWrappers::SparseMatrix *tangent) const;

private:
  const DisplacementSpace &space_;
  BoundaryIds boundaries_;
  std::function<double(const dealii::Point<2> &)> pressure_;
};
} // namespace antiform::continuum

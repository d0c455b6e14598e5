#pragma once

#include "continuum/displacement_space.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// The mesh's linear theory holds for small strains and rotations: beyond 5 degrees or
/// 10 % it is off by several per cent, which a run says; at twice that it stops.
class SmallStrainWatch
{
public:
  /// measure() and demand().
  void look(const continuum::DisplacementSpace &space,
            const continuum::Vector &displacement,
            long step);
  /// Look at a displacement, ghosts set, in the middle of the cells. Collective.
  void measure(const continuum::DisplacementSpace &space,
               const continuum::Vector &displacement);
  /// Throws NumericalError at twice a limit, on all ranks.
  void demand(long step) const;
  bool is_beyond() const; ///< twice a limit
  std::vector<std::string> warnings() const;

  double largest_rotation = 0.; ///< so far [rad]
  double largest_strain = 0.;   ///< principal [-]
};
} // namespace antiform::cases

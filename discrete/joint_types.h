#pragma once

#include "discrete/joints.h"

#include <cstdint>

namespace antiform::discrete
{
/// Shares of the joints that begin without bonds (Potyondy 2012: types B, G and S; by
/// joint): slits, which touch, and gapped ones. The rest is bonded.
struct JointTypes
{
  double slit_fraction = 0.;   ///< phi_S [-]
  double gapped_fraction = 0.; ///< phi_G [-]
  double gap_ratio = 0.;       ///< mean of g_0 over the mean grain radius [-]
  double gap_deviation = 0.;   ///< standard deviation of g_0 over its mean [-]
};

/// Take the bonds off joint @p j before anything has moved: its faces are @p gap [m]
/// apart (0: a slit) and only rub. Its history is that of a broken joint from then on.
void unbond(Joints &joints, std::size_t j, double gap);

/// Unbond the share of @p group that @p types asks for. A joint's lot depends on the
/// numbers of its grains and on @p seed alone. g_0 is normal, cut off at 0.
void unbond_some(Joints &joints,
                 std::size_t group,
                 const JointTypes &types,
                 double mean_radius,
                 std::uint64_t seed);

/// Standard deviations of a joint's strengths over their means.
struct StrengthScatter
{
  double tension = 0.;  ///< of the tensile strength [-]
  double cohesion = 0.; ///< [-]
  bool any() const { return tension > 0. || cohesion > 0.; }
};

/// Give each joint of @p group strengths of its own, both drawn independently: normal,
/// within three deviations and above a twentieth of the mean. A joint's lot depends on
/// the numbers of its grains and on @p seed alone; all of its elements share it.
void scatter_strengths(Joints &joints,
                       std::size_t group,
                       const StrengthScatter &scatter,
                       std::uint64_t seed);
} // namespace antiform::discrete

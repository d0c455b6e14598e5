#include "discrete/joint_types.h"

#include "discrete/joint_damage.h"
#include "discrete/random.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace antiform::discrete
{
void unbond(Joints &joints, const std::size_t j, const double gap)
{
  if (joints.damage[j] >= 0)
    throw std::logic_error("a joint without bonds cannot lose them");
  if (gap > 0.)
  {
    for (std::vector<double> *v :
         {&joints.initial_gap, &joints.initial_shear, &joints.initial_rotation})
      v->resize(joints.size(), 0.);
    joints.initial_gap[j] = gap;
  }
  const std::size_t k = add_damaged(joints, j);
  for (int e = 0; e < joints.damaged.n_elements(); ++e)
    joints.damaged.set_bond(k, e, Bond::unbonded);
  joints.damaged.gap[k] = gap;
}

void unbond_some(Joints &joints,
                 const std::size_t group,
                 const JointTypes &types,
                 const double mean_radius,
                 const std::uint64_t seed)
{
  constexpr std::uint64_t stream = 7; // of joint types, among the uses of a seed
  for (std::size_t j = joints.groups[group].begin; j < joints.groups[group].end; ++j)
  {
    const auto [low, high] = std::minmax(joints.first[j], joints.second[j]);
    Random random(seed, (stream << 56) + (static_cast<std::uint64_t>(low) << 28) +
                            static_cast<std::uint64_t>(high));
    const double lot = random.uniform();
    if (lot < types.slit_fraction)
      unbond(joints, j, 0.);
    else if (lot < types.slit_fraction + types.gapped_fraction)
    {
      // Box and Muller; 1 - u is never 0.
      const double u = 1. - random.uniform(), v = random.uniform();
      const double normal = std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * v);
      const double mean = types.gap_ratio * mean_radius;
      unbond(joints, j, std::max(0., mean * (1. + types.gap_deviation * normal)));
    }
  }
}
} // namespace antiform::discrete

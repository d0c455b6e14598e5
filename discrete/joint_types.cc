#include "discrete/joint_types.h"

#include "discrete/joint_damage.h"
#include "discrete/random.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace antiform::discrete
{
namespace
{
// Among the uses of a seed.
constexpr std::uint64_t stream_of_types = 7, stream_of_strengths = 8;

/// Of the pair of grains alone, whichever is first.
Random random_of_joint(const Joints &joints,
                       const std::size_t j,
                       const std::uint64_t seed,
                       const std::uint64_t stream)
{
  const auto [low, high] = std::minmax(joints.first[j], joints.second[j]);
  return {seed, (stream << 56) + (static_cast<std::uint64_t>(low) << 28) +
                    static_cast<std::uint64_t>(high)};
}

/// Normal about 1, drawn again beyond three deviations and below a twentieth.
double draw_factor(Random &random, const double deviation)
{
  double normal = 0., factor = 0.;
  do
  {
    normal = random.normal();
    factor = 1. + deviation * normal;
  } while (std::abs(normal) > 3. || factor < 0.05);
  return factor;
}
} // namespace

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
  for (std::size_t j = joints.groups[group].begin; j < joints.groups[group].end; ++j)
  {
    Random random = random_of_joint(joints, j, seed, stream_of_types);
    const double lot = random.uniform();
    if (lot < types.slit_fraction)
      unbond(joints, j, 0.);
    else if (lot < types.slit_fraction + types.gapped_fraction)
    {
      const double mean = types.gap_ratio * mean_radius;
      unbond(joints, j,
             std::max(0., mean * (1. + types.gap_deviation * random.normal())));
    }
  }
}

void scatter_strengths(Joints &joints,
                       const std::size_t group,
                       const StrengthScatter &scatter,
                       const std::uint64_t seed)
{
  joints.tension_factor.resize(joints.size(), 1.);
  joints.cohesion_factor.resize(joints.size(), 1.);
  for (std::size_t j = joints.groups[group].begin; j < joints.groups[group].end; ++j)
  {
    Random random = random_of_joint(joints, j, seed, stream_of_strengths);
    joints.tension_factor[j] = draw_factor(random, scatter.tension);
    joints.cohesion_factor[j] = draw_factor(random, scatter.cohesion);
  }
}
} // namespace antiform::discrete

// Compiled once per vector level, like joint_kernel_level.cc; all give the same bits.
#include "discrete/damping_law.h"
#include "discrete/joint_kernel.h"

namespace antiform::discrete::ANTIFORM_LEVEL
{
namespace
{
inline Lanes read(const double *from, Lanes)
{
  return load(from);
}
inline double read(const double *from, double)
{
  return *from;
}
inline void write(double *to, const Lanes v)
{
  store(to, v);
}
inline void write(double *to, const double v)
{
  *to = v;
}

/// Entry @p i, or (V = Lanes) four from there on. \return power of the last step's and of
/// these damping forces
template <class V, bool combined>
inline V kick_some(const DampedKick &in, const std::size_t i)
{
  const V r = read(in.force + i, V{}), v = read(in.velocity + i, V{});
  V damping;
  if (combined)
  {
    damping = combined_damping(in.alpha, r, read(in.force_before + i, V{}), v);
    write(in.force_before + i, r);
  }
  else
    damping = local_damping(in.alpha, r, v);
  const V power = (read(in.damping + i, V{}) + damping) * v;
  write(in.damping + i, damping);
  write(in.velocity + i, v + in.dt * read(in.inverse_mass + i, V{}) * (r + damping));
  return power;
}

template <bool combined>
double kick_all(const DampedKick &in, const std::size_t begin, const std::size_t end)
{
  Lanes sums{};
  std::size_t i = begin;
  for (; i + n_lanes <= end; i += n_lanes)
    sums += kick_some<Lanes, combined>(in, i);
  double power = (sums[0] + sums[2]) + (sums[1] + sums[3]);
  for (; i < end; ++i)
    power += kick_some<double, combined>(in, i);
  return power;
}
} // namespace

double damped_kick(const DampedKick &in, const std::size_t begin, const std::size_t end)
{
  return in.force_before != nullptr ? kick_all<true>(in, begin, end)
                                    : kick_all<false>(in, begin, end);
}
} // namespace antiform::discrete::ANTIFORM_LEVEL

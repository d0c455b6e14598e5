#pragma once

#include <cstdint>
#include <cstring>

// Four joints at a time. g++'s vector types mean the same IEEE operations at every vector
// level, a lane as a scalar: results have the same bits everywhere. Everything here has
// internal linkage, so that no two objects built for different processors share code.

namespace antiform::discrete
{
using Lanes = double __attribute__((vector_size(32)));
using LaneMask = std::int64_t __attribute__((vector_size(32)));
using LanePair = double __attribute__((vector_size(16)));
constexpr std::size_t n_lanes = 4;

namespace
{
// Templates over double and Lanes (and their masks) see one interface.
template <class Mask, class V>
inline V select(const Mask mask, const V yes, const V no)
{
  return mask ? yes : no;
}
inline double absolute(const double x)
{
  return __builtin_fabs(x);
}
inline Lanes absolute(const Lanes x)
{
  return (Lanes)((LaneMask)x & INT64_MAX);
}
template <class V>
inline V smaller(const V a, const V b)
{
  return a < b ? a : b;
}
template <class V>
inline V larger(const V a, const V b)
{
  return a > b ? a : b;
}
inline bool any(const bool mask)
{
  return mask;
}
inline bool any(const LaneMask mask)
{
#ifdef __AVX__
  return __builtin_ia32_movmskpd256((Lanes)mask) != 0;
#else
  return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
#endif
}

inline Lanes load(const double *from)
{
  Lanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline LanePair load_pair(const double *from)
{
  LanePair v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store(double *to, const Lanes v)
{
  std::memcpy(to, &v, sizeof v);
}
inline Lanes join(const LanePair low, const LanePair high)
{
  return __builtin_shufflevector(low, high, 0, 1, 2, 3);
}
/// Even and odd lanes of two, pair by pair: a0 b0 a2 b2 and a1 b1 a3 b3.
inline Lanes evens(const Lanes a, const Lanes b)
{
  return __builtin_shufflevector(a, b, 0, 4, 2, 6);
}
inline Lanes odds(const Lanes a, const Lanes b)
{
  return __builtin_shufflevector(a, b, 1, 5, 3, 7);
}
inline Lanes lower_halves(const Lanes a, const Lanes b)
{
  return __builtin_shufflevector(a, b, 0, 1, 4, 5);
}
inline Lanes upper_halves(const Lanes a, const Lanes b)
{
  return __builtin_shufflevector(a, b, 2, 3, 6, 7);
}
/// Rows to columns and back.
inline void transpose(Lanes &a, Lanes &b, Lanes &c, Lanes &d)
{
  const Lanes ab_even = evens(a, b), ab_odd = odds(a, b);
  const Lanes cd_even = evens(c, d), cd_odd = odds(c, d);
  a = lower_halves(ab_even, cd_even);
  b = lower_halves(ab_odd, cd_odd);
  c = upper_halves(ab_even, cd_even);
  d = upper_halves(ab_odd, cd_odd);
}
} // namespace
} // namespace antiform::discrete

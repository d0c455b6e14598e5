#pragma once

#include "discrete/lanes.h"

// The formulas of non-viscous damping, for one degree of freedom or four at a time.
// Internal linkage, as in lanes.h.

namespace antiform::discrete
{
namespace
{
/// -1, 0 or 1, without a branch: signs of a vibration are beyond any prediction.
template <class V>
inline V sign(const V x)
{
  const V none{}, one = none + 1.;
  return select(x > none, one, none) - select(x < none, one, none);
}

/// -alpha |r| sgn(v) (Cundall).
template <class V>
inline V local_damping(const double alpha, const V r, const V v)
{
  return -(alpha * absolute(r)) * sign(v);
}

/// alpha/2 |r| (sgn(r - r of the last step) - sgn(v)).
template <class V>
inline V combined_damping(const double alpha, const V r, const V r_before, const V v)
{
  return 0.5 * (alpha * absolute(r)) * (sign(r - r_before) - sign(v));
}
} // namespace
} // namespace antiform::discrete

#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace antiform::continuum
{
/// What two nodes or points of strips that lie on one another may be apart, over the
/// shorter side of a cell there: well above round-off, well below the next node.
constexpr double same_place = 1e-6;

/// Order things with members x and y [m] for at_place().
template <class T>
void sort_by_place(std::vector<T> &things)
{
  std::sort(things.begin(), things.end(),
            [](const T &a, const T &b)
            { return a.x < b.x || (a.x == b.x && a.y < b.y); });
}

/// The first of the sorted things that lies within @p tolerance of the place in x and in
/// y [m]; null without one.
template <class T>
const T *at_place(const std::vector<T> &things,
                  const double x,
                  const double y,
                  const double tolerance)
{
  auto thing = std::lower_bound(things.begin(), things.end(), x - tolerance,
                                [](const T &a, const double left) { return a.x < left; });
  for (; thing != things.end() && thing->x <= x + tolerance; ++thing)
    if (std::abs(thing->y - y) <= tolerance)
      return &*thing;
  return nullptr;
}
} // namespace antiform::continuum

#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
/// Throw std::invalid_argument "NAME is VALUE UNIT; it must be ALLOWED." unless @p holds.
inline void require(const bool holds,
                    const std::string &name,
                    const double value,
                    const std::string &unit,
                    const std::string &allowed)
{
  if (holds)
    return;
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  throw std::invalid_argument(name + " is " + number + (unit.empty() ? "" : " ") + unit +
                              "; it must be " + allowed + ".");
}
} // namespace antiform::continuum

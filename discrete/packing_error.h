#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
/// No packing as asked for is found: the run ends with exit status 2.
struct PackingError : std::runtime_error
{
  /// \param reason what happened and what to change
  /// \param value  the offending number, and \p limit what it may be at most
  PackingError(const std::string &reason, const double value, const double limit)
      : std::runtime_error("packing: " + reason + numbers(value, limit))
  {
  }

private:
  static std::string numbers(const double value, const double limit)
  {
    char text[96];
    std::snprintf(text, sizeof text, " (value %.6g, limit %.6g)", value, limit);
    return text;
  }
};
} // namespace antiform::discrete

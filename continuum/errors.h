#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

namespace antiform
{
/// The physics' error: no convergence, inverted cell, unstable step, not a number. Always
/// on, raised on all ranks together; main() saves the last good state and exits 2.
struct NumericalError : std::runtime_error
{
  /// \param component  who refuses, as the deck calls it
  /// \param reason     what happened and what to change
  /// \param value      the offending number, and \p limit what it may be at most
  /// \param step       of the stepping loop; -1 outside of it
  NumericalError(const std::string &component,
                 const std::string &reason,
                 const double value,
                 const double limit,
                 const long step = -1)
      : std::runtime_error(text(component, reason, value, limit, step))
      , component(component)
      , value(value)
      , limit(limit)
      , step(step)
  {
  }

  std::string component;
  double value;
  double limit;
  long step;

private:
  static std::string text(const std::string &component,
                          const std::string &reason,
                          const double value,
                          const double limit,
                          const long step)
  {
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, " (value %.6g, limit %.6g)", value, limit);
    return component + (step >= 0 ? ", step " + std::to_string(step) : "") + ": " +
           reason + numbers;
  }
};
} // namespace antiform

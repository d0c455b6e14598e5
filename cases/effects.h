#pragma once

#include "cases/parameters.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// An effect of the program and whether a scene has it.
struct Effect
{
  enum class State
  {
    present,
    when_needed, ///< joins when the run makes it necessary
    absent
  };
  std::string name;
  State state = State::absent;
  std::string reason;
};

/// Every effect that the program has, for this scene: what `antiform check` lists and
/// what build() composes by.
std::vector<Effect> list_effects(const Parameters &parameters);

/// The reason of one of them.
std::string reason_for(const Parameters &parameters, const std::string &effect);
} // namespace antiform::cases

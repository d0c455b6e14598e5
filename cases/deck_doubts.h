#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// Why the figures of a deck that can be run will not be worth much, and what to do: told
/// by 'antiform check', and by the run as warnings.
std::vector<std::string> doubts_of(const Parameters &parameters,
                                   const SectionGeometry &geometry);
} // namespace antiform::cases

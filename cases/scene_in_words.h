#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"

#include <iosfwd>

namespace antiform::cases
{
/// A line for each part of the section and for what loads it: the deck's ratios and what
/// they come to. Builds nothing.
void print_scene(const Parameters &parameters,
                 const SectionGeometry &geometry,
                 std::ostream &out);
} // namespace antiform::cases

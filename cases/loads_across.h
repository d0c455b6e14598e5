#pragma once

#include "cases/closed_forms.h"
#include "cases/geometry.h"

namespace antiform::cases
{
/// Section of `antiform theory` on loads across the layer of a deck: arch, snap-through,
/// upheaval. \param why_none why none of them applies; empty: they may
TheorySection
loads_across(const Parameters &p, const SectionGeometry &g, const std::string &why_none);
} // namespace antiform::cases

#pragma once

#include "cases/grain_section.h"
#include "cases/summary.h"
#include "discrete/packing.h"

namespace antiform::cases
{
/// The grains of the layer before they are numbered, and up to which gap they are bonded.
struct LayerPacking
{
  discrete::Packing packing;    ///< its quality is that with this gap
  double installation_gap = 0.; ///< [m]
};

discrete::PackingParameters packing_parameters(const Parameters &parameters, int seed);

/// Pack the layer as the deck asks, or take it from the cache of packings. Throws
/// InputError when porosity or coordination number are out of the packing's reach.
LayerPacking make_layer_packing(const Parameters &parameters,
                                const SectionGeometry &geometry,
                                const Progress &progress);

/// The figures of a packing by name, and in one line.
void report_packing(const discrete::PackingQuality &quality,
                    std::map<std::string, Result> &results);
std::string packing_text(const discrete::PackingQuality &quality);

/// The tile that matrix grains are cut from, likewise.
discrete::PeriodicTile make_tile(const Parameters &parameters, const Progress &progress);
} // namespace antiform::cases

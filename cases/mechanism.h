#pragma once

#include "cases/geometry.h"
#include "continuum/layer_theory.h"

#include <vector>

namespace antiform::cases
{
/// How the layer of a deck is expected to fail, by closed forms
/// (docs/theory/continuum.md). gamma is a buckling load over the load that crushes the
/// layer.
struct Mechanism
{
  double slenderness_ratio;     ///< Lambda [-]
  double critical_length_ratio; ///< L/h at Lambda = 1 [-]
  double pinned, guided;        ///< gamma with the matrix; ends that turn, or do not [-]
  double bare_pinned, bare_guided; ///< the same without it [-]
  bool crushes_first;              ///< long before it could fold
};

/// The deck's layer as the closed forms see it: one layer, whatever its beds.
continuum::theory::Layer layer_of(const Parameters &p);

/// What lies above and below the layer: the cover with a free top, and the base on what
/// it stands on. None without a matrix.
std::vector<continuum::theory::Side> matrix_sides(const Parameters &p);

/// The layer between them in the contact of the deck, or on its foundation where there is
/// no matrix; a frictional interface counts as one that holds.
continuum::theory::SupportedLayer supported_layer(const Parameters &p);

Mechanism expect_mechanism(const Parameters &p, const SectionGeometry &g);
} // namespace antiform::cases

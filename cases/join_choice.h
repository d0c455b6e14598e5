#pragma once

#include "cases/parameters.h"

namespace antiform::cases
{
/// Where the deck leaves it to the program ('Matrix/Join' = 'automatic'): how a layer of
/// grains and its matrix meet, by the thickness of the cover, and why. A cover of matrix
/// grains may stand on a base of mesh; the surface interface is for both sides at once.
/// Whatever is thinner than a row of cells gets a row of its own.
void choose_join(Parameters &p);

/// What was chosen and why, for people. \pre something was
std::string join_in_words(const Parameters &p);

/// Least cover in mean grain diameters that is worth the name of grains [-].
constexpr double thinnest_grain_cover = 4.;

/// What a cover or base must hold from the layer outward to be joined in an overlap:
/// buffer, overlap, and a row of cells that is mesh only [m].
double room_of_overlap(const Parameters &p);

/// Is @p room [m] as much as @p needed [m], but for rounding?
inline bool holds(const double room, const double needed)
{
  return needed <= room * (1. + 1e-12);
}
} // namespace antiform::cases

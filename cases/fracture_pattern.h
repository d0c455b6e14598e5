#pragma once

#include "cases/geometry.h"
#include "cases/summary.h"
#include "discrete/joints.h"

#include <vector>

namespace antiform::cases
{
/// Places along the layer before shortening of its fractures in tension, ascending [m]:
/// groups of cracks, each within 1.5 mean grain diameters of another, that reach over a
/// fifth of the layer's thickness (an element is as wide as a grain). As
/// report_figures.py draws them.
std::vector<double> fracture_places(const std::vector<discrete::Crack> &cracks,
                                    double diameter,
                                    double thickness);

/// Share of the length of the layer's tension cracks that lies across it, at more than
/// 45 degrees to its axis as laid down: what opens where a fold stretches an arc, where
/// cracks along the layer split what is compressed. 0 of no crack [-].
double share_across(const std::vector<discrete::Crack> &cracks,
                    const SectionGeometry &geometry);

/// A bent layer when its stress was largest.
struct FoldAtPeak
{
  double amplitude = 0.; ///< crest over troughs [m]
  double limb_dip = 0.;  ///< [degrees]
  double n_tensile = 0., n_shear = 0.; ///< cracks so far
};

/// How the peak came about, by the growth of the fold up to it, amplitude over that as
/// laid down. An elastic layer has grown by 1/(1 - N/N_cr) under N: twofold at half of its
/// buckling load, tenfold at nine tenths.
enum class FoldMechanism
{
  crushes = 1,          ///< grown less than twofold
  folds_and_cracks = 2, ///< between
  buckles = 3           ///< grown tenfold
};
FoldMechanism mechanism_of(double growth);

/// Results of a layer of grains, shortened: its fractures, and of a bent one the fold at
/// the peak and the mechanism.
void report_fold(const std::vector<discrete::Crack> &cracks,
                 const SectionGeometry &geometry,
                 const FoldAtPeak &peak,
                 Summary &summary);
} // namespace antiform::cases

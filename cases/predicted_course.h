#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"

namespace antiform::cases
{
/// How far a run is expected to go, from its deck and closed forms. Counts are numbers
/// without unit.
struct PredictedCourse
{
  double shortening = 0.;     ///< at the end [-]
  double steps = 0.;          ///< in time, of load or events; of buckling: 1
  double solves = 0.;         ///< of systems of equations; 0 in time
  double collapse_steps = 0.; ///< in time, between those of the event driver
  double samples = 0.;        ///< lines of history.csv
  double field_files = 0.;
};

/// On the sides of the layer: by walls or a membrane, or by the matrix at its depth [Pa].
double side_pressure(const Parameters &parameters);

/// Strain at which a layer or specimen fails, roughly [-].
double predict_strain_at_peak(const Parameters &parameters,
                              const SectionGeometry &geometry);

/// The event driver's longest: that of the deck, but where walls pull short enough for
/// the strength, which lies within one of its records [-].
double longest_load_step(const Parameters &parameters);
/// Half of it; where it is long, so that events end most steps, short enough for the
/// strength of any body [-].
double half_load_step(const Parameters &parameters);

PredictedCourse predict_course(const Parameters &parameters,
                               const SectionGeometry &geometry);
} // namespace antiform::cases

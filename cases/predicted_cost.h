#pragma once

#include "cases/geometry.h"
#include "cases/machine_speed.h"
#include "cases/parameters.h"
#include "cases/predicted_course.h"
#include "cases/sizes.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// What a part of a run takes [s]: of one core, and of the clock on so many threads.
struct CostShare
{
  std::string what;
  double core_seconds, wall_seconds;
};

/// What a run is expected to take on this machine: counts of its deck, times the speeds
/// measured on the spot. No run reads it.
struct PredictedCost
{
  PredictedCourse course;
  std::vector<CostShare> shares; ///< in the order of a run
  double memory = 0.;            ///< [bytes]

  double core_seconds() const; ///< of a run on one thread
  double wall_seconds() const; ///< with a free core for each thread
};

PredictedCost predict_cost(const Parameters &parameters,
                           const SectionGeometry &geometry,
                           const Sizes &sizes,
                           MachineSpeed &speed,
                           int threads = 1);
} // namespace antiform::cases

#pragma once

#include "cases/trial.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// A result of the laboratory that the grains are to reach.
struct Target
{
  std::string name; ///< "young_modulus", "strength_at_10MPa"
  Test test;        ///< that measures it
  bool is_modulus = false;
  double value = 0., tolerance = 0.; ///< [Pa], relative
};

/// A micro-parameter that the search may change. It goes by a coordinate without bounds,
/// u = ln((v - lower) / (upper - v)), where v is the value, or its logarithm.
struct FreeParameter
{
  MicroName micro;
  double lower = 0., upper = 0.; ///< of the value
  bool is_logarithmic = false;
  double difference = 0.; ///< step of v in finite differences

  double coordinate(double value) const;
  double value(double coordinate) const;
  double slope(double coordinate) const; ///< dv/du
};

/// All that a calibration is asked for.
struct CalibrationProblem
{
  std::vector<Target> targets;
  std::vector<FreeParameter> free;
  MicroParameters start;
  int first_seed = 1, search_seeds = 3;
  int check_seeds = 3, check_rounds = 3;
  int evaluations = 6;
};

/// Throws InputError when the laboratory data cannot be read.
CalibrationProblem calibration_problem(const Parameters &parameters);

/// All tests that the targets need, each once.
std::vector<Test> tests_of(const std::vector<Target> &targets);
} // namespace antiform::cases

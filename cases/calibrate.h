#pragma once

#include "cases/calibration_search.h"
#include "cases/program.h"

#include <iosfwd>
#include <string>

namespace antiform::cases
{
/// From the targets of a deck to a rock file. Writes into options.output: trials.csv and
/// the trials, calibration.json, rock.prm, deck.prm, log.txt. For one rank. Throws
/// InputError. \return exit status: 0 met on fresh packings, 2 not met or a trial failed,
/// 3 interrupted
int calibrate(const Parameters &parameters, const RunOptions &options);

/// What a calibration would take: trials, time. \return exit status
int check_cost_of_calibration(const Parameters &parameters, bool json, std::ostream &out);

/// Throws InputError unless the deck is a calibration, or is none (@p wanted false).
void demand_calibration(const Parameters &parameters, bool wanted);

/// A rock for the decks, like those of cases/rocks, with where it comes from above it.
std::string rock_file(const Parameters &parameters,
                      const CalibrationProblem &problem,
                      const CalibrationResult &result,
                      const std::string &date);

/// A line a target: wanted, expected, reached on fresh packings, met or not.
std::vector<std::string> table_of(const CalibrationProblem &problem,
                                  const CalibrationResult &result);
} // namespace antiform::cases

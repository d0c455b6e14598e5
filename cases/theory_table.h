#pragma once

#include "cases/summary.h"

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace antiform::cases
{
struct Parameters;
struct TheoryOptions;

/// What applies of closed_forms(), by names as 'Study/Collect' has them:
/// "theory/critical/scene_smooth/wavelength". \param friction_angle of the rock [degrees]
std::map<std::string, Result> theory_figures(const Parameters &parameters,
                                             double friction_angle);

/// Print a table (CSV) of the closed forms along the values that `--along` gives, for the
/// scene of the deck @p file: a line a combination, its values first; a column a figure
/// that some line has, named as in study.csv. Throws InputError with the problems of all
/// values. For one rank. \return exit status
int print_theory_table(const std::string &file,
                       const std::vector<std::string> &overrides,
                       const TheoryOptions &options,
                       std::ostream &out);
} // namespace antiform::cases

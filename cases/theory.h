#pragma once

#include <iosfwd>
#include <string>

namespace antiform::cases
{
struct Parameters;

/// What the command line asks of `antiform theory`.
struct TheoryOptions
{
  bool json = false;
  std::string plot;            ///< file (.svg) for the diagram; empty: none
  std::string along;           ///< values of entries for a table; empty: none
  double friction_angle = 42.; ///< of the rock, in the large [degrees]
};

/// Print the closed forms for the scene of a deck, for people or as JSON (SI units), and
/// draw its diagram of gamma against Lambda. Throws InputError when the diagram cannot be
/// written. For one rank. \return exit status
int print_theory(const Parameters &parameters,
                 const TheoryOptions &options,
                 std::ostream &out);
} // namespace antiform::cases

#pragma once

#include "cases/parameters.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// A figure in SI units.
struct Quantity
{
  std::string name; ///< in JSON; empty: the row's own
  double value;
  std::string unit;
  std::string symbol; ///< for people, before the value; may be empty
};

/// One row of `antiform theory`: figures, or words in place of them.
struct TheoryRow
{
  std::string name;  ///< in JSON
  std::string label; ///< for people
  std::vector<Quantity> quantities;
  std::string words;
  bool applies = true; ///< false: words tell why not
};

TheoryRow figure_row(const std::string &name,
                     const std::string &label,
                     double value,
                     const std::string &unit);
TheoryRow
words_row(const std::string &name, const std::string &label, const std::string &words);
/// What does not apply.
TheoryRow
no_row(const std::string &name, const std::string &label, const std::string &reason);

struct TheorySection
{
  std::string name, title;
  std::vector<TheoryRow> rows;
};

/// Theta up to which a cover does not count (1 % of the critical stress) and from which
/// it is deep (2 %) [-].
constexpr double shallow_theta = 0.3, deep_theta = 2.;

/// Weight of the matrix; 0 without gravity [N/m^3].
double unit_weight(const Parameters &p);
/// What presses on the crest of the layer from above, rho g H + p [Pa].
double load_of_cover(const Parameters &p);

/// Confinement of the layer of a deck.
struct Confinement
{
  double pressure = 0.;      ///< p on its faces [Pa]
  double friction_angle;     ///< of the rock [degrees]
  double failure_ratio = 1.; ///< gamma_p = (sigma_1 - p) / UCS at failure [-]
};
/// By surface pressure and cover at the crest's axis, or by walls or membrane around a
/// specimen. \param friction_angle of the rock [degrees]
Confinement confinement_of(const Parameters &p, double friction_angle);

/// The closed forms of docs/theory/continuum.md for the scene of a deck. What does not
/// apply to it is there, with the reason. \param friction_angle of the rock [degrees]
std::vector<TheorySection> closed_forms(const Parameters &p, double friction_angle);
} // namespace antiform::cases

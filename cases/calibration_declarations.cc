// What a deck may say of a calibration.
#include "cases/declarations.h"

namespace antiform::cases
{
namespace
{
void declare_targets(CalibrationParameters &c, Declarations &entries)
{
  entries.number("Young modulus", c.young_modulus, "Target: E; 0: none [Pa].",
                 Number::at_least(0.));
  entries.choice(
      "Modulus from", c.modulus_from,
      "elastic: E of specimens that do not break, which is that of intact "
      "layers; uniaxial: the slope between 30 and 60 % of the UCS, which cracks "
      "lower.",
      "elastic|uniaxial");
  entries.number("Tensile strength", c.tensile_strength,
                 "Target: strength in direct tension; 0: from the laboratory data, or "
                 "none [Pa].",
                 Number::at_least(0.));
  entries.number("UCS", c.compressive_strength,
                 "Target: uniaxial compressive strength; 0: from the laboratory data, or "
                 "none [Pa].",
                 Number::at_least(0.));
  entries.numbers("Confinements", c.confinements,
                  "sigma_3 of the confined tests, rising; empty: none [Pa].",
                  Number::above(0.));
  entries.numbers("Strengths", c.strengths,
                  "Targets: sigma_1 at those confinements; empty: from the laboratory "
                  "data [Pa].",
                  Number::above(0.));
  entries.text("Laboratory data", c.data,
               "Table (.csv, beside the deck) with columns sigma3_MPa, sigma1_MPa and "
               "perhaps site; its Hoek-Brown line gives the strengths that are not given "
               "above.");
  entries.text("Site", c.site, "Rows of that table to use; empty: all.");
  entries.number("Modulus tolerance", c.modulus_tolerance, "Relative, of E [-].",
                 Number::above(0.).below(1.));
  entries.number("Tension tolerance", c.tension_tolerance,
                 "Relative, of the tensile strength [-].", Number::above(0.).below(1.));
  entries.number("Uniaxial tolerance", c.uniaxial_tolerance, "Relative, of UCS [-].",
                 Number::above(0.).below(1.));
  entries.number("Confined tolerance", c.confined_tolerance,
                 "Relative, of the strengths under confinement [-].",
                 Number::above(0.).below(1.));
}

void declare_search(CalibrationParameters &c, Declarations &entries)
{
  entries.list("Free", c.free,
               "Micro-parameters to search for: effective modulus, tensile strength, "
               "cohesion, friction angle; also residual friction and slit fraction. The "
               "others are those of the layer.");
  entries.choice("Start", c.start,
                 "targets: from rules of thumb for the targets; rock: from the layer.",
                 "targets|rock");
  entries.number("Range factor", c.range_factor,
                 "Modulus and strengths stay between their start over and times this "
                 "[-].",
                 Number::above(1.));
  entries.numbers("Friction angle bounds", c.angle_bounds,
                  "Least and largest phi_b [degrees].", Number::at_least(0.).below(85.));
  entries.numbers("Residual friction bounds", c.friction_bounds, "Least and largest [-].",
                  Number::at_least(0.));
  entries.numbers("Slit fraction bounds", c.slit_bounds, "Least and largest [-].",
                  Number::at_least(0.).up_to(0.9));
}

void declare_cost(CalibrationParameters &c, Declarations &entries)
{
  entries.whole("Search seeds", c.search_seeds,
                "Packings whose mean the search brings to the targets; the first is "
                "'Layer/Seed' [-].",
                Number::between(1, 100));
  entries.whole("Check seeds", c.check_seeds,
                "Fresh packings, whose mean must meet the targets [-].",
                Number::between(1, 100));
  entries.whole("Check rounds", c.check_rounds,
                "A check that fails adds its packings to the search and is repeated, "
                "corrected, on further fresh ones: checks at most [-].",
                Number::between(1, 20));
  entries.whole("Evaluations", c.evaluations,
                "Sets of micro-parameters that the search tests at most, finite "
                "differences apart [-].",
                Number::between(1, 100));
  entries.whole("Jobs", c.jobs, "Trials at once, a thread each; 0: as many as cores [-].",
                Number::between(0, 1024));
  entries.number("Tension transits per millistrain", c.transits_of_tension,
                 "Slowness of the grips; 'Walls/Transits per millistrain' is that of the "
                 "platens [-].",
                 Number::above(0.));
}
} // namespace

void declare(CalibrationParameters &calibration, Declarations &entries)
{
  entries.enter("Calibration");
  declare_targets(calibration, entries);
  declare_search(calibration, entries);
  declare_cost(calibration, entries);
  entries.leave();
}
} // namespace antiform::cases

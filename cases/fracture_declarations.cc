// What a deck may say of fractures and of measurement circles.
#include "cases/declarations.h"

namespace antiform::cases
{
namespace
{
void declare_network(FracturesParameters &fractures, Declarations &entries)
{
  const auto numbers = [&](const std::string &name, std::vector<double> &value,
                           const std::string &what, const Number &range)
  { entries.numbers(name, value, what, range); };
  numbers("Intensity", fractures.intensity,
          "P21 of each set of a drawn network, length of traces per area, a list; empty: "
          "none is drawn [1/m].",
          Number::above(0.));
  numbers("Spacing ratio", fractures.spacing_ratio,
          "Spacing over h of each set of parallel fractures that go all the way through, "
          "at even distances (P21 is 1/spacing), a list; empty: none, and not beside a "
          "drawn network [-].",
          Number::above(0.));
  numbers("Phase", fractures.phase,
          "Distance over the spacing from the origin, on the axis beside the fold below "
          "the crest, to a trace of such a set, one number or one for each set [-].",
          Number::between(0., 1.));
  numbers("Orientation", fractures.orientation,
          "Direction of the traces, from x, in a drawn network its mean, one number or "
          "one for each set [degrees].",
          Number::between(-180., 180.));
  numbers("Orientation deviation", fractures.orientation_deviation,
          "Standard deviation of it in a drawn network [degrees].",
          Number::between(0., 90.));
  entries.choice("Length law", fractures.length_law,
                 "Distribution of the lengths, of all sets.",
                 "constant|exponential|lognormal|power law");
  numbers("Mean length", fractures.mean_length, "But for a power law [m].",
          Number::above(0.));
  numbers("Length deviation", fractures.length_deviation,
          "Standard deviation of a lognormal length [m].", Number::at_least(0.));
  numbers("Length exponent", fractures.length_exponent,
          "a of a power law: the density of lengths falls as length^-a [-].",
          Number::above(0.));
  numbers("Shortest", fractures.shortest, "Least length; a power law needs it [m].",
          Number::at_least(0.));
  numbers("Longest", fractures.longest,
          "Largest length, 0 for no bound; a power law needs it [m].",
          Number::at_least(0.));
  entries.choice("Region", fractures.region,
                 "Where the sets lie: in the layer, or in the whole section.",
                 "layer|section");
  entries.whole("Seed", fractures.seed,
                "Of the network; the same seed draws the same fractures [-].",
                Number::at_least(0.));
}
} // namespace

void declare(FracturesParameters &fractures, Declarations &entries)
{
  entries.enter("Fractures");
  entries.text("List", fractures.list,
               "Tips of fractures, x1 y1 x2 y2 of each, separated by semicolons [m].");
  entries.text("Table", fractures.table,
               "Table (.csv, beside the deck) with columns x1_m, y1_m, x2_m, y2_m and, "
               "where wanted, friction_angle_deg, dilation_angle_deg, cohesion_Pa, "
               "tensile_strength_Pa, dip_deg; empty: none.");
  declare_network(fractures, entries);
  entries.number("Normal stiffness", fractures.law.normal_stiffness,
                 "k_n of the smooth joints, 0 for that of the joints that they replace "
                 "[Pa/m].",
                 Number::at_least(0.));
  entries.number("Shear stiffness", fractures.law.shear_stiffness, "k_s, likewise [Pa/m].",
                 Number::at_least(0.));
  entries.angle("Friction angle", fractures.law.friction,
                "Of the unbonded fracture [degrees].");
  entries.angle("Dilation angle", fractures.law.tan_dilation,
                "psi, opening per slip is tan(psi); at most the friction angle "
                "[degrees].");
  entries.flag("Bonded", fractures.law.bonded,
               "Are the fractures healed, with the three strengths below?");
  entries.number("Tensile strength", fractures.law.tensile_strength,
                 "Of a bonded fracture [Pa].", Number::at_least(0.));
  entries.number("Cohesion", fractures.law.cohesion,
                 "Shear strength of a bonded fracture without normal stress [Pa].",
                 Number::at_least(0.));
  entries.angle("Bonded friction angle", fractures.law.tan_friction,
                "By which pressure adds to it [degrees].");
  entries.leave();
}

void declare(MeasurementCirclesParameters &circles, Declarations &entries)
{
  entries.enter("Measurement circles");
  entries.number("Radius ratio", circles.radius,
                 "Radius of each circle over the mean grain diameter; the stress of one "
                 "circle scatters with its power -3/2 [-].",
                 Number::at_least(1.));
  entries.text(
      "Centres", circles.centres,
      "A list, 'x y; x y', in the section before shortening; empty: a grid [m].");
  entries.whole("Along the layer", circles.along,
                "Circles of the grid along the layer; 0: side by side [-].",
                Number::at_least(0.));
  entries.whole("Across the layer", circles.across,
                "Circles of the grid across the layer [-].", Number::at_least(1.));
  entries.leave();
}
} // namespace antiform::cases

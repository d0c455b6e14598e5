// What a deck may say: every entry with its unit, range and default.
#include "cases/declarations.h"

#include <algorithm>

namespace antiform::cases
{
namespace
{
void declare_strengths(double &tensile_strength,
                       double &cohesion,
                       double &tan_friction,
                       double &residual_friction,
                       Declarations &entries)
{
  entries.number("Tensile strength", tensile_strength,
                 "sigma_b, normal stress at which a bonded element breaks [Pa].",
                 Number::at_least(0.));
  entries.number("Cohesion", cohesion,
                 "c_b, shear strength of a bonded element without normal stress [Pa].",
                 Number::at_least(0.));
  entries.angle("Friction angle", tan_friction,
                "phi_b, by which pressure adds to the shear strength of a bonded element "
                "[degrees].");
  entries.number("Residual friction", residual_friction,
                 "mu, friction coefficient of a broken element [-].",
                 Number::at_least(0.));
}

void declare(discrete::FlatJoint &joint, Declarations &entries)
{
  entries.enter("Flat joint");
  entries.number(
      "Effective modulus", joint.effective_modulus,
      "E*, of grains and bonds; the stiffness of a joint follows from it and the "
      "two radii [Pa].",
      Number::above(0.));
  entries.number("Stiffness ratio", joint.stiffness_ratio,
                 "kappa, normal over shear stiffness [-].", Number::above(0.));
  declare_strengths(joint.tensile_strength, joint.cohesion, joint.tan_friction,
                    joint.residual_friction, entries);
  entries.number("Residual cohesion", joint.residual_cohesion,
                 "Shear strength of the closed part of a broken element without pressure "
                 "[Pa].",
                 Number::at_least(0.));
  entries.number("Radius multiplier", joint.radius_multiplier,
                 "lambda, half length of the joint over the smaller radius [-].",
                 Number::above(0.).up_to(1.));
  entries.whole("Elements", joint.n_elements,
                "N, elements of a joint; each breaks on its own [-].",
                Number::between(1, 16));
  entries.flag("Element moment", joint.element_moment,
               "Does the stress vary linearly within an element, or is it uniform?");
  entries.leave();
}

void declare(discrete::ParallelBond &bond, Declarations &entries)
{
  entries.enter("Parallel bond");
  entries.number("Bond modulus", bond.bond_modulus,
                 "E_c, of the cement; its stiffness follows from it and the two radii "
                 "[Pa].",
                 Number::above(0.));
  entries.number("Stiffness ratio", bond.stiffness_ratio,
                 "kappa, normal over shear stiffness of the cement [-].",
                 Number::above(0.));
  entries.number("Tensile strength", bond.tensile_strength,
                 "sigma_c, normal stress at the cement's edge at which it breaks [Pa].",
                 Number::at_least(0.));
  entries.number("Cohesion", bond.cohesion,
                 "c, shear stress at which the cement breaks without normal stress [Pa].",
                 Number::at_least(0.));
  entries.angle("Friction angle", bond.tan_friction,
                "phi, by which pressure adds to the shear strength; 0 in the model of "
                "2004 [degrees].");
  entries.number("Radius multiplier", bond.radius_multiplier,
                 "lambda, half width of the cement over the smaller radius [-].",
                 Number::above(0.).up_to(1.));
  entries.number("Moment contribution", bond.moment_contribution,
                 "beta, share of the bending stress that the strengths see; 1 in the "
                 "model of 2004 [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number("Contact modulus", bond.contact_modulus,
                 "E*, of the linear contact of the grains beside the cement [Pa].",
                 Number::above(0.));
  entries.number("Contact stiffness ratio", bond.contact_stiffness_ratio,
                 "Normal over shear stiffness of the contact [-].", Number::above(0.));
  entries.number("Residual friction", bond.residual_friction,
                 "mu, friction coefficient of the contact [-].", Number::at_least(0.));
  entries.leave();
}

void declare(discrete::ContactBond &bond, Declarations &entries)
{
  entries.enter("Contact bond");
  entries.number("Effective modulus", bond.effective_modulus,
                 "E*, of the glued contact [Pa].", Number::above(0.));
  entries.number("Stiffness ratio", bond.stiffness_ratio,
                 "kappa, normal over shear stiffness [-].", Number::above(0.));
  entries.number("Tensile strength", bond.tensile_strength,
                 "Tension at which the glue breaks, over the width 2 min(R) [Pa].",
                 Number::at_least(0.));
  entries.number("Shear strength", bond.shear_strength,
                 "Shear force at which it breaks, over the same width [Pa].",
                 Number::at_least(0.));
  entries.number("Residual friction", bond.residual_friction,
                 "mu, friction coefficient of the contact that stays [-].",
                 Number::at_least(0.));
  entries.leave();
}

void declare(discrete::JointTypes &types, Declarations &entries)
{
  entries.enter("Joint types");
  entries.number("Slit fraction", types.slit_fraction,
                 "Share of the joints that begin without bonds, their faces touching "
                 "(type S of PFC) [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number(
      "Gapped fraction", types.gapped_fraction,
      "Share of the joints that begin without bonds, their faces apart (type G) "
      "[-].",
      Number::at_least(0.).up_to(1.));
  entries.number("Gap ratio", types.gap_ratio,
                 "Mean gap of the gapped joints over the mean grain radius [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number("Gap deviation", types.gap_deviation,
                 "Standard deviation of those gaps over their mean; normal, cut off at 0 "
                 "[-].",
                 Number::at_least(0.));
  entries.leave();
}

void declare(LayerParameters &layer, Declarations &entries)
{
  entries.enter("Layer");
  entries.choice("Representation", layer.representation,
                 "Flat-jointed grains that may break, or finite elements that do not.",
                 "grains|continuum");
  entries.number("Thickness", layer.thickness,
                 "h, the length that all ratios are multiples of [m].",
                 Number::above(0.));
  entries.choice(
      "Shape", layer.shape,
      "straight, or cosine: bent beforehand into one anticline between straight "
      "ends.",
      "straight|cosine");
  entries.number(
      "Slenderness ratio", layer.slenderness_ratio,
      "Lambda, slenderness sqrt(12) L/h over the critical one, pi sqrt(E/UCS), at "
      "which buckling and shear failure coincide [-].",
      Number::above(0.));
  entries.number(
      "Length ratio", layer.length_ratio,
      "L/h, wavelength (cosine) or length (straight) over thickness; 0: from the "
      "slenderness ratio [-].",
      Number::at_least(0.));
  entries.number(
      "Amplitude ratio", layer.amplitude_ratio,
      "a0/h, height of the crest above the troughs (cosine) over thickness [-].",
      Number::at_least(0.));
  entries.number(
      "Straight end ratio", layer.straight_end_ratio,
      "Length of each straight end over L (cosine); without them the walls decide "
      "where the layer breaks [-].",
      Number::at_least(0.));
  entries.number(
      "Young modulus", layer.young_modulus,
      "E of the rock as a laboratory measures it; grains have theirs from the flat "
      "joint [Pa].",
      Number::above(0.));
  entries.number("Poisson ratio", layer.poisson_ratio,
                 "nu of the rock, plane strain [-].", Number::at_least(0.).below(0.5));
  entries.number(
      "UCS", layer.compressive_strength,
      "Uniaxial compressive strength of the rock; the slenderness ratio needs it "
      "[Pa].",
      Number::above(0.));
  entries.number("Grains across", layer.grains_across,
                 "h over the mean grain diameter: the resolution of the scene [-].",
                 Number::at_least(2.));
  entries.number("Radius ratio", layer.radius_ratio,
                 "Largest over smallest grain radius, uniform by number [-].",
                 Number::between(1., 3.));
  entries.number("Installation gap ratio", layer.installation_gap,
                 "Largest gap that is bonded, over the mean grain radius [-].",
                 Number::between(0.1, 1.));
  entries.number("Grain density", layer.grain_density,
                 "Of the solid; the rock's is less by the porosity [kg/m^3].",
                 Number::above(0.));
  entries.whole("Seed", layer.seed,
                "Of the random packing; the same seed gives the same bits [-].",
                Number::at_least(0.));
  entries.flag("Breakable", layer.joint.breakable,
               "May joints break? If not, would-be breaks are counted.");
  entries.choice("Bond model", layer.bond_model,
                 "Law that joins the grains: flat joints, as the source; the older "
                 "parallel bonds and contact bonds, which leave round grains behind when "
                 "they break.",
                 "flat joint|parallel bond|contact bond");
  declare(layer.joint, entries);
  declare(layer.types, entries);
  declare(layer.parallel_bond, entries);
  declare(layer.contact_bond, entries);
  entries.leave();
}

void declare_matrix_mesh(MatrixParameters &matrix, Declarations &entries)
{
  entries.number(
      "Mesh modulus ratio", matrix.mesh_modulus_ratio,
      "Moduli of the mesh over those of the matrix grains; other than 1 only to "
      "measure what a mismatch does [-].",
      Number::above(0.));
  entries.number("Cell size ratio", matrix.cell_size,
                 "Size of the cells near the layer over the mean grain diameter [-].",
                 Number::above(0.));
  entries.number(
      "Largest cell ratio", matrix.largest_cell,
      "Height of the cells away from the layer over the mean grain diameter [-].",
      Number::above(0.));
  entries.whole("Element degree", matrix.element_degree,
                "Polynomial degree of the finite elements [-].", Number::between(1, 2));
}

void declare(MatrixParameters &matrix, Declarations &entries)
{
  entries.enter("Matrix");
  entries.choice(
      "Representation", matrix.representation,
      "Finite elements (joined to a layer of grains by the bridging domain), or "
      "grains everywhere.",
      "continuum|grains");
  entries.number("Stiffness contrast", matrix.stiffness_contrast,
                 "E/E0, modulus of the layer over that of the matrix [-].",
                 Number::above(0.));
  entries.number("Poisson ratio", matrix.poisson_ratio,
                 "nu_0 of the matrix, plane strain [-].",
                 Number::at_least(0.).below(0.5));
  entries.number("Grain density", matrix.grain_density,
                 "Of the solid; the matrix' is less by the porosity [kg/m^3].",
                 Number::above(0.));
  entries.number("Burial depth ratio", matrix.burial_depth_ratio,
                 "H/h, cover above the crest over thickness of the layer [-].",
                 Number::at_least(0.));
  entries.number("Base depth ratio", matrix.base_depth_ratio,
                 "Matrix below the layer's lowest point over thickness of the layer [-].",
                 Number::at_least(0.));
  entries.choice(
      "Base", matrix.base,
      "What the base stands on when no foundation is listed: roller (free along "
      "x) or fixed.",
      "roller|fixed");
  entries.choice("Interface", matrix.interface,
                 "Contact of layer and matrix: cemented, or frictionless (may open, no "
                 "shear).",
                 "cemented|frictionless");
  entries.choice("Join", matrix.join, "How grains and mesh meet.", "bridging domain");
  declare_matrix_mesh(matrix, entries);
  entries.number("Tile size ratio", matrix.tile_size,
                 "Period of the tile that matrix grains are cut from over the mean grain "
                 "diameter [-].",
                 Number::at_least(8.));
  entries.flag("Breakable", matrix.breakable,
               "May joints of matrix grains break? If not, would-be breaks are counted "
               "where strengths are given.");
  declare_strengths(matrix.tensile_strength, matrix.cohesion, matrix.tan_friction,
                    matrix.residual_friction, entries);
  entries.leave();
}

void declare(BridgingParameters &bridging, Declarations &entries)
{
  entries.enter("Bridging domain");
  entries.number(
      "Overlap width ratio", bridging.overlap,
      "w, width in which grains and mesh share the energy, over the mean grain "
      "diameter [-].",
      Number::above(0.));
  entries.number(
      "Buffer width ratio", bridging.buffer,
      "Matrix grains between layer and overlap, over the mean grain diameter [-].",
      Number::at_least(0.));
  entries.choice(
      "Ramp", bridging.ramp,
      "Weight across the overlap; automatic: cubic from 4 cells on, else linear.",
      "automatic|linear|cubic");
  entries.number("Weight floor", bridging.weight_floor,
                 "eps, least weight of either model; keeps the system regular [-].",
                 Number::above(0.).up_to(0.1));
  entries.flag("Constraint", bridging.constraint,
               "Are the two models joined? false only to see what the constraint does.");
  entries.leave();
}

void declare(FoundationParameters &foundation, Declarations &entries)
{
  entries.enter("Foundation");
  entries.number(
      "Stiffness ratio", foundation.stiffness_ratio,
      "k_w h/E0, stiffness of the elastic (Winkler) foundation under the base over "
      "that of the matrix [-].",
      Number::above(0.));
  entries.leave();
}

void declare(WallsParameters &walls, Declarations &entries)
{
  entries.enter("Walls");
  entries.number(
      "Transits per millistrain", walls.transits_per_millistrain,
      "Axial wave transits of the layer in which the walls shorten it by 1e-3: "
      "slowness; 300 up to the peak bring it within 5 % [-].",
      Number::above(0.));
  entries.number("Ramp", walls.ramp, "Transits in which the walls come up to speed [-].",
                 Number::at_least(0.));
  entries.choice(
      "Action", walls.action,
      "press: rigid frictionless platens shorten the section; pull: the grains "
      "of its ends are gripped, do not turn, and are moved apart.",
      "press|pull");
  entries.number("Grip layers", walls.grip_layers,
                 "Width of each grip over the mean grain diameter (pull) [-].",
                 Number::at_least(1.));
  entries.leave();
}

void declare(ServoWallsParameters &servo, Declarations &entries)
{
  entries.enter("Servo walls");
  entries.number("Pressure", servo.pressure,
                 "Confinement that rigid frictionless walls keep on the sides of a "
                 "specimen; it comes up on all four sides before shortening begins [Pa].",
                 Number::above(0.));
  entries.number("Gain", servo.gain,
                 "beta, share of the error in the pressure that a step takes away [-].",
                 Number::above(0.).below(1.));
  entries.number("Ramp", servo.ramp,
                 "Axial transits in which the pressure comes up; as many follow at rest "
                 "[-].",
                 Number::above(0.));
  entries.leave();
}

void declare_network(FracturesParameters &fractures, Declarations &entries)
{
  const auto numbers = [&](const std::string &name, std::vector<double> &value,
                           const std::string &what, const Number &range)
  { entries.numbers(name, value, what, range); };
  numbers("Intensity", fractures.intensity,
          "P21 of each set of a drawn network, length of traces per area, a list; empty: "
          "none is drawn [1/m].",
          Number::above(0.));
  numbers("Orientation", fractures.orientation,
          "Mean direction of the traces, from x, one number or one for each set "
          "[degrees].",
          Number::between(-180., 180.));
  numbers("Orientation deviation", fractures.orientation_deviation,
          "Standard deviation of it [degrees].", Number::between(0., 90.));
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
                 "Where the network lies: in the layer, or in the whole section.",
                 "layer|section");
  entries.whole("Seed", fractures.seed,
                "Of the network; the same seed draws the same fractures [-].",
                Number::at_least(0.));
}

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

void declare(DampingParameters &damping, Declarations &entries)
{
  entries.enter("Damping");
  entries.choice(
      "Form", damping.form,
      "Non-viscous, -alpha |r| sgn(v) with the unbalanced force r (local), or "
      "alpha/2 |r| (sgn(dr/dt) - sgn(v)) (combined). A drift faster than the "
      "vibration on it turns local damping into dry friction, which holds back "
      "the bending of a slender layer; combined damping acts on the vibration.",
      "combined|local");
  entries.number("Coefficient", damping.coefficient, "alpha [-].",
                 Number::above(0.).below(1.));
  entries.leave();
}

void declare(RunParameters &run, Declarations &entries)
{
  entries.enter("Run");
  entries.choice(
      "Driver", run.driver,
      "quasi-static (rates do not matter), dynamic (they do), static (implicit "
      "solves).",
      "quasi-static|dynamic|static");
  entries.number("Step safety", run.safety, "Step over the rigorous stable step [-].",
                 Number::above(0.).below(1.));
  entries.number("End shortening", run.end_shortening,
                 "Shortening (or extension) at which the run ends, whatever the stress "
                 "does; 0: after the peak, as the next three entries say [-].",
                 Number::at_least(0.).below(1.));
  entries.number("Strain multiple of peak", run.strain_multiple_of_peak,
                 "The run ends at this multiple of the shortening at the peak [-].",
                 Number::above(1.));
  entries.number(
      "Stress ratio of peak", run.stress_ratio_of_peak,
      "The run ends once the axial stress has fallen for good below this share "
      "of its peak; 0: it goes on [-].",
      Number::at_least(0.).below(1.));
  entries.number("Longest shortening", run.longest_shortening,
                 "The run ends here at the latest, peak or not [-].",
                 Number::above(0.).below(1.));
  entries.whole("Load steps", run.load_steps,
                "Steps of the static driver up to the end shortening [-].",
                Number::at_least(1.));
  entries.leave();
}

void declare(OutputParameters &output, Declarations &entries)
{
  entries.enter("Output");
  entries.whole("Samples per millistrain", output.samples_per_millistrain,
                "Lines of history.csv for a shortening of 1e-3 [-].",
                Number::at_least(1.));
  entries.number("Fields interval", output.fields_interval,
                 "Shortening between two field files [-].", Number::above(0.));
  entries.number("Checkpoint interval", output.checkpoint_minutes,
                 "Wall time between two checkpoints [minutes].", Number::above(0.));
  entries.leave();
}

void declare_one(const std::string &name,
                 const std::string &entry,
                 double &value,
                 const std::string &documentation,
                 const Number &range,
                 Declarations &entries)
{
  entries.enter(name);
  entries.number(entry, value, documentation, range);
  entries.leave();
}
} // namespace

const std::vector<std::string> &all_components()
{
  static const std::vector<std::string> names = {
      "layer",   "matrix", "foundation",  "surface pressure",
      "gravity", "walls",  "servo walls", "fractures", "damping", "calibration"};
  return names;
}

const std::vector<Section> &all_sections()
{
  static const std::vector<Section> sections = {
      {"Layer", "component layer"},
      {"Matrix", "component matrix"},
      {"Bridging domain", "the layer is grains and the matrix is continuum"},
      {"Foundation", "component foundation"},
      {"Surface pressure", "component surface pressure"},
      {"Gravity", "component gravity"},
      {"Walls", "component walls"},
      {"Servo walls", "component servo walls"},
      {"Fractures", "component fractures"},
      {"Damping", "component damping"},
      {"Calibration", "component calibration"},
      {"Run", "always"},
      {"Output", "always"}};
  return sections;
}

bool is_read(const std::string &section, const Parameters &p)
{
  if (section == "Run" || section == "Output")
    return true;
  if (section == "Bridging domain")
    return p.is_bridged();
  std::string component = section;
  component[0] = static_cast<char>(component[0] - 'A' + 'a');
  return p.has(component);
}

void declare_parameters(Parameters &p,
                        const std::vector<std::string> &sections,
                        Declarations &entries)
{
  entries.text("Title", p.title, "What the run is called in its output.");
  entries.list(
      "Components", p.components,
      "What exists in the scene, a list: layer, matrix, foundation, surface "
      "pressure, gravity, walls, servo walls, fractures, damping; calibration for 'antiform "
      "calibrate'. Only their sections are read.");
  for (const std::string &section : sections)
  {
    if (section == "Layer")
      declare(p.layer, entries);
    else if (section == "Matrix")
      declare(p.matrix, entries);
    else if (section == "Bridging domain")
      declare(p.bridging, entries);
    else if (section == "Foundation")
      declare(p.foundation, entries);
    else if (section == "Surface pressure")
      declare_one(section, "Pressure", p.surface_pressure.pressure,
                  "Normal to the top of the section, positive inward [Pa].",
                  Number::at_least(0.), entries);
    else if (section == "Gravity")
      declare_one(section, "Acceleration", p.gravity.acceleration, "Downward [m/s^2].",
                  Number::above(0.), entries);
    else if (section == "Walls")
      declare(p.walls, entries);
    else if (section == "Servo walls")
      declare(p.servo_walls, entries);
    else if (section == "Fractures")
      declare(p.fractures, entries);
    else if (section == "Damping")
      declare(p.damping, entries);
    else if (section == "Calibration")
      declare(p.calibration, entries);
    else if (section == "Run")
      declare(p.run, entries);
    else
      declare(p.output, entries);
  }
}
} // namespace antiform::cases

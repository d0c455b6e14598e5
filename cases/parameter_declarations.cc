// What a deck may say: every entry with its unit, range and default.
#include "cases/declarations.h"

#include <algorithm>

namespace antiform::cases
{
namespace
{
void declare(MatrixParameters &matrix, const bool bare, Declarations &entries)
{
  entries.enter("Matrix");
  if (bare)
  {
    declare_mesh(matrix, bare, entries);
    entries.leave();
    return;
  }
  entries.choice(
      "Representation", matrix.representation,
      "Finite elements (joined to a layer of grains as 'Join' says), or "
      "grains everywhere. Joints of matrix grains have the elements, radius multiplier "
      "and element moment of 'Layer/Flat joint' in the deck, beds or not; their moduli "
      "follow from the stiffness contrast and Poisson ratio.",
      "continuum|grains");
  entries.number("Stiffness contrast", matrix.stiffness_contrast,
                 "E/E0, modulus of the layer over that of the matrix [-].",
                 Number::above(0.));
  entries.number("Poisson ratio", matrix.poisson_ratio,
                 "nu_0 of the matrix, plane strain [-].",
                 Number::at_least(0.).below(0.5));
  entries.number("Grain density", matrix.grain_density,
                 "Of the solid; the matrix' is less by the porosity [kg/m^3].",
                 Number::between(100., 3e4));
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
                 "Contact of layer and matrix: cemented, sliding (no shear, does not "
                 "open), frictional (Coulomb with cohesion, may open), frictionless (no "
                 "shear, may open). Of finite elements: the buckling driver knows the "
                 "first two, the static driver all; of a layer of grains: cemented or "
                 "frictionless where matrix grains lie on it, all four by the surface "
                 "interface.",
                 "cemented|sliding|frictional|frictionless");
  entries.number("Interface friction", matrix.friction,
                 "mu of a frictional interface [-].", Number::at_least(0.));
  entries.number("Interface cohesion", matrix.interface_cohesion,
                 "c of a frictional interface [Pa].",
                 Number::at_least(0.));
  entries.choice(
      "Join", matrix.join,
      "How a layer of grains and the mesh of the matrix meet: in an overlap, with matrix "
      "grains beside the layer; the same below it, under a cover of matrix grains alone; "
      "or the mesh ends where the layer's outer grains begin, "
      "and 'Interface' says by which law they hold on to it, without matrix grains. "
      "automatic takes the first that the cover is thick enough for.",
      "bridging domain|grain cover|surface interface|automatic");
  entries.number(
      "Mesh modulus ratio", matrix.mesh_modulus_ratio,
      "Moduli of the mesh over those of the matrix grains; other than 1 only to "
      "measure what a mismatch does [-].",
      Number::above(0.));
  declare_mesh(matrix, bare, entries);
  entries.number("Tile size ratio", matrix.tile_size,
                 "Period of the tile that matrix grains are cut from over the mean grain "
                 "diameter [-].",
                 Number::at_least(8.));
  entries.flag("Breakable", matrix.breakable,
               "May joints of matrix grains break? If not, would-be breaks are counted "
               "where strengths are given (not by the event driver).");
  declare_strengths(matrix.tensile_strength, matrix.cohesion, matrix.tan_friction,
                    matrix.residual_friction, entries);
  entries.leave();
}

void declare(BedsParameters &beds, Declarations &entries)
{
  entries.enter("Beds");
  entries.numbers("Thickness ratios", beds.thickness_ratios,
                  "Thickness of each bed, from below; only their ratios count, together "
                  "they are the layer [-].",
                  Number::above(0.));
  entries.list(
      "Rocks", beds.rocks,
      "A rock file (.prm, looked for from the deck) for each bed, from below: its "
      "moduli, strengths and density. Grain sizes are those of the layer.");
  entries.choice(
      "Interface", beds.interface,
      "Between beds: cemented (by joints with the weaker rock's strengths), or "
      "frictional (smooth joints along the bedding).",
      "cemented|frictional");
  entries.number("Friction", beds.friction,
                 "mu between frictional beds; 0: they slide freely [-].",
                 Number::at_least(0.));
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
  entries.choice(
      "Multipliers", bridging.multipliers,
      "What the constraint demands: that the mean of the grains around each vertex of "
      "the mesh follows it; or around each of a coarser mesh, for cells below two grain "
      "diameters; or each grain by itself, for lattices.",
      "mesh|coarsened|per grain");
  entries.number("Overlap damping", bridging.damping,
                 "Rate at which motion of the grains relative to the mesh dies out in the "
                 "overlap, over c/d, c the speed of P waves in the matrix; 0: none. 0.05 "
                 "takes the waves that the mesh cannot carry [-].",
                 Number::at_least(0.).up_to(1.));
  entries.whole("Sub-cycles", bridging.sub_cycles,
                "Steps of the grains for which the mesh's forces are evaluated once, by "
                "the dynamic driver; at most 0.3 of the mesh's stable step.",
                Number::at_least(1.).whole());
  entries.leave();
}

void declare(SurfacePressureParameters &surface, Declarations &entries)
{
  entries.enter("Surface pressure");
  entries.number("Pressure", surface.pressure,
                 "Normal to the top of the section, positive inward [Pa].",
                 Number::at_least(0.));
  entries.number("Overburden ratio", surface.overburden_ratio,
                 "Thickness over h of further cover that is not part of the section: its "
                 "weight under gravity adds to the pressure [-].",
                 Number::at_least(0.));
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
  entries.choice("Loading", walls.loading,
                 "constant rate: the walls move all the time; step and relax: they "
                 "advance by load steps, each in one transit, and stand still after "
                 "each until the forces balance; event driver: no time at all, from the "
                 "balance at one event (bonds that break) to that at the next few, for "
                 "flat joints of grains, alone or joined to a mesh.",
                 "constant rate|step and relax|event driver");
  entries.number("Load step", walls.load_step,
                 "Step and relax: shortening in one load step; some 2 % of that at the "
                 "peak. Event driver: the longest one; less where walls pull, "
                 "and before the first crack [-].",
                 Number::above(0.).below(0.1));
  entries.number("Relaxation tolerance", walls.relaxation_tolerance,
                 "Step and relax: mean unbalanced force over the mean force of a joint "
                 "below which the walls go on, the largest below 0.1; ten times it when a "
                 "collapse has taken 100 transits [-].",
                 Number::above(0.).below(0.1));
  entries.number("Balance tolerance", walls.balance_tolerance,
                 "Event driver: mean unbalanced force over the mean force of a joint that "
                 "counts as balance; the largest one is to be below 100 times it, and "
                 "below 150 times it of what an element carries when it breaks [-].",
                 Number::above(0.).below(0.01));
  entries.number("Ramp", walls.ramp, "Transits in which the walls come up to speed [-].",
                 Number::at_least(0.));
  entries.choice(
      "Action", walls.action,
      "press: rigid frictionless platens shorten the section; pull: the grains "
      "of its ends are gripped, do not turn, and are moved apart; turn: the platens turn "
      "about their centres, so that the lower side is pressed, and bend a layer of "
      "grains that is not glued to them. What says strain or shortening of the loading is "
      "h/L times their rotation then, the strain of the faces of a straight layer.",
      "press|pull|turn");
  entries.number("Grip layers", walls.grip_layers,
                 "Width of each grip over the mean grain diameter (pull) [-].",
                 Number::at_least(1.));
  entries.number("End rotation", walls.end_rotation,
                 "Of each wall, at which the run ends at the latest: > 0 where walls turn, 0 "
                 "where they do not [degrees].",
                 Number::at_least(0.).up_to(30.));
  entries.number("Shortening before turning", walls.shortening_before,
                 "By which the walls press the section first, and keep their centres "
                 "there as they turn (turn, at a constant rate): small strain, and of a "
                 "layer that may break at most UCS/E', which would crush it [-].",
                 Number::at_least(0.).up_to(0.02));
  entries.leave();
}

void declare_pressure(ConfinementParameters &confinement,
                      const std::string &what,
                      Declarations &entries)
{
  entries.number("Pressure", confinement.pressure,
                 "Confinement that " + what +
                     "; it comes up on all four sides before shortening begins [Pa].",
                 Number::above(0.));
}

void declare_control(ConfinementParameters &confinement, Declarations &entries)
{
  entries.number("Gain", confinement.gain,
                 "beta, share of the error in a wall's pressure that a step takes away "
                 "[-].",
                 Number::above(0.).below(1.));
  entries.number("Ramp", confinement.ramp,
                 "Axial transits in which the pressure comes up; as many follow at rest "
                 "[-].",
                 Number::above(0.));
}

void declare(ServoWallsParameters &servo, Declarations &entries)
{
  entries.enter("Servo walls");
  declare_pressure(servo, "rigid frictionless walls keep on the sides of a specimen", entries);
  declare_control(servo, entries);
  entries.leave();
}

/// @p bare: around a layer of finite elements, which it follows exactly.
void declare(MembraneParameters &membrane, const bool bare, Declarations &entries)
{
  entries.enter("Membrane");
  declare_pressure(membrane, "a flexible membrane puts on the faces of a layer, straight or bent", entries);
  if (bare)
  {
    entries.leave();
    return;
  }
  declare_control(membrane, entries);
  entries.number("Reach ratio", membrane.reach,
                 "Radius over the mean grain diameter of the ball that cannot pass "
                 "between two neighbours of the membrane; a smaller one follows notches "
                 "further in [-].",
                 Number::between(0.7, 5.));
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
      "solves, finite elements only), buckling (loads and shapes at which a straight "
      "section gives way, by the linear theory).",
      "quasi-static|dynamic|static|buckling");
  entries.number(
      "Step safety", run.safety,
      "Step over the rigorous stable step, that of damped grains and nodes; "
      "the event driver does not use it [-].",
      Number::above(0.).below(1.));
  entries.number("End shortening", run.end_shortening,
                 "Shortening (or extension) at which the run ends, whatever the stress "
                 "does; 0: after the peak, as the next three entries say [-].",
                 Number::at_least(0.).below(1.));
  entries.number("Strain multiple of peak", run.strain_multiple_of_peak,
                 "The run ends at this multiple of the shortening at the peak, and not "
                 "before the stress has stayed below it for 2e-4 [-].",
                 Number::above(1.));
  entries.number(
      "Stress ratio of peak", run.stress_ratio_of_peak,
      "The run ends once the axial stress has fallen for good below this share "
      "of its peak; 0: it goes on [-].",
      Number::at_least(0.).below(1.));
  entries.number("Longest shortening", run.longest_shortening,
                 "The run ends here at the latest, peak or not [-].",
                 Number::above(0.).below(1.));
  entries.flag("Estimate loading-rate error", run.estimate_rate_error,
               "Drivers in time: after the run, repeat the last stretch before the peak "
               "at half the loading rate (walls that step and relax: half the load step and "
               "tolerance; event driver: likewise) and print how far the peak "
               "moves.");
  entries.whole("Load steps", run.load_steps,
                "Steps of the static driver up to the end shortening [-].",
                Number::at_least(1.));
  entries.choice("Strain", run.strain,
                 "Of finite elements, static driver and drivers in time: small strain and "
                 "rotation, or finite.",
                 "small|finite");
  entries.number("Duration", run.duration,
                 "Static driver: time in which the section is shortened, for viscous "
                 "materials [s].",
                 Number::at_least(0.));
  entries.choice("Path", run.path,
                 "Static driver: even load steps, or by arc length, which follows the "
                 "section past limit points, where it snaps.",
                 "load steps|arc length");
  entries.whole("Modes", run.modes,
                "Buckling driver: how many of the lowest loads to find [-].",
                Number::between(1., 20.));
  entries.leave();
}

void declare(OutputParameters &output, Declarations &entries)
{
  entries.enter("Output");
  entries.whole("Samples per millistrain", output.samples_per_millistrain,
                "Lines of history.csv for a shortening of 1e-3 [-].",
                Number::at_least(1.));
  entries.number("Fields interval", output.fields_interval,
                 "Shortening between two field files [-].", Number::at_least(1e-7));
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
  static const std::vector<std::string> names = {"layer",
                                                 "beds",
                                                 "matrix",
                                                 "foundation",
                                                 "absorbing boundary",
                                                 "surface pressure",
                                                 "gravity",
                                                 "walls",
                                                 "servo walls",
                                                 "membrane",
                                                 "fractures",
                                                 "damping",
                                                 "measurement circles",
                                                 "calibration"};
  return names;
}

const std::vector<Section> &all_sections()
{
  static const std::vector<Section> sections = {
      {"Layer", "component layer"},
      {"Beds", "component beds"},
      {"Matrix", "component matrix; of a layer of finite elements without it Cell size "
                 "ratio, Cell aspect ratio, Element degree and refinement"},
      {"Layer material", "the layer is continuum"},
      {"Matrix material", "component matrix, which is continuum"},
      {"Bridging domain", "the layer is grains and the matrix is continuum, 'Matrix/Join' "
                          "= 'bridging domain'"},
      {"Foundation", "component foundation"},
      {"Absorbing boundary", "component absorbing boundary"},
      {"Surface pressure", "component surface pressure"},
      {"Gravity", "component gravity"},
      {"Walls", "component walls"},
      {"Servo walls", "component servo walls"},
      {"Membrane", "component membrane"},
      {"Fractures", "component fractures"},
      {"Damping", "component damping"},
      {"Calibration", "component calibration"},
      {"Measurement circles", "component measurement circles"},
      {"Study", "by 'antiform study'; the other commands leave it alone"},
      {"Run", "always"},
      {"Output", "always"}};
  return sections;
}

bool is_read(const std::string &section, const Parameters &p)
{
  if (section == "Run" || section == "Output")
    return true;
  if (section == "Study")
    return p.study.has_value();
  if (section == "Bridging domain")
    return p.is_bridged();
  if (section == "Matrix" && p.is_bare_mesh())
    return true;
  if (section == "Layer material")
    return p.has_layer_mesh();
  if (section == "Matrix material")
    return p.has_matrix_mesh();
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
      "What exists in the scene, a list: layer, beds, matrix, foundation, absorbing "
      "boundary, surface pressure, gravity, walls, servo walls, membrane, fractures, "
      "damping, measurement circles; "
      "calibration for 'antiform calibrate'. Only their sections are read.");
  entries.percentage(
      "Accuracy", p.accuracy.percent,
      "Error wanted, as 5 %: grains across, cells, overlap, loading rate or tolerances "
      "that the deck does not set are chosen from what has been measured, for what the "
      "errors of those that it sets leave (docs/accuracy.md). Empty: nothing is chosen.");
  for (const std::string &section : sections)
  {
    if (section == "Layer")
      declare(p.layer, entries);
    else if (section == "Beds")
      declare(p.beds, entries);
    else if (section == "Matrix")
      declare(p.matrix, p.is_bare_mesh(), entries);
    else if (section == "Layer material")
      declare(section, p.layer_material, entries);
    else if (section == "Matrix material")
      declare(section, p.matrix_material, entries);
    else if (section == "Bridging domain")
      declare(p.bridging, entries);
    else if (section == "Foundation")
      declare(p.foundation, entries);
    else if (section == "Absorbing boundary")
      declare(p.absorbing_boundary, entries);
    else if (section == "Surface pressure")
      declare(p.surface_pressure, entries);
    else if (section == "Gravity")
      declare_one(section, "Acceleration", p.gravity.acceleration, "Downward [m/s^2].",
                  Number::above(0.).up_to(1e3), entries);
    else if (section == "Walls")
      declare(p.walls, entries);
    else if (section == "Servo walls")
      declare(p.servo_walls, entries);
    else if (section == "Membrane")
      declare(p.membrane, p.is_bare_mesh(), entries);
    else if (section == "Fractures")
      declare(p.fractures, entries);
    else if (section == "Damping")
      declare(p.damping, entries);
    else if (section == "Calibration")
      declare(p.calibration, entries);
    else if (section == "Measurement circles")
      declare(p.measurement_circles, entries);
    else if (section == "Study")
      declare(p.study ? *p.study : p.study.emplace(), entries);
    else if (section == "Run")
      declare(p.run, entries);
    else
      declare(p.output, entries);
  }
}
} // namespace antiform::cases

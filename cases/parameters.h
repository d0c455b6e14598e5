#pragma once

#include "cases/accuracy.h"
#include "cases/study_plan.h"
#include "discrete/bond_laws.h"
#include "discrete/fractures.h"
#include "discrete/joint_types.h"
#include "discrete/linear_contact.h"

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace dealii
{
class ParameterHandler;
}

namespace antiform::cases
{
/// The user's error: deck, option or file. The text lists every problem, one paragraph
/// each: file and line, entry, value, remedy. main() prints it and exits 1.
class InputError : public std::runtime_error
{
public:
  explicit InputError(const std::vector<std::string> &problems);
  const std::vector<std::string> &problems() const { return problems_; }

private:
  std::vector<std::string> problems_;
};

/// The competent layer.
struct LayerParameters
{
  LayerParameters(); ///< friction angle of the bonds: 8 degrees to the last bit

  std::string representation = "grains"; ///< grains | continuum
  double thickness = 10.;                ///< h [m]
  std::string shape = "cosine";          ///< straight | cosine (pre-bent, straight ends)
  double slenderness_ratio = 2.;         ///< Lambda = lambda/lambda_c of the wavelength
  double length_ratio = 0.;              ///< L/h; 0: from the slenderness ratio
  double amplitude_ratio = 0.5;          ///< a0/h, crest to trough (cosine)
  double straight_end_ratio = 0.115;     ///< length of each straight end over L (cosine)
  double young_modulus = 56e9;           ///< macroscopic E [Pa]
  double poisson_ratio = 0.2;            ///< macroscopic plane-strain nu
  double compressive_strength = 162e6;   ///< UCS [Pa]
  // grains
  double grains_across = 12.;      ///< h over mean diameter
  double radius_ratio = 1.66;      ///< R_max/R_min
  double installation_gap = 0.3;   ///< over the mean radius
  double porosity = 0.;            ///< wanted; 0: jammed [-]
  double coordination_number = 0.; ///< wanted; 0: by the installation gap [-]
  double locked_in_stress = 0.;    ///< isotropic pressure in the bonds [Pa]
  double grain_density = 2500.;    ///< [kg/m^3]
  int seed = 1;
  std::string bond_model = "flat joint"; ///< or parallel bond, contact bond
  discrete::FlatJoint joint;             ///< breakable, of whichever model
  discrete::JointTypes types;
  discrete::StrengthScatter scatter;
  discrete::ParallelBond parallel_bond;
  discrete::ContactBond contact_bond;

  /// What joins the grains of the layer.
  discrete::JointLaw law() const;
  /// What acts between grains of the layer that nothing joins.
  discrete::LinearContact grain_contact() const;
};

/// The layer as a stack of beds, each with a rock of its own.
struct BedsParameters
{
  std::vector<double> thickness_ratios = {1., 1., 1.}; ///< from below; shares of h
  std::vector<std::string> rocks;                      ///< a file (.prm) each, from below
  std::string interface = "cemented";                  ///< cemented | frictional
  double friction = 0.6;                               ///< mu between frictional beds
  std::vector<LayerParameters> layers; ///< what the files say, the rest as the layer
};

/// The weak rock around the layer.
struct MatrixParameters
{
  std::string representation = "continuum"; ///< continuum (bridged) | grains
  double stiffness_contrast = 1e4;          ///< E/E0 [-]
  double poisson_ratio = 0.2;               ///< plane strain
  double grain_density = 2500.;             ///< [kg/m^3]
  double burial_depth_ratio = 3.;           ///< H/h: cover above the crest
  double base_depth_ratio = 3.;             ///< matrix below the layer over h
  std::string base = "roller";              ///< roller | fixed | foundation via component
  std::string interface = "cemented"; ///< cemented | sliding | frictional | frictionless
  double friction = 0.6;              ///< mu of a frictional interface [-]
  double interface_cohesion = 0.;     ///< c of a frictional interface [Pa]
  std::string join = "bridging domain"; ///< of grains and mesh, or grain cover, surface
                                        ///< interface; automatic until it is chosen
  std::string why_join;                 ///< it was chosen; empty: the deck says it
  double mesh_modulus_ratio = 1.; ///< mesh moduli over those of the matrix grains
  // mesh
  double cell_size = 2.;    ///< h_FE over mean grain diameter, near the overlap
  double largest_cell = 6.; ///< rows away from the layer, over mean grain diameter
  double cell_aspect = 1.;  ///< width of the columns over the size of the cells
  int element_degree = 1;   ///< 1 or 2
  int cover_rows = 0;       ///< of cells in the cover; 0: by the size of the cells
  int refinement_rounds = 0;       ///< buckling driver
  double refinement_share = 0.5;   ///< of the estimated error, in the cells to refine [-]
  double contact_stiffness = 100.; ///< of faces that may part, over the cells' beside [-]
  // grains
  double tile_size = 24.; ///< period of the tile over mean grain diameter
  bool breakable = false;
  double tensile_strength = 0., cohesion = 0.;
  double tan_friction = 0., residual_friction = 0.;
};

/// How finite elements of the layer or of the matrix answer to strain.
struct MaterialParameters
{
  MaterialParameters(); ///< friction angle: 42 degrees to the last bit

  std::string law = "elastic";  ///< St Venant-Kirchhoff | Mohr-Coulomb | Drucker-Prager |
                                ///< Maxwell
  double cohesion = 36.3e6;     ///< c [Pa]
  double tan_friction;          ///< of phi [-]
  double tan_dilation = 0.;     ///< of psi [-]
  double tensile_strength = 0.; ///< cut-off; 0: none, up to the apex [Pa]
  std::string match = "plane strain"; ///< of the cone: plane strain | outer | inner
  double viscosity = 1e20;            ///< eta of shear [Pa s]

  bool yields() const { return law == "Mohr-Coulomb" || law == "Drucker-Prager"; }
};

struct BridgingParameters
{
  double overlap = 4.; ///< w over mean grain diameter
  double buffer = 4.;  ///< matrix grains between layer and overlap, over mean diameter
  std::string ramp = "automatic"; ///< automatic | linear | cubic
  double weight_floor = 1e-3;     ///< eps
  bool constraint = true; ///< false: the two models are not joined (negative control)
  std::string multipliers = "mesh"; ///< mesh | coarsened | per grain
  double damping = 0.;              ///< rate in the overlap over c/d; 0: none [-]
  int sub_cycles = 1;               ///< steps of the grains in one of the mesh
};

struct FoundationParameters
{
  double stiffness_ratio = 0.13; ///< k_w h/E0 [-]
  double stiffness = 0.;         ///< k_w [Pa/m]; 0: from the ratio
  double shear_ratio = 0.;       ///< G_p/(k_w h^2), of Pasternak's shear layer [-]
  std::string faces = "base";    ///< base | top | base and top
  bool lifts_off = false;        ///< pushes only

};

/// Where waves leave the section.
struct AbsorbingBoundaryParameters
{
  std::string faces = "base"; ///< base | top | base and top
};

struct SurfacePressureParameters
{
  double pressure = 0.;         ///< [Pa]
  double overburden_ratio = 0.; ///< rock on top that is not part of the section, over h
};

struct GravityParameters
{
  double acceleration = 9.81; ///< downward [m/s^2]
};

/// End walls: rigid, frictionless, over the full height; both move inward, or turn.
struct WallsParameters
{
  std::string loading = "constant rate"; ///< constant rate | step and relax | event driver
  double load_step = 4e-5; ///< shortening of one, step and relax; the largest, events [-]
  double balance_tolerance = 1e-3; ///< mean unbalanced ratio, event driver [-]
  double relaxation_tolerance = 1e-4;    ///< unbalanced ratio, step and relax [-]
  double transits_per_millistrain = 300.; ///< axial wave transits of the layer per 1e-3
  double ramp = 20.;            ///< transits over which the walls come up to speed
  std::string action = "press"; ///< press | pull (by grips) | turn
  double grip_layers = 7.5;     ///< width of a grip over the mean grain diameter
  double end_rotation = 0.;     ///< of each wall, turn; the run ends there [degrees]
  double shortening_before = 0.; ///< of the section, before the walls turn [-]

  bool steps_and_relaxes() const { return loading == "step and relax"; }
  bool follows_events() const { return loading == "event driver"; }
  bool pulls() const { return action == "pull"; }
  bool turns() const { return action == "turn"; }
};

/// A pressure on the sides of a specimen, and on its ends before they shorten it.
struct ConfinementParameters
{
  double pressure = 10e6; ///< [Pa]
  double gain = 0.5;      ///< beta: share of the error that one step takes away
  double ramp = 100.;     ///< transits over which the pressure comes up on all sides
};
/// By rigid frictionless walls along the sides.
struct ServoWallsParameters : ConfinementParameters
{
};
/// By a flexible membrane around the specimen.
struct MembraneParameters : ConfinementParameters
{
  double reach = 1.; ///< of the ball that finds the outer grains, over the mean diameter
};

/// Pre-existing fractures, by smooth joints.
struct FracturesParameters
{
  std::string list;  ///< "x1 y1 x2 y2; ..." [m]
  std::string table; ///< of fractures (.csv); empty: none
  // A drawn network: a number for each set, or one for all
  std::vector<double> intensity;           ///< P21 [1/m]
  std::vector<double> orientation = {60.}; ///< [degrees]
  std::vector<double> orientation_deviation = {5.};
  std::string length_law = "constant"; ///< exponential, lognormal, power law
  std::vector<double> mean_length = {10.}, length_deviation = {2.}; ///< [m]
  std::vector<double> length_exponent = {2.5};
  std::vector<double> shortest = {0.}, longest = {0.}; ///< 0: no bound [m]
  // Parallel sets that go through, likewise, with the orientations above
  std::vector<double> spacing_ratio;  ///< over h [-]
  std::vector<double> phase = {0.5};  ///< of the traces, over the spacing [-]
  std::string region = "layer";       ///< layer | section
  int seed = 1;
  discrete::SmoothJoint law;

  /// Sets that are drawn, or that are parallel.
  std::size_t n_sets() const
  {
    return intensity.empty() ? spacing_ratio.size() : intensity.size();
  }
};

/// Circles in which averages of the grains are recorded.
struct MeasurementCirclesParameters
{
  double radius = 5.;  ///< over the mean grain diameter [-]
  std::string centres; ///< "x y; x y" [m]; empty: a grid along the layer
  int along = 0;       ///< of the grid; 0: side by side
  int across = 1;
};

struct DampingParameters
{
  std::string form = "combined"; ///< or local
  double coefficient = 0.7;      ///< alpha
};

/// Driver and when the run ends.
struct RunParameters
{
  std::string driver = "quasi-static"; ///< quasi-static | dynamic | static | buckling
  double safety = 0.9;                 ///< step over the rigorous stable step
  double end_shortening = 0.;          ///< 0: by the peak
  double strain_multiple_of_peak = 2.; ///< end at this multiple of the strain at the peak
  double stress_ratio_of_peak =
      0.; ///< end when the stress has fallen to this share of it
  double longest_shortening = 0.02; ///< give up here [-]
  bool estimate_rate_error = false; ///< the way to the peak again at half the rate
  int load_steps = 10;              ///< static driver
  int modes = 4;                    ///< buckling driver
  std::string strain = "small";     ///< small | finite; static driver
  double duration = 0.;             ///< of the shortening, for laws with time [s]
  std::string path = "load steps";  ///< load steps | arc length; static driver

  /// Whether the scene steps in time.
  bool steps_in_time() const { return driver != "static" && driver != "buckling"; }
};

struct OutputParameters
{
  int samples_per_millistrain = 200; ///< lines of history.csv
  double fields_interval = 2e-4;     ///< shortening between field files [-]
  double checkpoint_minutes = 5.;    ///< wall time between checkpoints
};

/// From laboratory targets to the layer's flat joint. A target of 0 is not given: it
/// comes from the table of laboratory data, or does not exist.
struct CalibrationParameters
{
  // What the rock has
  double young_modulus = 0.;            ///< [Pa]
  std::string modulus_from = "elastic"; ///< elastic | uniaxial
  double tensile_strength = 0.;         ///< [Pa]
  double compressive_strength = 0.;     ///< UCS [Pa]
  std::vector<double> confinements;     ///< sigma_3 of the confined tests [Pa]
  std::vector<double> strengths;        ///< sigma_1 there [Pa]
  std::string data;                     ///< table of sigma_3 and sigma_1; empty: none
  std::string site;                     ///< rows of it to use; empty: all
  // How near is near enough, relative
  double modulus_tolerance = 0.02, tension_tolerance = 0.05;
  double uniaxial_tolerance = 0.05, confined_tolerance = 0.1;
  // What is searched for
  std::vector<std::string> free = {"effective modulus", "tensile strength", "cohesion",
                                   "friction angle"};
  std::string start = "targets"; ///< targets | rock
  double range_factor = 8.;      ///< of modulus and strengths about their start
  std::vector<double> angle_bounds = {0., 60.};     ///< phi_b [degrees]
  std::vector<double> friction_bounds = {0.05, 1.}; ///< mu [-]
  std::vector<double> slit_bounds = {0., 0.4};      ///< [-]
  // What it may cost
  int search_seeds = 3, check_seeds = 3, check_rounds = 3;
  int evaluations = 6;                ///< of the search at most, differences apart
  int jobs = 0;                       ///< trials at once; 0: as many as cores
  double transits_of_tension = 2000.; ///< per millistrain
};

struct Parameters
{
  std::string title;
  AccuracyPlan accuracy; ///< the deck's percentage, and what the reader has made of it
  std::vector<std::string> components;
  LayerParameters layer;
  BedsParameters beds;
  MatrixParameters matrix;
  MaterialParameters layer_material, matrix_material;
  BridgingParameters bridging;
  FoundationParameters foundation;
  AbsorbingBoundaryParameters absorbing_boundary;
  SurfacePressureParameters surface_pressure;
  GravityParameters gravity;
  WallsParameters walls;
  ServoWallsParameters servo_walls;
  MembraneParameters membrane;
  FracturesParameters fractures;
  MeasurementCirclesParameters measurement_circles;
  DampingParameters damping;
  RunParameters run;
  OutputParameters output;
  CalibrationParameters calibration;
  std::optional<StudyParameters> study; ///< of 'antiform study' alone

  bool has(const std::string &component) const;
  /// Beds of the layer, from below; one without the component beds.
  int n_beds() const { return has("beds") ? static_cast<int>(beds.layers.size()) : 1; }
  const LayerParameters &bed(const int k) const
  {
    return has("beds") ? beds.layers.at(static_cast<std::size_t>(k)) : layer;
  }
  /// Share of bed @p k in the layer's thickness [-].
  double bed_share(int k) const;
  /// E and E/(1 - nu^2) of the layer, the means of its beds [Pa].
  double young_modulus() const;
  double plane_modulus() const;
  /// Fractures, or beds that slide.
  bool has_smooth_joints() const;
  /// The layer has joints that begin without bonds.
  bool has_unbonded_joints() const;
  /// Linear contacts act before anything has broken.
  bool has_contacts_from_start() const;
  /// What confines the specimen; null: nothing.
  const ConfinementParameters *confinement() const;
  /// From one state of balance to the next, not in time (coupling::EventDriver).
  bool follows_events() const { return has("walls") && walls.follows_events(); }
  /// The ends of the layer are turned, not moved.
  bool bends() const { return has("walls") && walls.turns(); }
  /// A layer of grains without a matrix.
  bool is_bare_grains() const;
  /// The same and straight: a specimen of the laboratory.
  bool is_specimen() const;
  /// The parts of the section that are finite elements alone.
  bool has_layer_mesh() const
  {
    return has("layer") && layer.representation == "continuum";
  }
  bool has_matrix_mesh() const
  {
    return has("matrix") && matrix.representation == "continuum";
  }
  /// Layer and matrix are finite elements that slide on one another, or may part.
  bool has_mesh_contact() const;
  /// The static driver has more to solve than a linear elastic body: a law, large strain,
  /// contact.
  bool is_nonlinear() const;
  /// Layer of grains in a matrix of finite elements.
  bool joins_grains_and_mesh() const;
  /// The same, joined in an overlap.
  bool is_bridged() const;
  /// The same, below the layer only: the cover is matrix grains up to its surface.
  bool has_grain_cover() const;
  /// The same, joined where the mesh's edges and the layer's outer grains meet.
  bool has_surface_interface() const;
  /// That keeps layer and matrix together, by multipliers.
  bool has_surface_tie() const
  {
    return has_surface_interface() &&
           (matrix.interface == "cemented" || matrix.interface == "sliding");
  }
  /// Layer of finite elements without a matrix.
  bool is_bare_mesh() const;

  // Derived geometry, in metres, from the ratios.
  double layer_length() const;   ///< L: wavelength (cosine) or length (straight) [m]
  double section_length() const; ///< straight ends included [m]
  /// Strain that turning both ends by 1 rad puts on the faces of a straight layer as long
  /// as the section, h/L: what counts as strain where walls turn [-].
  double strain_per_radian() const { return layer.thickness / section_length(); }
  /// That strain at 'Walls/End rotation' [-].
  double end_bending() const;
  double grain_diameter() const; ///< mean [m]
  double matrix_modulus() const; ///< E0 [Pa]
  bool has_foundation_under(const std::string &face) const; ///< base or top
  bool is_absorbing(const std::string &face) const;         ///< base or top
  double foundation_stiffness() const;                      ///< k_w [Pa/m]
  double foundation_shear() const;     ///< G_p [Pa m]
  /// Bulk densities of layer and matrix where they are not grains [kg/m^3].
  double layer_density() const;
  double matrix_density() const;
  /// On the top of the section, with the overburden that is not part of it [Pa].
  double pressure_on_top() const;
};

/// Read a deck (with its includes) and the `--set "Section/Entry=value"` overrides.
/// Throws InputError with every problem of syntax, name, pattern and value at once.
Parameters read_deck(const std::string &file, const std::vector<std::string> &overrides);

/// What the deck says of a study of its scene, alone: the scene is read member by member,
/// by read_deck(). Throws InputError with every problem of the section.
StudyParameters read_study(const std::string &file,
                           const std::vector<std::string> &overrides);

/// The effective parameters: sections of the listed components only, complete, so that
/// reading the text gives the same parameters.
std::string effective_deck(const Parameters &parameters);

/// Every parameter (or those whose path contains @p name): path, default, range, meaning.
/// Throws InputError with the nearest name when nothing matches.
std::string describe_parameters(const std::string &name = "");

/// The same as the page docs/parameters.md: a table for each section.
std::string parameters_markdown();
} // namespace antiform::cases

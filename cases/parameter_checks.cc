// What a scene is made of and what cannot go together in it.
#include "cases/beds.h"
#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/fracture_list.h"
#include "cases/sizes.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unistd.h>

namespace antiform::cases
{
std::string short_text(const double number)
{
  std::ostringstream text;
  text.precision(4);
  text << number;
  return text.str();
}

namespace
{
std::string metres(const double length)
{
  return short_text(length) + " m";
}

using Findings = std::vector<Finding>;

void check_components(const Parameters &p, Findings &findings)
{
  const auto find = [&](const std::string &text) {
    findings.push_back({{"Components"}, text});
  };
  if (!p.has("layer"))
    find(
        "there is no layer, and every length is a multiple of its thickness. Add layer.");
  if (p.has("foundation") && !p.has("matrix") && !p.is_bare_mesh())
    find("foundation without matrix: it carries finite elements or the matrix' base. Add "
         "matrix, give 'Layer/Representation' = 'continuum', or remove foundation.");
  for (const std::string load : {"gravity", "surface pressure"})
    if (p.has(load) && !p.has("matrix") && !p.has_foundation_under("base"))
    {
      std::string text = load;
      text += " without matrix: nothing would carry the layer, and it would fall. Add "
              "matrix, under a layer of finite elements a foundation, or remove ";
      text += load;
      find(text + ".");
    }
  if (p.run.driver != "static" && !p.has("walls"))
    findings.push_back({{"Run/Driver", "Components"},
                        "without walls nothing shortens the scene, and the " +
                            p.run.driver +
                            " driver would never end. Add walls to 'Components', or use "
                            "the static driver."});
  else if (!p.has("walls") && !p.has("gravity") && !p.has("surface pressure"))
    find("nothing loads the scene. Add walls, gravity or surface pressure.");
}

void check_types(const Parameters &p, Findings &findings)
{
  const discrete::JointTypes &types = p.layer.types;
  if (types.slit_fraction + types.gapped_fraction > 1.)
    findings.push_back(
        {{"Layer/Joint types/Slit fraction", "Layer/Joint types/Gapped fraction"},
         "with 'Layer/Joint types/Gapped fraction' = " +
             short_text(types.gapped_fraction) +
             " the shares add up to more than 1. Give less of one."});
  if (p.has_unbonded_joints() && (p.has("gravity") || p.has("surface pressure")))
    findings.push_back(
        {{types.slit_fraction > 0. ? "Layer/Joint types/Slit fraction"
                                   : "Layer/Joint types/Gapped fraction",
          "Components"},
         "a prestressed layer must be bonded throughout in this version. Give 0, or "
         "remove gravity and surface pressure from 'Components'."});
}

/// Grips and servo walls are for specimens of the laboratory.
void check_specimen(const Parameters &p, Findings &findings)
{
  const std::string specimen = "a straight layer of grains without matrix. Give "
                               "'Layer/Shape' = 'straight', 'Layer/Representation' = "
                               "'grains' and no matrix in 'Components'";
  const bool pulls = p.has("walls") && p.walls.action == "pull";
  if (p.has("membrane") && p.is_bare_mesh())
    return check_membrane_of_mesh(p, findings);
  if (p.has("servo walls") && (!p.is_specimen() || !p.has("walls")))
    findings.push_back({{"Components"},
                        "servo walls confine a specimen between walls, " + specimen +
                            ", and walls; around a bent layer give membrane in their "
                            "place."});
  if (p.has("membrane") && (!p.is_bare_grains() || !p.has("walls")))
    findings.push_back({{"Components"},
                        "a membrane confines a layer between walls, straight or bent, of "
                        "grains and without matrix. Give walls, and no matrix; beside a "
                        "matrix, a surface pressure."});
  if (p.has("servo walls") && p.has("membrane"))
    findings.push_back({{"Components"},
                        "servo walls and membrane both confine the layer. Give one of "
                        "them."});
  if (p.confinement() != nullptr && p.confinement()->pressure > 0.02 * p.young_modulus())
    findings.push_back({{p.has("membrane") ? "Membrane/Pressure" : "Servo walls/Pressure",
                         "Layer/Young modulus"},
                        "more than 2 % of the rock's Young's modulus, beyond the small "
                        "strains of joints. Give less, in Pa."});
  if (pulls && !p.is_specimen())
    findings.push_back(
        {{"Walls/Action", "Components"}, "grips pull a specimen, " + specimen + "."});
  if (pulls && p.confinement() != nullptr)
    findings.push_back({{"Walls/Action", "Components"},
                        "servo walls and membrane press a specimen that platens shorten. "
                        "Give press, or remove them from 'Components'."});
  const double free_length =
      p.layer_length() / p.grain_diameter() - 2. * p.walls.grip_layers;
  if (pulls && p.is_specimen() && free_length < 5.)
    findings.push_back(
        {{"Walls/Grip layers", "Layer/Length ratio", "Layer/Grains across"},
         "between the grips " + short_text(free_length) +
             " grain diameters are left. Give narrower grips or a longer specimen: at "
             "least 5."});
}

void check_strengths(const std::string &section,
                     const double tensile_strength,
                     const double cohesion,
                     const double tan_friction,
                     Findings &findings)
{
  // Beyond the apex of the Coulomb line the shear strength would be negative.
  if (tan_friction > 0. && tensile_strength > cohesion / tan_friction)
    findings.push_back(
        {{section + "/Tensile strength", section + "/Cohesion",
          section + "/Friction angle"},
         "beyond cohesion / tan(friction angle) = " +
             short_text(cohesion / tan_friction) +
             " Pa, where the shear strength has fallen to nothing. Give at most that, or "
             "more cohesion."});
}

void check_bonds(const Parameters &p, Findings &findings)
{
  const discrete::BondConstants bond = discrete::constants(p.layer.law());
  const bool flat = p.layer.bond_model == "flat joint";
  const std::string section = flat ? "Layer/Flat joint"
                              : p.layer.bond_model == "parallel bond"
                                  ? "Layer/Parallel bond"
                                  : "Layer/Contact bond";
  const std::string cohesion =
      section + (section == "Layer/Contact bond" ? "/Shear strength" : "/Cohesion");
  if (bond.breakable && bond.tensile_strength == 0. && bond.cohesion == 0.)
    findings.push_back({{"Layer/Breakable", section + "/Tensile strength", cohesion},
                        "but both strengths are 0 Pa: every joint would break in the "
                        "first step. Give strengths."});
  if (bond.breakable && section != "Layer/Contact bond")
    check_strengths(section, bond.tensile_strength, bond.cohesion, bond.tan_friction,
                    findings);
  if (!flat && (p.has("gravity") || p.has("surface pressure")))
    findings.push_back({{"Layer/Bond model", "Components"},
                        "a prestressed layer must be of flat joints in this version. "
                        "Give flat joint, or "
                        "remove gravity and surface pressure from 'Components'."});
  if (!flat && p.layer.types.slit_fraction + p.layer.types.gapped_fraction > 0.)
    findings.push_back({{"Layer/Joint types/Slit fraction",
                         "Layer/Joint types/Gapped fraction", "Layer/Bond model"},
                        "only flat joints can begin without bonds. Give 0, or "
                        "'Layer/Bond model' = 'flat joint'."});
}

/// The modulus of a disk packing is that of its bonds within a factor of two or so.
void check_modulus(const Parameters &p, Findings &findings)
{
  constexpr double factor = 20.;
  const double rock = p.layer.young_modulus;
  const double bonds = discrete::joint_modulus(p.layer.law());
  if (!(bonds < factor * rock && rock < factor * bonds))
    findings.push_back({{"Layer/Young modulus", p.layer.bond_model == "flat joint"
                                                    ? "Layer/Flat joint/Effective modulus"
                                                    : "Layer/Bond model"},
                        "the rock's modulus is " + short_text(rock) +
                            " Pa and that of its bonds " + short_text(bonds) +
                            " Pa, which cannot belong together. Give both in Pa."});
}

/// What holds for any rock of the layer, be it that of a bed.
void check_rocks(const Parameters &p, Findings &findings)
{
  if (p.layer.representation != "grains")
    return;
  for (int bed = 0; bed < p.n_beds(); ++bed)
  {
    Parameters alone = p;
    alone.layer = p.bed(bed);
    Findings of_bed;
    check_modulus(alone, of_bed);
    check_bonds(alone, of_bed);
    check_types(alone, of_bed);
    for (Finding &finding : of_bed)
    {
      if (p.has("beds"))
        finding = {{"Beds/Rocks"},
                   "bed " + std::to_string(bed + 1) + " from below, '" +
                       finding.entries.front() + "': " + finding.text};
      findings.push_back(finding);
    }
  }
}

void check_layer(const Parameters &p, Findings &findings)
{
  if (p.layer.representation == "grains" && p.layer_length() < p.layer.thickness)
    findings.push_back(
        {{p.layer.length_ratio > 0. ? "Layer/Length ratio" : "Layer/Slenderness ratio",
          "Layer/Young modulus", "Layer/UCS"},
         "the layer would be " + metres(p.layer_length()) + " long and " +
             metres(p.layer.thickness) +
             " thick. Give a length of at least the thickness."});
  if (p.layer.shape == "cosine")
  {
    // Steepest slope of a0/2 cos(2 pi x / L); top and bottom are shifted along y, so the
    // layer thins with the cosine of its dip.
    const double per_ratio = M_PI * p.layer.thickness / p.layer_length();
    const double steepest = std::tan(M_PI / 3.);
    if (p.layer.amplitude_ratio * per_ratio > steepest)
      findings.push_back(
          {{"Layer/Amplitude ratio", "Layer/Length ratio", "Layer/Slenderness ratio"},
           "the limbs would dip by " +
               short_text(180. / M_PI * std::atan(p.layer.amplitude_ratio * per_ratio)) +
               " degrees, and the layer be thinner there by the cosine of that. Give at "
               "most " +
               short_text(std::floor(steepest / per_ratio * 100.) / 100.) +
               " (60 degrees)."});
  }
}

void check_matrix(const Parameters &p, Findings &findings)
{
  const MatrixParameters &m = p.matrix;
  if (m.burial_depth_ratio == 0.)
    findings.push_back({{"Matrix/Burial depth ratio"},
                        "there is no cover above the layer. Give a value > 0, or remove "
                        "matrix from 'Components' for a bare layer."});
  if (m.base_depth_ratio == 0.)
    findings.push_back(
        {{"Matrix/Base depth ratio"},
         "there is no matrix below the layer, which must rest on some. Give a "
         "value > 0, or remove matrix from 'Components' for a bare layer."});
  if (p.layer.representation == "continuum" && m.representation == "grains")
    findings.push_back(
        {{"Matrix/Representation", "Layer/Representation"},
         "a layer of finite elements in a matrix of grains does not exist. "
         "Set 'Layer/Representation' = 'grains', or this to 'continuum'."});

  if (p.layer.representation == "grains" && !p.has_surface_interface() &&
      (m.interface == "sliding" || m.interface == "frictional"))
    findings.push_back(
        {{"Matrix/Interface", "Layer/Representation"},
         "a layer of grains is cemented to matrix grains, or in frictionless "
         "contact with them. Give one of these, or 'Matrix/Join' = 'surface interface' "
         "with a matrix of finite elements, or 'Layer/Representation' = 'continuum'."});
  if (m.cell_aspect > 1. && (p.layer.representation == "grains"))
    findings.push_back({{"Matrix/Cell aspect ratio", "Layer/Representation"},
                        "beside grains cells are as wide as high. Give 1."});

  const bool has_grains = m.representation == "grains" || p.is_bridged();
  if (has_grains && (m.poisson_ratio < 0.01 || m.poisson_ratio > 0.235))
    findings.push_back(
        {{"Matrix/Poisson ratio", "Matrix/Representation", "Layer/Representation"},
         "out of reach of the matrix grains: packings of disks stay below nu_2D = 1/3, "
         "which is 0.25 in plane strain, and ours reach 0.01 to 0.235. Give such a "
         "ratio, "
         "or 'Matrix/Join' = 'surface interface', which needs no matrix grains, or "
         "'Layer/Representation' = 'continuum'."});
  if (has_grains && m.breakable && m.tensile_strength == 0. && m.cohesion == 0.)
    findings.push_back(
        {{"Matrix/Breakable", "Matrix/Tensile strength", "Matrix/Cohesion"},
         "but 'Matrix/Tensile strength' and 'Matrix/Cohesion' are 0 Pa: every "
         "joint would break in the first step. Give strengths."});
  if (has_grains)
    check_strengths("Matrix", m.tensile_strength, m.cohesion, m.tan_friction, findings);
  if (m.representation == "continuum" && m.largest_cell < m.cell_size)
    findings.push_back({{"Matrix/Largest cell ratio", "Matrix/Cell size ratio"},
                        "smaller than 'Matrix/Cell size ratio' = " +
                            short_text(m.cell_size) + ". Give at least that."});
}

void check_run(const Parameters &p, Findings &findings)
{
  if (p.run.end_shortening > p.run.longest_shortening)
    findings.push_back(
        {{"Run/End shortening", "Run/Longest shortening"},
         "beyond 'Run/Longest shortening' = " + short_text(p.run.longest_shortening) +
             ", where the run would be given up. Raise that, or end sooner."});
  if (p.run.driver == "static" && p.has("layer") && p.layer.representation == "grains")
    findings.push_back({{"Run/Driver", "Layer/Representation"},
                        "the static driver solves the elastic continuum, and the layer is "
                        "grains. Give quasi-static, or 'Layer/Representation' = "
                        "'continuum'."});
  if (p.has("walls") && p.walls.steps_and_relaxes())
  {
    if (!p.has("damping") || p.run.driver != "quasi-static")
      findings.push_back({{"Walls/Loading", "Components", "Run/Driver"},
                          "forces come to balance under damping only, with the "
                          "quasi-static driver. Add 'damping' to 'Components', or give "
                          "'constant rate'."});
    if (p.walls.action == "pull")
      findings.push_back({{"Walls/Loading", "Walls/Action"},
                          "grips move at a constant rate only. Give 'constant rate'."});
  }
  if (p.run.estimate_rate_error && p.has("layer") &&
      (p.run.driver != "quasi-static" || p.layer.representation != "grains"))
    findings.push_back({{"Run/Estimate loading-rate error", "Run/Driver"},
                        "there is no loading-rate error to estimate without grains that "
                        "the quasi-static driver shortens to a peak. Give false."});
  if (p.run.driver == "static" && p.has("walls") && p.run.end_shortening == 0.)
    findings.push_back(
        {{"Run/End shortening", "Run/Driver"},
         "the static driver does not look for a peak. Give the shortening to "
         "go to, > 0."});
}

void check_memory(const Parameters &p, Findings &findings)
{
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGESIZE));
  const Sizes sizes = predict_sizes(p, SectionGeometry(p));
  if (sizes.memory <= memory)
    return;
  constexpr double gib = 1024. * 1024. * 1024.;
  std::string entry = "Layer/Grains across", count = short_text(sizes.grains) + " grains",
              remedy = "fewer grains across the layer, a shorter layer, or 'continuum' "
                       "for the matrix";
  if (sizes.tile_grains > sizes.grains)
  {
    entry = "Matrix/Tile size ratio";
    count = short_text(sizes.tile_grains) + " grains of the matrix tile";
    remedy = "a smaller tile";
  }
  if (sizes.dofs > std::max(sizes.grains, sizes.tile_grains))
  {
    entry = "Matrix/Cell size ratio";
    count = short_text(sizes.cells) + " cells";
    remedy = "larger cells or a smaller section";
  }
  findings.push_back({{entry, "Layer/Thickness"},
                      "about " + count + ", and the scene needs " +
                          short_text(sizes.memory / gib) +
                          " GiB of memory; this machine has " + short_text(memory / gib) +
                          " GiB. Give " + remedy + "."});
}
} // namespace

std::vector<Finding> check_parameters(const Parameters &p)
{
  Findings findings;
  check_components(p, findings);
  if (p.has("layer") && p.has("beds"))
  {
    check_beds(p, findings);
    if (!findings.empty())
      return findings; // what else is wrong depends on the beds
  }
  if (p.has("layer"))
  {
    check_rocks(p, findings);
    check_layer(p, findings);
    check_specimen(p, findings);
  }
  if (p.has("layer") && p.has("matrix"))
    check_matrix(p, findings);
  if (p.joins_grains_and_mesh())
    check_join(p, findings);
  check_run(p, findings);
  check_event_driver(p, findings);
  check_turning_walls(p, findings);
  check_materials(p, findings);
  if (p.has("layer"))
    check_solid_scene(p, findings);
  if (p.has("layer") && p.run.driver == "buckling")
    check_buckling(p, findings);
  if (p.has("layer") && p.has("fractures"))
    check_fractures(p, findings);
  if (p.has("calibration"))
    check_calibration(p, findings);
  if (p.has("layer") && p.has("fractures") && findings.empty())
    check_drawn_fractures(p, findings);
  if (p.has("layer") && p.layer.representation == "grains" && findings.empty())
    check_packing(p, findings);
  if (p.has("measurement circles") && findings.empty())
    check_circles(p, findings);
  if (p.has("layer") && findings.empty()) // else the geometry may not exist
    check_memory(p, findings);
  return findings;
}
} // namespace antiform::cases

// What finite elements may be made of, and what the linear theory of buckling leaves out.
#include "cases/declarations.h"

namespace antiform::cases
{
namespace
{
using Findings = std::vector<Finding>;

/// Whether a law and the driver go together, and its strengths among themselves.
void check_material(const Parameters &p,
                    const std::string &section,
                    const MaterialParameters &m,
                    const double poisson_ratio,
                    Findings &findings)
{
  const auto find = [&](const std::vector<std::string> &entries, const std::string &text)
  {
    std::vector<std::string> paths;
    for (const std::string &entry : entries)
      paths.push_back(entry.find('/') == std::string::npos ? section + "/" + entry
                                                           : entry);
    findings.push_back({paths, text});
  };
  if (m.law != "elastic" && (p.run.driver != "static" || p.joins_grains_and_mesh()))
    find({"Law", "Run/Driver"},
         "the " + p.run.driver +
             " driver knows elastic finite elements only. Give "
             "elastic, or 'Run/Driver' = 'static' for a section without grains.");
  if (m.law == "St Venant-Kirchhoff" && p.run.strain != "finite")
    find({"Law", "Run/Strain"},
         "a law of finite strain. Give 'Run/Strain' = 'finite', or elastic.");
  if (m.law == "Maxwell" && p.run.duration == 0.)
    find({"Law", "Run/Duration"},
         "a viscous material needs the time in which it is shortened. Give "
         "'Run/Duration' > 0 s.");
  if (m.yields() && m.tan_dilation > m.tan_friction)
    find(
        {"Dilation angle", "Friction angle"},
        "rock that dilates by more than its friction would make energy. Give at most the "
        "friction angle.");
  if (m.yields() && m.cohesion == 0. && m.tan_friction == 0.)
    find({"Cohesion", "Friction angle"},
         "a rock without strength. Give a cohesion, or a friction angle.");
  if (m.law == "Mohr-Coulomb" && m.tensile_strength * m.tan_friction > m.cohesion)
    find({"Tensile strength", "Cohesion", "Friction angle"},
         "above the apex c cot phi = " + short_text(m.cohesion / m.tan_friction) +
             " Pa. Give at most that, or 0 for none.");
  if (p.matrix.element_degree == 1 && poisson_ratio >= 0.45 && !p.is_bridged())
    find({section == "Layer material" ? "Layer/Poisson ratio" : "Matrix/Poisson ratio",
          "Matrix/Element degree"},
         "bilinear cells lock where the volume hardly changes, and are many times too "
         "stiff. Give 'Matrix/Element degree' = 2, or less than 0.45.");
}

/// Finite strain where the mesh steps in time, or buckles.
void check_finite_strain(const Parameters &p, Findings &findings)
{
  if (p.run.driver == "buckling")
    findings.push_back({{"Run/Strain", "Run/Driver"},
                        "the buckling driver is of small strain in its finite elements. "
                        "Give small, or 'Run/Driver' = 'static'."});
  else if (!p.has_layer_mesh() && !p.has_matrix_mesh())
    findings.push_back({{"Run/Strain", "Matrix/Representation"},
                        "nothing of this section is finite elements, and grains turn by "
                        "any angle anyway. Give small."});
  else
    for (const std::string load : {"gravity", "surface pressure"})
      if (p.has(load))
        findings.push_back({{"Run/Strain", "Components"},
                            "the prestress that is installed under " + load +
                                " does not turn with the section. Remove " + load +
                                " from 'Components', or give small."});
}
} // namespace

void check_materials(const Parameters &p, Findings &findings)
{
  if (p.has_layer_mesh())
    check_material(p, "Layer material", p.layer_material, p.layer.poisson_ratio,
                   findings);
  if (p.has_matrix_mesh())
    check_material(p, "Matrix material", p.matrix_material, p.matrix.poisson_ratio,
                   findings);
  if (p.run.strain == "finite" && p.run.driver != "static")
    check_finite_strain(p, findings);
}

namespace
{
/// What the linear static system of grains leaves out. Grips, locked-in stress and the
/// like are no shortening from a stress-free state.
void check_buckling_of_grains(const Parameters &p, Findings &findings)
{
  const auto find = [&](std::vector<std::string> entries, const std::string &text)
  { findings.push_back({std::move(entries), "the buckling driver " + text}); };
  if (p.has("fractures"))
    find({"Components", "Run/Driver"},
         "knows no smooth joints, and fractures slide and part. Remove fractures from "
         "'Components', or give quasi-static.");
  if (p.has("beds") && p.beds.interface == "frictional")
    find({"Beds/Interface", "Run/Driver"},
         "knows no smooth joints, and beds that rub are joined by these. Give cemented, "
         "or 'Run/Driver' = 'quasi-static'.");
  if (p.has("matrix") && p.matrix.interface.find("friction") == 0)
    find({"Matrix/Interface", "Run/Driver"},
         "is linear, and grains in " + p.matrix.interface +
             " contact may part. Give cemented, or 'Run/Driver' = 'quasi-static'.");
  if (p.has_unbonded_joints())
    find({"Layer/Joint types/Slit fraction", "Layer/Joint types/Gapped fraction",
          "Run/Driver"},
         "is linear, and joints that begin without bonds close and slide. Give 0 for "
         "both, or 'Run/Driver' = 'quasi-static'.");
  for (int bed = 0; bed < p.n_beds(); ++bed)
    if (discrete::has_contact_beside(p.bed(bed).law()))
    {
      find({"Layer/Bond model", "Run/Driver"},
           "is linear, and the contacts beside parallel bonds may part. Give flat joint "
           "or contact bond, or 'Run/Driver' = 'quasi-static'.");
      break;
    }
  if (p.layer.locked_in_stress > 0.)
    find({"Layer/Locked-in stress", "Run/Driver"},
         "looks for a multiple of one load, the shortening, beside which no other stress "
         "can be. Give 0.");
  if (p.walls.action != "press")
    find({"Walls/Action", "Run/Driver"},
         "knows one load, the shortening by the walls. Give press.");
  for (const char *pressing : {"servo walls", "membrane"})
    if (p.has(pressing))
      find({"Components", "Run/Driver"},
           std::string("knows one load, the shortening by the walls. Remove ") +
               pressing + " from 'Components'.");
  if (p.is_bridged() && !p.bridging.constraint)
    find({"Bridging domain/Constraint", "Run/Driver"},
         "would find the cover loose. Give true.");
  if (p.has("matrix") && p.matrix.refinement_rounds > 0)
    find({"Matrix/Refinement rounds", "Layer/Representation"},
         "refines sections of finite elements alone. Give 0, and a smaller "
         "'Matrix/Cell size ratio' for smaller cells.");
}
} // namespace

/// What the linear theory of buckling leaves out.
void check_buckling(const Parameters &p, Findings &findings)
{
  const auto find = [&](std::vector<std::string> entries, const std::string &text) {
    findings.push_back({std::move(entries), text});
  };
  if (p.layer.shape != "straight")
    find({"Layer/Shape", "Run/Driver"},
         "a layer that is bent beforehand has no buckling load. Give straight.");
  // Bilinear cells of length a are too stiff by 0.4 (a/h)^2 in bending: measured on
  // square ones, 5.0, 1.1, 0.25 % with 3, 6, 12 in the layer's thickness.
  const double length =
      p.matrix.cell_aspect * p.matrix.cell_size * p.grain_diameter() / p.layer.thickness;
  if (p.layer.representation == "grains")
    check_buckling_of_grains(p, findings);
  else if (p.matrix.element_degree == 1 && p.matrix.refinement_rounds == 0 &&
           0.4 * length * length > 0.02)
    find({"Matrix/Element degree", "Matrix/Cell aspect ratio", "Matrix/Cell size ratio"},
         "bilinear cells " + short_text(length) + " h long are some " +
             short_text(40. * length * length) +
             " % too stiff in bending, and so is their buckling load. Give 2, or "
             "'Matrix/Refinement rounds'.");
  for (const std::string load : {"gravity", "surface pressure"})
    if (p.has(load))
      find({"Components", "Run/Driver"},
           "the buckling driver knows one load, the shortening by the walls, and "
           "ignores none. Remove " +
               load + " from 'Components'.");
}

namespace
{
/// Contact of layer and matrix, where both are finite elements.
void check_interface(const Parameters &p, Findings &findings)
{
  const std::string &word = p.matrix.interface;
  const bool buckles = p.run.driver == "buckling";
  if (p.has_mesh_contact() && p.run.driver == "static" && word != "sliding" &&
      !p.has("gravity") && !p.has("surface pressure"))
    findings.push_back({{"Matrix/Interface", "Components"},
                        "nothing presses the cover on a layer that it may part from: it "
                        "could float away, a mechanism without stiffness. Add gravity or "
                        "surface pressure to 'Components', or give sliding or cemented."});
  if (!p.has_mesh_contact() || p.run.driver == "static" || (buckles && word == "sliding"))
    return;
  findings.push_back({{"Matrix/Interface", "Run/Driver", "Layer/Representation"},
                      "the " + p.run.driver + " driver knows of finite elements that are " +
                          (buckles ? "cemented or sliding" : "cemented") +
                          ". Give that, or 'Run/Driver' = 'static'."});
}

void check_foundation(const Parameters &p, Findings &findings)
{
  const FoundationParameters &f = p.foundation;
  const bool on_grains = p.has("matrix") && p.matrix.representation == "grains";
  if (!p.has("matrix") && f.stiffness == 0.)
    findings.push_back({{"Foundation/Stiffness", "Components"},
                        "without a matrix there is no modulus that the ratio could "
                        "multiply. Give the stiffness in Pa/m."});
  if (on_grains && (f.shear_ratio > 0. || f.faces != "base"))
    findings.push_back({{f.shear_ratio > 0. ? "Foundation/Shear ratio"
                                            : "Foundation/Faces",
                         "Matrix/Representation"},
                        "under a base of grains there are springs only. Give no shear "
                        "and the base, or 'Matrix/Representation' = 'continuum'."});
  if (f.lifts_off && f.faces != "base")
    findings.push_back({{"Foundation/Faces", "Foundation/Lifts off"},
                        "a foundation that only pushes carries the base. Give base."});
  if (f.lifts_off && p.run.driver != "static")
    findings.push_back({{"Foundation/Lifts off", "Run/Driver"},
                        "only the static driver knows a foundation that pushes and does "
                        "not pull. Give false, or 'Run/Driver' = 'static'."});
  if (f.lifts_off && !p.has("gravity") && !p.has("surface pressure"))
    findings.push_back({{"Foundation/Lifts off", "Components"},
                        "nothing presses the section on a foundation that does not pull: "
                        "it could float away, a mechanism without stiffness. Add gravity "
                        "or surface pressure to 'Components', or give false."});
  if (f.lifts_off && f.shear_ratio > 0.)
    findings.push_back({{"Foundation/Shear ratio", "Foundation/Lifts off"},
                        "a shear layer holds on to the section; from springs alone it "
                        "can part. Give 0."});
}

void check_absorbing_boundary(const Parameters &p, Findings &findings)
{
  if (p.run.driver != "dynamic" || !p.has_matrix_mesh())
    findings.push_back({{"Components", "Run/Driver", "Matrix/Representation"},
                        "an absorbing boundary lets the waves of the dynamic driver out "
                        "of a matrix of finite elements. Remove it, or give 'Run/Driver' "
                        "= 'dynamic' and 'Matrix/Representation' = 'continuum'."});
  for (const std::string face : {"base", "top"})
    if (p.has_foundation_under(face) && p.is_absorbing(face))
      findings.push_back({{"Absorbing boundary/Faces", "Foundation/Faces"},
                          "the " + face +
                              " is on a foundation, which throws waves back. Give one of "
                              "the two another face."});
}

/// Rows of a cover that has none of its own: a cell that is cut down to a sliver is a
/// matter to decide, not to happen.
void check_thin_strips(const Parameters &p, Findings &findings)
{
  if (!(p.has_layer_mesh() && p.has_matrix_mesh()) && !p.has_surface_interface())
    return;
  const double cell = p.matrix.cell_size * p.grain_diameter();
  const auto check = [&](const std::string &what, const double ratio,
                         const std::string &entry, const std::string &rows)
  {
    const double height = ratio * p.layer.thickness;
    if (height > 0. && height < 0.999 * cell)
      findings.push_back({{entry, "Matrix/Cell size ratio", "Layer/Grains across"},
                          "the " + what + " of " + short_text(height) +
                              " m is thinner than a cell of " + short_text(cell) +
                              " m. Give " + rows + "'Matrix/Cell size ratio' of " +
                              short_text(height / p.grain_diameter()) + " or less."});
  };
  if (p.matrix.cover_rows == 0)
    check("cover", p.matrix.burial_depth_ratio, "Matrix/Burial depth ratio",
          "'Matrix/Cover rows' = 1 or more, or ");
  check("base", p.matrix.base_depth_ratio, "Matrix/Base depth ratio", "");
}
} // namespace

void check_solid_scene(const Parameters &p, Findings &findings)
{
  check_interface(p, findings);
  check_thin_strips(p, findings);
  if (p.has("foundation"))
    check_foundation(p, findings);
  if (p.has("absorbing boundary"))
    check_absorbing_boundary(p, findings);
  if (p.matrix.cover_rows > 0 && p.has("matrix") && !p.has_layer_mesh() &&
      !p.has_surface_interface())
    findings.push_back({{"Matrix/Cover rows", "Layer/Representation"},
                        "rows of their own are for a cover on a layer of finite "
                        "elements, or on a surface interface. Give 0."});
  if (p.matrix.refinement_rounds > 0 && p.run.driver != "buckling")
    findings.push_back({{"Matrix/Refinement rounds", "Run/Driver"},
                        "only the buckling driver refines its cells. Give 0."});
  if (p.matrix.refinement_rounds > 0 && p.has("foundation") &&
      p.foundation.shear_ratio > 0.)
    findings.push_back({{"Matrix/Refinement rounds", "Foundation/Shear ratio"},
                        "the error indicator does not know a shear layer. Give 0 rounds, "
                        "or no shear."});
  if (p.run.path == "arc length")
  {
    if (p.run.driver != "static")
      findings.push_back({{"Run/Path", "Run/Driver"},
                          "only the static driver follows a path. Give load steps."});
    if (p.run.duration > 0.)
      findings.push_back({{"Run/Path", "Run/Duration"},
                          "a path past limit points has no time. Give load steps, or a "
                          "duration of 0 and no viscous law."});
  }
  if (p.surface_pressure.overburden_ratio > 0. && p.has("surface pressure") &&
      !p.has("gravity"))
    findings.push_back({{"Surface pressure/Overburden ratio", "Components"},
                        "an overburden weighs nothing without gravity. Add gravity to "
                        "'Components', or give its pressure."});
}

/// A membrane around a layer of finite elements is a pressure that follows its faces.
void check_membrane_of_mesh(const Parameters &p, Findings &findings)
{
  if (p.run.driver != "static" || p.run.strain != "finite" || !p.has("walls"))
    findings.push_back({{"Components", "Run/Driver", "Run/Strain"},
                        "a membrane around a layer of finite elements is a pressure that "
                        "follows its faces: it needs walls, 'Run/Driver' = 'static' and "
                        "'Run/Strain' = 'finite'."});
  if (p.has("servo walls") || p.has("surface pressure") || p.has("foundation"))
    findings.push_back({{"Components"},
                        "the membrane presses on the faces of the layer. Remove servo "
                        "walls, surface pressure and foundation."});
}
} // namespace antiform::cases

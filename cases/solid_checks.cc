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
  if (m.law != "elastic" && (p.run.driver != "static" || p.is_bridged()))
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
    findings.push_back({{"Run/Strain", "Run/Driver"},
                        "the " + p.run.driver +
                            " driver is of small strain in its finite "
                            "elements. Give small, or 'Run/Driver' = 'static'."});
}

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
  if (p.matrix.element_degree == 1 && 0.4 * length * length > 0.02)
    find({"Matrix/Element degree", "Matrix/Cell aspect ratio", "Matrix/Cell size ratio"},
         "bilinear cells " + short_text(length) + " h long are some " +
             short_text(40. * length * length) +
             " % too stiff in bending, and so is their buckling load. Give 2.");
  for (const std::string load : {"gravity", "surface pressure"})
    if (p.has(load))
      find({"Components", "Run/Driver"},
           "the buckling driver knows one load, the shortening by the walls, and "
           "ignores none. Remove " +
               load + " from 'Components'.");
}
} // namespace antiform::cases

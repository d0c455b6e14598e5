// What the event driver does not know.
#include "cases/declarations.h"

namespace antiform::cases
{
namespace
{
const std::string otherwise = "Give 'Walls/Loading' = 'step and relax'";

/// E/E0 beyond which a layer is as good as loose in its mesh, whose stiffness must stand
/// out from round-off at 1e-9 of the grains' (coupling/constrained_inverse.h): measured
/// there 0.5 over the contrast, 0.09 in a matrix twelve times as deep as the layer [-].
constexpr double largest_contrast = 1e6;

/// What acts on the grains beside flat joints, walls, pressure and base.
void check_event_components(const Parameters &p, std::vector<Finding> &findings)
{
  for (const std::string name :
       {"gravity", "surface pressure", "foundation", "membrane", "fractures"})
    if (p.has(name))
      findings.push_back({{"Walls/Loading", "Components"},
                          "the event driver does not know " + name + ". " + otherwise +
                              ", or remove " + name + " from 'Components'."});
  if (p.has("calibration"))
    findings.push_back({{"Walls/Loading", "Components"},
                        "trials of a calibration are loaded in time. Give 'constant "
                        "rate'."});
  if (p.has("beds") && p.beds.interface == "frictional")
    findings.push_back({{"Walls/Loading", "Beds/Interface"},
                        "the event driver does not know beds that slide. " + otherwise +
                            ", or 'Beds/Interface' = 'cemented'."});
  if (p.is_bridged() && !p.bridging.constraint)
    findings.push_back({{"Walls/Loading", "Bridging domain/Constraint"},
                        "the event driver moves grains and mesh together. " + otherwise +
                            ", or 'Bridging domain/Constraint' = true."});
  if (p.is_bridged() && p.matrix.stiffness_contrast > largest_contrast)
    findings.push_back({{"Matrix/Stiffness contrast", "Walls/Loading"},
                        "to the event driver a mesh this soft holds the layer no more "
                        "than none. " +
                            otherwise + ", or a contrast of at most " +
                            short_text(largest_contrast) + "."});
  if (p.has("matrix") && p.matrix.representation == "grains" &&
      p.matrix.interface != "cemented")
    findings.push_back({{"Walls/Loading", "Matrix/Interface"},
                        "the event driver does not know grains that slide on one "
                        "another without a joint. " +
                            otherwise + ", or 'Matrix/Interface' = 'cemented'."});
}

/// Joints that are not flat, or not bonded and free of stress at the beginning.
void check_event_joints(const Parameters &p, std::vector<Finding> &findings)
{
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &bed = p.bed(k);
    const std::string of_bed =
        p.has("beds") ? "bed " + std::to_string(k + 1) + " from below: " : "";
    const std::string rocks = p.has("beds") ? "Beds/Rocks" : "";
    const auto entry = [&](const std::string &name)
    { return rocks.empty() ? name : rocks; };
    if (bed.bond_model != "flat joint")
      findings.push_back({{"Walls/Loading", entry("Layer/Bond model")},
                          of_bed +
                              "the event driver breaks elements of flat joints, no " +
                              bed.bond_model + "s. " + otherwise +
                              ", or 'Layer/Bond model' = 'flat joint'."});
    if (bed.types.slit_fraction + bed.types.gapped_fraction > 0.)
      findings.push_back(
          {{"Walls/Loading", entry("Layer/Joint types/Slit fraction"),
            entry("Layer/Joint types/Gapped fraction")},
           of_bed +
               "the event driver wants all joints bonded at the "
               "beginning. " +
               otherwise +
               ", or 0 to 'Layer/Joint types/Slit fraction' and 'Gapped fraction'."});
  }
  if (p.layer.locked_in_stress > 0.)
    findings.push_back(
        {{"Walls/Loading", "Layer/Locked-in stress"},
         "the event driver wants joints free of stress at the beginning. " + otherwise +
             ", or 'Layer/Locked-in stress' = 0."});
}
} // namespace

void check_event_driver(const Parameters &p, std::vector<Finding> &findings)
{
  if (!p.follows_events())
    return;
  if (!p.has("damping") || p.run.driver != "quasi-static")
    findings.push_back(
        {{"Walls/Loading", "Components", "Run/Driver"},
         "the event driver belongs to the quasi-static driver, and where a "
         "collapse goes on it hands over to motion that comes to rest "
         "under damping only. Add 'damping' to 'Components' and give 'Run/Driver' = "
         "'quasi-static', or here 'constant rate'."});
  if (!p.has("layer"))
    return;
  if (p.layer.representation != "grains")
  {
    findings.push_back(
        {{"Walls/Loading", "Layer/Representation"},
         "the event driver breaks bonds of grains, and the layer is finite "
         "elements. Give 'constant rate', or 'Layer/Representation' = "
         "'grains'."});
    return;
  }
  check_event_components(p, findings);
  check_event_joints(p, findings);
}
} // namespace antiform::cases

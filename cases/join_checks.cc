// How grains and mesh may be joined.
#include "cases/declarations.h"
#include "cases/join_choice.h"

#include <cmath>

namespace antiform::cases
{
namespace
{
using Findings = std::vector<Finding>;

std::string in_metres(const double length)
{
  return short_text(length) + " m";
}

/// From the layer outward: buffer, overlap, and at least one row of cells that is mesh
/// only.
void check_overlap_fits(const Parameters &p,
                        const std::string &what,
                        const std::string &entry,
                        const double ratio,
                        Findings &findings)
{
  const double d = p.grain_diameter();
  const double room = ratio * p.layer.thickness;
  const double overlap = p.bridging.overlap * d;
  const double buffer = p.bridging.buffer * d;
  const double cell = p.matrix.cell_size * d;
  if (ratio == 0. || holds(room, room_of_overlap(p)))
    return;
  const double largest = std::floor((room - buffer - cell) / d * 1e3) / 1e3;
  std::string text = "the overlap is wider than the " + what + ": buffer " +
                     in_metres(buffer) + " + overlap " + in_metres(overlap) +
                     " + one row of cells " + in_metres(cell) + " = " +
                     in_metres(buffer + overlap + cell) + ", but the " + what + " is " +
                     in_metres(room) + ". ";
  if (largest >= p.matrix.cell_size)
    text += "The largest overlap width ratio that fits is " + short_text(largest) + " (" +
            in_metres(largest * d) + "); or give";
  else
    text += "No overlap fits beside this buffer. Give";
  const bool of_cover = what == "cover";
  text += " more grains across the layer, a smaller buffer width ratio, a larger '" +
          entry + "', 'Matrix/Join' = " +
          (of_cover && holds(room, thinnest_grain_cover * d) ? "'grain cover' or " : "") +
          "'surface interface'" + (of_cover ? " (or 'automatic')" : "") +
          ", or 'Matrix/Representation' = 'grains'.";
  findings.push_back(
      {{"Bridging domain/Overlap width ratio", "Bridging domain/Buffer width ratio",
        "Matrix/Cell size ratio", "Layer/Grains across", "Layer/Thickness", entry},
       text});
}

/// Damping and sub-cycling are of waves, in the real time of the dynamic driver.
void check_waves_of_overlap(const Parameters &p, Findings &findings)
{
  const BridgingParameters &b = p.bridging;
  const bool sub_cycles = b.sub_cycles > 1;
  if (p.run.driver != "dynamic" && (b.damping > 0. || sub_cycles))
    findings.push_back(
        {{sub_cycles ? "Bridging domain/Sub-cycles" : "Bridging domain/Overlap damping",
          "Run/Driver"},
         "the " + p.run.driver +
             " driver knows no waves, and makes grains and mesh equally slow. Give " +
             (sub_cycles ? "1" : "0") + ", or 'Run/Driver' = 'dynamic'."});
  if ((b.damping > 0. || sub_cycles) && !b.constraint)
    findings.push_back({{"Bridging domain/Constraint"},
                        "what is not joined has nothing to damp or to sub-cycle. Give "
                        "true, or neither of these."});
  if (sub_cycles && b.damping == 0.)
    findings.push_back({{"Bridging domain/Overlap damping", "Bridging domain/Sub-cycles"},
                        "without it the mesh's impulses may meet a resonance. Give 0.05, "
                        "or 'Bridging domain/Sub-cycles' = 1."});
  if (sub_cycles && p.has("damping"))
    findings.push_back({{"Components", "Bridging domain/Sub-cycles"},
                        "damping opposes forces of the moment, and those of a sub-cycled "
                        "mesh come as impulses. Remove damping, or give "
                        "'Bridging domain/Sub-cycles' = 1."});
}

/// A cover of grains has enough of them, and no mesh above.
void check_grain_cover(const Parameters &p, Findings &findings)
{
  const double cover = p.matrix.burial_depth_ratio * p.layer.thickness,
               least = thinnest_grain_cover * p.grain_diameter();
  if (!holds(cover, least) && cover > 0.)
    findings.push_back({{"Matrix/Join", "Matrix/Burial depth ratio",
                         "Layer/Grains across"},
                        "a cover of " + in_metres(cover) + " is thinner than " +
                            short_text(thinnest_grain_cover) + " grains of " +
                            in_metres(p.grain_diameter()) +
                            ": that is no rock. Give 'surface interface' or "
                            "'automatic', or more grains across the layer."});
  for (const bool stands : {p.has_foundation_under("top"), p.is_absorbing("top")})
    if (stands)
      findings.push_back({{"Matrix/Join", "Foundation/Faces",
                           "Absorbing boundary/Faces"},
                          "a foundation or an absorbing boundary on the top is one of "
                          "the mesh, and the cover is grains. Give base to its faces, or "
                          "'bridging domain' or 'surface interface' here."});
}

void check_bridging(const Parameters &p, Findings &findings)
{
  if (p.matrix.cell_size < 1.5 && p.bridging.multipliers == "mesh")
    findings.push_back(
        {{"Matrix/Cell size ratio"},
         "multiplier space too rich: cells below 1.5 grain diameters hold "
         "more nodes than grains, and the constraint becomes singular. Give "
         "2 to 4, or 'Bridging domain/Multipliers' = 'coarsened'."});
  if (p.bridging.multipliers == "coarsened" && p.bridging.overlap < 2.)
    findings.push_back({{"Bridging domain/Overlap width ratio",
                         "Bridging domain/Multipliers"},
                        "narrower than a coarsened cell of two grain diameters. Give at "
                        "least 4."});
  check_waves_of_overlap(p, findings);
  if (p.bridging.overlap < p.matrix.cell_size)
    findings.push_back({{"Bridging domain/Overlap width ratio", "Matrix/Cell size ratio"},
                        "narrower than one cell ('Matrix/Cell size ratio' = " +
                            short_text(p.matrix.cell_size) +
                            "). Give at least 2 cells and 4 grain diameters."});
  if (p.has_grain_cover())
    check_grain_cover(p, findings);
  else
    check_overlap_fits(p, "cover", "Matrix/Burial depth ratio",
                       p.matrix.burial_depth_ratio, findings);
  check_overlap_fits(p, "base", "Matrix/Base depth ratio", p.matrix.base_depth_ratio,
                     findings);
}

/// What a layer of grains on the edges of a mesh leaves out.
void check_surface_interface(const Parameters &p, Findings &findings)
{
  const std::string otherwise = "'Matrix/Join' = 'bridging domain'";
  if (p.matrix.mesh_modulus_ratio != 1.)
    findings.push_back({{"Matrix/Mesh modulus ratio", "Matrix/Join"},
                        "there are no matrix grains that the mesh could differ from. "
                        "Give 1, or " +
                            otherwise + "."});
  if (p.run.strain == "finite")
    findings.push_back({{"Run/Strain", "Matrix/Join"},
                        "a surface interface joins a mesh of small strain. Give small, "
                        "or " + otherwise + "."});
  if (p.follows_events())
    findings.push_back({{"Walls/Loading", "Matrix/Join"},
                        "the event driver does not know a surface interface. Give "
                        "'constant rate', " +
                            otherwise +
                            " where it fits, or 'Matrix/Representation' = 'grains'."});
  // The corners of the layer are looked for between its ends and the mesh.
  const double slope =
      M_PI * p.layer.amplitude_ratio * p.layer.thickness / p.layer_length();
  if (p.layer.shape == "cosine" && slope > 0.95)
    findings.push_back(
        {{"Layer/Amplitude ratio", "Matrix/Join"},
         "the limbs would dip by " + short_text(180. / M_PI * std::atan(slope)) +
             " degrees, and from 44 on the layer's upper grains cannot be told from "
             "those of its ends. Give at most " +
             short_text(std::floor(95. * p.layer.amplitude_ratio / slope) / 100.) +
             ", or " + otherwise + "."});
}
} // namespace

void check_join(const Parameters &p, Findings &findings)
{
  if (p.is_bridged())
    check_bridging(p, findings);
  else
    check_surface_interface(p, findings);
}
} // namespace antiform::cases

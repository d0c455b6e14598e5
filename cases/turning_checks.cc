// What walls that turn ask of a scene, and what asks for them.
#include "cases/declarations.h"

#include <string>
#include <vector>

namespace antiform::cases
{
namespace
{
/// Entries of turning walls that have no effect where walls do not turn.
void check_walls_that_stand(const Parameters &p, std::vector<Finding> &findings)
{
  const auto find = [&](const std::string &entry)
  {
    findings.push_back({{entry, "Walls/Action"},
                        "has no effect where walls do not turn. Give 0, or "
                        "'Walls/Action' = 'turn'."});
  };
  if (p.walls.end_rotation > 0.)
    find("Walls/End rotation");
  if (p.walls.shortening_before > 0.)
    find("Walls/Shortening before turning");
}

/// What is bent: a layer of grains alone, with nothing that presses or confines it.
void check_bent_layer(const Parameters &p, std::vector<Finding> &findings)
{
  for (const std::string name : {"matrix", "foundation", "gravity", "surface pressure",
                                 "servo walls", "membrane", "calibration"})
    if (p.has(name))
      findings.push_back({{"Walls/Action", "Components"},
                          "walls that turn bend a layer with nothing around it. Remove " +
                              name + " from 'Components', or give 'press'."});
  if (p.has("layer") && p.layer.representation != "grains")
    findings.push_back({{"Walls/Action", "Layer/Representation"},
                        "walls that turn push grains and leave them, which finite "
                        "elements do not know. Give 'Layer/Representation' = 'grains', or "
                        "'press'."});
  if (p.layer.locked_in_stress > 0.)
    findings.push_back({{"Walls/Action", "Layer/Locked-in stress"},
                        "a locked-in stress presses on walls that hold it, and these "
                        "leave the layer. Give 0, or 'press'."});
}

/// How the walls turn and when the run ends.
void check_turn(const Parameters &p, std::vector<Finding> &findings)
{
  if (p.walls.end_rotation == 0.)
    findings.push_back({{"Walls/End rotation", "Walls/Action"},
                        "the walls would turn for ever. Give the rotation of each wall "
                        "at which the run ends, > 0 and <= 30 degrees."});
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &rock = p.bed(k);
    const double modulus =
        rock.young_modulus / (1. - rock.poisson_ratio * rock.poisson_ratio);
    const double crushing = rock.compressive_strength / modulus;
    if (!rock.joint.breakable || p.walls.shortening_before <= crushing)
      continue;
    findings.push_back(
        {{"Walls/Shortening before turning", "Layer/UCS", "Layer/Young modulus"},
         "would press the layer with " +
             short_text(1e-6 * p.walls.shortening_before * modulus) +
             " MPa and crush it before it turns. Give at most UCS/E' = " +
             short_text(crushing) + "."});
    break;
  }
  if (p.run.end_shortening > 0.)
    findings.push_back({{"Run/End shortening", "Walls/Action"},
                        "walls that turn do not shorten. Give 0, and 'Walls/End "
                        "rotation' for the end of the run; 'Walls/Shortening before "
                        "turning' is what they press before."});
  if (p.walls.loading != "constant rate")
    findings.push_back({{"Walls/Loading", "Walls/Action"},
                        "walls turn at a constant rate only. Give 'constant rate'."});
  if (p.run.estimate_rate_error)
    findings.push_back({{"Run/Estimate loading-rate error", "Walls/Action"},
                        "the estimate is of the peak stress of a shortened section. Give "
                        "false, and compare with a run of twice the 'Walls/Transits per "
                        "millistrain'."});
}
} // namespace

void check_turning_walls(const Parameters &p, std::vector<Finding> &findings)
{
  if (!p.has("walls"))
    return;
  if (!p.walls.turns())
    return check_walls_that_stand(p, findings);
  check_bent_layer(p, findings);
  check_turn(p, findings);
}
} // namespace antiform::cases

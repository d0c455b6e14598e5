// What a packing cannot give, and where measurement circles cannot be.
#include "cases/circle_record.h"
#include "cases/declarations.h"
#include "cases/layer_packing.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
void check_packing(const Parameters &p, std::vector<Finding> &findings)
{
  const LayerParameters &layer = p.layer;
  const SectionGeometry g(p);
  double rim = 0.;
  const std::vector<Vec2> outline = g.layer_outline();
  for (std::size_t k = 0; k < outline.size(); ++k)
    rim += norm(outline[(k + 1) % outline.size()] - outline[k]);
  const discrete::PorosityRange range = discrete::porosity_range(
      discrete::area(outline), rim, packing_parameters(p, layer.seed));
  constexpr double unsure = 0.02; // of the estimates; the packing itself decides
  if (layer.porosity > 0. &&
      !(layer.porosity > range.least - unsure && layer.porosity < range.most + unsure))
    findings.push_back(
        {{"Layer/Porosity", "Layer/Installation gap ratio"},
         "out of reach: these grains jam at about " + short_text(range.least) +
             ", and beyond " + short_text(range.most) +
             " neighbours would be too far apart for a bond. Give a porosity between, 0 "
             "for the densest, or a larger installation gap for a looser packing."});
  // A disk of a connected packing has two to six neighbours.
  const double z = layer.coordination_number;
  if (z > 0. && !(z >= 3. && z <= 6.5))
    findings.push_back({{"Layer/Coordination number"},
                        "out of reach of a packing of disks, which has about 4 to 6 "
                        "neighbours within the gaps that can be bonded. Give such a "
                        "number, or 0."});
  if (layer.locked_in_stress == 0.)
    return;
  const std::string entry = "Layer/Locked-in stress";
  if (!p.is_specimen() || p.confinement() != nullptr || p.walls.action == "pull")
    findings.push_back(
        {{entry, "Components"},
         "a locked-in stress is for a straight layer of grains between platens, without "
         "matrix, confinement and grips. Give 0."});
  if (layer.porosity > 0.)
    findings.push_back({{entry, "Layer/Porosity"},
                        "grains that are apart press on nothing. Give 0 for one of the "
                        "two."});
  if (p.layer.bond_model != "flat joint" || p.has_smooth_joints())
    findings.push_back({{entry, "Layer/Bond model", "Components"},
                        "only flat joints keep a locked-in stress, and no fracture does. "
                        "Give 0."});
  if (p.has_unbonded_joints())
    findings.push_back(
        {{entry, "Layer/Joint types/Slit fraction", "Layer/Joint types/Gapped fraction"},
         "the layer must be bonded throughout. Give 0."});
  if (layer.locked_in_stress > 0.02 * layer.joint.effective_modulus)
    findings.push_back(
        {{entry},
         "more than 2 % of the bonds' modulus, beyond the small strains of "
         "joints. Give less, in Pa."});
}

void check_circles(const Parameters &p, std::vector<Finding> &findings)
{
  if (p.layer.representation != "grains")
  {
    findings.push_back({{"Components", "Layer/Representation"},
                        "measurement circles average over grains, and the layer is "
                        "continuum. Remove measurement circles, or give 'grains'."});
    return;
  }
  const SectionGeometry g(p);
  std::vector<Vec2> centres;
  const MeasurementCirclesParameters &wanted = p.measurement_circles;
  if (!parse_points(wanted.centres, centres))
    findings.push_back({{"Measurement circles/Centres"},
                        "not a list of points. Give x and y of each in metres, with ; "
                        "between the points: '0 0; 1.5 -0.5'."});
  const std::string names = "Measurement circles/";
  for (const Vec2 &c : centres)
    if (!(c.x >= g.x_min() && c.x <= g.x_max() && c.y >= g.layer_bottom(c.x) &&
          c.y <= g.layer_top(c.x)))
      findings.push_back(
          {{names + "Centres"},
           "the point " + short_text(c.x) + " " + short_text(c.y) +
               " is not in the layer. Its axis is at y = " + short_text(g.axis(c.x)) +
               " m there, and x goes from " + short_text(g.x_min()) + " to " +
               short_text(g.x_max()) + " m."});
  const double width = std::min(g.thickness(), g.length());
  if (centres.empty() && 2. * wanted.radius * g.diameter() > width * (1. + 1e-12))
    findings.push_back(
        {{names + "Radius ratio", "Layer/Grains across"},
         "the circles would be wider than the layer. Give at most " +
             short_text(std::floor(0.5 * width / g.diameter() * 100.) / 100.) +
             ", or more grains across."});
}
} // namespace antiform::cases

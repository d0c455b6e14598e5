#include "cases/fracture_record.h"

#include "cases/fracture_list.h"
#include "coupling/output/vtu.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace antiform::cases
{
using discrete::SmoothContact;

void report_fractures(const Scene &scene, Summary &summary)
{
  if (!scene.grains || !scene.grains->smooth)
    return;
  const discrete::SmoothJoints &smooth = *scene.grains->smooth;
  const std::size_t n_fractures =
      smooth.fractures.size() - scene.grains->n_bedding_traces;
  double farthest = 0., widest = 0., joints = 0.;
  for (const SmoothContact &c : smooth.contacts)
  {
    farthest = std::max(farthest, std::abs(c.slip));
    widest = std::max(widest, c.gap);
    joints += 1.;
  }
  auto &results = summary.results;
  if (scene.parameters.has("fractures"))
  {
    results["fractures"] = {static_cast<double>(n_fractures), "-"};
    const std::vector<discrete::Fracture> of_deck(
        smooth.fractures.begin(),
        smooth.fractures.begin() + static_cast<std::ptrdiff_t>(n_fractures));
    results["fracture_intensity"] = {traces_in_layer(of_deck, scene.geometry).intensity,
                                     "1/m"};
  }
  results["smooth_joints"] = {joints, "-"};
  results["largest_fracture_slip"] = {farthest, "m"};
  results["largest_fracture_opening"] = {widest, "m"};
}

void write_fractures(const std::string &path, const Scene &scene)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<long, 2>> lines;
  using coupling::Field;
  Field slip{"slip_m", 1, {}}, opening{"opening_m", 1, {}}, bonded{"bonded", 1, {}};
  Field normal{"normal_stress_Pa", 1, {}}, shear{"shear_stress_Pa", 1, {}};
  Field number{"fracture", 1, {}};
  for (const SmoothContact &c : scene.grains->smooth->contacts)
  {
    const double turn = 0.5 * (grains.rotation[c.first] + grains.rotation[c.second]);
    const Vec2 tangent = perpendicular(rotated({c.normal_x, c.normal_y}, turn));
    const Vec2 one = grains.reference(c.first);
    const Vec2 place = discrete::crossing(scene.grains->smooth->fractures[c.fracture],
                                          one, grains.reference(c.second));
    const Vec2 centre =
        grains.position(c.first) + rotated(place - one, grains.rotation[c.first]);
    for (const double side : {-0.5, 0.5})
    {
      const Vec2 end = centre + (side * c.area) * tangent;
      points.push_back({end.x, end.y, 0.});
    }
    const long last = static_cast<long>(points.size());
    lines.push_back({last - 2, last - 1});
    slip.values.push_back(c.slip);
    opening.values.push_back(c.gap);
    bonded.values.push_back(c.bonded ? 1. : 0.);
    normal.values.push_back(c.normal_stress);
    shear.values.push_back(c.shear_stress);
    number.values.push_back(c.fracture);
  }
  coupling::write_lines_vtu(path, points, lines,
                            {slip, opening, bonded, normal, shear, number});
}
} // namespace antiform::cases

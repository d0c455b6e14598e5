#include "cases/scene_in_words.h"

#include "cases/declarations.h"
#include "cases/formatted.h"
#include "cases/fracture_list.h"
#include "cases/join_choice.h"

#include <cmath>
#include <ostream>

namespace antiform::cases
{
namespace
{
/// Lines with what they are about before them; further ones of the same below.
class SceneLines
{
public:
  explicit SceneLines(std::ostream &out)
      : out_(out)
  {
  }
  void add(const std::string &what, const std::string &text)
  {
    out_ << formatted("  %-9s %s\n", what.c_str(), text.c_str());
  }
  void more(const std::string &text) { add("", text); }

private:
  std::ostream &out_;
};

void add_layer(const Parameters &p, const SectionGeometry &g, SceneLines &lines)
{
  lines.add("layer",
            formatted("%s, h = %.3g m, L/h = %.2f, amplitude %.2f h, as %s",
                      p.layer.shape.c_str(), g.thickness(),
                      g.wavelength() / g.thickness(), g.amplitude() / g.thickness(),
                      p.layer.representation.c_str()));
  if (p.layer.representation == "grains")
    lines.more(formatted("%.3g grains across, mean diameter %.3g m",
                         p.layer.grains_across, g.diameter()));
  for (int bed = 0; p.has("beds") && bed < p.n_beds(); ++bed)
  {
    const std::string &rock = p.beds.rocks[static_cast<std::size_t>(bed)];
    lines.add("bed " + std::to_string(bed + 1),
              formatted("%.3g m thick, %s: %.40s", p.bed_share(bed) * g.thickness(),
                        p.beds.interface.c_str(),
                        rock.substr(rock.rfind('/') + 1).c_str()));
  }
}

void add_matrix(const Parameters &p, const SectionGeometry &g, SceneLines &lines)
{
  lines.add("matrix",
            formatted("E/E0 = %.3g (E0 = %.3g MPa), H/h = %.3g above, %.3g h below, %s, "
                      "as %s",
                      p.matrix.stiffness_contrast, 1e-6 * p.matrix_modulus(),
                      p.matrix.burial_depth_ratio, p.matrix.base_depth_ratio,
                      p.matrix.interface.c_str(), p.matrix.representation.c_str()));
  if (p.is_bridged())
    lines.add("overlap",
              formatted("%.3g d wide (%.3g m), %.3g d of matrix grains before it",
                        p.bridging.overlap, p.bridging.overlap * g.diameter(),
                        p.bridging.buffer));
  if (p.has_grain_cover())
    lines.add("cover", "matrix grains up to its surface, mesh below the layer only");
  if (p.has_surface_interface())
    lines.add("join",
              formatted("the mesh ends at the layer's outer grains, cells of %.3g m",
                        p.matrix.cell_size * g.diameter()));
  if (!p.matrix.why_join.empty())
    lines.add("chosen", join_in_words(p));
}

/// "60 degrees", or of several sets "60, -60 degrees".
std::string list_in_words(const std::vector<double> &numbers, const std::string &unit)
{
  std::string text;
  for (const double number : numbers)
    text += (text.empty() ? "" : ", ") + short_text(number);
  return text + unit;
}

void add_fractures(const Parameters &p, const SectionGeometry &g, SceneLines &lines)
{
  const FracturesParameters &f = p.fractures;
  const FractureTraces traces = traces_in_layer(make_fractures(p, g), g);
  lines.add("fractures",
            formatted("%zu in the layer, %.4g m of traces: P21 = %.3g /m; %s, friction "
                      "angle %.3g degrees",
                      traces.number, traces.length, traces.intensity,
                      f.law.bonded ? "bonded" : "not bonded",
                      degrees_of_tangent(f.law.friction)));
  const std::string where = ", at " + list_in_words(f.orientation, " degrees from x");
  if (!f.spacing_ratio.empty())
  {
    std::vector<double> spacings;
    for (const double ratio : f.spacing_ratio)
      spacings.push_back(ratio * g.thickness());
    lines.more("parallel, every " + list_in_words(f.spacing_ratio, " h (") +
               list_in_words(spacings, " m)") + where);
  }
  if (!f.intensity.empty())
    lines.more("drawn with seed " + std::to_string(f.seed) + " in the " + f.region +
               ", P21 = " + list_in_words(f.intensity, " /m") + where);
}

std::string foundation_in_words(const Parameters &p)
{
  std::string text = formatted("k_w = %.3g Pa/m", p.foundation_stiffness());
  if (p.foundation.shear_ratio > 0.)
    text += formatted(", G_p = %.3g Pa m", p.foundation_shear());
  return text + " on " + p.foundation.faces +
         (p.foundation.lifts_off ? ", pushes only" : "");
}

std::string walls_in_words(const Parameters &p)
{
  if (p.bends())
    return formatted(
        "turn to %.3g degrees each, which puts a strain of %.3g on the faces "
        "of a straight layer",
        p.walls.end_rotation, p.end_bending());
  std::string text =
      p.walls.pulls() ? "pull the ends apart by grips" : "shorten the section";
  if (p.run.driver == "quasi-static" || p.run.driver == "dynamic")
    text += ", " + p.walls.loading;
  return text;
}

void add_loads(const Parameters &p, SceneLines &lines)
{
  const auto pressure = [&](const ConfinementParameters &confinement)
  { return formatted("%.4g MPa ", 1e-6 * confinement.pressure); };
  if (p.has("foundation"))
    lines.add("springs", foundation_in_words(p));
  if (p.has("absorbing boundary"))
    lines.add("absorbing", p.absorbing_boundary.faces);
  if (p.has("gravity"))
    lines.add("gravity", formatted("%.4g m/s^2", p.gravity.acceleration));
  if (p.has("surface pressure"))
    lines.add("pressure", formatted("%.4g MPa on top", 1e-6 * p.pressure_on_top()));
  if (p.has("servo walls"))
    lines.add("servo", pressure(p.servo_walls) + "by walls on the sides of the specimen");
  if (p.has("membrane"))
    lines.add("membrane", pressure(p.membrane) + "on the faces of the layer");
  if (p.has("walls"))
    lines.add("walls", walls_in_words(p));
}
} // namespace

void print_scene(const Parameters &p, const SectionGeometry &g, std::ostream &out)
{
  SceneLines lines(out);
  lines.add("section", formatted("%.4g m long, from y = %.4g to %.4g m", g.length(),
                                 g.base(), g.surface()));
  add_layer(p, g, lines);
  if (p.has("fractures"))
    add_fractures(p, g, lines);
  if (p.has("matrix"))
    add_matrix(p, g, lines);
  add_loads(p, lines);
}
} // namespace antiform::cases

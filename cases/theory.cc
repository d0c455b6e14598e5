#include "cases/theory.h"

#include "cases/closed_forms.h"
#include "cases/declarations.h"
#include "cases/mechanism.h"
#include "cases/strength_diagram.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <ostream>

namespace antiform::cases
{
namespace theory = continuum::theory;

namespace
{
using Json = nlohmann::ordered_json;

Json to_json(const TheoryRow &row)
{
  if (!row.applies)
    return {{"applies", false}, {"reason", row.words}};
  if (row.quantities.empty())
    return row.words;
  Json json;
  for (const Quantity &q : row.quantities)
  {
    const Json figure = {{"value", q.value}, {"unit", q.unit}};
    if (q.name.empty())
      return figure;
    json[q.name] = figure;
  }
  return json;
}

/// With the prefix that leaves one to three digits before the point.
std::string si_text(const double value, const std::string &unit)
{
  char text[64];
  double scaled = value;
  std::string prefix;
  if (unit == "Pa" || unit == "Pa/m")
    for (const char *next : {"k", "M", "G"})
      if (std::abs(scaled) >= 999.95)
      {
        scaled *= 1e-3;
        prefix = next;
      }
  std::snprintf(text, sizeof text, "%.4g", scaled);
  return unit == "-" ? text : text + (" " + prefix) + unit;
}

std::string text_of(const TheoryRow &row)
{
  if (!row.applies)
    return "does not apply: " + row.words;
  if (row.quantities.empty())
    return row.words;
  std::string text;
  for (const Quantity &q : row.quantities)
    text += (text.empty() ? "" : ", ") + (q.symbol.empty() ? "" : q.symbol + " ") +
            si_text(q.value, q.unit);
  return text;
}

void print(const Parameters &p,
           const std::vector<TheorySection> &sections,
           std::ostream &out)
{
  const SectionGeometry g(p);
  out << p.title << "\nClosed forms, docs/theory/continuum.md; compression positive\n\n"
      << "Scene\n  layer: h = " << short_text(g.thickness())
      << " m, L/h = " << short_text(g.wavelength() / g.thickness())
      << ", a0 = " << short_text(g.amplitude() / g.thickness()) << " h";
  if (!p.has("beds"))
    out << ", E = " << si_text(p.layer.young_modulus, "Pa")
        << ", nu = " << short_text(p.layer.poisson_ratio);
  if (p.has("matrix"))
    out << "\n  matrix: E0 = " << si_text(p.matrix_modulus(), "Pa")
        << ", nu0 = " << short_text(p.matrix.poisson_ratio)
        << ", cover H = " << short_text(p.matrix.burial_depth_ratio)
        << (p.has_foundation_under("top") ? " h under springs" : " h with a free top")
        << ", below " << short_text(p.matrix.base_depth_ratio) << " h on a "
        << (p.has_foundation_under("base") ? "foundation of springs"
                                           : p.matrix.base + " base");
  out << '\n';
  for (const TheorySection &section : sections)
  {
    out << '\n' << section.title << '\n';
    std::size_t column = 0;
    for (const TheoryRow &row : section.rows)
      column = std::max(column, row.label.size());
    for (const TheoryRow &row : section.rows)
      out << "  " << row.label << std::string(column + 2 - row.label.size(), ' ')
          << text_of(row) << '\n';
  }
}

std::string mark_text(const std::string &what, const double ratio, const double gamma)
{
  char text[160];
  std::snprintf(text, sizeof text, "%s: \u039b = %.3g, \u03b3 = %.3g", what.c_str(),
                ratio, gamma);
  return text;
}

StrengthDiagram diagram_of(const Parameters &p, const double friction_angle)
{
  const SectionGeometry g(p);
  StrengthDiagram d;
  d.title = p.title;
  d.failure_ratio = confinement_of(p, friction_angle).failure_ratio;
  const auto mark = [&](const std::string &what, const double ratio, const double gamma,
                        const bool filled)
  {
    const double reached = std::min(gamma, d.failure_ratio);
    d.marks.push_back({mark_text(what, ratio, reached), ratio, reached, filled});
  };
  const std::string length = "L/h = " + short_text(g.wavelength() / g.thickness()),
                    bent = "a\u2080/h = " + short_text(g.amplitude() / g.thickness());
  if (p.has("beds"))
  {
    for (int k = 0; k < p.n_beds(); ++k)
    {
      const LayerParameters &rock = p.bed(k);
      const double ratio =
          theory::slenderness_ratio(rock.young_modulus, rock.compressive_strength,
                                    g.wavelength(), p.bed_share(k) * g.thickness());
      mark("bed " + std::to_string(k + 1) + " alone", ratio,
           theory::stress_ratio_at_buckling(ratio), true);
    }
    d.subtitle =
        std::to_string(p.n_beds()) + " beds, " + length + " of the stack, " + bent;
    return d;
  }
  const Mechanism e = expect_mechanism(p, g);
  d.subtitle = "E = " + si_text(p.layer.young_modulus, "Pa") +
               ", UCS = " + si_text(p.layer.compressive_strength, "Pa") + ", " + length +
               ", " + bent;
  if (p.has("matrix"))
    d.subtitle += ", E/E\u2080 = " + short_text(p.matrix.stiffness_contrast) +
                  ", H/h = " + short_text(p.matrix.burial_depth_ratio);
  d.strength = p.layer.compressive_strength;
  d.length_ratio = e.critical_length_ratio;
  d.imperfection = 6. * g.amplitude() / g.thickness();
  d.imperfection_label = "crushing of a layer bent by " + bent + " (Perry-Robertson)";
  mark(p.has("matrix") ? "this scene without its matrix" : "this scene",
       e.slenderness_ratio, theory::stress_ratio_at_buckling(e.slenderness_ratio), true);
  if (p.has("matrix"))
    mark("with its matrix (E\u2032)", e.slenderness_ratio, e.pinned, false);
  return d;
}

void write(const std::string &file, const std::string &picture)
{
  std::ofstream out(file);
  out << picture << std::flush;
  if (!out)
    throw InputError({"--plot: '" + file +
                      "' cannot be written. Give a file in a folder that exists."});
}
} // namespace

int print_theory(const Parameters &p, const TheoryOptions &options, std::ostream &out)
{
  const std::vector<TheorySection> sections = closed_forms(p, options.friction_angle);
  if (!options.plot.empty())
    write(options.plot, draw(diagram_of(p, options.friction_angle)));
  if (!options.json)
  {
    print(p, sections, out);
    if (!options.plot.empty())
      out << "\nDiagram: " << options.plot << '\n';
    return 0;
  }
  Json json;
  json["title"] = p.title;
  for (const TheorySection &section : sections)
    for (const TheoryRow &row : section.rows)
      json[section.name][row.name] = to_json(row);
  out << json.dump(2) << '\n';
  return 0;
}
} // namespace antiform::cases

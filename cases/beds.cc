#include "cases/beds.h"

#include "cases/deck_reader.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
BedPlanes::BedPlanes(const Parameters &p, const SectionGeometry &geometry)
    : x_min_(geometry.x_min())
    , thickness_(geometry.thickness())
{
  // As long as they follow the fold to a fiftieth of a grain: at its ends a chord is not
  // covered by pairs of its own.
  const double q = 2. * M_PI / geometry.wavelength(), d = geometry.diameter();
  const double curvature = 0.5 * geometry.amplitude() * q * q;
  const double chord = curvature > 0.
                           ? std::max(4. * d, std::sqrt(8. * 0.02 * d / curvature))
                           : geometry.length();
  const auto n = static_cast<std::size_t>(std::ceil(geometry.length() / chord));
  chord_ = geometry.length() / static_cast<double>(n);
  for (std::size_t k = 0; k <= n; ++k)
    bottom_.push_back(geometry.layer_bottom(x_min_ + static_cast<double>(k) * chord_));
  double below = 0.;
  for (int k = 0; k + 1 < p.n_beds(); ++k)
    shares_.push_back(below += p.bed_share(k));
}

double BedPlanes::bottom(const double x) const
{
  const double place = (x - x_min_) / chord_;
  const auto last = static_cast<double>(bottom_.size() - 2);
  const double k = std::clamp(std::floor(place), 0., last);
  const auto i = static_cast<std::size_t>(k);
  return bottom_[i] + (place - k) * (bottom_[i + 1] - bottom_[i]);
}

int BedPlanes::bed_at(const Vec2 &place) const
{
  const double share = (place.y - bottom(place.x)) / thickness_;
  return static_cast<int>(std::count_if(shares_.begin(), shares_.end(),
                                        [share](const double below)
                                        { return share > below; }));
}

std::vector<discrete::Fracture> BedPlanes::traces(const discrete::SmoothJoint &law) const
{
  std::vector<discrete::Fracture> traces;
  for (const double share : shares_)
    for (std::size_t k = 0; k + 1 < bottom_.size(); ++k)
    {
      const double x = x_min_ + static_cast<double>(k) * chord_, y = share * thickness_;
      traces.push_back({{x, bottom_[k] + y}, {x + chord_, bottom_[k + 1] + y}, law});
    }
  // Grains at the walls may stand a little beyond the section.
  for (std::size_t s = 0; s < shares_.size(); ++s)
  {
    const std::size_t n = bottom_.size() - 1;
    discrete::Fracture &first = traces[s * n], &last = traces[s * n + n - 1];
    first.begin = first.begin - (first.end - first.begin);
    last.end = last.end + (last.end - last.begin);
  }
  return traces;
}

discrete::FlatJoint joint_between(const LayerParameters &one,
                                  const LayerParameters &other)
{
  const discrete::FlatJoint &a = one.joint, &b = other.joint;
  discrete::FlatJoint law = a;
  law.stiffness_ratio = 0.5 * (a.stiffness_ratio + b.stiffness_ratio);
  law.tensile_strength = std::min(a.tensile_strength, b.tensile_strength);
  law.cohesion = std::min(a.cohesion, b.cohesion);
  law.tan_friction = std::min(a.tan_friction, b.tan_friction);
  law.residual_friction = std::min(a.residual_friction, b.residual_friction);
  law.residual_cohesion = std::min(a.residual_cohesion, b.residual_cohesion);
  law.radius_multiplier = std::min(a.radius_multiplier, b.radius_multiplier);
  law.breakable = a.breakable && b.breakable;
  return law;
}

namespace
{
bool is_of_whole_layer(const std::string &path)
{
  for (const char *name :
       {"Representation", "Thickness", "Shape", "Slenderness ratio", "Length ratio",
        "Amplitude ratio", "Straight end ratio", "Grains across", "Porosity",
        "Coordination number", "Locked-in stress", "Seed", "Bond model"})
    if (path == std::string("Layer/") + name)
      return true;
  return false;
}

/// Is @p path that of something within the section @p outer?
bool is_within(const std::string &path, const std::string &outer)
{
  return path.compare(0, outer.size() + 1, outer + "/") == 0;
}

/// Sections of the text that a rock does not have; said once, not again for what is in
/// them.
std::vector<std::string> refuse_unknown_sections(const DeckText &text,
                                                 const Declarations &declarations,
                                                 std::vector<std::string> &problems)
{
  std::vector<std::string> unknown;
  const auto is_inside_unknown = [&](const std::string &path)
  {
    return std::any_of(unknown.begin(), unknown.end(),
                       [&](const std::string &section)
                       { return is_within(path, section); });
  };
  for (const DeckLine &line : text.sections)
    if (!is_inside_unknown(line.path) &&
        std::none_of(declarations.entries().begin(), declarations.entries().end(),
                     [&](const Declarations::Entry &entry)
                     { return is_within(entry.path, line.path); }))
    {
      problems.push_back(
          line.place + ": there is no subsection '" + line.path +
          "' of a rock: a rock file has entries of 'Layer'. Leave it out.");
      unknown.push_back(line.path);
    }
  return unknown;
}
} // namespace

LayerParameters read_rock(const std::string &file,
                          const LayerParameters &like,
                          std::vector<std::string> &problems)
{
  LayerParameters rock = like;
  if (file.empty())
  {
    problems.push_back(
        "'Beds/Rocks' has an empty name in its list. Give a file (.prm) for "
        "each bed.");
    return rock;
  }
  std::vector<std::string> unreadable;
  const DeckText text = scan_deck(file, unreadable);
  for (const std::string &problem : unreadable)
    problems.push_back("'Beds/Rocks': " + problem);
  dealii::ParameterHandler prm;
  Declarations declarations(prm);
  declare(rock, declarations);
  const std::vector<std::string> unknown =
      refuse_unknown_sections(text, declarations, problems);
  if (text.entries.empty() && unreadable.empty())
    problems.push_back("'Beds/Rocks': " + file +
                       " sets no entry, and the bed would be of the layer's rock. Give a "
                       "file with the moduli and strengths of a rock.");
  for (const DeckLine &line : text.entries)
  {
    const Declarations::Entry *const entry = declarations.find(line.path);
    if (std::any_of(unknown.begin(), unknown.end(),
                    [&](const std::string &s) { return is_within(line.path, s); }))
      continue;
    if (entry == nullptr)
      problems.push_back(
          line.place + ": there is no entry '" + line.path +
          "' of a rock: a rock file has entries of 'Layer'. Leave it out.");
    else if (is_of_whole_layer(line.path))
      problems.push_back(
          line.place + ": '" + line.path +
          "' is of the whole layer, not of the rock of a bed. Set it in the "
          "deck.");
    else if (!entry->pattern->match(line.value))
      problems.push_back(line.place + ": '" + line.path + "' = '" + line.value +
                         "' is out of range. Give " + range_in_words(*entry) + " " +
                         unit_of(*entry) + ".");
    else
      declarations.set(line.path, line.value);
  }
  return rock;
}

std::string rock_text(const LayerParameters &rock)
{
  LayerParameters copy = rock;
  dealii::ParameterHandler prm;
  Declarations declarations(prm);
  declare(copy, declarations);
  std::string text, section;
  const auto leave = [&]
  {
    text += section.empty() ? "" : "  end\n";
    section.clear();
  };
  for (const Declarations::Entry &entry : declarations.entries())
  {
    if (is_of_whole_layer(entry.path))
      continue;
    const std::string path = entry.path.substr(entry.path.find('/') + 1);
    const std::size_t slash = path.find('/');
    const std::string inner = slash == std::string::npos ? "" : path.substr(0, slash);
    if (inner != section)
    {
      leave();
      section = inner;
      text += section.empty() ? "" : "  subsection " + section + "\n";
    }
    text += std::string(inner.empty() ? "  " : "    ") + "set " +
            path.substr(inner.empty() ? 0 : slash + 1) + " = " + entry.default_value +
            "\n";
  }
  leave();
  return "subsection Layer\n" + text + "end\n";
}

void check_beds(const Parameters &p, std::vector<Finding> &findings)
{
  const BedsParameters &beds = p.beds;
  if (beds.rocks.size() != beds.thickness_ratios.size() || beds.rocks.size() < 2)
    findings.push_back(
        {{"Beds/Rocks", "Beds/Thickness ratios"},
         "a stack has two beds or more, each with a thickness and a rock; there are " +
             std::to_string(beds.thickness_ratios.size()) + " thicknesses and " +
             std::to_string(beds.rocks.size()) + " rocks. Give as many of both."});
  if (p.layer.representation != "grains")
    findings.push_back({{"Components", "Layer/Representation"},
                        "beds are of grains. Give grains, or leave beds out."});
  if (p.has("gravity") || p.has("surface pressure"))
    findings.push_back(
        {{"Components"},
         "a stack of beds cannot be prestressed in this version. Leave out "
         "gravity and surface pressure, or beds."});
  if (p.has("calibration"))
    findings.push_back({{"Components"}, "a calibration finds one rock. Leave out beds."});
  for (const LayerParameters &bed : beds.layers)
    if (bed.bond_model != "flat joint")
    {
      findings.push_back({{"Beds/Rocks", "Layer/Bond model"},
                          "beds need flat joints in this version. Give flat joint."});
      break;
    }
  for (const LayerParameters &bed : beds.layers)
    if (bed.radius_ratio != p.layer.radius_ratio ||
        bed.installation_gap != p.layer.installation_gap)
    {
      findings.push_back(
          {{"Beds/Rocks", "Layer/Radius ratio", "Layer/Installation gap ratio"},
           "all beds are packed as one, with the layer's radius ratio (" +
               short_text(p.layer.radius_ratio) + ") and installation gap ratio (" +
               short_text(p.layer.installation_gap) +
               "); a rock has others. Give rocks of one packing, and the layer the "
               "same."});
      break;
    }
  if (findings.empty())
    for (int k = 0; k < p.n_beds(); ++k)
      if (p.bed_share(k) * p.layer.grains_across < 2.)
      {
        findings.push_back(
            {{"Beds/Thickness ratios", "Layer/Grains across"},
             "bed " + std::to_string(k + 1) + " from below would be " +
                 short_text(p.bed_share(k) * p.layer.grains_across) +
                 " grains thick. Give at least two: more grains across, or "
                 "a thicker bed."});
      }
}
} // namespace antiform::cases

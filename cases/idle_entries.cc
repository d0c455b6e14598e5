#include "cases/idle_entries.h"

#include "cases/all_parameters.h"
#include "cases/deck_reader.h"

#include <algorithm>
#include <map>
#include <set>

namespace antiform::cases
{
namespace
{
/// The entries as they are found, section by section.
class Collector
{
public:
  void enter(const std::string &section) { section_ = section + "/"; }
  void add(const bool is_idle,
           const std::vector<std::string> &names,
           const std::string &reason)
  {
    if (is_idle)
      for (const std::string &name : names)
        entries_.push_back({section_ + name, reason});
  }
  const std::vector<IdleEntry> &entries() const { return entries_; }

private:
  std::string section_;
  std::vector<IdleEntry> entries_;
};

void find_of_layer(const Parameters &p, Collector &found)
{
  const LayerParameters &l = p.layer;
  found.enter("Layer");
  found.add(l.length_ratio > 0., {"Slenderness ratio"}, "'Layer/Length ratio' decides");
  found.add(l.shape == "straight", {"Amplitude ratio", "Straight end ratio"},
            "the layer is straight");
  found.add(l.representation == "continuum",
            {"Radius ratio", "Installation gap ratio", "Porosity", "Coordination number",
             "Seed", "Breakable", "Bond model", "Flat joint/", "Joint types/",
             "Strength scatter/", "Parallel bond/", "Contact bond/"},
            "the layer is finite elements");
  if (l.representation != "grains")
    return;
  found.add(l.coordination_number > 0., {"Installation gap ratio"},
            "'Layer/Coordination number' decides");
  const auto other = [&](const char *model)
  { return l.bond_model != model && !p.has("matrix") && !p.has("beds"); };
  const std::string bonds = "'Layer/Bond model' is " + l.bond_model;
  found.add(other("flat joint"), {"Flat joint/"}, bonds);
  found.add(other("parallel bond"), {"Parallel bond/"}, bonds);
  found.add(other("contact bond"), {"Contact bond/"}, bonds);
  found.add(l.types.gapped_fraction == 0.,
            {"Joint types/Gap ratio", "Joint types/Gap deviation"},
            "no joints begin with a gap");
}

void find_of_matrix(const Parameters &p, Collector &found)
{
  const MatrixParameters &m = p.matrix;
  const bool buckles = p.run.driver == "buckling";
  found.enter("Matrix");
  found.add(!buckles || m.refinement_rounds == 0, {"Refinement share"},
            "no cells are refined");
  if (!p.has("matrix"))
    return;
  found.add(m.interface != "frictional", {"Interface friction", "Interface cohesion"},
            "the interface is " + m.interface);
  found.add(p.has_foundation_under("base"), {"Base"},
            "the base stands on the foundation");
  found.add(!p.joins_grains_and_mesh(), {"Join", "Mesh modulus ratio"},
            "no grains meet finite elements");
  found.add(!p.has_mesh_contact() || p.run.driver != "static",
            {"Contact stiffness ratio"}, "no finite elements are in contact");
  found.add(m.representation == "grains",
            {"Largest cell ratio", "Element degree", "Cover rows"},
            "the matrix is grains");
  found.add(m.representation != "grains" && !p.is_bridged(),
            {"Tile size ratio", "Breakable", "Tensile strength", "Cohesion",
             "Friction angle", "Residual friction"},
            "there are no matrix grains");
}

void find_of_material(const std::string &section,
                      const MaterialParameters &material,
                      Collector &found)
{
  const std::string law = "the law is " + material.law;
  found.enter(section);
  found.add(!material.yields(), {"Cohesion", "Friction angle", "Dilation angle"}, law);
  found.add(material.law != "Mohr-Coulomb", {"Tensile strength"}, law);
  found.add(material.law != "Drucker-Prager", {"Match"}, law);
  found.add(material.law != "Maxwell", {"Viscosity"}, law);
}

void find_of_loads(const Parameters &p, Collector &found)
{
  found.enter("Beds");
  found.add(p.beds.interface != "frictional", {"Friction"}, "beds are cemented");
  found.enter("Foundation");
  found.add(p.foundation.stiffness > 0., {"Stiffness ratio"},
            "'Foundation/Stiffness' decides");
  found.enter("Surface pressure");
  found.add(!p.has("gravity"), {"Overburden ratio"}, "there is no gravity");
  found.enter("Walls");
  const WallsParameters &w = p.walls;
  found.add(!w.pulls(), {"Grip layers"}, "the walls have no grips");
  found.add(!w.steps_and_relaxes(), {"Relaxation tolerance"},
            "'Walls/Loading' is " + w.loading);
  found.add(!w.follows_events(), {"Balance tolerance"},
            "'Walls/Loading' is " + w.loading);
  found.add(!w.steps_and_relaxes() && !w.follows_events(), {"Load step"},
            "'Walls/Loading' is " + w.loading);
  found.add(!p.run.steps_in_time(), {"Transits per millistrain", "Ramp"},
            "the " + p.run.driver + " driver knows no rates");
  found.enter("Damping");
  found.add(!p.run.steps_in_time(), {"Form", "Coefficient"},
            "the " + p.run.driver + " driver damps nothing");
}

void find_of_fractures(const FracturesParameters &f, Collector &found)
{
  found.enter("Fractures");
  found.add(f.n_sets() == 0, {"Orientation", "Region"}, "there are no sets");
  found.add(f.spacing_ratio.empty(), {"Phase"}, "no set is parallel");
  if (f.intensity.empty())
    found.add(true,
              {"Orientation deviation", "Length law", "Mean length", "Length deviation",
               "Length exponent", "Shortest", "Longest", "Seed"},
              "no network is drawn");
  else
  {
    const std::string law = "'Fractures/Length law' is " + f.length_law;
    found.add(f.length_law == "power law", {"Mean length"}, law);
    found.add(f.length_law != "lognormal", {"Length deviation"}, law);
    found.add(f.length_law != "power law", {"Length exponent"}, law);
  }
  found.add(!f.law.bonded && f.table.empty(),
            {"Tensile strength", "Cohesion", "Bonded friction angle"},
            "'Fractures/Bonded' is false");
}

void find_of_run(const Parameters &p, Collector &found)
{
  const RunParameters &run = p.run;
  const std::string driver = "the driver is " + run.driver;
  found.enter("Run");
  found.add(!run.steps_in_time(),
            {"Step safety", "Strain multiple of peak", "Stress ratio of peak"}, driver);
  found.add(run.steps_in_time() && run.end_shortening > 0., {"Strain multiple of peak"},
            "'Run/End shortening' decides");
  found.add(run.steps_in_time() && p.bends(),
            {"Strain multiple of peak", "Longest shortening"},
            "'Walls/End rotation' decides");
  found.add(run.driver != "static", {"Load steps"}, driver);
  found.add(run.driver != "buckling", {"Modes"}, driver);
  found.add(run.driver == "buckling", {"End shortening", "Longest shortening"}, driver);
  found.enter("Output");
  found.add(!run.steps_in_time(),
            {"Samples per millistrain", "Fields interval", "Checkpoint interval"},
            driver);
}
} // namespace

std::vector<IdleEntry> idle_entries(const Parameters &p)
{
  Collector found;
  find_of_layer(p, found);
  find_of_matrix(p, found);
  find_of_material("Layer material", p.layer_material, found);
  find_of_material("Matrix material", p.matrix_material, found);
  find_of_loads(p, found);
  find_of_fractures(p.fractures, found);
  find_of_run(p, found);
  return found.entries();
}

std::string why_idle(const std::vector<IdleEntry> &entries, const std::string &path)
{
  const auto found =
      std::find_if(entries.begin(), entries.end(),
                   [&](const IdleEntry &entry)
                   {
                     return entry.path == path ||
                            (entry.path.back() == '/' && path.find(entry.path) == 0);
                   });
  return found == entries.end() ? "" : found->reason;
}

namespace
{
/// Values of all entries that nobody has set.
std::map<std::string, std::string> defaults()
{
  const AllParameters all;
  std::map<std::string, std::string> values;
  for (const Declarations::Entry &entry : all.entries())
    values[entry.path] = entry.default_value;
  return values;
}

bool is_same(const std::string &value, const std::string &other)
{
  double a = 0., b = 0.;
  return value == other || (parse_number(value, a) && parse_number(other, b) && a == b);
}

const Section *section_of(const DeckLine &line)
{
  const std::string name = line.path.substr(0, line.path.find('/'));
  for (const Section &section : all_sections())
    if (section.name == name && line.path != name)
      return &section;
  return nullptr; // above all sections
}
} // namespace

std::vector<std::string> idle_lines(const std::string &file,
                                    const std::vector<std::string> &overrides,
                                    const Parameters &parameters)
{
  std::vector<std::string> ignored; // read_deck() has found none
  DeckText deck;
  if (!file.empty())
    deck = scan_deck(file, ignored);
  for (const std::string &text : overrides)
    scan_override(text, deck, ignored);
  std::map<std::string, DeckLine>
      last; // the last line of an entry is the one that counts
  for (const DeckLine &line : deck.entries)
    last[line.path] = line;

  const std::vector<IdleEntry> idle = idle_entries(parameters);
  const std::map<std::string, std::string> unset = defaults();
  std::set<std::string> unread; // sections that have been told of
  std::vector<std::string> texts;
  for (const auto &[path, line] : last)
  {
    const Section *const section = section_of(line);
    const bool is_set = line.place == "--set";
    if (section == nullptr || section->name == "Study" ||
        !(is_set || line.place.find(file + ":") == 0))
      continue;
    if (!is_read(section->name, parameters))
    {
      if (unread.insert(section->name).second)
        texts.push_back(line.place + ": section '" + section->name +
                        "' is not read here, but with: " + section->read_when);
    }
    else if (const std::string reason = why_idle(idle, path);
             !reason.empty() && (is_set || !is_same(line.value, unset.at(path))))
      texts.push_back(line.place + ": '" + path + "' changes nothing: " + reason);
  }
  return texts;
}
} // namespace antiform::cases

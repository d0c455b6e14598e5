#include "cases/parameters.h"
#include "cases/beds.h"
#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/join_choice.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

namespace antiform::cases
{
namespace
{
/// Words of the design that this version does not have; refused by naming what exists.
const std::map<std::string, std::vector<std::string>> planned = {
    {"Layer/Representation", {"manifold", "adaptive"}},
    {"Matrix/Representation", {"manifold", "adaptive"}}};

std::vector<std::string> names_of(const std::vector<Section> &sections)
{
  std::vector<std::string> names;
  names.reserve(sections.size());
  for (const Section &section : sections)
    names.push_back(section.name);
  return names;
}

std::string section_of(const std::string &path)
{
  return path.substr(0, path.find('/'));
}

std::string parent_of(const std::string &path)
{
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::string name_of(const std::string &path)
{
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

/// Reading a deck: the lines, what is wrong with them, and the parameters they give.
class DeckParser
{
public:
  DeckParser(const std::string &file, const std::vector<std::string> &overrides)
      : file_(file)
  {
    text_ = scan_deck(file, problems_);
    const bool unreadable = !problems_.empty() && text_.entries.empty();
    for (const std::string &text : overrides)
      scan_override(text, text_, problems_);
    if (unreadable)
      throw InputError(problems_); // nothing else can be said of a deck that is not there
    Parameters scratch;
    declare_parameters(scratch, names_of(all_sections()), known_);
    for (const DeckLine &line : text_.entries)
      last_[line.path] = line;
  }

  Parameters parse()
  {
    Parameters p;
    find_components(p);

    std::vector<std::string> sections;
    for (const Section &section : all_sections())
      if (is_read(section.name, p))
        sections.push_back(section.name);
    dealii::ParameterHandler prm;
    Declarations declarations(prm);
    declare_parameters(p, sections, declarations);
    refuse_unknown_names(p, declarations);
    for (const Declarations::Entry &entry : declarations.entries())
      if (const auto line = last_.find(entry.path); line != last_.end())
        read_value(entry, line->second, declarations);

    choose_accuracy(p, declarations);

    find_data("Calibration/Laboratory data", p.calibration.data);
    find_data("Fractures/Table", p.fractures.table);
    if (p.has("beds"))
    {
      read_rocks(p);
      refuse_what_rocks_say(p);
    }
    choose_join(p);
    for (const Finding &finding : check_parameters(p))
      report(finding);
    if (!problems_.empty())
      throw InputError(problems_);
    return p;
  }

  /// The section Study alone, with the entries that it names.
  StudyParameters parse_study()
  {
    const auto is_of_others = [](const DeckLine &line)
    { return section_of(line.path) != "Study"; };
    for (std::vector<DeckLine> *lines : {&text_.entries, &text_.sections})
      lines->erase(std::remove_if(lines->begin(), lines->end(), is_of_others),
                   lines->end());
    Parameters p;
    p.study.emplace();
    dealii::ParameterHandler prm;
    Declarations declarations(prm);
    declare_parameters(p, {"Study"}, declarations);
    refuse_unknown_names(p, declarations);
    for (const Declarations::Entry &entry : declarations.entries())
      if (const auto line = last_.find(entry.path);
          line != last_.end() && section_of(entry.path) == "Study")
        read_value(entry, line->second, declarations);
    check_axes(*p.study);
    if (!problems_.empty())
      throw InputError(problems_);
    return *p.study;
  }

private:
  void check_axes(const StudyParameters &study)
  {
    const auto line = last_.find("Study/Vary");
    if (line == last_.end())
    {
      problems_.push_back(file_ +
                          ": 'Study/Vary' is missing: this deck has no study. Add "
                          "'subsection Study' with 'set Vary = Section/Entry = value, "
                          "value', or 'antiform run' it.");
      return;
    }
    const std::string begin = line->second.place + ": 'Study/Vary' ";
    std::vector<std::string> found;
    const std::vector<StudyAxis> axes = read_axes(study.vary, found);
    for (const std::string &problem : found)
      problems_.push_back(begin + problem);
    for (const StudyAxis &axis : axes)
      for (const StudyEntry &varied : axis)
      {
        const Declarations::Entry *const entry = known_.find(varied.path);
        if (entry == nullptr || section_of(varied.path) == "Study")
          problems_.push_back(begin + "names '" + varied.path + "': " +
                              (entry == nullptr
                                   ? unknown_entry(varied.path)
                                   : "a study does not vary itself. Name entries of the "
                                     "scene."));
        else
          for (const std::string &value : varied.values)
            if (!entry->pattern->match(value))
              problems_.push_back(begin + "gives '" + varied.path + "' = '" + value +
                                  "'. Give " + range_in_words(*entry) + ".");
      }
    if (const double n = n_members(axes); n > study.most_members)
      problems_.push_back(begin + "makes " + exact_text(n) +
                          " members, more than 'Study/Most members' = " +
                          std::to_string(study.most_members) +
                          ". Take fewer values, or raise that number.");
  }

  /// Components, the two representations and their join decide which sections are read.
  void find_components(Parameters &p)
  {
    const auto line = last_.find("Components");
    if (line == last_.end() || line->second.value.empty())
    {
      problems_.push_back(
          (line == last_.end() ? file_ : line->second.place) + ": 'Components' is " +
          (line == last_.end() ? "missing" : "empty") +
          ". List what the scene has, of: " + join(all_components()) + ".");
      refused_.emplace_back("Components");
    }
    else
    {
      std::istringstream words(line->second.value);
      for (std::string word; std::getline(words, word, ',');)
        add_component(tidy(word), line->second.place, p.components);
    }
    for (auto [path, target] :
         {std::pair{"Layer/Representation", &p.layer.representation},
          std::pair{"Matrix/Representation", &p.matrix.representation},
          std::pair{"Matrix/Join", &p.matrix.join}})
      if (const auto set = last_.find(path); set != last_.end())
        if (known_.find(path)->pattern->match(set->second.value))
          *target = set->second.value;
  }

  /// Entries that the deck leaves to its 'Accuracy'.
  void choose_accuracy(Parameters &p, Declarations &declarations)
  {
    if (p.accuracy.percent == 0. || !refused_.empty())
      return;
    std::set<std::string> given;
    for (const auto &[path, line] : last_)
      given.insert(path);
    std::string problem;
    p.accuracy = plan_accuracy(p, given, problem);
    if (!problem.empty())
      report({{"Accuracy"}, problem});
    else
      for (const AccuracySetting &setting : p.accuracy.settings)
        if (setting.is_chosen)
        {
          declarations.set(setting.entry, setting.value);
          chosen_[setting.entry] = setting.value;
        }
  }

  void add_component(const std::string &name,
                     const std::string &place,
                     std::vector<std::string> &components)
  {
    const std::vector<std::string> &all = all_components();
    const std::string begin = place + ": 'Components' lists '" + name + "'";
    if (std::find(all.begin(), all.end(), name) == all.end())
    {
      const std::string near = nearest_name(name, all);
      problems_.push_back(begin + ", which does not exist. " +
                          (near.empty() ? "" : "Did you mean '" + near + "'? ") +
                          "What exists: " + join(all) + ".");
      refused_.emplace_back("Components");
    }
    else if (std::find(components.begin(), components.end(), name) != components.end())
      problems_.push_back(begin + " twice. Name it once.");
    else
      components.push_back(name);
  }

  void read_rocks(Parameters &p)
  {
    for (std::string &rock : p.beds.rocks)
    {
      find_data("Beds/Rocks", rock);
      std::vector<std::string> found;
      p.beds.layers.push_back(read_rock(rock, p.layer, found));
      for (const std::string &problem : found) // once, be it the rock of several beds
        if (std::find(problems_.begin(), problems_.end(), problem) == problems_.end())
          problems_.push_back(problem);
    }
  }

  /// A stack has its bonds from the rock files: an override that looks as if it did
  /// something would be lost.
  void refuse_what_rocks_say(const Parameters &p)
  {
    const auto is_of_matrix_too = [](const std::string &path)
    {
      return path == "Layer/Flat joint/Elements" ||
             path == "Layer/Flat joint/Radius multiplier" ||
             path == "Layer/Flat joint/Element moment";
    };
    for (const DeckLine &line : text_.entries)
      if (line.place == "--set" &&
          (line.path == "Layer/Young modulus" || line.path == "Layer/Grain density" ||
           line.path.find("Layer/Flat joint/") == 0) &&
          !(p.has("matrix") && is_of_matrix_too(line.path)))
        problems_.push_back(set_place(line) + "the rocks of 'Beds/Rocks' say this for "
                                              "each bed. Change their files, or give "
                                              "others.");
  }

  bool is_known_section(const std::string &path) const
  {
    return std::any_of(known_.entries().begin(), known_.entries().end(),
                       [&](const Declarations::Entry &e)
                       { return e.path.compare(0, path.size() + 1, path + "/") == 0; });
  }

  /// @p read: the entries that this scene has a use for.
  void refuse_unknown_names(const Parameters &p, const Declarations &read)
  {
    std::vector<std::string> unknown_sections;
    const auto inside_unknown = [&](const std::string &path)
    {
      return std::any_of(unknown_sections.begin(), unknown_sections.end(),
                         [&](const std::string &s)
                         { return path.compare(0, s.size() + 1, s + "/") == 0; });
    };
    for (const DeckLine &line : text_.sections)
      if (!is_known_section(line.path) && !inside_unknown(line.path) &&
          (parent_of(line.path).empty() || is_read(section_of(line.path), p)))
      {
        problems_.push_back(line.place + ": " + unknown_section(line.path));
        unknown_sections.push_back(line.path);
      }

    for (const DeckLine &line : text_.entries)
    {
      const std::string parent = parent_of(line.path);
      if (known_.find(line.path) != nullptr && line.place == "--set" &&
          read.find(line.path) == nullptr)
        problems_.push_back(
            set_place(line) + "this scene has no use for '" +
            (is_read(section_of(line.path), p) ? line.path : section_of(line.path)) +
            "', which is read when: " + read_when(section_of(line.path)) +
            ". Leave it out, or change the scene.");
      if (known_.find(line.path) != nullptr || inside_unknown(line.path))
        continue;
      if (!parent.empty() && !is_known_section(parent))
        problems_.push_back(set_place(line) + unknown_section(parent));
      else if (parent.empty() || is_read(section_of(line.path), p))
        problems_.push_back(set_place(line) + unknown_entry(line.path));
    }
  }

  static std::string read_when(const std::string &name)
  {
    for (const Section &section : all_sections())
      if (section.name == name)
        return section.read_when;
    throw std::logic_error("no section is called " + name);
  }

  static std::string set_place(const DeckLine &line)
  {
    return line.place == "--set" ? "--set \"" + line.path + "=" + line.value + "\": "
                                 : line.place + ": ";
  }

  std::string unknown_section(const std::string &path) const
  {
    std::vector<std::string> siblings;
    if (parent_of(path).empty())
      siblings = names_of(all_sections());
    else
      for (const Declarations::Entry &entry : known_.entries())
        if (const std::string section = parent_of(entry.path);
            parent_of(section) == parent_of(path) && !section.empty() &&
            std::find(siblings.begin(), siblings.end(), name_of(section)) ==
                siblings.end())
          siblings.push_back(name_of(section));
    const std::string near = nearest_name(name_of(path), siblings);
    return "there is no subsection '" + path + "'. " +
           (near.empty() ? "" : "Did you mean '" + near + "'? ") +
           (siblings.empty() ? "" : "Subsections here: " + join(siblings) + ".");
  }

  std::string unknown_entry(const std::string &path) const
  {
    std::vector<std::string> siblings, elsewhere;
    for (const Declarations::Entry &entry : known_.entries())
    {
      if (parent_of(entry.path) == parent_of(path))
        siblings.push_back(name_of(entry.path));
      else if (name_of(entry.path) == name_of(path))
        elsewhere.push_back("'" + entry.path + "'");
    }
    const std::string near = nearest_name(name_of(path), siblings);
    std::string text = "there is no entry '" + path + "'. ";
    if (!near.empty())
      text += "Did you mean '" + near + "'?";
    else if (!elsewhere.empty())
      text += "There is " + join(elsewhere) + ".";
    else
      text += "Entries here: " + join(siblings) + ".";
    return text;
  }

  void read_value(const Declarations::Entry &entry,
                  const DeckLine &line,
                  Declarations &declarations)
  {
    if (entry.path == "Components")
      return; // read beforehand
    if (entry.pattern->match(line.value))
    {
      declarations.set(entry.path, line.value);
      return;
    }
    refused_.push_back(entry.path);
    const bool is_number = dynamic_cast<const Number *>(entry.pattern.get()) != nullptr;
    double number = 0.;
    std::string what = "is not one of its words";
    if (is_number)
      what = parse_number(line.value, number) ? "is out of range" : "is not a number";
    if (dynamic_cast<const NumberList *>(entry.pattern.get()) != nullptr)
      what = "is no such list";
    if (dynamic_cast<const Percentage *>(entry.pattern.get()) != nullptr)
      what = "is no such percentage";
    const auto words = planned.find(entry.path);
    if (words != planned.end() && std::find(words->second.begin(), words->second.end(),
                                            line.value) != words->second.end())
      what = "does not exist yet in this version";
    const std::string unit = is_number ? unit_of(entry) : "";
    problems_.push_back(line.place + ": '" + entry.path + "' = '" + line.value + "' " +
                        what + ". Give " + range_in_words(entry) +
                        (unit.empty() ? "" : " ") + unit +
                        (entry.default_value.empty()
                             ? ""
                             : "; the default is " + entry.default_value) +
                        ".");
  }

  /// A table is looked for from the deck that names it, like an include. Its path becomes
  /// absolute, so that deck.prm can stand anywhere.
  void find_data(const std::string &entry, std::string &path) const
  {
    const auto line = last_.find(entry);
    if (path.empty() || line == last_.end())
      return;
    const std::string &place = line->second.place;
    std::filesystem::path folder;
    if (place != "--set")
      folder = std::filesystem::path(place.substr(0, place.rfind(':'))).parent_path();
    path = std::filesystem::absolute(folder / path).lexically_normal().string();
  }

  void report(const Finding &finding)
  {
    for (const std::string &path : finding.entries)
      if (std::find(refused_.begin(), refused_.end(), path) != refused_.end())
        return; // said already; what follows from a refused value is not the user's error
    const std::string &path = finding.entries.front();
    const auto line = last_.find(path);
    const auto chosen = chosen_.find(path);
    std::string value = known_.find(path)->default_value + "' (the default)";
    if (chosen != chosen_.end())
      value = chosen->second + "' (chosen by 'Accuracy')";
    else if (line != last_.end())
      value = line->second.value + "'";
    problems_.push_back((line != last_.end() ? line->second.place : file_) + ": '" +
                        path + "' = '" + value + ": " + finding.text);
  }

  std::string file_;
  DeckText text_;
  std::vector<std::string> problems_;
  std::vector<std::string> refused_; ///< paths whose value was not taken
  std::map<std::string, DeckLine> last_;
  std::map<std::string, std::string> chosen_; ///< values by 'Accuracy'
  dealii::ParameterHandler known_prm_;
  Declarations known_{known_prm_};
};
} // namespace

InputError::InputError(const std::vector<std::string> &problems)
    : std::runtime_error(join(problems, "\n"))
    , problems_(problems)
{
}

Parameters read_deck(const std::string &file, const std::vector<std::string> &overrides)
{
  return DeckParser(file, overrides).parse();
}

StudyParameters read_study(const std::string &file,
                           const std::vector<std::string> &overrides)
{
  return DeckParser(file, overrides).parse_study();
}

std::string effective_deck(const Parameters &parameters)
{
  Parameters copy = parameters;
  std::vector<std::string> sections;
  for (const Section &section : all_sections())
    if (is_read(section.name, copy))
      sections.push_back(section.name);
  dealii::ParameterHandler prm;
  Declarations declarations(prm);
  declare_parameters(copy, sections, declarations);
  std::ostringstream text;
  prm.print_parameters(text, dealii::ParameterHandler::PRM |
                                 dealii::ParameterHandler::KeepDeclarationOrder);
  return text.str();
}
} // namespace antiform::cases

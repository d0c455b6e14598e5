#include "cases/study_decks.h"

#include "cases/calibrate.h"
#include "cases/deck_reader.h"
#include "cases/idle_entries.h"
#include "cases/predicted_cost.h"
#include "cases/run_deck.h"
#include "cases/theory.h"
#include "cases/theory_table.h"
#include "coupling/output/whole_file.h"
#include "coupling/state_image.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

namespace antiform::cases
{
namespace
{
const std::string checksum_line = "# A member of a study. Checksum ";

std::string hexadecimal_crc(const std::string &text)
{
  char digits[24];
  std::snprintf(
      digits, sizeof digits, "%016llx",
      static_cast<unsigned long long>(coupling::crc64(text.data(), text.size())));
  return digits;
}

/// Texts, and of which members each is, in the order in which they came.
class SharedProblems
{
public:
  void add(const std::string &text, const std::string &member)
  {
    const auto [place, is_new] = index_.emplace(text, texts_.size());
    if (is_new)
      texts_.push_back({text, {}});
    texts_[place->second].second.push_back(member);
  }
  /// @p n_all: a text of all members is one of the deck itself.
  std::vector<std::string> in_words(const std::size_t n_all) const
  {
    std::vector<std::string> result;
    for (const auto &[text, members] : texts_)
    {
      std::string begin;
      if (members.size() < n_all)
        begin =
            "member '" + members.front() + "'" +
            (members.size() > 1 ? " and " + std::to_string(members.size() - 1) + " more"
                                : "") +
            ": ";
      result.push_back(begin + text);
    }
    return result;
  }
  bool empty() const { return texts_.empty(); }

private:
  std::vector<std::pair<std::string, std::vector<std::string>>> texts_;
  std::map<std::string, std::size_t> index_;
};

/// A value of the study reaches a member as an override, which its user has not written.
std::string without_override(const std::string &problem,
                             const std::vector<std::string> &paths)
{
  const std::string option = "--set";
  if (problem.compare(0, option.size(), option) != 0)
    return problem;
  for (const std::string &path : paths)
    for (const std::string &begin : {"--set \"" + path + "=", "--set: '" + path + "'"})
      if (problem.compare(0, begin.size(), begin) == 0)
        return "'Study/Vary'" + problem.substr(option.size());
  return problem;
}

/// Overrides of a member: those of the command line, and its values.
std::vector<std::string> with_values(std::vector<std::string> overrides,
                                     const std::vector<std::string> &paths,
                                     const StudyMember &member)
{
  for (std::size_t i = 0; i < paths.size(); ++i)
    overrides.push_back(paths[i] + "=" + member.values[i]);
  return overrides;
}

MemberDeck
member_deck(const StudyMember &member, const Parameters &p, MachineSpeed &speed)
{
  const RunDeck deck(p);
  MemberDeck result;
  result.member = member;
  result.checksum = hexadecimal_crc(deck.everything);
  result.text = effective_deck(p);
  const SectionGeometry geometry(p);
  const PredictedCost cost = predict_cost(p, geometry, predict_sizes(p, geometry), speed);
  result.core_seconds = cost.core_seconds();
  result.memory = cost.memory;
  return result;
}
} // namespace

std::vector<std::string> overrides_of_scene(const std::vector<std::string> &overrides)
{
  std::vector<std::string> of_scene;
  for (const std::string &text : overrides)
    if (tidy(text).compare(0, 6, "Study/") != 0)
      of_scene.push_back(text);
  return of_scene;
}

bool has_study(const std::string &file, const std::vector<std::string> &overrides)
{
  std::vector<std::string> ignored; // read_deck() tells
  DeckText deck = scan_deck(file, ignored);
  for (const std::string &text : overrides)
    scan_override(text, deck, ignored);
  return std::any_of(deck.entries.begin(), deck.entries.end(),
                     [](const DeckLine &line) { return line.path == "Study/Vary"; });
}

std::vector<MemberDeck> read_members(const std::string &file,
                                     const std::vector<std::string> &overrides,
                                     const StudyParameters &study,
                                     MachineSpeed &speed)
{
  std::vector<std::string> ignored; // read_study() has found none
  const std::vector<StudyAxis> axes = read_axes(study.vary, ignored);
  const std::vector<std::string> paths = paths_of(axes);
  const bool names_title = std::find(paths.begin(), paths.end(), "Title") != paths.end();
  const bool collects_theory = std::any_of(
      study.collect.begin(), study.collect.end(),
      [](const std::string &name) { return name.find("theory/") != std::string::npos; });
  const std::vector<std::string> of_scene = overrides_of_scene(overrides);
  std::vector<std::string> lost;
  for (const std::string &text : of_scene)
    if (const std::string path = tidy(text.substr(0, text.find('=')));
        std::find(paths.begin(), paths.end(), path) != paths.end())
      lost.push_back("--set \"" + text + "\": the study varies '" + path +
                     "'. Leave this out, or change 'Study/Vary'.");
  if (!lost.empty())
    throw InputError(lost);

  const std::vector<StudyMember> members = members_of(axes);
  std::vector<MemberDeck> decks;
  SharedProblems problems;
  std::map<std::string, std::string> first_with; // deck -> member
  for (const StudyMember &member : members)
  {
    try
    {
      Parameters p = read_deck(file, with_values(of_scene, paths, member));
      demand_calibration(p, false);
      const auto [same, is_new] = first_with.emplace(RunDeck(p).everything, member.name);
      if (!is_new)
        problems.add("is the same run as member '" + same->second +
                         "': its values do not change the deck. Leave one of them out.",
                     member.name);
      const std::string scene = p.title;
      if (!names_title)
        p.title += (p.title.empty() ? "" : ": ") + member.label;
      decks.push_back(member_deck(member, p, speed));
      decks.back().scene = scene;
      const std::vector<IdleEntry> idle = idle_entries(p);
      for (const std::string &path : paths)
        if (const std::string reason = why_idle(idle, path); !reason.empty())
          decks.back().idle[path] = reason;
      if (collects_theory)
        decks.back().theory = theory_figures(p, TheoryOptions().friction_angle);
    }
    catch (const InputError &error)
    {
      for (const std::string &problem : error.problems())
        problems.add(without_override(problem, paths), member.name);
    }
  }
  if (!problems.empty())
    throw InputError(problems.in_words(members.size()));
  return decks;
}

double predicted_seconds(const std::vector<MemberDeck> &members, const int jobs)
{
  double sum = 0.;
  for (const MemberDeck &deck : members)
    sum += deck.core_seconds;
  return sum / std::min(jobs, static_cast<int>(members.size()));
}

std::vector<std::string> varied_in_vain(const std::vector<MemberDeck> &members)
{
  std::vector<std::string> texts;
  for (const auto &[path, reason] : members.front().idle)
    if (const std::string &entry = path;
        std::all_of(members.begin(), members.end(),
                    [&](const MemberDeck &one) { return one.idle.count(entry) > 0; }))
      texts.push_back("'Study/Vary' names '" + path + "', which changes nothing in any " +
                      "run: " + reason);
  return texts;
}

StudyBase read_base(const std::string &file,
                    const std::vector<std::string> &overrides,
                    const StudyParameters &study)
{
  const std::vector<std::string> of_scene = overrides_of_scene(overrides);
  try
  {
    return {read_deck(file, of_scene), ""};
  }
  catch (const InputError &)
  {
    std::vector<std::string> ignored; // read_study() has found none
    const std::vector<StudyAxis> axes = read_axes(study.vary, ignored);
    const StudyMember first = members_of(axes).front();
    return {read_deck(file, with_values(of_scene, paths_of(axes), first)), first.name};
  }
}

std::string deck_of_study(const std::string &file,
                          const std::vector<std::string> &overrides,
                          const StudyParameters &study)
{
  try
  {
    Parameters p = read_deck(file, overrides_of_scene(overrides));
    p.study = study;
    return effective_deck(p);
  }
  catch (const InputError &)
  {
    return ""; // its members have been accepted, one by one
  }
}

std::string member_folder(const std::string &directory, const std::string &name)
{
  return directory + "/members/" + name;
}

void write_member_deck(const std::string &directory, const MemberDeck &deck)
{
  coupling::replace_file(member_folder(directory, deck.member.name) + ".prm",
                         checksum_line + deck.checksum + "\n" + deck.text);
}

void demand_same_decks(const std::string &directory,
                       const std::vector<MemberDeck> &members)
{
  SharedProblems differences;
  for (const MemberDeck &deck : members)
  {
    const std::string path = member_folder(directory, deck.member.name) + ".prm";
    if (!std::filesystem::exists(path))
      continue;
    const std::string there = coupling::read_file(path);
    const std::string first = there.substr(0, there.find('\n'));
    if (first == checksum_line + deck.checksum)
      continue;
    std::vector<std::string> changes = deck_differences(there, deck.text);
    if (changes.empty())
      changes.emplace_back("another rock file or table");
    for (const std::string &change : changes)
      differences.add(change, deck.member.name);
  }
  if (differences.empty())
    return;
  std::vector<std::string> problems;
  for (const std::string &text : differences.in_words(members.size()))
    problems.push_back("output directory '" + directory +
                       "': its members are of another deck, with " + text +
                       ". Put the deck back, give another directory with -o DIR, or "
                       "remove this one.");
  throw InputError(problems);
}
} // namespace antiform::cases

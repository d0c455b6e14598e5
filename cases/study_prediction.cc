#include "cases/study_prediction.h"

#include "cases/deck_reader.h"
#include "cases/formatted.h"
#include "cases/study_members.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <thread>

namespace antiform::cases
{
namespace
{
constexpr std::size_t most_listed = 7;

std::vector<std::string> at_both_ends(const std::vector<std::string> &values)
{
  if (values.size() <= most_listed)
    return values;
  std::vector<std::string> some(values.begin(), values.begin() + 4);
  some.emplace_back("...");
  some.push_back(values.back());
  return some;
}

/// "Layer/Seed = 1, 2, 3"
std::string entry_in_words(const StudyEntry &entry)
{
  const std::string n = std::to_string(entry.values.size());
  return entry.path + " = " + join(at_both_ends(entry.values)) +
         (entry.values.size() > most_listed ? " (" + n + " values)" : "");
}

std::vector<std::string> varied_in_words(const std::vector<StudyAxis> &axes)
{
  std::vector<std::string> lines;
  for (const StudyAxis &axis : axes)
    for (std::size_t e = 0; e < axis.size(); ++e)
      lines.push_back((e > 0 ? "  with it " : "") + entry_in_words(axis[e]));
  return lines;
}

std::pair<const MemberDeck *, const MemberDeck *>
cheapest_and_dearest(const std::vector<MemberDeck> &members)
{
  const auto [least, most] =
      std::minmax_element(members.begin(), members.end(),
                          [](const MemberDeck &a, const MemberDeck &b)
                          { return a.core_seconds < b.core_seconds; });
  return {&*least, &*most};
}
} // namespace

int cores_of_machine()
{
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

double StudyPrediction::memory() const
{
  double most = 0.;
  for (const MemberDeck &member : members)
    most = std::max(most, member.memory);
  return most;
}

StudyPrediction predict_study(const RunOptions &options, MachineSpeed &speed)
{
  StudyPrediction prediction;
  prediction.study = read_study(options.deck, options.overrides);
  std::vector<std::string> ignored; // read_study() has found none
  prediction.axes = read_axes(prediction.study.vary, ignored);
  prediction.members =
      read_members(options.deck, options.overrides, prediction.study, speed);
  prediction.base = read_base(options.deck, options.overrides, prediction.study);
  return prediction;
}

void print_study(const StudyPrediction &prediction, std::ostream &out)
{
  const std::vector<MemberDeck> &members = prediction.members;
  const auto [least, most] = cheapest_and_dearest(members);
  const auto at_once =
      std::min<std::size_t>(static_cast<std::size_t>(cores_of_machine()), members.size());
  const auto line = [&out](const std::string &what, const std::string &text)
  { out << formatted("  %-9s %s\n", what.c_str(), text.c_str()); };

  out << "A study of " << members.size() << (members.size() == 1 ? " run" : " runs")
      << ", which 'antiform study' makes of this deck\n";
  std::string what = "varied";
  for (const std::string &text : varied_in_words(prediction.axes))
  {
    line(what, text);
    what.clear();
  }
  const std::vector<std::string> &collect = prediction.study.collect;
  line("collected", collect.empty()
                        ? "all results"
                        : join(at_both_ends(collect)) +
                              (collect.size() > most_listed
                                   ? " (" + std::to_string(collect.size()) + " figures)"
                                   : ""));
  line("one run", duration_text(least->core_seconds) + " of one core (" +
                      least->member.name + ") to " + duration_text(most->core_seconds) +
                      " (" + most->member.name + ")");
  line("all runs",
       "about " + duration_text(prediction.core_seconds()) + " of one core, " +
           duration_text(predicted_seconds(members, static_cast<int>(at_once))) +
           " with " + std::to_string(at_once) + " at once (--jobs)");
  for (const std::string &text : varied_in_vain(members))
    line("note", text);
  if (prediction.base.member.empty())
    out << "\nThe base deck, which the runs change (alone by 'antiform run'): ";
  else
    out << "\nThe first run, " << prediction.base.member
        << " (without its values the deck is no scene): ";
}

std::string study_json(const StudyPrediction &prediction)
{
  using Json = nlohmann::ordered_json;
  const auto [least, most] = cheapest_and_dearest(prediction.members);
  Json json = {{"members", prediction.members.size()},
               {"core_seconds", prediction.core_seconds()},
               {"least_core_seconds", least->core_seconds},
               {"most_core_seconds", most->core_seconds},
               {"memory_bytes", std::llround(prediction.memory())},
               {"vary", Json::object()}};
  for (const StudyAxis &axis : prediction.axes)
    for (const StudyEntry &entry : axis)
      json["vary"][entry.path] = entry.values;
  if (!prediction.base.member.empty())
    json["scene_of_member"] = prediction.base.member;
  return json.dump();
}
} // namespace antiform::cases

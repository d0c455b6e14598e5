#include "cases/study_tables.h"

#include "cases/all_parameters.h"
#include "cases/deck_reader.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace antiform::cases
{
namespace
{
/// What is left of a warning that other members have with other numbers.
std::string without_numbers(const std::string &text)
{
  std::string kind;
  for (const char c : text)
    if (std::string("0123456789.+-e").find(c) == std::string::npos)
      kind += c;
  return kind;
}

/// "Pa" of a documentation that ends in "[Pa].", "-" of one without.
std::vector<std::string> units_of(const std::vector<std::string> &paths)
{
  const AllParameters all;
  std::vector<std::string> units;
  for (const std::string &path : paths)
  {
    const Declarations::Entry *const entry = all.find(path);
    const bool is_number =
        entry != nullptr && dynamic_cast<const Number *>(entry->pattern.get()) != nullptr;
    const std::string unit = is_number ? unit_of(*entry) : "";
    units.push_back(unit.size() > 2 ? unit.substr(1, unit.size() - 2) : "-");
  }
  return units;
}
} // namespace

std::string csv_cell(const std::string &text)
{
  if (text.find_first_of(",\"\n") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> value_columns(const std::vector<std::string> &paths)
{
  std::vector<std::string> names = short_names(paths, '_');
  const std::vector<std::string> units = units_of(paths);
  for (std::size_t i = 0; i < paths.size(); ++i)
    names[i] = column_name(names[i], units[i]);
  return names;
}

std::string column_name(const std::string &name, const std::string &unit)
{
  std::string result;
  for (const char c : name)
    result += c == '/' || c == ' ' || c == '-' ? '_' : c;
  const auto ends_in = [&](const std::string &end)
  {
    return result.size() >= end.size() &&
           result.compare(result.size() - end.size(), end.size(), end) == 0;
  };
  if (unit == "-" || unit.empty() || (unit == "s" && ends_in("seconds")) ||
      (unit == "bytes" && ends_in("bytes")))
    return result;
  result += '_';
  for (const char c : unit)
    if (c == '/')
      result += "_per_";
    else if (c != '^')
      result += c == ' ' ? '_' : c;
  return result;
}

StudyTable::StudyTable(std::vector<std::string> paths, std::vector<std::string> collect)
    : paths_(std::move(paths))
    , value_names_(value_columns(paths_))
    , collect_(std::move(collect))
{
}

std::vector<StudyTable::Column> StudyTable::columns(const StudyMembers &members) const
{
  std::vector<std::string> names = collect_;
  if (names.empty())
  {
    std::set<std::string> all;
    for (const RunOutcome &outcome : members.outcomes())
      all.insert(outcome.results.begin(), outcome.results.end());
    names.assign(all.begin(), all.end());
  }
  std::vector<Column> result;
  for (const std::string &name : names)
  {
    Column column{name, column_name(name, "-"), "-"};
    for (const RunOutcome &outcome : members.outcomes())
      if (Result figure; find_figure(outcome, name, figure))
      {
        column.name = column_name(name, figure.unit);
        column.unit = figure.unit;
        break;
      }
    result.push_back(column);
  }
  return result;
}

std::string StudyTable::csv(const StudyMembers &members) const
{
  const std::vector<Column> all = columns(members);
  std::string text = "member";
  for (const std::string &name : value_names_)
    text += "," + name;
  text += ",status";
  for (const Column &column : all)
    text += "," + column.name;
  text += "\n";
  for (std::size_t k = 0; k < members.decks().size(); ++k)
  {
    const StudyMember &member = members.decks()[k].member;
    const RunOutcome &outcome = members.outcomes()[k];
    text += member.name;
    for (const std::string &value : member.values)
      text += "," + csv_cell(value);
    text += "," + outcome.status;
    for (const Column &column : all)
    {
      Result figure;
      text += ",";
      if (find_figure(outcome, column.wanted, figure))
        text += exact_text(figure.value);
    }
    text += "\n";
  }
  return text;
}

std::string StudyTable::json(const StudyMembers &members,
                             const std::string &title,
                             const std::string &status,
                             const double seconds) const
{
  using Json = nlohmann::ordered_json;
  const std::vector<Column> all = columns(members);
  std::vector<std::string> warnings = missing(members);
  for (const std::string &text : warnings_of(members))
    warnings.push_back(text);
  Json json = {{"title", title},           {"version", ANTIFORM_VERSION},
               {"status", status},         {"warnings", warnings},
               {"wall_seconds", seconds},  {"vary", Json::array()},
               {"collect", Json::array()}, {"members", Json::array()}};
  for (std::size_t i = 0; i < paths_.size(); ++i)
    json["vary"].push_back({{"entry", paths_[i]}, {"column", value_names_[i]}});
  for (const Column &column : all)
    json["collect"].push_back(
        {{"name", column.wanted}, {"column", column.name}, {"unit", column.unit}});
  for (std::size_t k = 0; k < members.decks().size(); ++k)
  {
    const StudyMember &member = members.decks()[k].member;
    const RunOutcome &outcome = members.outcomes()[k];
    Json one = {{"name", member.name},
                {"values", Json::object()},
                {"status", outcome.status},
                {"figures", Json::object()}};
    if (!outcome.reason.empty())
      one["reason"] = outcome.reason;
    if (!outcome.warnings.empty())
      one["warnings"] = outcome.warnings;
    for (std::size_t i = 0; i < paths_.size(); ++i)
      one["values"][value_names_[i]] = member.values[i];
    for (const Column &column : all)
      if (Result figure; find_figure(outcome, column.wanted, figure))
        one["figures"][column.name] = figure.value;
    json["members"].push_back(one);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<std::string> StudyTable::warnings_of(const StudyMembers &members)
{
  struct Warned
  {
    std::string kind, text, member; ///< as the first one has it
    std::size_t n = 0;
  };
  std::vector<Warned> all;
  std::size_t n_ended = 0;
  for (std::size_t k = 0; k < members.decks().size(); ++k)
  {
    n_ended += members.outcomes()[k].has_ended() ? 1 : 0;
    std::set<std::string> of_member; // one that warns twice of a kind counts once
    for (const std::string &text : members.outcomes()[k].warnings)
    {
      const std::string kind = without_numbers(text);
      if (!of_member.insert(kind).second)
        continue;
      auto known = std::find_if(all.begin(), all.end(),
                                [&](const Warned &one) { return one.kind == kind; });
      if (known == all.end())
        known = all.insert(all.end(), {kind, text, members.decks()[k].member.name, 0});
      ++known->n;
    }
  }
  std::vector<std::string> texts;
  for (const Warned &one : all)
    texts.push_back(std::to_string(one.n) + " of " + std::to_string(n_ended) +
                    (n_ended == 1 ? " member" : " members") +
                    (one.n == 1 ? " warns (" : " warn (the first: ") + one.member +
                    "): " + one.text);
  return texts;
}

std::vector<std::string> StudyTable::missing(const StudyMembers &members) const
{
  std::vector<std::string> names, texts;
  bool any = false;
  for (const RunOutcome &outcome : members.outcomes())
    for (const auto &[name, figure] : outcome.figures)
    {
      any = true;
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    }
  Result figure;
  for (const std::string &wanted : collect_)
  {
    const auto has = [&](const RunOutcome &outcome)
    { return find_figure(outcome, wanted, figure); };
    if (!any || std::any_of(members.outcomes().begin(), members.outcomes().end(), has))
      continue;
    const std::string near = nearest_name(wanted, names);
    texts.push_back("'Study/Collect' lists '" + wanted + "', which no member has. " +
                    (near.empty() ? "They have: " + join(names) + "."
                                  : "Did you mean '" + near + "'?"));
  }
  return texts;
}
} // namespace antiform::cases

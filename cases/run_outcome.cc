#include "cases/run_outcome.h"

#include "cases/child_runs.h"
#include "cases/deck_reader.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <vector>

namespace antiform::cases
{
namespace
{
const std::string over = " over ";

/// Units of the numbers of a summary that are no results.
std::string unit_of_summary(const std::string &name)
{
  const auto ends_in = [&](const std::string &end)
  {
    return name.size() >= end.size() &&
           name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_in("seconds"))
    return "s";
  if (ends_in("bytes"))
    return "bytes";
  return name.compare(0, 7, "energy/") == 0 && !ends_in("_error") ? "J" : "-";
}

void read_figures(const nlohmann::json &summary, RunOutcome &outcome)
{
  if (const auto results = summary.find("results"); results != summary.end())
    for (const auto &[name, result] : results->items())
      if (result.is_object() && result.contains("value") && result["value"].is_number())
      {
        outcome.figures[name] = {result["value"].get<double>(),
                                 result.value("unit", std::string("-"))};
        outcome.results.insert(name);
      }
  const auto add = [&](const std::string &name, const nlohmann::json &value)
  {
    if (value.is_number())
      outcome.figures.insert({name, {value.get<double>(), unit_of_summary(name)}});
  };
  for (const auto &[name, value] : summary.items())
  {
    add(name, value);
    if ((name == "sizes" || name == "energy") && value.is_object())
      for (const auto &[part, number] : value.items())
        add(name + "/" + part, number);
  }
}
} // namespace

RunOutcome read_outcome(const std::string &folder)
{
  RunOutcome outcome;
  std::ifstream input(folder + "/summary.json");
  const auto summary = nlohmann::json::parse(input, nullptr, false);
  if (!input.is_open() || summary.is_discarded() || !summary.is_object())
    return outcome;
  outcome.status = summary.value("status", std::string("waiting"));
  if (!outcome.has_ended())
    return outcome;
  outcome.warnings = summary.value("warnings", std::vector<std::string>());
  if (outcome.status == "failed")
  {
    outcome.reason = outcome.warnings.empty() ? last_line_of(folder + "/log.txt")
                                              : outcome.warnings.back();
    if (!outcome.warnings.empty())
      outcome.warnings.pop_back();
  }
  read_figures(summary, outcome);
  return outcome;
}

bool find_figure(const RunOutcome &outcome, const std::string &wanted, Result &figure)
{
  const auto whole = outcome.figures.find(wanted);
  if (whole != outcome.figures.end())
  {
    figure = whole->second;
    return true;
  }
  const std::size_t at = wanted.find(over);
  if (at == std::string::npos)
    return false;
  const auto top = outcome.figures.find(tidy(wanted.substr(0, at))),
             low = outcome.figures.find(tidy(wanted.substr(at + over.size())));
  if (top == outcome.figures.end() || low == outcome.figures.end() ||
      low->second.value == 0.)
    return false;
  figure.value = top->second.value / low->second.value;
  figure.unit = top->second.unit == low->second.unit
                    ? "-"
                    : top->second.unit + "/" + low->second.unit;
  return std::isfinite(figure.value);
}
} // namespace antiform::cases

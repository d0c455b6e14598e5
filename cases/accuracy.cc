// Resolution and rates by the error that is wanted.
#include "cases/accuracy.h"

#include "cases/declarations.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace antiform::cases
{
namespace
{
using Curves = std::vector<AccuracyCurve>;

double sum_of(const Curves &curves, const std::vector<std::size_t> &rows)
{
  double sum = 0.;
  for (std::size_t k = 0; k < curves.size(); ++k)
    sum += curves[k].rows[rows[k]].error;
  return sum;
}

/// The next row of a smaller error; none: rows.size().
std::size_t finer_than(const AccuracyCurve &curve, const std::size_t from)
{
  std::size_t to = from;
  while (to < curve.rows.size() && curve.rows[to].error >= curve.rows[from].error)
    ++to;
  return to;
}

/// Error that a finer row takes away for each e-folding of the time.
double gain(const AccuracyCurve &curve, const std::size_t from, const std::size_t to)
{
  constexpr double least = 0.01; // a finer row that costs nothing is taken at once
  const double longer = std::log(curve.rows[to].seconds / curve.rows[from].seconds);
  return (curve.rows[from].error - curve.rows[to].error) / std::max(longer, least);
}
} // namespace

std::vector<std::size_t> choose_rows(const Curves &curves, const double wanted)
{
  std::vector<std::size_t> rows(curves.size(), 0);
  while (sum_of(curves, rows) > wanted)
  {
    double best = 0.;
    std::size_t which = 0, to = 0;
    for (std::size_t k = 0; k < curves.size(); ++k)
    {
      const std::size_t next = finer_than(curves[k], rows[k]);
      if (next == curves[k].rows.size() || gain(curves[k], rows[k], next) <= best)
        continue;
      best = gain(curves[k], rows[k], next);
      which = k;
      to = next;
    }
    if (best == 0.)
      return {};
    rows[which] = to;
  }
  return rows;
}

std::optional<double> error_of(const AccuracyCurve &curve, const std::string &value)
{
  double x = 0.;
  parse_number(value, x);
  for (std::size_t k = 0; k < curve.rows.size(); ++k)
  {
    double here = 0., next = 0.;
    parse_number(curve.rows[k].value, here);
    if (x == here)
      return curve.rows[k].error;
    if (k + 1 == curve.rows.size())
      break;
    parse_number(curve.rows[k + 1].value, next);
    if ((x - here) * (x - next) > 0. || here * next <= 0.)
      continue;
    const double share = std::log(x / here) / std::log(next / here);
    return curve.rows[k].error + share * (curve.rows[k + 1].error - curve.rows[k].error);
  }
  return std::nullopt;
}

std::vector<std::string> AccuracyPlan::warnings() const
{
  std::vector<std::string> texts;
  for (const AccuracySetting &setting : settings)
    if (!setting.error)
      texts.push_back("'" + setting.entry + "' = " + setting.value + ": " +
                      setting.why_unknown);
  return texts;
}

double AccuracyPlan::sum_of_errors() const
{
  double sum = 0.;
  for (const AccuracySetting &setting : settings)
    sum += setting.error.value_or(0.);
  return sum;
}

namespace
{
/// The record is of grains that come to their peak without waves, and of square cells.
std::vector<std::string> knobs_of(const Parameters &p)
{
  std::vector<std::string> knobs;
  const bool grains = p.has("layer") && p.layer.representation == "grains";
  const bool is_test = p.is_specimen() && p.run.driver != "buckling";
  if (grains)
    knobs.emplace_back(is_test ? "grains in stiffness" : "grains in bending");
  if (grains && p.has("walls") && p.run.driver == "quasi-static" &&
      p.walls.action == "press")
  {
    if (p.follows_events())
      knobs.emplace_back("balance tolerance");
    else if (p.walls.steps_and_relaxes())
      knobs.insert(knobs.end(), {"load step", "relaxation tolerance"});
    else
      knobs.emplace_back(is_test ? "loading rate of a specimen"
                                 : "loading rate of a layer");
  }
  if (p.is_bridged())
    knobs.insert(knobs.end(), {"cells beside grains", "overlap", "buffer"});
  if (p.has_layer_mesh() && !p.run.steps_in_time() && p.matrix.cell_aspect == 1. &&
      p.matrix.refinement_rounds == 0)
    knobs.emplace_back(p.matrix.element_degree == 2 ? "quadratic cells"
                                                    : "bilinear cells");
  return knobs;
}

/// Cells of a layer of finite elements are recorded over its thickness, and entered over
/// the diameter of grains that are not there.
void measure_in_diameters(const Parameters &p, AccuracyCurve &curve)
{
  for (AccuracyCurve::Row &row : curve.rows)
  {
    double over_thickness = 0.;
    parse_number(row.value, over_thickness);
    row.value = exact_text(over_thickness * p.layer.grains_across);
  }
}

/// Runs to a peak take grains times steps, which rise as n^2 and n; the record of grains
/// is of solves.
void price_in_steps(AccuracyCurve &curve)
{
  for (AccuracyCurve::Row &row : curve.rows)
  {
    double across = 0.;
    parse_number(row.value, across);
    row.seconds = across * across * across;
  }
}

/// Rows that the deck's other entries have no room for are not offered.
void leave_out_what_does_not_fit(const Parameters &p,
                                 const std::string &knob,
                                 AccuracyCurve &curve)
{
  double least = 0., most = 1e300;
  if (knob == "cells beside grains")
  {
    least = p.bridging.multipliers == "mesh" ? 1.5 : 0.;
    most = std::min(p.matrix.largest_cell, std::max(p.bridging.overlap, 4.));
  }
  else if (knob == "overlap")
    least = std::max(4., p.matrix.cell_size);
  else if (knob.find("cells") != std::string::npos)
    most = p.matrix.largest_cell;
  const auto does_not_fit = [&](const AccuracyCurve::Row &row)
  {
    double x = 0.;
    parse_number(row.value, x);
    return x < least || x > most;
  };
  curve.rows.erase(std::remove_if(curve.rows.begin(), curve.rows.end(), does_not_fit),
                   curve.rows.end());
}

/// What the struct has for an entry of the record.
std::string value_of(const Parameters &p, const std::string &entry)
{
  const std::array<std::pair<const char *, double>, 8> values = {
      {{"Layer/Grains across", p.layer.grains_across},
       {"Walls/Transits per millistrain", p.walls.transits_per_millistrain},
       {"Walls/Load step", p.walls.load_step},
       {"Walls/Relaxation tolerance", p.walls.relaxation_tolerance},
       {"Walls/Balance tolerance", p.walls.balance_tolerance},
       {"Matrix/Cell size ratio", p.matrix.cell_size},
       {"Bridging domain/Overlap width ratio", p.bridging.overlap},
       {"Bridging domain/Buffer width ratio", p.bridging.buffer}}};
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const auto &pair) { return pair.first == entry; });
  return exact_text(found->second);
}

double seconds_of(const Curves &curves, const std::vector<std::size_t> &rows)
{
  double product = 1.;
  for (std::size_t k = 0; k < curves.size(); ++k)
    product *= curves[k].rows[rows[k]].seconds;
  return product;
}

/// What other errors take of a scene in which all is free.
std::vector<AccuracyAlternative> alternatives_to(const double wanted,
                                                 const Curves &curves)
{
  std::vector<std::size_t> here = choose_rows(curves, wanted);
  if (here.empty())
    here.assign(curves.size(), 0);
  std::vector<AccuracyAlternative> alternatives;
  for (const double error : {0.2, 0.1, 0.05, 0.02, 0.01})
  {
    AccuracyAlternative other;
    other.wanted = error;
    const std::vector<std::size_t> rows = choose_rows(curves, error);
    for (std::size_t k = 0; k < rows.size(); ++k)
      other.values.emplace_back(curves[k].entry, curves[k].rows[rows[k]].value);
    if (!rows.empty())
      other.relative_seconds = seconds_of(curves, rows) / seconds_of(curves, here);
    alternatives.push_back(other);
  }
  return alternatives;
}

/// The scatter of peaks belongs to a scene whose grains may break on its way.
std::optional<double> scatter_of_packings(const Parameters &p, const AccuracyPlan &plan)
{
  if (p.layer.representation != "grains" || !p.layer.joint.breakable ||
      !p.run.steps_in_time())
    return std::nullopt;
  double across = p.layer.grains_across;
  for (const AccuracySetting &setting : plan.settings)
    if (setting.entry == "Layer/Grains across")
      parse_number(setting.value, across);
  return packing_scatter(across);
}

std::string percent_text(const double share)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100. * share);
  return text;
}

/// The curves of a scene. What the deck gives is a single row among the open ones: its
/// error counts, and nothing can be done about it.
struct Ways
{
  Curves open; ///< with the deck's entries as they are; without those of unknown error
  Curves all;  ///< as if the deck gave none of them
};

/// @p curves have it.
std::size_t place_of(const Curves &curves, const std::string &entry)
{
  std::size_t k = 0;
  while (curves[k].entry != entry)
    ++k;
  return k;
}

/// How slender the scene is, for those knobs whose error grows with it: a long layer
/// bends slowly, and walls that a stout one follows drive it on. 0: it does not matter.
double slenderness_of(const Parameters &p, const std::string &knob)
{
  const bool is_of_loading = knob.find("loading rate") == 0 || knob == "load step" ||
                             knob.find(" tolerance") != std::string::npos;
  return is_of_loading ? p.layer_length() / p.layer.thickness : 0.;
}

std::string why_unknown(const Parameters &p,
                        const std::string &knob,
                        const AccuracyCurve &curve)
{
  if (curve.rows.empty())
    return "the record has no layer as slender as this one, L/h = " +
           short_text(slenderness_of(p, knob)) +
           ", so nothing is chosen and no error counted. Compare two values yourself" +
           (curve.entry == "Walls/Transits per millistrain"
                ? ", or take 'Walls/Loading = event driver', which knows no rate."
                : ".");
  return "outside of the record, which goes from " + curve.rows.front().value + " to " +
         curve.rows.back().value + ", so no error is counted.";
}

/// The setting as it stands before the choice; adds its curves to @p ways.
AccuracySetting setting_of(const Parameters &p,
                           const std::string &knob,
                           const std::set<std::string> &given,
                           Ways &ways)
{
  AccuracyCurve curve = accuracy_curve(knob, slenderness_of(p, knob));
  if (p.has_layer_mesh())
    measure_in_diameters(p, curve);
  if (curve.entry == "Layer/Grains across" && p.run.steps_in_time())
    price_in_steps(curve);
  AccuracySetting setting;
  setting.entry = curve.entry;
  setting.value = value_of(p, curve.entry);
  setting.is_given = given.count(curve.entry) > 0;
  setting.of = curve.of;
  setting.truth = curve.truth;
  setting.error = error_of(curve, setting.value);
  if (!setting.error)
    setting.why_unknown = why_unknown(p, knob, curve);
  leave_out_what_does_not_fit(p, knob, curve);
  if (!curve.rows.empty())
  {
    setting.is_chosen = !setting.is_given;
    ways.all.push_back(curve);
  }
  if (!setting.is_chosen && setting.error)
    curve.rows = {{setting.value, *setting.error, 1.}};
  if (setting.is_chosen || setting.error)
    ways.open.push_back(curve);
  return setting;
}

double smallest_of(const Curves &curves)
{
  double finest = 0.;
  for (const AccuracyCurve &curve : curves)
    finest += curve.rows.back().error;
  return finest;
}

/// Up to the next tenth of a percent, so that what is said can be had.
std::string tenths_text(const double share)
{
  return short_text(std::ceil(share * 1e3) * 0.1) + " %";
}

/// Why no choice is near enough, and which of the deck's entries stand in its way.
std::string smallest_in_words(const AccuracyPlan &plan, const Ways &ways)
{
  std::string entries, said, other;
  Curves freed = ways.open;
  for (const AccuracyCurve &curve : ways.all)
  {
    if (curve.entry == "Walls/Transits per millistrain")
      other = " 'Walls/Loading = event driver' has no rate that would count.";
    const auto setting = std::find_if(plan.settings.begin(), plan.settings.end(),
                                      [&](const AccuracySetting &one)
                                      { return one.entry == curve.entry; });
    if (setting->is_chosen || !setting->error ||
        *setting->error <= curve.rows.back().error)
      continue;
    freed[place_of(freed, curve.entry)] = curve;
    entries += (entries.empty() ? "'" : " and '") + curve.entry + "'";
    said += (said.empty() ? "'" : ", '") + curve.entry + "' = " + setting->value +
            " is off by " + percent_text(*setting->error);
  }
  if (entries.empty())
    return "smaller than any that has been measured of a scene like this. The smallest "
           "possible is " +
           tenths_text(smallest_of(ways.open)) +
           ", with all of docs/accuracy.md at its finest. Give that or more, or leave it "
           "out and give the resolution yourself." +
           other;
  return "smaller than the deck's other entries let it be: " + said +
         ". The smallest possible is " + tenths_text(smallest_of(ways.open)) +
         ", with the rest of docs/accuracy.md at its finest. Give that or more, or "
         "leave " +
         entries + " out of the deck to be chosen (then " +
         tenths_text(smallest_of(freed)) + " is possible)." + other;
}
} // namespace

AccuracyPlan plan_accuracy(const Parameters &p,
                           const std::set<std::string> &given,
                           std::string &problem)
{
  AccuracyPlan plan;
  plan.percent = p.accuracy.percent;
  Ways ways;
  for (const std::string &knob : knobs_of(p))
    plan.settings.push_back(setting_of(p, knob, given, ways));
  const std::vector<std::size_t> rows = choose_rows(ways.open, 0.01 * plan.percent);
  if (plan.settings.empty())
    problem = "the record has nothing of this scene: neither grains that are pressed or "
              "buckle nor square cells that are not refined. Leave it out, and see "
              "docs/accuracy.md.";
  else if (rows.size() < ways.open.size())
    problem = smallest_in_words(plan, ways);
  if (!problem.empty())
    return plan;
  for (AccuracySetting &setting : plan.settings)
    if (setting.is_chosen)
    {
      const std::size_t k = place_of(ways.open, setting.entry);
      setting.value = ways.open[k].rows[rows[k]].value;
      setting.error = ways.open[k].rows[rows[k]].error;
    }
  plan.alternatives = alternatives_to(0.01 * plan.percent, ways.all);
  plan.packing_scatter = scatter_of_packings(p, plan);
  return plan;
}

std::string accuracy_json(const AccuracyPlan &plan)
{
  using Json = nlohmann::ordered_json;
  Json json;
  json["wanted_percent"] = plan.percent;
  json["sum_percent"] = 100. * plan.sum_of_errors();
  json["packing_scatter_percent"] =
      plan.packing_scatter ? Json(100. * *plan.packing_scatter) : Json();
  json["settings"] = Json::array();
  for (const AccuracySetting &setting : plan.settings)
    json["settings"].push_back(
        {{"entry", setting.entry},
         {"value", setting.value},
         {"chosen", setting.is_chosen},
         {"given", setting.is_given},
         {"error_percent", setting.error ? Json(100. * *setting.error) : Json()},
         {"of", setting.of},
         {"truth", setting.truth}});
  json["warnings"] = plan.warnings();
  json["alternatives"] = Json::array();
  for (const AccuracyAlternative &other : plan.alternatives)
  {
    json["alternatives"].push_back({{"wanted_percent", 100. * other.wanted},
                                    {"values", Json::object()},
                                    {"relative_seconds", other.relative_seconds}});
    for (const auto &[entry, value] : other.values)
      json["alternatives"].back()["values"][entry] = value;
  }
  return json.dump();
}

std::vector<std::string> accuracy_in_words(const AccuracyPlan &plan)
{
  if (plan.percent == 0.)
    return {};
  std::vector<std::string> lines = {"Accuracy: " + exact_text(plan.percent) +
                                    " % wanted, by the record in docs/accuracy.md"};
  for (const AccuracySetting &setting : plan.settings)
  {
    char text[256];
    std::snprintf(text, sizeof text, "  %-36s %-8s %-10s %s", setting.entry.c_str(),
                  setting.value.c_str(),
                  setting.is_chosen  ? "chosen"
                  : setting.is_given ? "the deck's"
                                     : "the default",
                  setting.error ? (percent_text(*setting.error) + " of the " +
                                   setting.of + ", against " + setting.truth)
                                      .c_str()
                                : "not known");
    lines.emplace_back(text);
  }
  const std::vector<std::string> unknown = plan.warnings();
  lines.push_back("  together at most " + percent_text(plan.sum_of_errors()) +
                  (unknown.empty() ? "" : ", but for what no error is known of"));
  for (const std::string &text : unknown)
    lines.push_back("  warning: " + text);
  if (plan.packing_scatter)
    lines.push_back("  one packing's peak is off the mean of many by " +
                    percent_text(*plan.packing_scatter) +
                    " besides, whatever the settings: run several seeds");
  return lines;
}
} // namespace antiform::cases

#include "cases/strength_envelope.h"

#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/parameters.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <ostream>
#include <sstream>

namespace antiform::cases
{
namespace
{
using Json = nlohmann::ordered_json;

struct Line
{
  double intercept = 0., slope = 0., correlation = 0.;
};

/// Least squares of y over sigma_3.
Line fit_line(const std::vector<StrengthPoint> &points,
              const std::function<double(const StrengthPoint &)> &y)
{
  const double n = static_cast<double>(points.size());
  double mean_x = 0., mean_y = 0.;
  for (const StrengthPoint &point : points)
  {
    mean_x += point.sigma3 / n;
    mean_y += y(point) / n;
  }
  double xx = 0., xy = 0., yy = 0.;
  for (const StrengthPoint &point : points)
  {
    const double dx = point.sigma3 - mean_x, dy = y(point) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  if (!(xx > 0.))
    throw std::invalid_argument("an envelope needs tests at two confinements at least");
  const double slope = xy / xx;
  return {mean_y - slope * mean_x, slope, yy > 0. ? xy / std::sqrt(xx * yy) : 1.};
}
} // namespace

MohrCoulombFit fit_mohr_coulomb(const std::vector<StrengthPoint> &points)
{
  const Line line = fit_line(points, [](const StrengthPoint &p) { return p.sigma1; });
  if (!(line.slope > 0.) || !(line.intercept > 0.))
    throw std::invalid_argument("the Mohr-Coulomb line falls, or begins below 0: sigma_1 "
                                "= UCS + N sigma_3 with N > 0 and UCS > 0 does not fit");
  MohrCoulombFit fit;
  fit.ucs = line.intercept;
  fit.slope = line.slope;
  fit.correlation = line.correlation;
  fit.cohesion = fit.ucs / (2. * std::sqrt(fit.slope));
  fit.friction_angle = std::asin((fit.slope - 1.) / (fit.slope + 1.));
  return fit;
}

HoekBrownFit fit_hoek_brown(const std::vector<StrengthPoint> &points)
{
  const Line line = fit_line(points,
                             [](const StrengthPoint &p)
                             {
                               const double difference = p.sigma1 - p.sigma3;
                               return difference * difference;
                             });
  if (!(line.intercept > 0.))
    throw std::invalid_argument("the Hoek-Brown line begins below 0: no UCS fits");
  HoekBrownFit fit;
  fit.sigma_ci = std::sqrt(line.intercept);
  fit.mi = line.slope / fit.sigma_ci;
  fit.tensile_strength = 0.5 * fit.sigma_ci * (std::sqrt(fit.mi * fit.mi + 4.) - fit.mi);
  fit.correlation = line.correlation;
  return fit;
}

namespace
{
using Groups = StrengthTable;

std::vector<std::string> split(const std::string &line)
{
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    cells.push_back(tidy(cell));
  return cells;
}

void read_table(const std::string &file,
                Groups &groups,
                std::vector<std::string> &problems)
{
  std::ifstream input(file);
  if (!input)
  {
    problems.push_back("'" + file + "' cannot be opened. Give a table that exists.");
    return;
  }
  std::vector<std::string> names;
  std::string line;
  int number = 0;
  while (std::getline(input, line))
  {
    ++number;
    if (tidy(line).empty() || line[0] == '#')
      continue;
    const std::vector<std::string> cells = split(line);
    if (names.empty())
    {
      names = cells;
      for (const char *name : {"sigma3_MPa", "sigma1_MPa"})
        if (std::find(names.begin(), names.end(), name) == names.end())
          problems.push_back(file + ":" + std::to_string(number) + ": no column '" +
                             name + "'. The first line names the columns.");
      if (!problems.empty())
        return;
      continue;
    }
    std::string group = file;
    StrengthPoint point;
    for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k)
    {
      double value = 0.;
      if (names[k] == "site")
        group = cells[k];
      else if (names[k] == "sigma3_MPa" || names[k] == "sigma1_MPa")
      {
        if (!parse_number(cells[k], value))
          problems.push_back(file + ":" + std::to_string(number) + ": '" + cells[k] +
                             "' is not a number [MPa].");
        (names[k] == "sigma3_MPa" ? point.sigma3 : point.sigma1) = 1e6 * value;
      }
    }
    groups[group].push_back(point);
  }
}

void read_run(const std::string &directory,
              Groups &groups,
              std::vector<std::string> &problems)
{
  const std::string file = directory + "/summary.json";
  std::ifstream input(file);
  const Json summary = Json::parse(input, nullptr, false);
  if (!input.is_open() || summary.is_discarded())
    problems.push_back("'" + file +
                       "' cannot be read. Give the directory of a finished "
                       "run of cases/laboratory.");
  else if (summary.value("status", "") != "completed")
    problems.push_back("'" + file + "': the run is " + summary.value("status", "broken") +
                       ". Let it finish with --resume.");
  else if (const Json &results = summary["results"];
           results.contains("tensile_strength")) // sigma_1 = 0 there
    groups["runs"].push_back({-results["tensile_strength"]["value"].get<double>(), 0.});
  else if (results.contains("confining_pressure") && results.contains("peak_stress"))
    groups["runs"].push_back({results["confining_pressure"]["value"].get<double>(),
                              results["peak_stress"]["value"].get<double>()});
  else
    problems.push_back("'" + file +
                       "' is of no laboratory test: it has neither "
                       "confining_pressure nor tensile_strength.");
}

} // namespace

StrengthTable read_strength_table(const std::string &file,
                                  std::vector<std::string> &problems)
{
  StrengthTable table;
  read_table(file, table, problems);
  return table;
}

namespace
{
Json envelope_of(const std::vector<StrengthPoint> &points)
{
  // Tension tests are listed, and left out of the lines, which are those of compression.
  std::vector<StrengthPoint> pressed;
  Json json;
  json["tests"] = Json::array();
  for (const StrengthPoint &point : points)
  {
    json["tests"].push_back({{"sigma3_Pa", point.sigma3}, {"sigma1_Pa", point.sigma1}});
    if (point.sigma3 >= 0.)
      pressed.push_back(point);
  }
  const MohrCoulombFit coulomb = fit_mohr_coulomb(pressed);
  const HoekBrownFit hoek = fit_hoek_brown(pressed);
  json["mohr_coulomb_ucs"] = {{"value", coulomb.ucs}, {"unit", "Pa"}};
  json["cohesion"] = {{"value", coulomb.cohesion}, {"unit", "Pa"}};
  json["friction_angle"] = {{"value", coulomb.friction_angle * 180. / M_PI},
                            {"unit", "deg"}};
  json["mohr_coulomb_r"] = {{"value", coulomb.correlation}, {"unit", "-"}};
  json["hoek_brown_sigma_ci"] = {{"value", hoek.sigma_ci}, {"unit", "Pa"}};
  json["hoek_brown_mi"] = {{"value", hoek.mi}, {"unit", "-"}};
  json["hoek_brown_tensile_strength"] = {{"value", hoek.tensile_strength},
                                         {"unit", "Pa"}};
  json["hoek_brown_r"] = {{"value", hoek.correlation}, {"unit", "-"}};
  return json;
}

void print_group(const std::string &name, const Json &envelope, std::ostream &out)
{
  char text[128];
  out << name << "\n   sigma_3 (MPa)  sigma_1 (MPa), compression positive\n";
  for (const Json &test : envelope["tests"])
  {
    std::snprintf(text, sizeof text, "  %14.4g %14.4g\n",
                  1e-6 * test["sigma3_Pa"].get<double>(),
                  1e-6 * test["sigma1_Pa"].get<double>());
    out << text;
  }
  for (const auto &[entry, result] : envelope.items())
    if (entry != "tests")
    {
      const std::string unit = result["unit"];
      const double value = result["value"];
      std::snprintf(text, sizeof text, "  %-28s %12.5g %s\n", entry.c_str(),
                    unit == "Pa" ? 1e-6 * value : value,
                    unit == "Pa" ? "MPa" : unit.c_str());
      out << text;
    }
}
} // namespace

int print_envelopes(const std::vector<std::string> &sources,
                    const bool json,
                    std::ostream &out)
{
  Groups groups;
  std::vector<std::string> problems;
  for (const std::string &source : sources)
    if (source.size() > 4 && source.substr(source.size() - 4) == ".csv")
      read_table(source, groups, problems);
    else
      read_run(source, groups, problems);
  Json all;
  for (const auto &[name, points] : groups)
    try
    {
      all[name] = envelope_of(points);
    }
    catch (const std::invalid_argument &error)
    {
      problems.push_back(name + ": " + error.what() + ".");
    }
  if (!problems.empty())
    throw InputError(problems);
  if (json)
    out << all.dump(2) << '\n';
  else
    for (const auto &[name, envelope] : all.items())
      print_group(name, envelope, out);
  return 0;
}
} // namespace antiform::cases

#include "cases/fracture_list.h"

#include "cases/deck_reader.h"
#include "discrete/packing.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace antiform::cases
{
using namespace discrete;

namespace
{
constexpr double degree = M_PI / 180.;

std::vector<std::string> split(const std::string &line, const char separator)
{
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, separator);)
    parts.push_back(tidy(part));
  return parts;
}

const std::vector<std::string> &columns()
{
  static const std::vector<std::string> names = {
      "x1_m",        "y1_m",    "x2_m", "y2_m", "friction_angle_deg", "dilation_angle_deg",
      "cohesion_Pa", "tensile_strength_Pa", "dip_deg"};
  return names;
}

/// Numbers of a line by their column; empty cells are left out.
using Row = std::map<std::string, double>;

/// Angle between two directions without a sense, in [0, 90] [degrees].
double between(const double a, const double b)
{
  const double difference = std::abs(std::remainder(a - b, 180.));
  return std::min(difference, 180. - difference);
}

/// \return what is wrong, or nothing
std::string make_fracture(const Row &row, const SmoothJoint &law, Fracture &fracture)
{
  for (const char *name : {"x1_m", "y1_m", "x2_m", "y2_m"})
    if (row.count(name) == 0)
      return std::string("has no ") + name;
  fracture.begin = {row.at("x1_m"), row.at("y1_m")};
  fracture.end = {row.at("x2_m"), row.at("y2_m")};
  fracture.law = law;
  if (!(fracture.length() > 0.))
    return "has both tips at one place";
  const auto take = [&](const char *name, double &value, const bool angle)
  {
    if (const auto found = row.find(name); found != row.end())
      value = angle ? std::tan(found->second * degree) : found->second;
  };
  for (const auto &[name, value] : row)
    if (name.find("angle") != std::string::npos && !(value >= 0. && value < 90.))
      return name + " must be at least 0 and below 90";
  take("friction_angle_deg", fracture.law.friction, true);
  take("dilation_angle_deg", fracture.law.tan_dilation, true);
  take("cohesion_Pa", fracture.law.cohesion, false);
  take("tensile_strength_Pa", fracture.law.tensile_strength, false);
  if (row.count("cohesion_Pa") + row.count("tensile_strength_Pa") > 0)
    fracture.law.bonded =
        fracture.law.cohesion > 0. || fracture.law.tensile_strength > 0.;
  if (fracture.law.cohesion < 0. || fracture.law.tensile_strength < 0.)
    return "has a strength below 0";
  if (fracture.law.tan_dilation > fracture.law.friction)
    return "dilates by more than its friction angle: sliding would make energy";
  if (row.count("dip_deg") > 0)
  {
    const Vec2 along = fracture.end - fracture.begin;
    const double dip = std::atan2(along.y, along.x) / degree;
    // A dip has no sense of its own in a section: either way down is accepted.
    if (std::min(between(row.at("dip_deg"), dip), between(-row.at("dip_deg"), dip)) > 1.)
      return "has a dip that is not that of its end points";
  }
  return {};
}
} // namespace

std::vector<Fracture> read_fracture_table(const std::string &file,
                                          const SmoothJoint &law,
                                          std::vector<std::string> &problems)
{
  std::vector<Fracture> fractures;
  std::ifstream input(file);
  if (!input)
  {
    problems.push_back("'" + file + "' cannot be opened. Give a table that exists.");
    return fractures;
  }
  std::vector<std::string> names;
  std::string line;
  for (int number = 1; std::getline(input, line); ++number)
  {
    if (tidy(line).empty() || line[0] == '#')
      continue;
    const std::string place = file + ":" + std::to_string(number) + ": ";
    const std::vector<std::string> cells = split(line, ',');
    if (names.empty())
    {
      names = cells;
      for (const std::string &name : names)
        if (std::find(columns().begin(), columns().end(), name) == columns().end())
        {
          std::string all;
          for (const std::string &column : columns())
            all += (all.empty() ? "" : ", ") + column;
          problems.push_back(place + "'" + name + "' is no column of fractures. There are " +
                             all + ".");
          return fractures;
        }
      continue;
    }
    Row row;
    bool numbers = true;
    for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k)
      if (double value = 0.; !cells[k].empty())
      {
        if (parse_number(cells[k], value))
          row[names[k]] = value;
        else
        {
          problems.push_back(place + "'" + cells[k] + "' is not a number.");
          numbers = false;
        }
      }
    Fracture fracture;
    if (!numbers)
      continue;
    if (const std::string wrong = make_fracture(row, law, fracture); wrong.empty())
      fractures.push_back(fracture);
    else
      problems.push_back(place + "the fracture " + wrong + ".");
  }
  if (names.empty())
    problems.push_back("'" + file + "' has no line. The first names the columns.");
  return fractures;
}

namespace
{
/// The deck's own list, "x1 y1 x2 y2; x1 y1 x2 y2".
std::vector<Fracture> listed_fractures(const FracturesParameters &p, std::string &wrong)
{
  std::vector<Fracture> fractures;
  for (const std::string &part : split(p.list, ';'))
  {
    if (part.empty())
      continue;
    std::istringstream words(part);
    std::vector<double> numbers;
    for (std::string word; words >> word;)
      if (double value = 0.; parse_number(word, value))
        numbers.push_back(value);
      else
        wrong = "'" + word + "' is not a number";
    if (wrong.empty() && numbers.size() != 4)
      wrong = "'" + part + "' are not the four coordinates of two tips";
    if (!wrong.empty())
      return {};
    fractures.push_back({{numbers[0], numbers[1]}, {numbers[2], numbers[3]}, p.law});
    if (!(fractures.back().length() > 0.))
      wrong = "'" + part + "' has both tips at one place";
  }
  return fractures;
}

/// Entry @p k of a list that holds one number for all sets, or one for each.
double of_set(const std::vector<double> &numbers, const std::size_t k)
{
  return numbers.size() == 1 ? numbers.front() : numbers.at(k);
}

FractureSet fracture_set(const FracturesParameters &p, const std::size_t k)
{
  FractureSet set;
  set.intensity = p.intensity[k];
  set.orientation = of_set(p.orientation, k) * degree;
  set.angle_deviation = of_set(p.orientation_deviation, k) * degree;
  using Form = LengthDistribution::Form;
  set.length.form = p.length_law == "constant"      ? Form::constant
                    : p.length_law == "exponential" ? Form::exponential
                    : p.length_law == "lognormal"   ? Form::lognormal
                                                    : Form::power_law;
  set.length.mean = of_set(p.mean_length, k);
  set.length.deviation = of_set(p.length_deviation, k);
  set.length.exponent = of_set(p.length_exponent, k);
  set.length.least = of_set(p.shortest, k);
  if (const double largest = of_set(p.longest, k); largest > 0.)
    set.length.largest = largest;
  set.law = p.law;
  return set;
}

ParallelSet
parallel_set(const FracturesParameters &p, const std::size_t k, const double thickness)
{
  return {of_set(p.orientation, k) * degree, p.spacing_ratio[k] * thickness,
          of_set(p.phase, k), p.law};
}

/// Sets of either kind: how many numbers each list has, and how close parallel ones lie.
void check_sets(const Parameters &p, std::vector<Finding> &findings)
{
  const FracturesParameters &f = p.fractures;
  if (!f.intensity.empty() && !f.spacing_ratio.empty())
    findings.push_back({{"Fractures/Intensity", "Fractures/Spacing ratio"},
                        "sets are drawn or parallel, not both: 'Orientation' belongs to "
                        "one kind. Give one of the two; others may be in a list or "
                        "table."});
  const std::string kind = f.intensity.empty() ? "Spacing ratio" : "Intensity";
  const std::size_t n = f.n_sets();
  for (const auto &[name, numbers] :
       {std::pair{"Orientation", &f.orientation},
        std::pair{"Orientation deviation", &f.orientation_deviation},
        std::pair{"Phase", &f.phase}, std::pair{"Mean length", &f.mean_length},
        std::pair{"Length deviation", &f.length_deviation},
        std::pair{"Length exponent", &f.length_exponent},
        std::pair{"Shortest", &f.shortest}, std::pair{"Longest", &f.longest}})
    if (n > 0 && numbers->size() != 1 && numbers->size() != n)
      findings.push_back({{std::string("Fractures/") + name, "Fractures/" + kind},
                          "give one number for all sets, or as many as there are sets (" +
                              std::to_string(n) + ")."});
  constexpr double fewest = 2.; // grains between two planes: else no joint is left whole
  for (const double ratio : f.spacing_ratio)
    if (ratio * p.layer.thickness < fewest * p.grain_diameter())
    {
      findings.push_back({{"Fractures/Spacing ratio", "Layer/Grains across"},
                          "a spacing of " + short_text(ratio) +
                              " h is less than two grain diameters: nothing would be left "
                              "between the fractures. Give more of either."});
      break;
    }
}
} // namespace

namespace
{
std::vector<Vec2> section_outline(const SectionGeometry &geometry)
{
  return {{geometry.x_min(), geometry.base()},
          {geometry.x_max(), geometry.base()},
          {geometry.x_max(), geometry.surface()},
          {geometry.x_min(), geometry.surface()}};
}

/// Where the sets lie.
std::vector<Vec2> region_of_sets(const Parameters &p, const SectionGeometry &geometry)
{
  return p.fractures.region == "section" ? section_outline(geometry)
                                         : geometry.layer_outline();
}

FractureTraces traces_inside(const std::vector<Vec2> &polygon,
                             const std::vector<Fracture> &fractures)
{
  FractureTraces traces;
  for (const Fracture &one : fractures)
    if (const double inside = length_inside(polygon, one.begin, one.end); inside > 0.)
    {
      ++traces.number;
      traces.length += inside;
    }
  traces.intensity = traces.length / area(polygon);
  return traces;
}
} // namespace

std::vector<Fracture> make_fractures(const Parameters &p, const SectionGeometry &geometry)
{
  const FracturesParameters &f = p.fractures;
  std::string wrong;
  std::vector<Fracture> fractures = listed_fractures(f, wrong);
  std::vector<std::string> problems;
  if (!f.table.empty())
    for (const Fracture &one : read_fracture_table(f.table, f.law, problems))
      fractures.push_back(one);
  const std::vector<Vec2> region = region_of_sets(p, geometry);
  for (std::size_t k = 0; k < f.intensity.size(); ++k)
    try
    {
      for (const Fracture &one : draw_fractures(
               region, fracture_set(f, k), static_cast<std::uint64_t>(f.seed) + 1000 * k))
        fractures.push_back(one);
    }
    catch (const std::invalid_argument &error)
    {
      problems.push_back("set " + std::to_string(k + 1) + ": " + error.what() + ".");
    }
  if (!problems.empty())
    throw InputError(problems);
  for (std::size_t k = 0; k < f.spacing_ratio.size(); ++k)
    for (const Fracture &one :
         parallel_fractures(region, parallel_set(f, k, geometry.thickness())))
      fractures.push_back(one);
  return fractures;
}

FractureTraces traces_in_layer(const std::vector<Fracture> &fractures,
                               const SectionGeometry &geometry)
{
  return traces_inside(geometry.layer_outline(), fractures);
}

void check_fractures(const Parameters &p, std::vector<Finding> &findings)
{
  const FracturesParameters &f = p.fractures;
  if (p.layer.representation != "grains")
  {
    findings.push_back({{"Components", "Layer/Representation"},
                        "fractures are laid into grains. Give grains, or leave fractures "
                        "out."});
    return;
  }
  if (!p.run.steps_in_time())
    findings.push_back({{"Components", "Run/Driver"},
                        "fractures slide, which the static driver cannot follow. Give "
                        "quasi-static."});
  if (p.has("gravity") || p.has("surface pressure"))
    findings.push_back({{"Components"},
                        "a section with fractures cannot be prestressed in this version. "
                        "Leave out gravity and surface pressure, or fractures."});
  if (p.layer.bond_model != "flat joint")
    findings.push_back({{"Components", "Layer/Bond model"},
                        "fractures need flat joints around them in this version. Give "
                        "flat joint."});
  if (f.list.empty() && f.table.empty() && f.n_sets() == 0)
    findings.push_back({{"Fractures/List", "Fractures/Table", "Fractures/Intensity",
                         "Fractures/Spacing ratio"},
                        "but fractures are listed in 'Components', and there are none. "
                        "Give one of the four, or leave fractures out."});
  std::string wrong;
  listed_fractures(f, wrong);
  if (!wrong.empty())
    findings.push_back({{"Fractures/List"},
                        wrong + ". Give x1 y1 x2 y2 of each [m], separated by semicolons."});
  std::vector<std::string> problems;
  if (!f.table.empty())
    read_fracture_table(f.table, f.law, problems);
  for (const std::string &problem : problems)
    findings.push_back({{"Fractures/Table"}, problem});
  if (f.law.tan_dilation > f.law.friction)
    findings.push_back({{"Fractures/Dilation angle", "Fractures/Friction angle"},
                        "a fracture that dilates by more than its friction angle makes "
                        "energy when it slides. Give a smaller dilation angle."});
  check_sets(p, findings);
}

namespace
{
/// Width of @p polygon across the traces of a set [m].
double width_across(const std::vector<Vec2> &polygon, const double orientation)
{
  const Vec2 across{-std::sin(orientation), std::cos(orientation)};
  double least = HUGE_VAL, greatest = -HUGE_VAL;
  for (const Vec2 &point : polygon)
  {
    least = std::min(least, dot(point, across));
    greatest = std::max(greatest, dot(point, across));
  }
  return greatest - least;
}

/// Sets so far apart that none of their traces lies in the region.
void check_empty_sets(const Parameters &p,
                      const SectionGeometry &geometry,
                      std::vector<Finding> &findings)
{
  const std::vector<Vec2> region = region_of_sets(p, geometry);
  for (std::size_t k = 0; k < p.fractures.spacing_ratio.size(); ++k)
  {
    const ParallelSet set = parallel_set(p.fractures, k, geometry.thickness());
    if (!parallel_fractures(region, set).empty())
      continue;
    const double width = width_across(region, set.orientation) / geometry.thickness();
    findings.push_back(
        {{"Fractures/Spacing ratio", "Fractures/Phase", "Fractures/Orientation"},
         "a spacing of " + short_text(p.fractures.spacing_ratio[k]) +
             " h leaves no fracture in the " + p.fractures.region + ", which is " +
             short_text(width) +
             " h wide across the traces. Give less than that, or another phase."});
  }
}

/// Fractures that all lie beside the grains that they were to part.
void check_missing_traces(const Parameters &p,
                          const SectionGeometry &geometry,
                          const std::vector<Fracture> &fractures,
                          std::vector<Finding> &findings)
{
  const FracturesParameters &f = p.fractures;
  const bool has_matrix_grains = p.has("matrix") && !p.has_surface_interface();
  const FractureTraces traces = traces_inside(
      has_matrix_grains ? section_outline(geometry) : geometry.layer_outline(),
      fractures);
  if (traces.length >= geometry.diameter())
    return;
  const std::string entry = !f.list.empty()        ? "List"
                            : !f.table.empty()     ? "Table"
                            : !f.intensity.empty() ? "Intensity"
                                                   : "Spacing ratio";
  findings.push_back(
      {{"Fractures/" + entry},
       "there are " + short_text(traces.length) +
           " m of traces in the grains, and a grain measures " +
           short_text(geometry.diameter()) +
           " m: nothing would be parted. Give fractures in the layer, x = " +
           short_text(geometry.x_min()) + " to " + short_text(geometry.x_max()) +
           " m and y = " + short_text(geometry.layer_bottom(geometry.x_min())) + " to " +
           short_text(geometry.layer_top(0.)) + " m, or leave fractures out."});
}
} // namespace

void check_drawn_fractures(const Parameters &p, std::vector<Finding> &findings)
{
  try
  {
    const SectionGeometry geometry(p);
    const std::vector<Fracture> fractures = make_fractures(p, geometry);
    check_empty_sets(p, geometry, findings);
    if (findings.empty())
      check_missing_traces(p, geometry, fractures, findings);
  }
  catch (const InputError &error)
  {
    for (const std::string &problem : error.problems())
      findings.push_back({{"Fractures/Intensity"}, problem});
  }
}
} // namespace antiform::cases

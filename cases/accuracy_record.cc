// What has been measured of error and time: cases/accuracy/record.csv.
#include "cases/accuracy.h"

#include "cases/declarations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace antiform::cases
{
extern const char *const accuracy_record_text; ///< the file, written by the build

namespace
{
using Line = std::map<std::string, std::string>; ///< column -> cell

std::vector<std::string> cells_of(const std::string &line)
{
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    cells.push_back(cell);
  return cells;
}

std::vector<Line> read_record()
{
  std::vector<Line> lines;
  std::istringstream stream(accuracy_record_text);
  std::string text;
  std::getline(stream, text);
  const std::vector<std::string> names = cells_of(text);
  while (std::getline(stream, text))
  {
    const std::vector<std::string> cells = cells_of(text);
    if (cells.empty())
      continue;
    if (cells.size() != names.size())
      throw std::logic_error(
          "cases/accuracy/record.csv: not as many cells as names in '" + text + "'");
    Line line;
    for (std::size_t k = 0; k < names.size(); ++k)
      line[names[k]] = cells[k];
    lines.push_back(line);
  }
  return lines;
}

const std::vector<Line> &record()
{
  static const std::vector<Line> lines = read_record();
  return lines;
}

double number(const Line &line, const std::string &column)
{
  double value = 0.;
  if (!parse_number(line.at(column), value))
    throw std::logic_error("cases/accuracy/record.csv: '" + line.at(column) +
                           "' is no number");
  return value;
}

/// The mean is known as well as its scatter lets it be.
double largest_error(const Line &line)
{
  return 0.01 * (std::abs(number(line, "error_percent")) +
                 number(line, "scatter_percent") / std::sqrt(number(line, "packings")));
}

/// L/h of the layers that the line speaks of, at most.
double largest_length_ratio(const Line &line)
{
  const std::string column = "largest_length_ratio";
  return line.at(column) == "any" ? std::numeric_limits<double>::infinity()
                                  : number(line, column);
}

/// The least of these in the lines of @p knob that is no less than @p length_ratio; 0:
/// none.
double stoutest_scene(const std::string &knob, const double length_ratio)
{
  double least = 0.;
  for (const Line &line : record())
    if (const double ratio = largest_length_ratio(line); line.at("knob") == knob &&
                                                         ratio >= length_ratio &&
                                                         (least == 0. || ratio < least))
      least = ratio;
  return least;
}
} // namespace

AccuracyCurve accuracy_curve(const std::string &knob, const double length_ratio)
{
  AccuracyCurve curve;
  const double scene = stoutest_scene(knob, length_ratio);
  for (const Line &line : record())
    if (line.at("knob") == knob)
    {
      curve.entry = line.at("entry");
      if (largest_length_ratio(line) != scene)
        continue;
      curve.of = line.at("of");
      curve.truth = line.at("truth");
      curve.rows.push_back(
          {line.at("value"), largest_error(line), number(line, "cpu_seconds")});
    }
  if (curve.entry.empty())
    throw std::logic_error("the record has no '" + knob + "'");
  // A coarser row is not credited with an error that a finer one does not have.
  for (std::size_t k = curve.rows.size(); k > 1; --k)
    curve.rows[k - 2].error = std::max(curve.rows[k - 2].error, curve.rows[k - 1].error);
  return curve;
}

std::optional<double> packing_scatter(const double grains_across)
{
  AccuracyCurve curve; // scatters in place of errors
  for (const Line &line : record())
    if (line.at("knob") == "grains in strength")
      curve.rows.push_back(
          {line.at("value"), 0.01 * number(line, "scatter_percent"), 0.});
  return error_of(curve, exact_text(grains_across));
}
} // namespace antiform::cases

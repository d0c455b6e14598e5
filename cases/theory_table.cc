#include "cases/theory_table.h"

#include "cases/calibrate.h"
#include "cases/closed_forms.h"
#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/study_plan.h"
#include "cases/study_tables.h"
#include "cases/theory.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace antiform::cases
{
namespace
{
constexpr double most_lines = 1e4;

/// The values that the option gives, none of them too many.
std::vector<StudyAxis> axes_of(const std::string &along)
{
  std::vector<std::string> problems;
  const std::vector<StudyAxis> axes = read_axes(along, problems);
  if (problems.empty() && n_members(axes) > most_lines)
    problems.emplace_back("has more than 10000 combinations. Give fewer values.");
  for (std::string &problem : problems)
    problem.insert(0, "--along ");
  if (!problems.empty())
    throw InputError(problems);
  return axes;
}

/// A value reaches the scene as an override, which its user has not written.
std::string in_words_of_along(const std::string &problem)
{
  const std::string option = "--set";
  return problem.compare(0, option.size(), option) == 0
             ? "--along" + problem.substr(option.size())
             : problem;
}
} // namespace

std::map<std::string, Result> theory_figures(const Parameters &p,
                                             const double friction_angle)
{
  std::map<std::string, Result> figures;
  for (const TheorySection &section : closed_forms(p, friction_angle))
    for (const TheoryRow &row : section.rows)
      for (const Quantity &q : row.quantities)
        if (row.applies && std::isfinite(q.value))
          figures["theory/" + section.name + "/" + row.name +
                  (q.name.empty() ? "" : "/" + q.name)] = {q.value, q.unit};
  return figures;
}

int print_theory_table(const std::string &file,
                       const std::vector<std::string> &overrides,
                       const TheoryOptions &options,
                       std::ostream &out)
{
  const std::vector<StudyAxis> axes = axes_of(options.along);
  const std::vector<std::string> paths = paths_of(axes);
  std::vector<std::map<std::string, Result>> lines;
  std::vector<std::string> problems;
  std::map<std::string, std::string> columns; // by the name of the figure
  const std::vector<StudyMember> members = members_of(axes);
  for (const StudyMember &member : members)
  {
    std::vector<std::string> with_values = overrides;
    for (std::size_t i = 0; i < paths.size(); ++i)
      with_values.push_back(paths[i] + "=" + member.values[i]);
    try
    {
      const Parameters p = read_deck(file, with_values);
      demand_calibration(p, false);
      lines.push_back(theory_figures(p, options.friction_angle));
      for (const auto &[name, figure] : lines.back())
        columns.insert({name, column_name(name, figure.unit)});
    }
    catch (const InputError &error)
    {
      for (const std::string &problem : error.problems())
        if (const std::string text = in_words_of_along(problem);
            std::find(problems.begin(), problems.end(), text) == problems.end())
          problems.push_back(text);
    }
  }
  if (!problems.empty())
    throw InputError(problems);
  const std::vector<std::string> names = value_columns(paths);
  for (const std::string &name : names)
    out << (&name == &names.front() ? "" : ",") << name;
  for (const auto &[name, column] : columns)
    out << ',' << column;
  out << '\n';
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    for (std::size_t i = 0; i < paths.size(); ++i)
      out << (i == 0 ? "" : ",") << csv_cell(members[k].values[i]);
    for (const auto &[name, column] : columns)
    {
      const auto figure = lines[k].find(name);
      out << ',' << (figure == lines[k].end() ? "" : exact_text(figure->second.value));
    }
    out << '\n';
  }
  return 0;
}
} // namespace antiform::cases

#include "cases/study_plan.h"

#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "coupling/state_image.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>

namespace antiform::cases
{
namespace
{
constexpr double most_values = 1e5;       // of one range
constexpr std::size_t longest_name = 100; // folders take 255 bytes

/// Split at @p separator outside of braces.
std::vector<std::string> split_outside_braces(const std::string &text,
                                              const char separator)
{
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text)
  {
    depth += c == '{' ? 1 : (c == '}' ? -1 : 0);
    if (c == separator && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string &part : parts)
    part = tidy(part);
  return parts;
}

/// Is every brace closed, in order, and none within another?
bool has_good_braces(const std::string &text)
{
  int depth = 0;
  for (const char c : text)
  {
    depth += c == '{' ? 1 : (c == '}' ? -1 : 0);
    if (depth < 0 || depth > 1)
      return false;
  }
  return depth == 0;
}

std::string rounded_text(const double number, const int digits)
{
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, number);
  return text;
}

/// The words of "1 to 5 in 9 logarithmic".
struct RangeWords
{
  double from = 0., to = 0., count = 0.;
  bool seeds = false, logarithmic = false;
};

/// False when @p words are no range; @p problem says what is wrong with one that is.
bool read_range(const std::vector<std::string> &words,
                RangeWords &range,
                std::string &problem)
{
  range.seeds = !words.empty() && words.front() == "seeds";
  const std::size_t first = range.seeds ? 1 : 0;
  const bool begins = words.size() >= first + 2 && parse_number(words[first], range.from);
  if (!range.seeds && !(begins && words[first + 1] == "to"))
    return false;
  const std::size_t n = words.size() - first;
  const bool has_ends = begins && n >= 3 && words[first + 1] == "to" &&
                        parse_number(words[first + 2], range.to);
  if (range.seeds)
  {
    range.count = range.to - range.from + 1.;
    const auto is_whole = [](const double x) { return x == std::floor(x); };
    if (!has_ends || n != 3 || !is_whole(range.from) || !is_whole(range.to) ||
        range.count < 1. || range.count > most_values)
      problem = "write seeds as 'seeds 1 to 5': whole numbers, the first not larger";
    return true;
  }
  range.logarithmic = n == 6 && words.back() == "logarithmic";
  if (!has_ends || !(n == 5 || range.logarithmic) || words[first + 3] != "in" ||
      !parse_number(words[first + 4], range.count))
    problem = "write a range as '1 to 5 in 9' or '0.01 to 100 in 9 logarithmic', the "
              "third number being that of the values";
  else if (range.count != std::floor(range.count) || range.count < 2. ||
           range.count > most_values)
    problem = "a range has a whole number of values, 2 or more";
  else if (range.from == range.to)
    problem = "the ends of a range differ";
  else if (range.logarithmic && !(range.from > 0. && range.to > 0.))
    problem = "the ends of a logarithmic range are > 0";
  return true;
}

std::vector<std::string> values_of(const RangeWords &range)
{
  std::vector<std::string> values;
  const int n = static_cast<int>(range.count);
  for (int i = 0; i < n; ++i)
  {
    const double share = n > 1 ? i / (range.count - 1.) : 0.;
    if (range.logarithmic)
      values.push_back(
          rounded_text(range.from * std::pow(range.to / range.from, share), 6));
    else if (range.seeds)
      values.push_back(rounded_text(range.from + i, 12));
    else // twelve digits: 0.3 is not 0.30000000000000004
      values.push_back(rounded_text((1. - share) * range.from + share * range.to, 12));
  }
  return values;
}

/// The values between commas.
std::vector<std::string> read_values(const std::string &text,
                                     const std::string &path,
                                     std::vector<std::string> &problems)
{
  std::vector<std::string> values;
  for (const std::string &part : split_outside_braces(text, ','))
  {
    if (part.size() >= 2 && part.front() == '{' && part.back() == '}')
    {
      values.push_back(tidy(part.substr(1, part.size() - 2)));
      continue;
    }
    std::vector<std::string> words;
    std::istringstream stream(part);
    for (std::string word; stream >> word;)
      words.push_back(word);
    RangeWords range;
    std::string problem;
    if (part.empty())
      problems.push_back("'" + path +
                         "' has no value between two commas, or none at all. Give one, "
                         "or '{}' for an empty text.");
    else if (!read_range(words, range, problem))
      values.push_back(part);
    else if (!problem.empty())
      problems.push_back("gives '" + path + "' = '" + part + "': " + problem + ".");
    else
      for (const std::string &value : values_of(range))
        values.push_back(value);
  }
  return values;
}

std::string lower_name(const std::string &text, const char blank)
{
  std::string result;
  for (const char c : text)
    result += c == ' ' || c == '/'
                  ? blank
                  : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// As a part of a file's name: letters, digits, '.', '+' and '-'; '_' for all else.
std::string file_text(const std::string &value)
{
  std::string result;
  for (const char c : value)
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '+' || c == '-')
      result += c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  return result;
}

bool all_differ(const std::vector<std::string> &values)
{
  return std::set<std::string>(values.begin(), values.end()).size() == values.size();
}

std::string checksum_of(const std::string &text)
{
  char digits[24];
  std::snprintf(
      digits, sizeof digits, "%016llx",
      static_cast<unsigned long long>(coupling::crc64(text.data(), text.size())));
  return std::string(digits).substr(8);
}

/// What is wrong with an axis as a whole.
void check_axis(const StudyAxis &axis, std::vector<std::string> &problems)
{
  for (const StudyEntry &entry : axis)
    if (entry.values.size() != axis.front().values.size())
      problems.push_back(
          "'" + axis.front().path + "' has " +
          std::to_string(axis.front().values.size()) + " values and '" + entry.path +
          "' beside it " + std::to_string(entry.values.size()) +
          ". Entries that are joined by '&' need equally many; ';' crosses "
          "them.");
}
} // namespace

std::vector<StudyAxis> read_axes(const std::string &text,
                                 std::vector<std::string> &problems)
{
  std::vector<StudyAxis> axes;
  if (!has_good_braces(text))
  {
    problems.emplace_back("a brace is not closed, is closed twice or stands within "
                          "another. Put one pair around a value.");
    return axes;
  }
  std::set<std::string> seen;
  for (const std::string &part : split_outside_braces(text, ';'))
  {
    if (part.empty())
      continue; // a ';' at the end
    StudyAxis axis;
    for (const std::string &one : split_outside_braces(part, '&'))
    {
      const std::size_t equals = one.find('=');
      const std::string path = tidy(one.substr(0, equals));
      if (equals == std::string::npos || path.empty())
      {
        problems.push_back(
            "cannot read '" + one +
            "'. Write 'Section/Entry = value, value', '&' before an entry "
            "that changes with it, ';' before one that does so by itself.");
        continue;
      }
      if (!seen.insert(path).second)
        problems.push_back("names '" + path + "' twice. Name it once.");
      axis.push_back({path, read_values(one.substr(equals + 1), path, problems)});
    }
    if (axis.empty())
      continue;
    check_axis(axis, problems);
    axes.push_back(axis);
  }
  if (axes.empty() && problems.empty())
    problems.emplace_back("names no entry. Write 'Section/Entry = value, value'.");
  return axes;
}

std::vector<std::string> paths_of(const std::vector<StudyAxis> &axes)
{
  std::vector<std::string> paths;
  for (const StudyAxis &axis : axes)
    for (const StudyEntry &entry : axis)
      paths.push_back(entry.path);
  return paths;
}

double n_members(const std::vector<StudyAxis> &axes)
{
  double n = axes.empty() ? 0. : 1.;
  for (const StudyAxis &axis : axes)
    n *= static_cast<double>(axis.front().values.size());
  return n;
}

std::vector<std::string> short_names(const std::vector<std::string> &paths,
                                     const char blank)
{
  const auto last_of = [](const std::string &path)
  {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
  };
  std::map<std::string, int> uses;
  for (const std::string &path : paths)
    ++uses[last_of(path)];
  std::vector<std::string> names;
  for (const std::string &path : paths)
    names.push_back(lower_name(uses[last_of(path)] > 1 ? path : last_of(path), blank));
  return names;
}

std::vector<StudyMember> members_of(const std::vector<StudyAxis> &axes)
{
  const std::vector<std::string> paths = paths_of(axes), names = short_names(paths, '-'),
                                 words = short_names(paths, ' ');
  std::vector<StudyMember> members(1);
  std::size_t first = 0; // of this axis' entries
  for (const StudyAxis &axis : axes)
  {
    const bool first_tells = all_differ(axis.front().values);
    std::vector<StudyMember> longer;
    for (const StudyMember &member : members)
      for (std::size_t i = 0; i < axis.front().values.size(); ++i)
      {
        StudyMember next = member;
        for (std::size_t e = 0; e < axis.size(); ++e)
        {
          next.values.push_back(axis[e].values[i]);
          if (e > 0 && first_tells)
            continue;
          const std::string &value = axis[e].values[i];
          next.name +=
              (next.name.empty() ? "" : "_") + names[first + e] + "-" + file_text(value);
          next.label += (next.label.empty() ? "" : ", ") + words[first + e] + " " + value;
        }
        longer.push_back(next);
      }
    members = longer;
    first += axis.size();
  }
  std::map<std::string, int> uses;
  for (const StudyMember &member : members)
    ++uses[member.name];
  for (StudyMember &member : members)
    if (uses[member.name] > 1 || member.name.size() > longest_name)
      member.name = member.name.substr(0, longest_name) + "-" +
                    checksum_of(join(paths, ";") + "=" + join(member.values, ";"));
  return members;
}
} // namespace antiform::cases

#include "cases/deck_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;

// Includes nest, and so do the functions that read them; a cycle is refused.
// NOLINTBEGIN(misc-no-recursion)

/// Reads one file after the other, down the includes; collects problems and goes on.
class Scanner
{
public:
  Scanner(DeckText &deck, std::vector<std::string> &problems)
      : deck_(deck)
      , problems_(problems)
  {
  }

  void read(const std::string &file, const std::string &from)
  {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(file, error);
    if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
    {
      problems_.push_back(from + ": '" + file +
                          "' includes itself. Remove this include.");
      return;
    }
    std::ifstream input;
    if (!fs::is_directory(file, error))
      input.open(file);
    if (!input.is_open())
    {
      problems_.push_back(missing(file, from));
      return;
    }
    open_files_.push_back(canonical);
    lines(input, file);
    if (const int more = n_unreadable_[file] - most_unreadable_lines; more > 0)
      problems_.push_back(file + ": " + std::to_string(more) +
                          " more lines cannot be read. Is this a deck (.prm)?");
    open_files_.pop_back();
  }

  void read_text(const std::string &text)
  {
    std::istringstream input(text);
    lines(input, "");
  }

private:
  static std::string missing(const std::string &file, const std::string &from)
  {
    if (from.empty())
      return file +
             ": cannot open this deck. Give the path of a .prm file that exists and "
             "can be read.";
    const fs::path folder = fs::absolute(fs::path(file)).parent_path();
    return from + ": cannot open the include '" + fs::path(file).filename().string() +
           "', looked for in " + folder.lexically_normal().string() +
           ". Give a path relative to the deck that includes it.";
  }

  void lines(std::istream &input, const std::string &file)
  {
    const std::size_t depth_before = open_sections_.size();
    std::string line, whole;
    int number = 0, first = 1;
    while (std::getline(input, line))
    {
      ++number;
      line = line.substr(0, line.find('#'));
      while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())))
        line.pop_back();
      const bool continued = !line.empty() && line.back() == '\\';
      if (continued)
        line.pop_back();
      whole += " " + line;
      if (continued)
        continue;
      statement(tidy(whole), file, file + ":" + std::to_string(first), depth_before);
      whole.clear();
      first = number + 1;
    }
    if (!whole.empty())
      problems_.push_back(file + ":" + std::to_string(number) +
                          ": the file ends in a line that is to be continued ('\\'). "
                          "Remove the '\\'.");
    while (open_sections_.size() > depth_before)
    {
      problems_.push_back(open_sections_.back().place + ": 'subsection " +
                          open_sections_.back().value +
                          "' is not closed. Add 'end' after its last entry.");
      open_sections_.pop_back();
    }
  }

  void statement(const std::string &line,
                 const std::string &file,
                 const std::string &place,
                 const std::size_t depth_before)
  {
    if (line.empty())
      return;
    const std::size_t blank = line.find(' ');
    std::string keyword = line.substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
    std::transform(keyword.begin(), keyword.end(), keyword.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });

    if (keyword == "set" && rest.find('=') != std::string::npos)
    {
      const std::size_t equals = rest.find('=');
      add_entry(
          {prefix() + tidy(rest.substr(0, equals)), tidy(rest.substr(equals + 1)), place},
          file);
    }
    else if (keyword == "subsection" && !rest.empty())
    {
      deck_.sections.push_back({prefix() + rest, "", place});
      open_sections_.push_back({prefix() + rest, rest, place});
    }
    else if (keyword == "end" && rest.empty())
      end(place, depth_before);
    else if (keyword == "include" && !rest.empty())
    {
      const fs::path target(rest);
      read((target.is_absolute() ? target : fs::path(file).parent_path() / target)
               .string(),
           place);
    }
    else if (++n_unreadable_[file] <= most_unreadable_lines)
      problems_.push_back(place + ": cannot read '" + line.substr(0, longest_quotation) +
                          (line.size() > longest_quotation ? "..." : "") +
                          "'. A line is 'set ENTRY = VALUE', 'subsection NAME', 'end', "
                          "'include FILE' or a comment after '#'.");
  }

  /// An entry of an include may be set anew, by the same include too; in two lines of one
  /// file it is a slip.
  void add_entry(const DeckLine &entry, const std::string &file)
  {
    const auto [first, is_new] = places_.insert({{file, entry.path}, entry.place});
    if (!is_new && first->second != entry.place)
      problems_.push_back(entry.place + ": '" + entry.path +
                          "' has been set in this file already (" + first->second +
                          "). Remove one of the two lines.");
    deck_.entries.push_back(entry);
  }

  void end(const std::string &place, const std::size_t depth_before)
  {
    if (open_sections_.size() > depth_before)
      open_sections_.pop_back();
    else
      problems_.push_back(place +
                          ": 'end' without a subsection of this file to close. "
                          "Remove it, or add the 'subsection NAME' that it ends.");
  }

  std::string prefix() const
  {
    return open_sections_.empty() ? "" : open_sections_.back().path + "/";
  }

  static constexpr int most_unreadable_lines = 3; // named one by one, of a file
  static constexpr std::size_t longest_quotation = 80;

  DeckText &deck_;
  std::vector<std::string> &problems_;
  std::map<std::string, int> n_unreadable_; ///< lines of a file
  std::map<std::pair<std::string, std::string>, std::string>
      places_;                          ///< where a file has set an entry
  std::vector<DeckLine> open_sections_; ///< path, own name, place
  std::vector<fs::path> open_files_;
};
// NOLINTEND(misc-no-recursion)

std::string lower_case(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Levenshtein: insertions, deletions and replacements from one to the other.
std::size_t edit_distance(const std::string &a, const std::string &b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}
} // namespace

DeckText scan_deck(const std::string &file, std::vector<std::string> &problems)
{
  DeckText deck;
  Scanner(deck, problems).read(file, "");
  return deck;
}

namespace
{
/// What is said of two lists of components; nothing when only their order differs.
std::vector<std::string> component_differences(const std::string &one,
                                               const std::string &other)
{
  const auto words = [](const std::string &list)
  {
    std::set<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');)
      names.insert(tidy(name));
    return names;
  };
  const std::set<std::string> first = words(one), second = words(other);
  std::vector<std::string> differences;
  for (const std::string &name : first)
    if (second.count(name) == 0)
      differences.push_back("a component '" + name + "' too many");
  for (const std::string &name : second)
    if (first.count(name) == 0)
      differences.push_back("no component '" + name + "'");
  return differences;
}
} // namespace

std::vector<std::string> deck_differences(const std::string &deck,
                                          const std::string &other)
{
  std::vector<std::string> problems;
  std::map<std::string, std::pair<std::string, std::string>> values;
  DeckText first, second;
  Scanner(first, problems).read_text(deck);
  Scanner(second, problems).read_text(other);
  for (const DeckLine &line : first.entries)
    values[line.path].first = line.value;
  for (const DeckLine &line : second.entries)
    values[line.path].second = line.value;
  // A section that only one has is a consequence of what the scene is made of.
  const auto section_of = [](const std::string &path)
  { return path.find('/') == std::string::npos ? "" : path.substr(0, path.find('/')); };
  std::set<std::string> of_first, of_second;
  for (const DeckLine &line : first.entries)
    of_first.insert(section_of(line.path));
  for (const DeckLine &line : second.entries)
    of_second.insert(section_of(line.path));
  const auto components = values.find("Components");
  std::vector<std::string> differences, consequences;
  if (components != values.end())
    differences =
        component_differences(components->second.first, components->second.second);
  const bool are_named = !differences.empty();
  for (const auto &[path, pair] : values)
    if (pair.first != pair.second && !(path == "Components" && are_named))
    {
      const std::string section = section_of(path);
      const bool common = of_first.count(section) + of_second.count(section) == 2;
      (common ? differences : consequences)
          .push_back("'" + path + "' = '" + pair.first + "' and not '" + pair.second +
                     "'");
    }
  return differences.empty() ? consequences : differences;
}

void scan_override(const std::string &text,
                   DeckText &deck,
                   std::vector<std::string> &problems)
{
  const std::size_t equals = text.find('=');
  const std::string path = tidy(text.substr(0, equals));
  if (equals == std::string::npos || path.empty())
  {
    problems.push_back("--set \"" + text +
                       "\": no entry or no '='. Write --set \"Section/Entry=value\".");
    return;
  }
  // '#' begins a comment in deck.prm, so the value would not survive being written there.
  if (text.find_first_of("#\n\\") != std::string::npos)
  {
    problems.push_back(
        "--set \"" + text +
        "\": '#', '\\' and line breaks cannot stand in a deck. Leave them out.");
    return;
  }
  deck.entries.push_back({path, tidy(text.substr(equals + 1)), "--set"});
}

std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &candidates)
{
  std::string best;
  // A third of the letters wrong is still a slip; more is another word.
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string &candidate : candidates)
  {
    const std::size_t distance = edit_distance(lower_case(name), lower_case(candidate));
    if (distance < least)
    {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string tidy(const std::string &text)
{
  std::istringstream words(text);
  std::string word, result;
  while (words >> word)
    result += (result.empty() ? "" : " ") + word;
  return result;
}

std::string join(const std::vector<std::string> &words, const std::string &separator)
{
  std::string result;
  for (const std::string &word : words)
    result += (result.empty() ? "" : separator) + word;
  return result;
}
} // namespace antiform::cases

#pragma once

#include <string>
#include <vector>

namespace antiform::cases
{
/// One `set ENTRY = VALUE` (or one --set), or one `subsection NAME`, and where it stands.
struct DeckLine
{
  std::string path;  ///< "Section/Subsection/Entry", or of the subsection itself
  std::string value; ///< as written; empty for a subsection
  std::string place; ///< "file:line" or "--set"
};

/// The text of a deck and of what it includes, in reading order.
struct DeckText
{
  std::vector<DeckLine> entries;
  std::vector<DeckLine> sections;
};

/// Read a .prm file: `subsection NAME`, `end`, `set ENTRY = VALUE`, `include FILE`
/// (relative to the file that includes), comments with '#', lines continued by a final
/// '\'. Names are not looked at. Whatever cannot be read is added to @p problems with
/// file and line.
DeckText scan_deck(const std::string &file, std::vector<std::string> &problems);

/// Add `Section/Entry=value` of the command line.
void scan_override(const std::string &text,
                   DeckText &deck,
                   std::vector<std::string> &problems);

/// What two texts without includes set differently: "'Section/Entry' = 'this' and not
/// 'that'" for each entry; of a component that only one has its name alone, "a component
/// 'this' too many" or "no component 'that'".
std::vector<std::string> deck_differences(const std::string &deck,
                                          const std::string &other);

/// The candidate that @p name was most likely meant to be; empty when none is near.
std::string nearest_name(const std::string &name,
                         const std::vector<std::string> &candidates);

/// Without blanks at both ends; runs of blanks inside become one.
std::string tidy(const std::string &text);

/// "a, b, c"
std::string join(const std::vector<std::string> &words,
                 const std::string &separator = ", ");
} // namespace antiform::cases

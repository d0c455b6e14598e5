#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What a deck says of a study of its scene.
struct StudyParameters
{
  std::string vary;                 ///< see read_axes()
  std::vector<std::string> collect; ///< of the members' summaries; empty: all results
  int most_members = 200;
};

/// An entry of the deck and the values that it takes in turn.
struct StudyEntry
{
  std::string path; ///< "Section/Entry"
  std::vector<std::string> values;
};

/// Entries that change together: equally many values each.
using StudyAxis = std::vector<StudyEntry>;

/// One run of a study.
struct StudyMember
{
  std::string name;                ///< of its directory: entries and values
  std::string label;               ///< the same for people: "interface sliding"
  std::vector<std::string> values; ///< one for each of paths_of()
};

/// Read "A = 1, 2 & B = 3, 4; C = x, y": axes between ';' are crossed, entries between
/// '&' are zipped, values stand between ','. A value may be a range: "1 to 5 in 9"
/// (evenly, both ends included), "0.01 to 100 in 9 logarithmic" (to six digits), "seeds 1
/// to 5" (whole numbers). Braces hold a value that has ',', ';' or '&' in it. What cannot
/// be read is added to @p problems, in words that follow the entry's name.
std::vector<StudyAxis> read_axes(const std::string &text,
                                 std::vector<std::string> &problems);

/// The entries of all axes, in their order.
std::vector<std::string> paths_of(const std::vector<StudyAxis> &axes);

/// How many members the axes make; a number that no int holds is possible.
double n_members(const std::vector<StudyAxis> &axes);

/// Every combination of the axes, the last one changing fastest, each with a name of its
/// own: "burial-depth-ratio-0.1_interface-sliding". A name tells of an axis its first
/// entry, where its values differ, else all; of long names and those that would be alike
/// the end is a checksum.
std::vector<StudyMember> members_of(const std::vector<StudyAxis> &axes);

/// For each of @p paths its last name, with its section before it where two have the same
/// ("layer-seed"): lower case, @p blank for blanks.
std::vector<std::string> short_names(const std::vector<std::string> &paths, char blank);
} // namespace antiform::cases

#pragma once

#include "cases/study_members.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// What a study has to show: the values and the collected figures of its members.
class StudyTable
{
public:
  /// \param paths entries that are varied, as paths_of() gives them
  /// \param collect as in StudyParameters
  StudyTable(std::vector<std::string> paths, std::vector<std::string> collect);

  /// A line a member, in the order of the study, whoever ended first; cells of what a
  /// member does not have are empty.
  std::string csv(const StudyMembers &members) const;
  /// The same for programs, with reasons. \param status of the study \param seconds wall
  std::string json(const StudyMembers &members,
                   const std::string &title,
                   const std::string &status,
                   double seconds) const;
  /// Collected names that no member which has ended has, in words.
  std::vector<std::string> missing(const StudyMembers &members) const;
  /// What members that have ended warn of, in words: each warning once, be it with other
  /// numbers, and how many have it.
  static std::vector<std::string> warnings_of(const StudyMembers &members);

private:
  struct Column
  {
    std::string wanted; ///< as in Collect
    std::string name;   ///< in the header, with its unit
    std::string unit;
  };
  std::vector<Column> columns(const StudyMembers &members) const;

  std::vector<std::string> paths_;
  std::vector<std::string> value_names_; ///< in the header, with units
  std::vector<std::string> collect_;
};

/// The columns of entries in the header of a table, with units: "burial_depth_ratio".
std::vector<std::string> value_columns(const std::vector<std::string> &paths);

/// Quoted where commas would make it two cells.
std::string csv_cell(const std::string &text);

/// "name_unit" for the header of a table: "peak_stress_Pa", "steps", "k_w_Pa_per_m".
std::string column_name(const std::string &name, const std::string &unit);
} // namespace antiform::cases

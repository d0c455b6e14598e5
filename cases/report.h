#pragma once

#include <string>
#include <vector>

namespace antiform::cases
{
/// What `antiform report` is asked for.
struct ReportOptions
{
  std::string directory; ///< of a run, or of a study
  std::string page;      ///< file to write; empty: report.html in the directory
  std::string steps;     ///< what is drawn; empty: onset, peak, last
};

/// What `antiform compare` is asked for.
struct ComparisonOptions
{
  std::vector<std::string> runs; ///< directories; the first is the reference
  std::string output;            ///< directory; empty: comparison
};

/// Write one self-contained page (docs/output.md): of a run, drawn by cases/report.py, or
/// of a study, study.html by cases/study_page.py.
/// \return exit status: that of the script, whose messages it leaves to it. Throws
/// InputError where the script or a Python to run it is missing.
int write_report(const ReportOptions &options);

/// Finished runs of one scene side by side: page, table and JSON (docs/output.md), by
/// cases/compare.py; otherwise as write_report().
int compare_runs(const ComparisonOptions &options);
} // namespace antiform::cases

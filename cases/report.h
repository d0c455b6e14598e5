#pragma once

#include <string>

namespace antiform::cases
{
/// What `antiform report` is asked for.
struct ReportOptions
{
  std::string directory; ///< of a run
  std::string page;      ///< file to write; empty: report.html in the directory
  std::string steps;     ///< what is drawn; empty: onset, peak, last
};

/// Write one self-contained page of a run (docs/output.md), drawn by cases/report.py.
/// \return exit status: that of the script, whose messages it leaves to it. Throws
/// InputError where the script or a Python to run it is missing.
int write_report(const ReportOptions &options);
} // namespace antiform::cases

#pragma once

#include "cases/program.h"
#include "cases/report.h"
#include "cases/theory.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// The command line, understood.
struct CommandLine
{
  enum class Command
  {
    help, ///< print help_text
    run,
    check,
    theory,
    parameters,
    envelope,
    calibrate,
    report,
    compare,
    study
  };
  Command command = Command::help;
  std::string help_text;
  RunOptions run;                   ///< deck and overrides of the others too
  TheoryOptions theory;             ///< theory --json, --plot, --friction-angle
  int jobs = 0;                     ///< study --jobs; 0: as many as cores
  bool json = false;                ///< check --json, envelope --json
  bool markdown = false;            ///< parameters --markdown
  std::string name;                 ///< parameters NAME
  std::vector<std::string> sources; ///< envelope SOURCE...
  ReportOptions report;             ///< report DIR
  ComparisonOptions comparison;     ///< compare DIR DIR...
};

/// Throws InputError for what it cannot accept.
/// \param arguments without the program's name
CommandLine parse_command_line(const std::vector<std::string> &arguments);
} // namespace antiform::cases

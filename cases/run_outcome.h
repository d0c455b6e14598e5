#pragma once

#include "cases/summary.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What has become of a run, as others see it.
struct RunOutcome
{
  /// waiting (not begun, or killed) | running | completed | failed | interrupted
  std::string status = "waiting";
  std::string reason; ///< why it failed
  std::vector<std::string> warnings; ///< of its summary, but for that reason
  /// The numbers of its summary: results by name, others as "sizes/grains", "steps".
  std::map<std::string, Result> figures;
  std::set<std::string> results; ///< names of those that are results

  bool has_ended() const { return status == "completed" || status == "failed"; }
};

/// What @p folder tells of its run; `waiting` of none.
RunOutcome read_outcome(const std::string &folder);

/// A figure by its name, or "A over B"; false when there is none such, or not finite.
bool find_figure(const RunOutcome &outcome, const std::string &wanted, Result &figure);
} // namespace antiform::cases

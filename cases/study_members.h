#pragma once

#include "cases/child_runs.h"
#include "cases/run_outcome.h"
#include "cases/study_decks.h"

#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace antiform::cases
{
/// "43 s", "12 minutes", "3.1 hours".
std::string duration_text(double seconds);

/// Runs the members of a study as processes, several at once. What has ended is not run
/// again; what has a checkpoint goes on from it.
class StudyMembers
{
public:
  /// \param threads of each member
  /// \param says hears what happens, in words
  /// \param changed is called when the outcomes have
  StudyMembers(std::string directory,
               std::vector<MemberDeck> decks,
               int jobs,
               int threads,
               std::function<void(const std::string &)> says,
               std::function<void(const StudyMembers &)> changed);

  /// False when a signal has stopped it; nothing is running then.
  bool run();

  const std::vector<MemberDeck> &decks() const { return decks_; }
  const std::vector<RunOutcome> &outcomes() const { return outcomes_; }
  std::size_t count(const std::string &status) const;
  int n_found() const { return n_found_; } ///< ended before this began

private:
  using Clock = std::chrono::steady_clock;
  std::string folder(std::size_t k) const
  {
    return member_folder(directory_, decks_[k].member.name);
  }
  RunOutcome outcome_of(std::size_t k) const;
  void find_ended();
  void start_what_fits();
  bool start(std::size_t k);
  void end(const ChildRuns::Ended &ended);
  double seconds_left() const;
  std::string ended_in_words(std::size_t k, double seconds) const;

  std::string directory_;
  std::vector<MemberDeck> decks_;
  std::vector<RunOutcome> outcomes_;
  std::vector<Clock::time_point> begins_;
  int jobs_, threads_;
  std::function<void(const std::string &)> says_;
  std::function<void(const StudyMembers &)> changed_;
  std::vector<std::size_t> waiting_;
  std::set<std::size_t> strangers_; ///< run by a process that a killed study has left
  ChildRuns children_;
  int n_found_ = 0;
  double predicted_ = 0., taken_ = 0.; ///< of those that this has run to their end [s]
};
} // namespace antiform::cases

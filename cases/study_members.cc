#include "cases/study_members.h"

#include "cases/directory_lock.h"
#include "cases/interrupt.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace antiform::cases
{
std::string duration_text(const double seconds)
{
  char text[48];
  if (seconds < 100.)
    std::snprintf(text, sizeof text, "%.*f s", seconds < 9.95 ? 1 : 0, seconds);
  else if (seconds < 6000.)
    std::snprintf(text, sizeof text, "%.0f minutes", seconds / 60.);
  else
    std::snprintf(text, sizeof text, "%.1f hours", seconds / 3600.);
  return text;
}

StudyMembers::StudyMembers(std::string directory,
                           std::vector<MemberDeck> decks,
                           const int jobs,
                           const int threads,
                           std::function<void(const std::string &)> says,
                           std::function<void(const StudyMembers &)> changed)
    : directory_(std::move(directory))
    , decks_(std::move(decks))
    , outcomes_(decks_.size())
    , begins_(decks_.size())
    , jobs_(jobs)
    , threads_(threads)
    , says_(std::move(says))
    , changed_(std::move(changed))
{
  std::filesystem::create_directories(directory_ + "/members");
}

std::size_t StudyMembers::count(const std::string &status) const
{
  return static_cast<std::size_t>(std::count_if(outcomes_.begin(), outcomes_.end(),
                                                [&](const RunOutcome &o)
                                                { return o.status == status; }));
}

/// With what theory says of its scene.
RunOutcome StudyMembers::outcome_of(const std::size_t k) const
{
  RunOutcome outcome = read_outcome(folder(k));
  if (outcome.has_ended())
    outcome.figures.insert(decks_[k].theory.begin(), decks_[k].theory.end());
  return outcome;
}

/// What has ended in a former session; the rest waits.
void StudyMembers::find_ended()
{
  for (std::size_t k = 0; k < decks_.size(); ++k)
  {
    outcomes_[k] = outcome_of(k);
    if (!outcomes_[k].has_ended())
    {
      waiting_.push_back(k);
      continue;
    }
    ++n_found_;
    if (outcomes_[k].status == "failed")
      says_("  " + decks_[k].member.name + " has failed before: " + outcomes_[k].reason +
            " (remove '" + folder(k) + "' to run it again)");
  }
}

/// False when a run that a killed study has left is still at work there: it writes its
/// checkpoint, or comes to its end.
bool StudyMembers::start(const std::size_t k)
{
  if (DirectoryLock::is_taken(folder(k)))
  {
    if (strangers_.insert(k).second)
      says_("  " + decks_[k].member.name +
            " is still run by what a killed study has left: waiting for it");
    return false;
  }
  if (strangers_.count(k) > 0)
    outcomes_[k] = outcome_of(k);
  if (outcomes_[k].has_ended())
  {
    ++n_found_;
    return true;
  }
  write_member_deck(directory_, decks_[k]);
  children_.start(k, folder(k) + ".prm", folder(k), threads_);
  begins_[k] = Clock::now();
  outcomes_[k] = RunOutcome();
  outcomes_[k].status = "running";
  return true;
}

void StudyMembers::start_what_fits()
{
  for (auto next = waiting_.begin();
       next != waiting_.end() && children_.size() < static_cast<std::size_t>(jobs_);)
    next = start(*next) ? waiting_.erase(next) : std::next(next);
}

/// By what was predicted, and how that has turned out so far [s].
double StudyMembers::seconds_left() const
{
  double left = 0.;
  for (std::size_t k = 0; k < decks_.size(); ++k)
    if (!outcomes_[k].has_ended())
      left += decks_[k].core_seconds;
  return predicted_ > 0. ? left * taken_ / predicted_ / jobs_ : 0.;
}

std::string StudyMembers::ended_in_words(const std::size_t k, const double seconds) const
{
  const RunOutcome &outcome = outcomes_[k];
  const std::size_t n = count("completed") + count("failed"), all = decks_.size();
  std::string text = "  " + std::to_string(n) + " of " + std::to_string(all) + ": " +
                     decks_[k].member.name + " " + outcome.status + " in " +
                     duration_text(seconds);
  if (outcome.status == "failed")
    text += ": " + outcome.reason;
  return n < all ? text + "; about " + duration_text(seconds_left()) + " left" : text;
}

void StudyMembers::end(const ChildRuns::Ended &ended)
{
  const std::size_t k = ended.key;
  RunOutcome &outcome = outcomes_[k];
  outcome = outcome_of(k);
  if (ended.status == 3)
    outcome.status = "interrupted"; // someone has signalled the member itself
  else if (!outcome.has_ended())
  {
    outcome.status = "failed";
    outcome.reason = ended.status < 0
                         ? "killed by signal " + std::to_string(-ended.status)
                         : last_line_of(folder(k) + ".out");
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - begins_[k]).count();
  predicted_ += decks_[k].core_seconds;
  taken_ += seconds;
  says_(ended_in_words(k, seconds));
  changed_(*this);
}

bool StudyMembers::run()
{
  find_ended();
  changed_(*this);
  while (!waiting_.empty() || children_.size() > 0)
  {
    if (interrupt_signal() != 0)
    {
      children_.stop();
      for (std::size_t k = 0; k < decks_.size(); ++k)
        if (outcomes_[k].status == "running")
        {
          outcomes_[k] = outcome_of(k);
          if (!outcomes_[k].has_ended())
            outcomes_[k].status = "interrupted";
        }
      return false;
    }
    start_what_fits();
    if (const auto ended = children_.poll())
      end(*ended);
  }
  return true;
}
} // namespace antiform::cases

#include "cases/run_log.h"

#include <unistd.h>

#include <cstdio>

namespace antiform::cases
{
RunLog::RunLog(const std::string &path, const bool prints, const bool appends)
    : prints_(prints)
    , terminal_(isatty(STDOUT_FILENO) != 0)
    , last_(std::chrono::steady_clock::now())
{
  if (prints)
    file_.open(path, appends ? std::ios::app : std::ios::trunc);
}

RunLog::~RunLog()
{
  clear_progress();
}

void RunLog::clear_progress()
{
  if (progress_shown_)
    std::fputs("\r\033[K", stdout);
  progress_shown_ = false;
}

void RunLog::line(const std::string &text)
{
  if (!prints_)
    return;
  clear_progress();
  std::puts(text.c_str());
  std::fflush(stdout);
  file_ << text << std::endl;
}

bool RunLog::is_due() const
{
  const double interval = terminal_ ? 0.2 : 10.;
  return prints_ &&
         std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >
             interval;
}

void RunLog::progress(const double share,
                      const std::int64_t step,
                      const double seconds_left,
                      const std::size_t cracks,
                      const double steps_per_second)
{
  last_ = std::chrono::steady_clock::now();
  char left[32] = "?";
  if (seconds_left >= 0.)
    std::snprintf(left, sizeof left, "%ld:%02ld", static_cast<long>(seconds_left) / 60,
                  static_cast<long>(seconds_left) % 60);
  char text[160];
  std::snprintf(
      text, sizeof text, "%5.1f %%  step %lld  at most %s left  %zu cracks  %.0f steps/s",
      100. * share, static_cast<long long>(step), left, cracks, steps_per_second);
  if (terminal_)
  {
    std::printf("\r\033[K%s", text);
    std::fflush(stdout);
    progress_shown_ = true;
    return;
  }
  line(text);
}
} // namespace antiform::cases

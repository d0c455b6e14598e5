#pragma once

#include <chrono>
#include <cstdint>
#include <fstream>
#include <string>

namespace antiform::cases
{
/// What a run prints: to the terminal (one updating progress line there, plain lines at
/// intervals elsewhere) and to log.txt. Silent on all ranks but the first.
class RunLog
{
public:
  RunLog(const std::string &path, bool prints, bool appends);
  ~RunLog();

  void line(const std::string &text);
  /// Time for another progress line: five a second on a terminal, one in ten seconds in a
  /// log.
  bool is_due() const;
  /// \param seconds_left negative: not known yet
  void progress(double share,
                std::int64_t step,
                double seconds_left,
                std::size_t cracks,
                double steps_per_second);

private:
  void clear_progress();

  std::ofstream file_;
  bool prints_, terminal_, progress_shown_ = false;
  std::chrono::steady_clock::time_point last_;
};
} // namespace antiform::cases

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace antiform::cases
{
/// Runs of this program as processes of their own, several at once. They end with this
/// process, however it ends, after a checkpoint; a signal of the terminal reaches them
/// through stop() only.
class ChildRuns
{
public:
  /// One that has ended.
  struct Ended
  {
    std::size_t key = 0; ///< as given to start()
    int status = 0;      ///< exit status, or minus the signal that ended it
  };

  ChildRuns() = default;
  ChildRuns(const ChildRuns &) = delete;
  ChildRuns &operator=(const ChildRuns &) = delete;
  ~ChildRuns() { stop(); }

  /// `antiform run DECK -o DIRECTORY --threads N`, and --resume where @p directory has a
  /// state; what else is there is removed, since a run refuses its own remains. What it
  /// prints goes to `DIRECTORY.out`. Throws std::runtime_error with the reason.
  void start(std::size_t key,
             const std::string &deck,
             const std::string &directory,
             int threads);
  std::size_t size() const { return running_.size(); }
  /// One that has ended; waits a few hundredths of a second for it.
  std::optional<Ended> poll();
  /// Interrupt what runs and wait until it has written its checkpoints.
  void stop();

private:
  struct Child
  {
    std::size_t key = 0;
    pid_t process = -1;
  };
  std::vector<Child> running_;
};

/// The last line of a log that is not empty.
std::string last_line_of(const std::string &file);
} // namespace antiform::cases

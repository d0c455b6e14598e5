#pragma once

#include <string>

namespace antiform::cases
{
/// Held while a run or a calibration works in a directory, so that no second one writes
/// into the same files. The system lets go of it when the process ends, however it ends;
/// nothing is left in the directory.
class DirectoryLock
{
public:
  enum class Children
  {
    let_go, ///< programs started by this one do not hold it
    hold    ///< they do, beyond the end of this one
  };

  /// Throws InputError when somebody else holds it, or the directory cannot be opened.
  /// \param what of the other one, for the message: "a run"
  DirectoryLock(const std::string &directory, const std::string &what, Children children);
  DirectoryLock(const DirectoryLock &) = delete;
  DirectoryLock &operator=(const DirectoryLock &) = delete;
  ~DirectoryLock();

  /// False on file systems that know no locks (some network ones).
  bool is_held() const { return held_; }

  /// Whether somebody holds it now; false where there is no such directory.
  static bool is_taken(const std::string &directory);

private:
  int file_;
  bool held_ = false;
};
} // namespace antiform::cases

#include "cases/directory_lock.h"

#include "cases/program.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace antiform::cases
{
DirectoryLock::DirectoryLock(const std::string &directory,
                             const std::string &what,
                             const Children children)
    : file_(open(directory.c_str(),
                 O_RDONLY | O_DIRECTORY |
                     (children == Children::let_go ? O_CLOEXEC : 0)))
{
  if (file_ < 0)
    throw InputError({"output directory '" + directory + "': cannot be opened (" +
                      std::strerror(errno) +
                      "). Change its permissions, or give another one with -o DIR."});
  held_ = flock(file_, LOCK_EX | LOCK_NB) == 0;
  if (!held_ && errno == EWOULDBLOCK)
  {
    close(file_);
    throw InputError({"output directory '" + directory + "': " + what +
                      " is at work there. Wait for its end, or give another one with -o "
                      "DIR."});
  }
}

bool DirectoryLock::is_taken(const std::string &directory)
{
  const int file = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0)
    return false;
  const bool taken = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file); // and lets go
  return taken;
}

DirectoryLock::~DirectoryLock()
{
  close(file_);
}
} // namespace antiform::cases

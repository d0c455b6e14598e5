#include "coupling/output/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

namespace antiform::coupling
{
namespace
{
[[noreturn]] void fail(const std::string &path, const std::string &temporary)
{
  const std::string reason = std::strerror(errno);
  std::remove(temporary.c_str());
  throw std::runtime_error(
      "'" + path + "' cannot be written: " + reason +
      ". What the file held before is unchanged. Free space on that disk, or choose "
      "another output folder with -o.");
}

/// A renamed file is safe only when its folder is on disk too.
bool flush_folder_of(const std::string &path)
{
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return false;
  // EINVAL: a file system without this operation keeps renames in order by itself.
  const bool flushed = fsync(descriptor) == 0 || errno == EINVAL;
  const int error = errno;
  close(descriptor);
  errno = error;
  return flushed;
}
} // namespace

bool write_all(const int descriptor, const std::string &bytes)
{
  std::size_t done = 0;
  while (done < bytes.size())
  {
    const ssize_t n = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n > 0)
      done += static_cast<std::size_t>(n);
    else if (n == 0 || errno != EINTR)
      return false;
  }
  return true;
}

void replace_file(const std::string &path, const std::string &bytes)
{
  const std::string temporary = path + ".tmp";
  const int descriptor =
      open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0)
    fail(path, temporary);
  const bool written = write_all(descriptor, bytes) && fsync(descriptor) == 0;
  const int error = errno;
  // Some file systems report a full disk only here.
  const bool closed = close(descriptor) == 0;
  if (!written)
    errno = error;
  if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0)
    fail(path, temporary);
  if (!flush_folder_of(path))
    throw std::runtime_error("'" + path +
                             "' is written, but its folder cannot be flushed: " +
                             std::strerror(errno) + ". Check that disk.");
}

std::string read_file(const std::string &path)
{
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  if (in)
    bytes.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (!in || in.bad())
    throw std::runtime_error("'" + path + "' cannot be read: " +
                             (errno ? std::strerror(errno) : "it is not a regular file") +
                             ".");
  return bytes;
}
} // namespace antiform::coupling

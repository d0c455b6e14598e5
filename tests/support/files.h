#pragma once

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <sys/resource.h>

namespace antiform::test
{
/// While this lives no file of the process can grow beyond @p bytes: write() fails like
/// on a full disk.
class FullDisk
{
public:
  explicit FullDisk(const rlim_t bytes)
      : handler_(std::signal(SIGXFSZ, SIG_IGN))
  {
    getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
      throw std::runtime_error("the size of files cannot be limited here");
  }
  FullDisk(const FullDisk &) = delete;
  FullDisk &operator=(const FullDisk &) = delete;
  ~FullDisk()
  {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, handler_);
  }

private:
  void (*handler_)(int);
  rlimit former_ = {};
};

/// A fresh folder that goes with this object. path("x") is a file in it.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    const char *const base = std::getenv("TMPDIR");
    path_ = std::string(base ? base : "/tmp") + "/antiform-test-XXXXXX";
    if (!mkdtemp(path_.data()))
      throw std::runtime_error("no temporary folder can be made at " + path_);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  ~TemporaryFolder()
  {
    const std::string command = "rm -rf '" + path_ + "'";
    if (std::system(command.c_str()) != 0)
      std::perror(path_.c_str());
  }
  std::string path(const std::string &name) const { return path_ + '/' + name; }

private:
  std::string path_;
};

/// The message of the exception of type @p E that @p action throws; "" if it throws none.
template <class E, class Action>
std::string message_of(const Action &action)
{
  try
  {
    action();
  }
  catch (const E &error)
  {
    return error.what();
  }
  return "";
}
} // namespace antiform::test

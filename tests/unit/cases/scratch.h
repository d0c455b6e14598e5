#pragma once

#include "cases/parameters.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// A directory of its own for a test, gone with it.
class Scratch
{
public:
  Scratch()
  {
    std::string name =
        (std::filesystem::temp_directory_path() / "antiform-XXXXXX").string();
    directory_ = mkdtemp(name.data());
  }
  Scratch(const Scratch &) = delete;
  Scratch &operator=(const Scratch &) = delete;
  ~Scratch()
  {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }

  std::string path(const std::string &name) const { return directory_ + "/" + name; }

  /// Write @p text to a file, folders included; gives its path.
  std::string write(const std::string &name, const std::string &text) const
  {
    const std::string file = path(name);
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file) << text;
    return file;
  }

private:
  std::string directory_;
};

/// The problems that reading this deck meets; empty when it is accepted.
inline std::vector<std::string>
problems_of(const std::string &file, const std::vector<std::string> &overrides = {})
{
  try
  {
    antiform::cases::read_deck(file, overrides);
  }
  catch (const antiform::cases::InputError &error)
  {
    return error.problems();
  }
  return {};
}

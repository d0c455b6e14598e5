// continuum and discrete know nothing of each other, coupling knows both, cases composes:
// no file includes one of a folder above or beside its own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

namespace include_direction_tests
{
namespace
{
const std::map<std::string, std::set<std::string>> may_include{
    {"continuum", {"continuum"}},
    {"discrete", {"discrete"}},
    {"coupling", {"continuum", "discrete", "coupling"}},
    {"cases", {"continuum", "discrete", "coupling", "cases"}}};

/// Folder of an #include "folder/file.h" line, or nothing.
std::string included_folder(const std::string &line)
{
  const std::string start = "#include \"";
  if (line.rfind(start, 0) != 0)
    return {};
  return line.substr(start.size(), line.find('/') - start.size());
}
} // namespace

TEST(Includes, NeverRunUpOrSideways)
{
  int n_files = 0;
  for (const auto &[folder, allowed] : may_include)
    for (const auto &entry : std::filesystem::recursive_directory_iterator(
             std::string(ANTIFORM_SOURCE_DIR) + "/" + folder))
    {
      const std::string extension = entry.path().extension();
      if (extension != ".cc" && extension != ".h")
        continue;
      ++n_files;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);)
        if (const std::string included = included_folder(line); !included.empty())
          EXPECT_TRUE(allowed.count(included) == 1) << entry.path() << ": " << line;
    }
  EXPECT_GT(n_files, 80);
}
} // namespace include_direction_tests

#pragma once

#include <fstream>
#include <string>

namespace antiform::test
{
/// The processor's name, for tables of speed.
inline std::string processor()
{
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0)
      return line.substr(line.find(':') + 2);
  return "unknown";
}
} // namespace antiform::test

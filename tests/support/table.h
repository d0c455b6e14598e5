#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace antiform::test
{
/// The rows of tests/data/@p name, text by text: '#' begins a comment, the first other
/// line names the columns.
inline std::vector<std::vector<std::string>> table(const std::string &name)
{
  std::ifstream file(std::string(ANTIFORM_SOURCE_DIR) + "/tests/data/" + name);
  if (!file)
    throw std::runtime_error("there is no table " + name);
  std::vector<std::vector<std::string>> rows;
  bool has_names = false;
  for (std::string line; std::getline(file, line);)
  {
    if (line.empty() || line[0] == '#')
      continue;
    if (!has_names)
    {
      has_names = true;
      continue;
    }
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');)
      rows.back().push_back(cell);
  }
  return rows;
}

/// Half a unit of the last digit that @p number is printed with.
inline double half_digit(const std::string &number)
{
  const std::size_t exponent = number.find('e'), point = number.find('.');
  const std::size_t end = exponent == std::string::npos ? number.size() : exponent;
  double unit = 0.5;
  for (std::size_t i = point; i != std::string::npos && i + 1 < end; ++i)
    unit *= 0.1;
  return exponent == std::string::npos ? unit
                                       : std::stod("1" + number.substr(exponent)) * unit;
}
} // namespace antiform::test

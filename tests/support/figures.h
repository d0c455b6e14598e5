#pragma once
// What tests measure, for the figures of docs/theory (docs/pictures/bridging_figures.py).
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <string>
#include <vector>

namespace antiform::test
{
/// A table of one test, written as <name>.csv into the directory that the environment
/// variable ANTIFORM_FIGURES names when this object goes; nothing without it. Rows are
/// numbers in the order of the columns.
class Figure
{
public:
  /// \param columns names separated by commas, units in them
  Figure(std::string name, std::string columns)
      : name_(std::move(name))
      , columns_(std::move(columns))
  {
  }
  Figure(const Figure &) = delete;
  Figure &operator=(const Figure &) = delete;
  ~Figure() { write(); }

  void add(std::vector<double> row) { rows_.push_back(std::move(row)); }

private:
  void write() const
  {
    const char *const directory = std::getenv("ANTIFORM_FIGURES");
    if (directory == nullptr)
      return;
    std::ofstream file(std::string(directory) + '/' + name_ + ".csv");
    file << columns_ << '\n' << std::setprecision(8);
    for (const std::vector<double> &row : rows_)
      for (std::size_t k = 0; k < row.size(); ++k)
        file << row[k] << (k + 1 < row.size() ? ',' : '\n');
    file.close();
    if (!file)
    {
      std::fprintf(stderr, "cannot write %s.csv into %s\n", name_.c_str(), directory);
      std::abort();
    }
  }

  std::string name_, columns_;
  std::vector<std::vector<double>> rows_;
};
} // namespace antiform::test

#pragma once

#include "discrete/joints.h"

#include <cstdint>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// The shortest text that reads back to the same bits; whole numbers without exponent.
std::string shortest_text(double x);

/// A growing CSV file: one header line, then one line an append(). Every line goes to the
/// file at once and whole: when the disk is full, the file ends with the line before, and
/// std::runtime_error names file and reason.
class Table
{
public:
  /// Start an empty table; a file of that name is replaced.
  /// \param columns names with units, "axial_stress_Pa"; not empty, no commas or quotes.
  Table(const std::string &path, const std::vector<std::string> &columns);

  /// Go on with a table of an earlier run: everything behind byte @p offset (of offset(),
  /// kept by the checkpoint) is cut off. Throws std::runtime_error if the file is
  /// missing, has another header, or holds no line end at @p offset.
  static Table reopen(const std::string &path,
                      const std::vector<std::string> &columns,
                      std::int64_t offset);

  Table(Table &&other) noexcept;
  Table(const Table &) = delete;
  Table &operator=(const Table &) = delete;
  Table &operator=(Table &&) = delete;
  ~Table();

  /// One value a column; another number of values is a std::logic_error.
  void append(const std::vector<double> &row);
  /// The same for text that is ready; no commas, quotes or line ends.
  void append(const std::vector<std::string> &row);

  /// Force what was appended to disk.
  void flush();
  /// Length of the file [bytes], where the next line begins; flushes, so that a
  /// checkpoint never points behind what is on disk.
  std::int64_t offset();

private:
  Table(const std::string &path,
        std::size_t n_columns,
        int descriptor,
        std::int64_t length);
  void write_line(const std::string &line);
  [[noreturn]] void fail() const;

  std::string path_;
  std::size_t n_columns_;
  int descriptor_;
  std::int64_t length_;
};

/// cracks.csv: one line a broken joint element, in the order of breaking.
class CrackTable
{
public:
  static std::vector<std::string> columns();
  /// \param further columns behind the others, as of Table
  explicit CrackTable(const std::string &path,
                      const std::vector<std::string> &further = {});
  /// As Table::reopen().
  CrackTable(const std::string &path,
             std::int64_t offset,
             const std::vector<std::string> &further = {});

  /// \param shortening of the section when the crack formed [-]
  /// \param further    values of the further columns
  /// The crack's mode must be a broken one (std::logic_error otherwise).
  void append(const discrete::Crack &crack,
              double shortening,
              const std::vector<double> &further = {});
  std::int64_t offset() { return table_.offset(); }

private:
  Table table_;
};
} // namespace antiform::coupling

#include "coupling/output/tables.h"

#include "coupling/output/whole_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace antiform::coupling
{
namespace
{
std::string line_of(const std::vector<std::string> &cells)
{
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (cells[i].find_first_of(",\"\r\n") != std::string::npos)
      throw std::logic_error("A table cell cannot hold '" + cells[i] +
                             "': no commas, quotes or line ends.");
    line += (i == 0 ? "" : ",") + cells[i];
  }
  return line + '\n';
}

[[noreturn]] void cannot_go_on(const std::string &path, const std::string &reason)
{
  throw std::runtime_error("'" + path + "' cannot be continued: " + reason +
                           ". Restore the file as the interrupted run left it, or run "
                           "without --resume to start afresh.");
}
} // namespace

std::string shortest_text(const double x)
{
  std::array<char, 32> text{};
  const bool is_whole = std::abs(x) < 1e15 && x == std::trunc(x) &&
                        !(x == 0. && std::signbit(x)); // -0 keeps its sign
  const auto result = is_whole ? std::to_chars(text.data(), text.data() + text.size(),
                                               static_cast<std::int64_t>(x))
                               : std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), result.ptr};
}

Table::Table(const std::string &path,
             const std::size_t n_columns,
             const int descriptor,
             const std::int64_t length)
    : path_(path)
    , n_columns_(n_columns)
    , descriptor_(descriptor)
    , length_(length)
{
}

Table::Table(const std::string &path, const std::vector<std::string> &columns)
    : Table(path,
            columns.size(),
            open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666),
            0)
{
  if (columns.empty())
    throw std::logic_error("'" + path + "': a table needs a column.");
  if (descriptor_ < 0)
    fail();
  write_line(line_of(columns));
}

Table Table::reopen(const std::string &path,
                    const std::vector<std::string> &columns,
                    const std::int64_t offset)
{
  const std::string header = line_of(columns);
  const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0)
    cannot_go_on(path, std::strerror(errno));
  Table table(path, columns.size(), descriptor, offset); // owns the descriptor from here

  std::string first(header.size(), '\0');
  const ssize_t n = pread(descriptor, first.data(), first.size(), 0);
  if (n != static_cast<ssize_t>(header.size()) || first != header)
    cannot_go_on(path,
                 "its first line is not '" + header.substr(0, header.size() - 1) + "'");
  struct stat status = {};
  if (fstat(descriptor, &status) != 0)
    cannot_go_on(path, std::strerror(errno));
  if (offset > status.st_size)
    cannot_go_on(path, "it has " + std::to_string(status.st_size) +
                           " bytes, the state was saved "
                           "when it had " +
                           std::to_string(offset));
  char last = '\0';
  if (offset < static_cast<std::int64_t>(header.size()) ||
      pread(descriptor, &last, 1, offset - 1) != 1 || last != '\n')
    cannot_go_on(path, "no line ends at byte " + std::to_string(offset) +
                           ", where the state was saved");
  if (ftruncate(descriptor, offset) != 0 || lseek(descriptor, offset, SEEK_SET) != offset)
    cannot_go_on(path, std::strerror(errno));
  return table;
}

Table::Table(Table &&other) noexcept
    : path_(std::move(other.path_))
    , n_columns_(other.n_columns_)
    , descriptor_(other.descriptor_)
    , length_(other.length_)
{
  other.descriptor_ = -1;
}

Table::~Table()
{
  if (descriptor_ >= 0)
    close(descriptor_);
}

void Table::fail() const
{
  throw std::runtime_error(
      "'" + path_ + "' cannot be written: " + std::strerror(errno) +
      ". Free space on that disk and continue with --resume, or choose "
      "another output folder with -o.");
}

void Table::write_line(const std::string &line)
{
  if (!write_all(descriptor_, line))
  {
    const int error = errno;
    // Cut a part of a line off again, so that what is there can be read.
    if (ftruncate(descriptor_, length_) == 0)
      lseek(descriptor_, length_, SEEK_SET);
    errno = error;
    fail();
  }
  length_ += static_cast<std::int64_t>(line.size());
}

void Table::append(const std::vector<std::string> &row)
{
  if (row.size() != n_columns_)
    throw std::logic_error("'" + path_ + "' has " + std::to_string(n_columns_) +
                           " columns, the line has " + std::to_string(row.size()) + '.');
  write_line(line_of(row));
}

void Table::append(const std::vector<double> &row)
{
  std::vector<std::string> cells;
  cells.reserve(row.size());
  for (const double x : row)
    cells.push_back(shortest_text(x));
  append(cells);
}

void Table::flush()
{
  // EINVAL: a pipe or device, which has nothing to flush.
  if (fsync(descriptor_) != 0 && errno != EINVAL)
    fail();
}

std::int64_t Table::offset()
{
  flush();
  return length_;
}

std::vector<std::string> CrackTable::columns()
{
  return {"step",          "time_s",        "shortening",      "x_m",      "y_m",
          "reference_x_m", "reference_y_m", "orientation_deg", "length_m", "mode",
          "layer",         "joint",         "element"};
}

namespace
{
std::vector<std::string> with(std::vector<std::string> names,
                              const std::vector<std::string> &further)
{
  names.insert(names.end(), further.begin(), further.end());
  return names;
}
} // namespace

CrackTable::CrackTable(const std::string &path, const std::vector<std::string> &further)
    : table_(path, with(columns(), further))
{
}

CrackTable::CrackTable(const std::string &path,
                       const std::int64_t offset,
                       const std::vector<std::string> &further)
    : table_(Table::reopen(path, with(columns(), further), offset))
{
}

void CrackTable::append(const discrete::Crack &crack,
                        const double shortening,
                        const std::vector<double> &further)
{
  using discrete::Bond;
  if (crack.mode != Bond::broken_in_tension && crack.mode != Bond::broken_in_shear)
    throw std::logic_error("Joint " + std::to_string(crack.joint) + ", element " +
                           std::to_string(crack.element) +
                           " is listed as a crack, but its "
                           "bond is not broken.");
  const double degrees = 180. / M_PI;
  std::vector<std::string> row{
      std::to_string(crack.step), shortest_text(crack.time),
      shortest_text(shortening), shortest_text(crack.place.x),
      shortest_text(crack.place.y), shortest_text(crack.reference_place.x),
      shortest_text(crack.reference_place.y),
      shortest_text(crack.orientation * degrees), shortest_text(crack.length),
      crack.mode == Bond::broken_in_tension ? "tension" : "shear",
      std::to_string(crack.layer), std::to_string(crack.joint),
      std::to_string(crack.element)};
  for (const double x : further)
    row.push_back(shortest_text(x));
  table_.append(row);
}
} // namespace antiform::coupling

#include "coupling/output/vtu.h"

#include "coupling/output/tables.h"
#include "coupling/output/whole_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace antiform::coupling
{
namespace
{
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "the files say byte_order=\"LittleEndian\"");

const std::uint8_t vtk_vertex = 1;
const std::uint8_t vtk_line = 3;

std::string base64(const std::string &bytes)
{
  static const char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3)
  {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 |
              (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int shift = 18; shift >= 0; shift -= 6)
      text += digits[group >> shift & 63];
  }
  for (std::size_t i = 0; i < (3 - bytes.size() % 3) % 3; ++i)
    text[text.size() - 1 - i] = '=';
  return text;
}

std::string xml_text(const std::string &plain)
{
  std::string text;
  for (const char c : plain)
    switch (c)
    {
    case '&':
      text += "&amp;";
      break;
    case '<':
      text += "&lt;";
      break;
    case '>':
      text += "&gt;";
      break;
    case '"':
      text += "&quot;";
      break;
    default:
      text += c;
    }
  return text;
}

/// One inline data array: length in bytes (UInt64), then the values.
template <class T>
std::string data_array(const std::string &type,
                       const std::string &name,
                       const int n_components,
                       const T *values,
                       const std::size_t n_values)
{
  const std::uint64_t n_bytes = n_values * sizeof(T);
  std::string bytes(sizeof n_bytes + n_bytes, '\0');
  std::memcpy(bytes.data(), &n_bytes, sizeof n_bytes);
  if (n_values > 0)
    std::memcpy(bytes.data() + sizeof n_bytes, values, n_bytes);
  return "<DataArray type=\"" + type + "\" Name=\"" + xml_text(name) +
         "\" NumberOfComponents=\"" + std::to_string(n_components) +
         "\" format=\"binary\">\n" + base64(bytes) + "\n</DataArray>\n";
}

std::string field_arrays(const std::string &path,
                         const std::vector<Field> &fields,
                         const std::size_t n_items)
{
  std::string text;
  for (const Field &field : fields)
  {
    const bool has_components = field.n_components == 1 || field.n_components == 3;
    if (!has_components ||
        field.values.size() != n_items * static_cast<std::size_t>(field.n_components))
      throw std::logic_error("'" + path + "': field '" + field.name + "' has " +
                             std::to_string(field.values.size()) + " values, " +
                             std::to_string(n_items) + " items of " +
                             std::to_string(field.n_components) +
                             " components (1 or 3) need another number.");
    text += data_array("Float64", field.name, field.n_components, field.values.data(),
                       field.values.size());
  }
  return text;
}

/// @p connectivity lists the points of all cells, the same number for each.
void write_grid(const std::string &path,
                const std::vector<std::array<double, 3>> &points,
                const std::vector<std::int64_t> &connectivity,
                const std::uint8_t cell_type,
                const std::vector<Field> &point_fields,
                const std::vector<Field> &cell_fields)
{
  const std::size_t points_a_cell = cell_type == vtk_line ? 2 : 1;
  const std::size_t n_cells = connectivity.size() / points_a_cell;
  std::vector<std::int64_t> ends(n_cells);
  for (std::size_t i = 0; i < n_cells; ++i)
    ends[i] = static_cast<std::int64_t>((i + 1) * points_a_cell);
  const std::vector<std::uint8_t> types(n_cells, cell_type);
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const auto &point : points)
    coordinates.insert(coordinates.end(), point.begin(), point.end());

  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
      std::to_string(points.size()) + "\" NumberOfCells=\"" + std::to_string(n_cells) +
      "\">\n<Points>\n";
  text += data_array("Float64", "Points", 3, coordinates.data(), coordinates.size());
  text += "</Points>\n<Cells>\n";
  text +=
      data_array("Int64", "connectivity", 1, connectivity.data(), connectivity.size());
  text += data_array("Int64", "offsets", 1, ends.data(), ends.size());
  text += data_array("UInt8", "types", 1, types.data(), types.size());
  text += "</Cells>\n<PointData>\n" + field_arrays(path, point_fields, points.size());
  text += "</PointData>\n<CellData>\n" + field_arrays(path, cell_fields, n_cells);
  text += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  replace_file(path, text);
}
} // namespace

void write_points_vtu(const std::string &path,
                      const std::vector<std::array<double, 3>> &points,
                      const std::vector<Field> &point_fields)
{
  std::vector<std::int64_t> connectivity(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    connectivity[i] = static_cast<std::int64_t>(i);
  write_grid(path, points, connectivity, vtk_vertex, point_fields, {});
}

void write_lines_vtu(const std::string &path,
                     const std::vector<std::array<double, 3>> &points,
                     const std::vector<std::array<long, 2>> &lines,
                     const std::vector<Field> &cell_fields)
{
  std::vector<std::int64_t> connectivity;
  connectivity.reserve(2 * lines.size());
  for (const auto &line : lines)
    for (const long point : line)
    {
      if (point < 0 || static_cast<std::size_t>(point) >= points.size())
        throw std::logic_error("'" + path + "': a line ends at point " +
                               std::to_string(point) + ", there are " +
                               std::to_string(points.size()) + " points.");
      connectivity.push_back(point);
    }
  write_grid(path, points, connectivity, vtk_line, {}, cell_fields);
}

void write_pvd(const std::string &path, const std::vector<PvdEntry> &entries)
{
  std::vector<PvdEntry> ordered = entries;
  for (const PvdEntry &entry : ordered)
    if (!std::isfinite(entry.time))
      throw std::logic_error("'" + path + "': the time of '" + entry.file +
                             "' is not a number.");
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const PvdEntry &a, const PvdEntry &b) { return a.time < b.time; });

  // ParaView shows the entries of one time as blocks when their parts differ.
  std::vector<std::string> groups;
  std::string text = "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"Collection\" version=\"1.0\" "
                     "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const PvdEntry &entry : ordered)
  {
    auto group = std::find(groups.begin(), groups.end(), entry.group);
    if (group == groups.end())
      group = groups.insert(groups.end(), entry.group);
    text += "<DataSet timestep=\"" + shortest_text(entry.time) + "\" group=\"" +
            xml_text(entry.group) + "\" part=\"" +
            std::to_string(group - groups.begin()) + "\" file=\"" + xml_text(entry.file) +
            "\"/>\n";
  }
  text += "</Collection>\n</VTKFile>\n";
  replace_file(path, text);
}
} // namespace antiform::coupling

#pragma once

#include <array>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// One named field of points or cells: n_components values an item, item by item.
struct Field
{
  std::string name;     ///< with unit, e.g. "displacement_m"
  int n_components = 1; ///< 1, or 3 for vectors (z = 0)
  std::vector<double> values;
};

/// VTK XML unstructured grid with vertices (grains, cracks) or two-point lines (joints).
/// Inline base64, uncompressed, UInt64 headers. Throws std::runtime_error naming the file
/// when it cannot be written whole, and std::logic_error naming file and field when a
/// field does not have one value (or three) an item or a line ends at a point that is not
/// there.
void write_points_vtu(const std::string &path,
                      const std::vector<std::array<double, 3>> &points,
                      const std::vector<Field> &point_fields);
void write_lines_vtu(const std::string &path,
                     const std::vector<std::array<double, 3>> &points,
                     const std::vector<std::array<long, 2>> &lines,
                     const std::vector<Field> &cell_fields);

/// fields.pvd: the time-ordered index of all files, rewritten whole (temporary name and
/// rename) at each call.
struct PvdEntry
{
  double time = 0.;  ///< here the shortening [-] or the time [s]
  std::string group; ///< continuum, grains, joints, cracks
  std::string file;  ///< relative to the pvd
};
void write_pvd(const std::string &path, const std::vector<PvdEntry> &entries);
} // namespace antiform::coupling

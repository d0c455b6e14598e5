#include "coupling/output/vtu.h"

#include "coupling/output/whole_file.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace vtu_tests
{
using namespace antiform::coupling;
using antiform::test::FullDisk;
using antiform::test::message_of;
using antiform::test::TemporaryFolder;

namespace
{
/// Names of all elements in order of opening; a failure if tags do not nest.
std::vector<std::string> elements_of(const std::string &xml)
{
  std::vector<std::string> names, open;
  for (std::size_t at = xml.find('<'); at != std::string::npos;
       at = xml.find('<', at + 1))
  {
    const std::size_t end = xml.find('>', at);
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag[0] == '?')
      continue;
    if (tag[0] == '/')
    {
      EXPECT_FALSE(open.empty());
      EXPECT_EQ(open.back(), tag.substr(1));
      open.pop_back();
      continue;
    }
    names.push_back(tag.substr(0, tag.find_first_of(" /")));
    if (tag.back() != '/')
      open.push_back(names.back());
  }
  EXPECT_TRUE(open.empty());
  return names;
}

std::string decoded(const std::string &text)
{
  const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned int bits = 0;
  int n_bits = 0;
  for (const char c : text)
  {
    if (c == '=' || c == '\n')
      continue;
    bits = (bits << 6 | static_cast<unsigned int>(digits.find(c))) & 0xffffff;
    n_bits += 6;
    if (n_bits >= 8)
      bytes += static_cast<char>(bits >> (n_bits -= 8) & 0xff);
  }
  return bytes;
}

/// Values of the data array @p name; @p tag gets its attributes.
template <class T>
std::vector<T> array(const std::string &xml, const std::string &name, std::string &tag)
{
  const std::size_t at = xml.find("Name=\"" + name + '"');
  if (at == std::string::npos)
    throw std::runtime_error("no array " + name);
  const std::size_t begin = xml.rfind('<', at), end = xml.find('>', at);
  tag = xml.substr(begin, end - begin);
  const std::string bytes = decoded(xml.substr(end + 1, xml.find('<', end) - end - 1));
  std::uint64_t n_bytes = 0;
  std::memcpy(&n_bytes, bytes.data(), 8);
  EXPECT_EQ(bytes.size(), 8 + n_bytes) << name;
  std::vector<T> values(n_bytes / sizeof(T));
  if (n_bytes > 0)
    std::memcpy(values.data(), bytes.data() + 8, n_bytes);
  return values;
}

template <class T>
std::vector<T> array(const std::string &xml, const std::string &name)
{
  std::string tag;
  return array<T>(xml, name, tag);
}

using Point = std::array<double, 3>;
} // namespace

TEST(Vtu, GrainsReadBack)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("grains_0001.vtu");
  // One, two, three points: the three kinds of base64 ending.
  for (std::size_t n = 0; n < 4; ++n)
  {
    std::vector<Point> points;
    Field radius{"radius_m", 1, {}}, displacement{"a<b & \"c\"", 3, {}};
    for (std::size_t i = 0; i < n; ++i)
    {
      const double x = 1. / (3. + static_cast<double>(i));
      points.push_back({x, -x, 0.});
      radius.values.push_back(x * 1e-300);
      displacement.values.insert(displacement.values.end(), {x, std::nan(""), 7.});
    }
    write_points_vtu(path, points, {radius, displacement});
    const std::string xml = read_file(path);
    const std::vector<std::string> expected = {
        "VTKFile",   "UnstructuredGrid", "Piece",     "Points",    "DataArray",
        "Cells",     "DataArray",        "DataArray", "DataArray", "PointData",
        "DataArray", "DataArray",        "CellData"};
    EXPECT_EQ(elements_of(xml), expected);
    EXPECT_NE(xml.find("NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfCells=\"" +
                       std::to_string(n) + '"'),
              std::string::npos);
    EXPECT_NE(xml.find("header_type=\"UInt64\""), std::string::npos);

    std::string tag;
    const auto coordinates = array<double>(xml, "Points", tag);
    ASSERT_EQ(coordinates.size(), 3 * n);
    for (std::size_t i = 0; i < 3 * n; ++i)
      EXPECT_EQ(coordinates[i], points[i / 3][i % 3]);
    EXPECT_NE(tag.find("NumberOfComponents=\"3\""), std::string::npos);
    EXPECT_EQ(array<double>(xml, "radius_m"), radius.values);
    const auto vectors = array<double>(xml, "a&lt;b &amp; &quot;c&quot;", tag);
    EXPECT_NE(tag.find("NumberOfComponents=\"3\""), std::string::npos);
    ASSERT_EQ(vectors.size(), 3 * n);
    if (n > 0)
    {
      EXPECT_EQ(std::memcmp(vectors.data(), displacement.values.data(), 24 * n), 0);
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      EXPECT_EQ(array<std::int64_t>(xml, "connectivity")[i], static_cast<long>(i));
      EXPECT_EQ(array<std::int64_t>(xml, "offsets")[i], static_cast<long>(i + 1));
    }
    EXPECT_EQ(array<std::uint8_t>(xml, "types"), std::vector<std::uint8_t>(n, 1));
  }
}

TEST(Vtu, JointsReadBack)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("joints.vtu");
  write_lines_vtu(path, {Point{0., 0., 0.}, Point{1., 0., 0.}, Point{1., 2., 0.}},
                  {{0, 1}, {2, 1}}, {{"normal_force_N", 1, {-5e6, 3.}}});
  const std::string xml = read_file(path);
  elements_of(xml);
  EXPECT_NE(xml.find("NumberOfPoints=\"3\" NumberOfCells=\"2\""), std::string::npos);
  EXPECT_EQ(array<std::int64_t>(xml, "connectivity"),
            (std::vector<std::int64_t>{0, 1, 2, 1}));
  EXPECT_EQ(array<std::int64_t>(xml, "offsets"), (std::vector<std::int64_t>{2, 4}));
  EXPECT_EQ(array<std::uint8_t>(xml, "types"), (std::vector<std::uint8_t>{3, 3}));
  EXPECT_EQ(array<double>(xml, "normal_force_N"), (std::vector<double>{-5e6, 3.}));
  EXPECT_GT(xml.find("normal_force_N"), xml.find("<CellData>"));
}

TEST(Vtu, RefusesFieldsThatDoNotFit)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("grains.vtu");
  const std::vector<Point> points(2);
  const auto error = [&](const Field &field)
  {
    return message_of<std::logic_error>([&] { write_points_vtu(path, points, {field}); });
  };
  EXPECT_NE(error({"radius_m", 1, {1.}}).find("'radius_m' has 1 values"),
            std::string::npos);
  EXPECT_FALSE(error({"x", 3, {1., 2.}}).empty());
  EXPECT_FALSE(error({"x", 2, {1., 2., 3., 4.}}).empty());
  EXPECT_THROW(write_lines_vtu(path, points, {{0, 2}}, {}), std::logic_error);
  EXPECT_THROW(write_lines_vtu(path, points, {{-1, 1}}, {}), std::logic_error);
  EXPECT_THROW(read_file(path), std::runtime_error) << "a refused file was written";
}

TEST(Vtu, FullDiskIsAnErrorThatNamesTheFile)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("grains.vtu");
  const std::vector<Point> points(1000);
  std::string error;
  {
    const FullDisk full(10000);
    error = message_of<std::runtime_error>([&] { write_points_vtu(path, points, {}); });
  }
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_THROW(read_file(path), std::runtime_error) << "half a file was left";
}

TEST(Pvd, ListsFilesByTimeWithOnePartAGroup)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("fields.pvd");
  write_pvd(path, {{0.5, "grains", "fields/grains_0002.vtu"},
                   {0.5, "continuum", "fields/continuum_0002.vtu"},
                   {1. / 3., "grains", "fields/grains_0001.vtu"}});
  const std::string xml = read_file(path);
  EXPECT_EQ(elements_of(xml),
            (std::vector<std::string>{"VTKFile", "Collection", "DataSet", "DataSet",
                                      "DataSet"}));
  const std::string expected =
      "<DataSet timestep=\"0.3333333333333333\" group=\"grains\" part=\"0\" "
      "file=\"fields/grains_0001.vtu\"/>\n"
      "<DataSet timestep=\"0.5\" group=\"grains\" part=\"0\" "
      "file=\"fields/grains_0002.vtu\"/>\n"
      "<DataSet timestep=\"0.5\" group=\"continuum\" part=\"1\" "
      "file=\"fields/continuum_0002.vtu\"/>\n";
  EXPECT_NE(xml.find(expected), std::string::npos) << xml;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_pvd(path, {{nan, "grains", "x.vtu"}}), std::logic_error);
  EXPECT_EQ(read_file(path), xml);
}
} // namespace vtu_tests

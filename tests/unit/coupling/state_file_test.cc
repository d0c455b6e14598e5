#include "coupling/state_file.h"

#include "coupling/output/whole_file.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace state_file_tests
{
using namespace antiform::coupling;
using antiform::test::FullDisk;
using antiform::test::message_of;
using antiform::test::TemporaryFolder;

namespace
{
/// An object with one state of each kind, as components have.
struct Sample
{
  std::vector<double> x;
  std::vector<std::int64_t> cell;
  std::vector<double> none;
  std::string deck;
  double time = 0.;
  std::int64_t step = 0;

  void visit_state(StateArchive &archive)
  {
    archive.array("grains/x", x);
    archive.array("grains/cell", cell);
    archive.array("none", none);
    archive.text("deck", deck);
    archive.value("time", time);
    archive.value("step", step);
  }
};

Sample sample()
{
  const double inf = std::numeric_limits<double>::infinity();
  Sample s;
  s.x = {0.1, -0., 1e-310, inf, -inf, std::nan("7"), 1. / 3.};
  s.cell = {0, -1, std::numeric_limits<std::int64_t>::max(), -(1ll << 60)};
  s.deck = std::string("set Title = K\xc3\xb6ln\n\0 end", 23);
  s.time = 1. / 7.;
  s.step = 123456789012345;
  return s;
}

void save(Sample s, const std::string &path)
{
  StateWriter writer;
  s.visit_state(writer);
  writer.commit(path);
}

Sample load(const std::string &path)
{
  Sample s;
  StateReader reader(path);
  s.visit_state(reader);
  reader.expect_all_read();
  return s;
}

bool exists(const std::string &path)
{
  return std::ifstream(path).good();
}

void put(const std::string &path, const std::string &bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string load_error(const std::string &path)
{
  return message_of<std::runtime_error>([&] { StateReader reader(path); });
}
} // namespace

TEST(StateFile, GivesBackTheSameBits)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("state.h5");
  const Sample before = sample();
  save(before, path);
  const Sample after = load(path);
  ASSERT_EQ(after.x.size(), before.x.size());
  EXPECT_EQ(std::memcmp(after.x.data(), before.x.data(), 8 * before.x.size()), 0);
  EXPECT_EQ(after.cell, before.cell);
  EXPECT_TRUE(after.none.empty());
  EXPECT_EQ(after.deck, before.deck);
  EXPECT_EQ(after.time, before.time);
  EXPECT_EQ(after.step, before.step);
  EXPECT_FALSE(exists(path + ".tmp"));
}

TEST(StateFile, ChecksumIsCrc64Xz)
{
  // Check value of the catalogue of parametrised CRC algorithms.
  EXPECT_EQ(crc64("123456789", 9), 0x995DC9BBDF1939FAu);
  EXPECT_EQ(crc64("", 0), 0u);
}

TEST(StateFile, RefusesFlippedBits)
{
  const TemporaryFolder folder;
  save(sample(), folder.path("state.h5"));
  const std::string whole = read_file(folder.path("state.h5"));
  const std::string damaged = folder.path("damaged.h5");
  // Every byte of the leading block, then samples of what the checksum covers.
  for (std::size_t i = 0; i < whole.size(); i += i < 512 ? 1 : 37)
  {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << i % 8));
    put(damaged, bytes);
    const std::string error = load_error(damaged);
    EXPECT_FALSE(error.empty()) << "byte " << i << " of " << whole.size();
    if (i > 512)
    {
      EXPECT_NE(error.find("checksum"), std::string::npos) << error;
    }
  }
}

TEST(StateFile, NamesWhatIsWrongWithAFile)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("state.h5");
  EXPECT_NE(load_error(path).find("No such file"), std::string::npos) << load_error(path);
  EXPECT_NE(load_error(path).find(path), std::string::npos);

  put(path, "");
  EXPECT_NE(load_error(path).find("not a state file"), std::string::npos);
  put(path, "\x89HDF\r\n\x1a\n of somebody else");
  EXPECT_NE(load_error(path).find("not a state file"), std::string::npos);

  save(sample(), path);
  const std::string whole = read_file(path);
  for (const std::size_t n : {std::size_t(40), std::size_t(100), whole.size() - 1})
  {
    put(path, whole.substr(0, n));
    const std::string wanted =
        n == 40 ? "first 512 bytes"
                : std::to_string(n) + " bytes of the " + std::to_string(whole.size());
    EXPECT_NE(load_error(path).find(wanted), std::string::npos) << load_error(path);
  }
  put(path, whole + "x");
  EXPECT_FALSE(load_error(path).empty());

  std::string newer = whole;
  newer.replace(newer.find("version 4"), 9, "version 7");
  put(path, newer);
  EXPECT_NE(load_error(path).find("format version 7"), std::string::npos);
}

TEST(StateFile, RefusesEntriesThatDoNotFitTheScene)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("state.h5");
  save(sample(), path);
  StateReader reader(path);
  std::vector<double> numbers;
  std::vector<std::int64_t> integers;

  const auto error = [&](const auto &action)
  { return message_of<std::runtime_error>(action); };
  EXPECT_NE(error([&] { reader.array("grains/y", numbers); }).find("'grains/y'"),
            std::string::npos);
  EXPECT_NE(error([&] { reader.array("grains/cell", numbers); }).find("integers"),
            std::string::npos);
  EXPECT_NE(error([&] { reader.array("grains/x", integers); }).find("numbers"),
            std::string::npos);
  numbers.assign(6, 4.);
  EXPECT_NE(error([&] { reader.array("grains/x", numbers); }).find("7 values"),
            std::string::npos);
  EXPECT_EQ(numbers, std::vector<double>(6, 4.)) << "changed by a refused load";
  double x = 5.;
  EXPECT_FALSE(error([&] { reader.value("grains/x", x); }).empty());
  numbers.assign(7, 4.);
  reader.array("grains/x", numbers);
  EXPECT_EQ(numbers[0], 0.1);
  EXPECT_NE(error([&] { reader.expect_all_read(); }).find("which nothing"),
            std::string::npos);
}

TEST(StateFile, RefusesBadNamesWhenWriting)
{
  StateWriter writer;
  std::vector<double> values(3, 1.);
  writer.array("x", values);
  EXPECT_THROW(writer.array("x", values), std::logic_error);
  for (const char *name : {"", "/x", "x/", "a//b", "a/./b", "a\nb", "contents"})
    EXPECT_THROW(writer.array(name, values), std::logic_error) << name;
  // A name cannot be an array and a group at once.
  const TemporaryFolder folder;
  writer.array("x/y", values);
  EXPECT_THROW(writer.commit(folder.path("state.h5")), std::runtime_error);
  EXPECT_FALSE(exists(folder.path("state.h5")));
}

TEST(StateFile, FullDiskLeavesTheFormerFile)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("state.h5");
  save(sample(), path);
  const std::string former = read_file(path);
  Sample larger = sample();
  larger.x.assign(100000, 0.5);
  std::string error;
  {
    const FullDisk full(300000);
    error = message_of<std::runtime_error>([&] { save(larger, path); });
  }
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_NE(error.find("File too large"), std::string::npos) << error;
  EXPECT_EQ(read_file(path), former);
  EXPECT_EQ(load(path).step, sample().step);
  EXPECT_FALSE(exists(path + ".tmp"));
  save(larger, path); // with space again
  EXPECT_EQ(load(path).x, larger.x);
}

TEST(StateFile, MissingFolderIsAnError)
{
  const TemporaryFolder folder;
  const std::string error = message_of<std::runtime_error>(
      [&] { save(sample(), folder.path("none/state.h5")); });
  EXPECT_NE(error.find("No such file"), std::string::npos) << error;
}

TEST(StateFile, HalfWrittenTemporaryFileOfAKilledRunDoesNoHarm)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("state.h5");
  save(sample(), path);
  put(path + ".tmp", "half a file");
  EXPECT_EQ(load(path).step, sample().step);
  save(sample(), path);
  EXPECT_EQ(load(path).step, sample().step);
  EXPECT_FALSE(exists(path + ".tmp"));
}
} // namespace state_file_tests

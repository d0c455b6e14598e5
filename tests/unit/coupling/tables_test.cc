#include "coupling/output/tables.h"

#include "coupling/output/whole_file.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace tables_tests
{
using namespace antiform;
using namespace antiform::coupling;
using antiform::test::FullDisk;
using antiform::test::message_of;
using antiform::test::TemporaryFolder;

TEST(ShortestText, ReadsBackToTheSameBits)
{
  const double largest = std::numeric_limits<double>::max();
  const double smallest = std::numeric_limits<double>::denorm_min();
  for (const double x : {0.1, 1. / 3., -2.5e-12, 1e15, 1e22, largest, smallest, 123456.75,
                         std::nextafter(1., 2.), -0., 1e14 - 1.})
  {
    const double back = std::strtod(shortest_text(x).c_str(), nullptr);
    EXPECT_EQ(back, x) << shortest_text(x);
    EXPECT_EQ(std::signbit(back), std::signbit(x)) << shortest_text(x);
  }
}

TEST(ShortestText, IsShortAndWholeNumbersHaveNoExponent)
{
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(100000.), "100000");
  EXPECT_EQ(shortest_text(-7.), "-7");
  EXPECT_EQ(shortest_text(0.), "0");
  EXPECT_EQ(shortest_text(1e22), "1e+22");
}

TEST(Table, HoldsHeaderAndLines)
{
  const TemporaryFolder folder;
  Table table(folder.path("history.csv"), {"step", "axial_stress_Pa"});
  EXPECT_EQ(table.offset(), 21);
  table.append(std::vector<double>{0., 0.1});
  table.append(std::vector<double>{200., -1.5e7 / 7.});
  const std::string text = read_file(folder.path("history.csv"));
  EXPECT_EQ(text, "step,axial_stress_Pa\n0,0.1\n200,-2142857.1428571427\n");
  EXPECT_EQ(table.offset(), static_cast<std::int64_t>(text.size()));
}

TEST(Table, RefusesLinesThatDoNotFit)
{
  const TemporaryFolder folder;
  Table table(folder.path("a.csv"), {"a", "b"});
  EXPECT_THROW(table.append(std::vector<double>{1.}), std::logic_error);
  EXPECT_THROW(table.append(std::vector<std::string>{"1", "2,3"}), std::logic_error);
  EXPECT_EQ(read_file(folder.path("a.csv")), "a,b\n");
  table.append(std::vector<std::string>{"", ""});
  EXPECT_EQ(read_file(folder.path("a.csv")), "a,b\n,\n");
  EXPECT_THROW(Table(folder.path("b.csv"), {}), std::logic_error);
  EXPECT_THROW(Table(folder.path("none/c.csv"), {"a"}), std::runtime_error);
}

TEST(Table, ResumedTableEqualsTheUninterruptedOne)
{
  const TemporaryFolder folder;
  const std::vector<std::string> columns = {"step", "x"};
  const std::string path = folder.path("history.csv");
  std::int64_t offset = 0;
  {
    Table table(path, columns);
    table.append(std::vector<double>{1., 0.1});
    offset = table.offset();
    table.append(std::vector<double>{2., 9e9}); // after the checkpoint: written again
    table.append(std::vector<double>{3., 9e9});
  }
  Table table = Table::reopen(path, columns, offset);
  table.append(std::vector<double>{2., 0.2});
  EXPECT_EQ(read_file(path), "step,x\n1,0.1\n2,0.2\n");
  EXPECT_EQ(table.offset(), 19);
}

TEST(Table, ReopenRefusesAnotherFile)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("history.csv");
  const std::vector<std::string> columns = {"step", "x"};
  const auto error = [&](const std::vector<std::string> &header,
                         const std::int64_t offset) {
    return message_of<std::runtime_error>([&] { Table::reopen(path, header, offset); });
  };
  EXPECT_NE(error(columns, 7).find("No such file"), std::string::npos);
  Table(path, columns).append(std::vector<double>{1., 0.1});
  const std::string before = read_file(path);
  EXPECT_NE(error({"step", "y"}, 7).find("first line is not 'step,y'"),
            std::string::npos);
  EXPECT_NE(error({"step", "x", "y"}, 13).find("first line"), std::string::npos);
  EXPECT_NE(error(columns, 14).find("13 bytes"), std::string::npos) << error(columns, 14);
  EXPECT_NE(error(columns, 9).find("no line ends at byte 9"), std::string::npos);
  EXPECT_NE(error(columns, 0).find("no line ends"), std::string::npos);
  EXPECT_EQ(read_file(path), before) << "changed by a refused reopen";
  EXPECT_EQ(error(columns, 7), "") << "7 is the end of the header";
  EXPECT_EQ(read_file(path), "step,x\n");
}

TEST(Table, FullDiskLeavesWholeLines)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("history.csv");
  Table table(path, {"step", "x"});
  std::string error;
  {
    const FullDisk full(60);
    error = message_of<std::runtime_error>(
        [&]
        {
          for (int i = 0; i < 100; ++i)
            table.append(std::vector<double>{1000. + i, 0.25});
        });
  }
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_NE(error.find("File too large"), std::string::npos) << error;
  EXPECT_EQ(read_file(path),
            "step,x\n1000,0.25\n1001,0.25\n1002,0.25\n1003,0.25\n1004,0.25\n");
  table.append(std::vector<double>{1005., 0.5}); // with space again
  EXPECT_EQ(read_file(path).substr(57), "1005,0.5\n");
}

TEST(CrackTable, WritesOneLineABrokenElement)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("cracks.csv");
  discrete::Crack crack;
  crack.step = 12000000000;
  crack.time = 0.125;
  crack.place = {1.5, -2.};
  crack.reference_place = {1.25, -2.};
  crack.orientation = M_PI / 2.;
  crack.length = 0.1;
  crack.mode = discrete::Bond::broken_in_shear;
  crack.layer = 1;
  crack.joint = 77;
  crack.element = 2;
  std::int64_t offset = 0;
  {
    CrackTable table(path);
    table.append(crack, 0.0025);
    offset = table.offset();
    crack.mode = discrete::Bond::bonded;
    EXPECT_THROW(table.append(crack, 0.0025), std::logic_error);
  }
  const std::string expected =
      "step,time_s,shortening,x_m,y_m,reference_x_m,reference_y_m,orientation_deg,length_"
      "m,"
      "mode,layer,joint,element\n"
      "12000000000,0.125,0.0025,1.5,-2,1.25,-2,90,0.1,shear,1,77,2\n";
  EXPECT_EQ(read_file(path), expected);
  CrackTable resumed(path, offset);
  crack.mode = discrete::Bond::broken_in_tension;
  resumed.append(crack, 0.003);
  EXPECT_EQ(read_file(path),
            expected + "12000000000,0.125,0.003,1.5,-2,1.25,-2,90,0.1,tension,1,77,2\n");
}
} // namespace tables_tests

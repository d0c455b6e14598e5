#include "cases/summary.h"

#include "coupling/output/whole_file.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <stdexcept>

namespace summary_tests
{
using namespace antiform::cases;
using antiform::coupling::read_file;
using antiform::test::FullDisk;
using antiform::test::message_of;
using antiform::test::TemporaryFolder;

namespace
{
Summary sample()
{
  Summary s;
  s.title = "Buried \"anticline\"\n";
  s.version = "0.1.0";
  s.status = "completed";
  s.warnings = {"one"};
  s.wall_seconds = 0.1;
  s.cpu_seconds = 1. / 3.;
  s.peak_memory = 5000000000;
  s.sizes = {{"grains", 15000}, {"joints", 38000}};
  s.steps = 1ll << 60;
  s.results = {{"peak_stress", {1.62e8 / 7., "Pa"}}};
  s.energy = {{"closure_error", 1e-12 / 3.}};
  s.effects = {{"gravity", {false, "not listed", 0, 0.}}};
  return s;
}
} // namespace

TEST(Summary, ReadsBack)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("summary.json");
  write_summary(path, sample());
  const auto json = nlohmann::json::parse(read_file(path));
  EXPECT_EQ(json["title"], "Buried \"anticline\"\n");
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["warnings"], nlohmann::json::array({"one"}));
  EXPECT_EQ(json["cpu_seconds"].get<double>(), 1. / 3.);
  EXPECT_EQ(json["peak_memory_bytes"].get<std::int64_t>(), 5000000000);
  EXPECT_EQ(json["sizes"]["joints"], 38000);
  EXPECT_EQ(json["steps"].get<std::int64_t>(), 1ll << 60);
  EXPECT_EQ(json["results"]["peak_stress"]["value"].get<double>(), 1.62e8 / 7.);
  EXPECT_EQ(json["results"]["peak_stress"]["unit"], "Pa");
  EXPECT_EQ(json["energy"]["closure_error"].get<double>(), 1e-12 / 3.);
  EXPECT_EQ(json["effects"]["gravity"]["active"], false);
  EXPECT_EQ(json["effects"]["gravity"]["reason"], "not listed");
}

TEST(Summary, RefusesNumbersThatAreNone)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("summary.json");
  write_summary(path, sample());
  const std::string former = read_file(path);
  const auto error = [&](const Summary &s)
  { return message_of<std::runtime_error>([&] { write_summary(path, s); }); };

  Summary s = sample();
  s.results["limb_dip"] = {std::numeric_limits<double>::quiet_NaN(), "deg"};
  EXPECT_NE(error(s).find("'results/limb_dip' is not a number"), std::string::npos);
  s = sample();
  s.energy["slip"] = std::numeric_limits<double>::infinity();
  EXPECT_NE(error(s).find("'energy/slip' is infinite"), std::string::npos);
  s.status = "interrupted";
  EXPECT_NE(error(s).find("'energy/slip' is infinite"), std::string::npos);
  s = sample();
  s.status = "fine";
  EXPECT_THROW(write_summary(path, s), std::logic_error);
  EXPECT_EQ(read_file(path), former);
}

TEST(Summary, OfAFailedRunHasNullForWhatWasLost)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("summary.json");
  Summary s = sample();
  s.status = "failed";
  s.energy["kinetic"] = std::numeric_limits<double>::quiet_NaN();
  s.results["limb_dip"] = {std::numeric_limits<double>::infinity(), "deg"};
  write_summary(path, s);
  const auto json = nlohmann::json::parse(read_file(path));
  EXPECT_TRUE(json["energy"]["kinetic"].is_null());
  EXPECT_TRUE(json["results"]["limb_dip"]["value"].is_null());
  EXPECT_EQ(json["energy"]["closure_error"].get<double>(), 1e-12 / 3.);
}

TEST(Summary, FullDiskLeavesTheFormerFile)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("summary.json");
  write_summary(path, sample());
  const std::string former = read_file(path);
  Summary s = sample();
  s.warnings.emplace_back(5000, 'x');
  {
    const FullDisk full(1000);
    EXPECT_THROW(write_summary(path, s), std::runtime_error);
  }
  EXPECT_EQ(read_file(path), former);
}
} // namespace summary_tests

#include "cases/run_outcome.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <fstream>

namespace run_outcome_tests
{
using namespace antiform::cases;
using namespace antiform::test;

TEST(RunOutcome, HasTheUnitsOfASummarysNumbers)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("summary.json"))
      << R"({"status": "completed", "cpu_seconds": 2, "steps": 7,
             "peak_memory_bytes": 3, "sizes": {"grains": 5},
             "energy": {"boundary_work": 4.0, "closure_error": 1e-4},
             "results": {"peak_stress": {"value": 1e8, "unit": "Pa"}}})";
  const RunOutcome outcome = read_outcome(folder.path("."));
  const std::pair<const char *, const char *> units[] = {
      {"cpu_seconds", "s"},           {"steps", "-"},
      {"peak_memory_bytes", "bytes"}, {"sizes/grains", "-"},
      {"energy/boundary_work", "J"},  {"energy/closure_error", "-"}, // a share
      {"peak_stress", "Pa"}};
  for (const auto &[name, unit] : units)
  {
    Result figure;
    ASSERT_TRUE(find_figure(outcome, name, figure)) << name;
    EXPECT_EQ(figure.unit, unit) << name;
  }
}
} // namespace run_outcome_tests

#include "cases/remedies.h"

#include <gtest/gtest.h>

namespace remedies_tests
{
using namespace antiform::cases;

TEST(Remedies, NameEntriesThatTheDriverReads)
{
  const struct
  {
    std::string loading, ledger, records;
  } drivers[] = {
      {"constant rate", "Run/Step safety", "Output/Samples per millistrain"},
      {"step and relax", "Run/Step safety", "Walls/Load step"},
      {"event driver", "Walls/Balance tolerance", "Walls/Load step"}};
  for (const auto &driver : drivers)
  {
    Parameters p;
    p.components = {"layer", "walls"};
    p.walls.loading = driver.loading;
    EXPECT_NE(closer_ledger(p).find(driver.ledger), std::string::npos) << driver.loading;
    EXPECT_NE(closer_records(p).find(driver.records), std::string::npos)
        << driver.loading;
    EXPECT_EQ(closer_ledger(p).find("Step safety") == std::string::npos,
              p.follows_events());
  }
}
} // namespace remedies_tests

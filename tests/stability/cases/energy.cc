// The ledger of a run: what the walls have put in is stored, dissipated or moving.
#include "support/tiny_run.h"

namespace energy_tests
{
using namespace antiform::test;

namespace
{
double closure_error(const nlohmann::json &summary)
{
  return summary.at("energy").at("closure_error").get<double>();
}
} // namespace

TEST(EnergyOfARun, ClosesThroughBreakage)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_tiny(folder.path("run"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_GT(result(summary, "crack_count"), 20.);
  EXPECT_GT(summary.at("energy").at("fracture").get<double>(), 0.);
  // A break and a slip are booked at the step's end: first order in the step.
  EXPECT_LT(closure_error(summary), 1e-3);
}

TEST(EnergyOfARun, ClosesWithoutDampingAndBreakage)
{
  const TemporaryFolder folder;
  const Outcome outcome =
      run_tiny(folder.path("run"), set(unbreakable({"Components=layer, matrix, walls"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_EQ(summary.at("energy").at("damping"), 0.);
  EXPECT_EQ(summary.at("energy").at("slip"), 0.);
  EXPECT_GT(summary.at("energy").at("kinetic").get<double>(), 0.);
  // Leapfrog: second order in the step, and the walls start gently.
  EXPECT_LT(closure_error(summary), 1e-5);
}
} // namespace energy_tests

// Bent layers of grains under a pressure: in a matrix that carries it.
#include "support/tiny_run.h"

namespace confined_layers_tests
{
using namespace antiform::test;

namespace
{
nlohmann::json run_quick(const std::vector<std::string> &entries,
                         const std::string &directory)
{
  const Outcome outcome = run_program(
      "run " ANTIFORM_SOURCE_DIR "/cases/confinement/quick.prm" + set(entries) + " -o " +
      directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json run = summary_of(directory);
  EXPECT_EQ(run.at("status"), "completed");
  EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
  return run;
}
} // namespace

TEST(ConfinedLayers, StartUnderTheirPressureAndAreStrongerByMoreThanIt)
{
  const TemporaryFolder folder;
  const nlohmann::json confined = run_quick({}, folder.path("confined"));
  const nlohmann::json bare =
      run_quick({"Components=layer, walls, damping"}, folder.path("bare"));
  // Laid down under 10 MPa: its ends begin with them, nothing is shortened first.
  const CsvTable history(folder.path("confined/history.csv"));
  EXPECT_NEAR(history.column("axial_stress_Pa").front() / 10e6, 1., 1e-6);
  EXPECT_EQ(history.column("shortening").front(), 0.);
  // The inner arc of the bent layer fails at UCS + N p of the rock, with N > 1, under a
  // stress that its bending has raised 2.5 times: twice the pressure is a lower bound of
  // what the matrix, which keeps it from bending on, lets it gain.
  EXPECT_GT(result(confined, "peak_stress"), result(bare, "peak_stress") + 2. * 10e6);
  // Pressure closes what would open.
  const auto share_in_tension = [](const nlohmann::json &run)
  { return result(run, "cracks_tensile") / result(run, "crack_count"); };
  EXPECT_LT(share_in_tension(confined), share_in_tension(bare));
}
} // namespace confined_layers_tests

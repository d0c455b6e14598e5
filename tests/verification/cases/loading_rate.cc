// Case 32 of docs/validation.md: walls at half the speed leave the strength as it is.
#include "support/tiny_run.h"

#include <cmath>
#include <csignal>
#include <filesystem>

namespace loading_rate_tests
{
using namespace antiform::test;

namespace
{
const std::string uniaxial = "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm";
const std::string estimate = "Run/Estimate loading-rate error=true";

std::vector<std::string> fast(const std::vector<std::string> &more = {})
{
  std::vector<std::string> entries{"Layer/Grains across=20", "Layer/Seed=2",
                                   "Walls/Transits per millistrain=20"};
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}
} // namespace

// The estimate repeats the last tenth of the way only, so it sees the greater part of
// what a whole run at half the rate shows: 0.25 against 0.29 % here.
TEST(LoadingRateEstimate, SeesWhatAWholeRunAtHalfTheRateShows)
{
  const TemporaryFolder folder;
  const std::string with = folder.path("with"), whole = folder.path("whole");
  Outcome outcome = run_program(uniaxial + " -o " + with + set(fast({estimate})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  outcome = run_program(uniaxial + " -o " + whole +
                        set(fast({"Walls/Transits per millistrain=40"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const auto summary = summary_of(with);
  const double peak = result(summary, "peak_stress"),
               at_half = result(summary, "peak_stress_at_half_rate"),
               change = result(summary, "loading_rate_error"),
               whole_change = peak / result(summary_of(whole), "peak_stress") - 1.;
  EXPECT_DOUBLE_EQ(change, peak / at_half - 1.);
  EXPECT_GT(change, 1e-3) << "20 transits a millistrain are fast";
  EXPECT_NEAR(change, whole_change, 2e-3);
  // The repetition is a run of its own, with what came before it.
  EXPECT_EQ(result(summary_of(with + "/half-rate"), "peak_stress"), at_half);
  const CsvTable former(with + "/history.csv"), half(with + "/half-rate/history.csv");
  EXPECT_EQ(former.column("axial_stress_Pa").at(100),
            half.column("axial_stress_Pa").at(100));
  EXPECT_FALSE(std::filesystem::exists(with + "/before-peak-1.h5"));
}

// An interruption of the repetition costs nothing: the same bits in the end.
TEST(LoadingRateEstimate, GoesOnWhereItWasInterrupted)
{
  const TemporaryFolder folder;
  const std::string once = folder.path("once"), twice = folder.path("twice");
  const std::string often = "Output/Checkpoint interval=1e-4";
  const std::string options = set(fast({estimate, often}));
  Outcome outcome = run_program(uniaxial + " -o " + once + options);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  RunningProgram program(uniaxial + " -o " + twice + options);
  const std::string history = twice + "/half-rate/history.csv";
  ASSERT_TRUE(program.wait_until(
      [&] { return std::filesystem::exists(twice + "/half-rate/state.h5"); }));
  std::error_code error;
  const auto before = std::filesystem::last_write_time(history, error);
  ASSERT_TRUE(program.wait_until(
      [&] { return std::filesystem::last_write_time(history, error) != before; }))
      << "over before it could be killed";
  program.send(SIGKILL);
  EXPECT_EQ(program.wait(), -SIGKILL);
  outcome = run_program(uniaxial + " -o " + twice + options + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_file("history.csv", once, twice);
  expect_same_file("half-rate/history.csv", once, twice);
  expect_same_file("half-rate/cracks.csv", once, twice);
  EXPECT_EQ(result(summary_of(once), "loading_rate_error"),
            result(summary_of(twice), "loading_rate_error"));
}

TEST(LoadingRateEstimate, IsRefusedOrMissedWhereThereIsNoPeak)
{
  const TemporaryFolder folder;
  for (const char *entry : {"Run/Driver=dynamic", "Layer/Representation=continuum"})
  {
    const Outcome outcome = run_program("check " + tiny_deck() + set({estimate, entry}));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find("Estimate loading-rate error"), std::string::npos)
        << outcome.output;
  }
  const std::string directory = folder.path("no-peak");
  const Outcome outcome = run_program(uniaxial + " -o " + directory +
                                      set(fast({estimate, "Run/End shortening=2e-4"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("no estimate of the loading-rate error"),
            std::string::npos);
  EXPECT_EQ(summary_of(directory).at("results").count("loading_rate_error"), 0U);
}

// A stout specimen at the laboratory's speed and at half of it. Which bond breaks first
// hangs on the least difference: single packings move by up to 6 %, the mean of 16 by
// -0.6 +- 0.5 %, that of eight by some 0.7 %. (Slender layers do depend on the speed:
// cases/shortening.)
TEST(LoadingRate, LeavesTheStrengthOfASpecimenAsItIsLong)
{
  const TemporaryFolder folder;
  constexpr int n_packings = 8;
  double change = 0.;
  for (int seed = 1; seed <= n_packings; ++seed)
  {
    double strength[2];
    for (const int k : {0, 1})
    {
      const std::string directory =
          folder.path(std::to_string(seed) + (k == 0 ? "-300" : "-600"));
      const Outcome outcome = run_program(
          "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " + directory +
          set({"Layer/Grains across=20", "Layer/Seed=" + std::to_string(seed),
               k == 0 ? "Walls/Transits per millistrain=300"
                      : "Walls/Transits per millistrain=600"}));
      ASSERT_EQ(outcome.status, 0) << outcome.output;
      strength[k] = result(summary_of(directory), "peak_stress");
    }
    std::printf("seed %d: %.2f MPa, %.2f MPa at half the speed\n", seed,
                1e-6 * strength[0], 1e-6 * strength[1]);
    EXPECT_NEAR(strength[1] / strength[0], 1., 0.1) << seed;
    change += (strength[1] / strength[0] - 1.) / n_packings;
  }
  EXPECT_LT(std::abs(change), 0.02);
}
} // namespace loading_rate_tests

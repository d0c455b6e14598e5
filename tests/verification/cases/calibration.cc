// A calibration from deck to rock file, its trials processes of their own. The specimen
// is far too small and fast for a rock; it is for the machinery.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace calibration_tests
{
using namespace antiform::test;

namespace
{
const std::vector<std::string> tiny{
    "Layer/Grains across=8",
    "Components=layer, walls, damping, calibration",
    "Walls/Transits per millistrain=30",
    "Walls/Grip layers=4",
    "Calibration/Confinements=",
    "Calibration/Strengths=",
    "Calibration/Free=effective modulus, tensile strength, "
    "cohesion",
    "Calibration/Tension transits per millistrain=300",
    "Calibration/Search seeds=1",
    "Calibration/Check seeds=1",
    "Calibration/Check rounds=1",
    "Calibration/Evaluations=2",
    "Calibration/Jobs=2",
    "Calibration/Tension tolerance=0.6",
    "Calibration/Uniaxial tolerance=0.6",
    "Calibration/Modulus tolerance=0.3"};

std::string calibrate(const std::string &directory,
                      const std::vector<std::string> &more = {},
                      const std::string &options = "")
{
  return "calibrate " ANTIFORM_SOURCE_DIR "/cases/laboratory/calibrate-rock-1.prm" +
         set(tiny) + set(more) + " -o " + directory + " " + options;
}

nlohmann::json record(const std::string &directory)
{
  return nlohmann::json::parse(contents(directory + "/calibration.json"));
}

std::size_t trial_folders(const std::string &directory)
{
  namespace fs = std::filesystem;
  const fs::directory_iterator all(directory + "/trials");
  return static_cast<std::size_t>(std::count_if(fs::begin(all), fs::end(all),
                                                [](const fs::directory_entry &entry)
                                                { return entry.is_directory(); }));
}
} // namespace

TEST(Calibration, LeavesARockARecordAndTrialsThatAreNotRunAgain)
{
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  const Outcome first = run_program(calibrate(out));
  ASSERT_EQ(first.status, 0) << first.output;
  const nlohmann::json json = record(out);
  EXPECT_EQ(json.at("status"), "completed");
  EXPECT_EQ(json.at("met"), true);
  EXPECT_EQ(json.at("targets").size(), 3u);
  for (const nlohmann::json &target : json.at("targets"))
    EXPECT_LE(
        std::abs(target.at("reached").get<double>() / target.at("target").get<double>() -
                 1.),
        target.at("tolerance").get<double>());
  // A trial by itself, from the deck that it leaves, gives the number in the table again.
  EXPECT_NE(contents(out + "/trials.csv").find("tension-seed1-"), std::string::npos);
  EXPECT_EQ(json.at("trials").get<std::size_t>(), trial_folders(out));
  EXPECT_NE(contents(out + "/rock.prm").find("subsection Flat joint"), std::string::npos);

  // The same again: everything is found, nothing changes.
  EXPECT_EQ(run_program(calibrate(out)).status, 1); // not without being told
  const Outcome again = run_program(calibrate(out, {}, "--resume"));
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_NE(
      again.output.find("(" + std::to_string(trial_folders(out)) + " of them found)"),
      std::string::npos)
      << again.output;
  EXPECT_EQ(record(out).at("parameters"), json.at("parameters"));
  EXPECT_EQ(record(out).at("evaluations"), json.at("evaluations"));

  // Tolerances that nothing meets: status 2, and a rock that says so.
  const Outcome missed =
      run_program(calibrate(out, {"Calibration/Uniaxial tolerance=1e-9"}, "--resume"));
  EXPECT_EQ(missed.status, 2) << missed.output;
  EXPECT_EQ(record(out).at("met"), false);
  EXPECT_NE(contents(out + "/rock.prm").find("NOT all targets are met"),
            std::string::npos);
}

TEST(Calibration, GoesOnAfterAnInterruptToTheSameRock)
{
  const TemporaryFolder folder;
  const std::string whole = folder.path("whole"), parts = folder.path("parts");
  // Slow enough to be met at work.
  const std::vector<std::string> slower{"Walls/Transits per millistrain=100",
                                        "Calibration/Evaluations=1"};
  ASSERT_EQ(run_program(calibrate(whole, slower)).status, 0);

  RunningProgram program(calibrate(parts, slower));
  // The elastic trial has ended, another is at work.
  ASSERT_TRUE(program.wait_until(
      [&]
      {
        namespace fs = std::filesystem;
        std::error_code error;
        for (fs::directory_iterator entry(parts + "/trials", error), end;
             !error && entry != end; entry.increment(error))
          if (entry->path().filename().string().rfind("uniaxial", 0) == 0 &&
              fs::exists(entry->path() / "state.h5", error))
            return true;
        return false;
      }));
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 3);
  EXPECT_EQ(record(parts).at("status"), "interrupted");

  const Outcome resumed = run_program(calibrate(parts, slower, "--resume"));
  EXPECT_EQ(resumed.status, 0) << resumed.output;
  EXPECT_EQ(record(parts).at("evaluations"), record(whole).at("evaluations"));
  EXPECT_EQ(trial_folders(parts), trial_folders(whole));
}

TEST(Calibration, RefusesTheDirectoryOfARun)
{
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path("run"));
  std::ofstream(folder.path("run/history.csv")) << "step\n";
  const Outcome outcome = run_program(calibrate(folder.path("run")));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("holds another run"), std::string::npos)
      << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(folder.path("run/trials")));
}

TEST(Calibration, TellsWhichTrialFailedAndWhy)
{
  // Given up long before it breaks.
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(calibrate(folder.path("out"), {"Run/Longest shortening=3e-4"}));
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("uniaxial-seed1-"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("did not break"), std::string::npos) << outcome.output;
  EXPECT_EQ(record(folder.path("out")).at("status"), "failed");
}

TEST(Calibration, CheckSaysWhatItTakes)
{
  const Outcome outcome = run_program("check --json " ANTIFORM_SOURCE_DIR
                                      "/cases/laboratory/calibrate-rock-1.prm");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  // Five tests of three packings: three evaluations and two checks. Before them E alone;
  // differences of three tests, two packings, three micro-parameters.
  EXPECT_EQ(json.at("trials").at("usual"), 3 + (3 + 2) * 5 * 3 + 3 * 2 * 3);
  EXPECT_GT(json.at("prediction").at("wall_seconds_usual").get<double>(), 60.);
}
} // namespace calibration_tests

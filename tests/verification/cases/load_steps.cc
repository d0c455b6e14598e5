// Walls that step and wait for balance, against walls that move all the time.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>

namespace load_steps_tests
{
using namespace antiform::test;

namespace
{
const std::string uniaxial = "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm";
const std::string steps = "Walls/Loading=step and relax";

std::vector<std::string> small(const std::vector<std::string> &more)
{
  std::vector<std::string> entries{"Layer/Grains across=20", "Layer/Seed=2"};
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

nlohmann::json run_specimen(const std::string &directory,
                            const std::vector<std::string> &entries)
{
  const Outcome outcome =
      run_program(uniaxial + " -o " + directory + set(small(entries)));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}
} // namespace

// The reference is slow: 1000 transits a millistrain, 280,000 steps to the peak. Load
// steps of 1.4 % of the shortening at the peak end half of that below it in the mean, and
// paths differ: 0.7 % lower, after a tenth of the steps.
TEST(LoadSteps, FindTheStrengthOfSlowWalls)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("steps");
  const auto stepped = run_specimen(directory, {steps, "Walls/Load step=4e-5"}),
             slow = run_specimen(folder.path("slow"),
                                 {"Walls/Transits per millistrain=1000"});
  EXPECT_NEAR(result(stepped, "peak_stress") / result(slow, "peak_stress"), 1., 0.02);
  // The springs of the joints are those of the deck at any rate.
  EXPECT_NEAR(result(stepped, "section_stiffness") / result(slow, "section_stiffness"),
              1., 1e-3);
  EXPECT_LT(2 * stepped.at("steps").get<int>(), slow.at("steps").get<int>())
      << "the collapse included";
  EXPECT_GT(result(stepped, "collapses"), 0.) << "the specimen has failed";

  // Every line up to the peak is an equilibrium, and they lie a load step apart.
  const CsvTable history(directory + "/history.csv");
  const auto stress = history.column("axial_stress_Pa"),
             shortening = history.column("shortening"),
             ratio = history.column("unbalanced_ratio");
  const auto peak = static_cast<std::size_t>(
      std::max_element(stress.begin(), stress.end()) - stress.begin());
  ASSERT_GT(peak, 50U);
  for (std::size_t k = 1; k <= peak; ++k)
  {
    // Written one step after the look at it, when what vibrates has moved on a little.
    EXPECT_LT(ratio[k], 1.3e-4) << "line " << k;
    EXPECT_NEAR(shortening[k] - shortening[k - 1], 4e-5, 1e-12) << "line " << k;
  }
  EXPECT_EQ(result(stepped, "load_steps"), static_cast<double>(history.size()));
  EXPECT_LT(stepped.at("energy").at("closure_error"), 1e-3);
}

TEST(LoadSteps, AreAbsentAtAConstantRate)
{
  const TemporaryFolder folder;
  const auto summary = run_specimen(folder.path("run"), {"Run/End shortening=1e-4"});
  EXPECT_EQ(summary.at("effects").at("load steps").at("calls"), 0);
  EXPECT_EQ(summary.at("effects").at("load steps").at("active"), false);
}

TEST(LoadSteps, BehindAConfinementBeginWhenItStands)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const Outcome outcome = run_program(
      "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/biaxial.prm -o " + directory +
      set(small({steps, "Servo walls/Pressure=10e6", "Run/End shortening=6e-4"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const CsvTable history(directory + "/history.csv");
  const auto stress = history.column("axial_stress_Pa"),
             side = history.column("lateral_stress_Pa");
  // Friction of the damping holds a share of the last rise of the pressure back.
  for (std::size_t k = history.size() - 5; k < history.size(); ++k)
    EXPECT_NEAR(side[k], 10e6, 0.1e6) << "line " << k;
  EXPECT_GT(stress.back(), 30e6);
}

TEST(LoadSteps, NeedDampingAndPlatens)
{
  for (const std::vector<std::string> &entries :
       {std::vector<std::string>{steps, "Components=layer, walls"},
        std::vector<std::string>{steps, "Walls/Action=pull"}})
  {
    const Outcome outcome =
        run_program("check " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm" +
                    set(small(entries)));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find("Walls/Loading"), std::string::npos) << outcome.output;
  }
}

// Nothing comes to rest within a millionth of a millionth: the run ends with the reason.
TEST(LoadSteps, ThatNeverComeToBalanceEndWithTheReason)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      uniaxial + " -o " + folder.path("run") +
      set(small({steps, "Layer/Grains across=10", "Walls/Relaxation tolerance=1e-18",
                 "Run/End shortening=1e-4"})));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("Relaxation tolerance"), std::string::npos)
      << outcome.output;
}
} // namespace load_steps_tests

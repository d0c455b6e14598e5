// Runs from event to event, against the same decks in time.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>

namespace event_runs_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
const std::string laboratory = ANTIFORM_SOURCE_DIR "/cases/laboratory/";
const std::string events = "Walls/Loading=event driver";

/// Some 430 grains.
std::vector<std::string> small(const std::vector<std::string> &more = {})
{
  std::vector<std::string> entries{"Layer/Grains across=14", "Layer/Seed=2"};
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

nlohmann::json run_test(const std::string &deck,
                        const std::string &directory,
                        const std::vector<std::string> &entries)
{
  const Outcome outcome =
      run_program("run " + laboratory + deck + " -o " + directory + set(small(entries)));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

/// Every line of the history is a balance, and the ledger is closed.
void expect_balances(const std::string &directory, const double tolerance = 1e-3)
{
  const CsvTable history(directory + "/history.csv");
  const auto mean = history.column("unbalanced_ratio"),
             largest = history.column("largest_unbalanced_ratio"),
             of_strength = history.column("unbalanced_over_strength");
  ASSERT_GT(history.size(), 10U);
  for (std::size_t k = 0; k < history.size(); ++k)
  {
    EXPECT_LT(mean[k], tolerance) << "line " << k;
    EXPECT_LT(largest[k], 100. * tolerance) << "line " << k;
    EXPECT_LT(of_strength[k], 150. * tolerance) << "line " << k;
  }
  const auto summary = summary_of(directory);
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-3);
  EXPECT_EQ(result(summary, "worst_mean_unbalanced"),
            *std::max_element(mean.begin(), mean.end()));
}
} // namespace

// Below the first crack both runs are one linear body. In time it vibrates by some 0.2 %
// at 1000 transits a millistrain, and a sample lies 5e-7 (0.1 %) before the crack.
TEST(EventRun, BeginsToBreakAsSlowWallsDo)
{
  const TemporaryFolder folder;
  const auto with = run_test("uniaxial.prm", folder.path("with"),
                             {events, "Run/End shortening=8e-4"}),
             slow = run_test("uniaxial.prm", folder.path("slow"),
                             {"Walls/Transits per millistrain=1000",
                              "Output/Samples per millistrain=2000",
                              "Run/End shortening=8e-4"});
  ASSERT_GT(result(slow, "crack_count"), 0.);
  for (const char *name : {"first_crack_x", "first_crack_above_axis"})
    EXPECT_NEAR(result(with, name), result(slow, name), 1e-6) << "another bond";
  EXPECT_NEAR(result(with, "first_crack_stress") / result(slow, "first_crack_stress"), 1.,
              5e-3);
  EXPECT_NEAR(result(with, "section_stiffness") / result(slow, "section_stiffness"), 1.,
              3e-3);
  // The same work, and the same share of it in the springs.
  for (const char *term : {"boundary_work", "strain_grains"})
    EXPECT_NEAR(with.at("energy").at(term).get<double>() /
                    slow.at("energy").at(term).get<double>(),
                1., 1e-2)
        << term;
  expect_balances(folder.path("with"));
}

TEST(EventRun, GoesThroughThePeakInBalance)
{
  const TemporaryFolder folder;
  const auto summary = run_test("uniaxial.prm", folder.path("run"), {events});
  expect_balances(folder.path("run"));
  EXPECT_EQ(summary.at("status"), "completed");
  // Ended by the share of the peak that the deck asks for.
  const CsvTable history(folder.path("run") + "/history.csv");
  const auto stress = history.column("axial_stress_Pa"),
             shortening = history.column("shortening");
  EXPECT_LT(stress.back(), 0.5 * result(summary, "peak_stress"));
  EXPECT_EQ(result(summary, "peak_stress"),
            *std::max_element(stress.begin(), stress.end()));
  for (std::size_t k = 1; k < history.size(); ++k)
    EXPECT_LT(shortening[k] - shortening[k - 1], 4e-5 * (1. + 1e-6)) << "line " << k;
  EXPECT_EQ(result(summary, "load_steps") + 1., static_cast<double>(history.size()));
  const CsvTable cracks(folder.path("run") + "/cracks.csv");
  EXPECT_EQ(static_cast<double>(cracks.size()), result(summary, "crack_count"));
  EXPECT_GE(result(summary, "crack_count"), result(summary, "breaks_in_batches"));
  EXPECT_GT(result(summary, "batches"), 20.);
  // All that is left of the work: springs, sliding, broken bonds, and what was held back.
  const auto &energy = summary.at("energy");
  EXPECT_EQ(energy.at("kinetic"), 0.);
  for (const char *term : {"strain_grains", "slip", "fracture", "damping"})
    EXPECT_GT(energy.at(term).get<double>(),
              1e-3 * energy.at("boundary_work").get<double>()) // of rubble little is left
        << term;
}

TEST(EventRun, KeepsThePressureOfSideWalls)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const auto summary =
      run_test("biaxial.prm", directory,
               {events, "Servo walls/Pressure=10e6", "Run/End shortening=2e-3"});
  expect_balances(directory);
  const CsvTable history(directory + "/history.csv");
  const auto side = history.column("lateral_stress_Pa"),
             axial = history.column("axial_stress_Pa"),
             shortening = history.column("shortening");
  std::size_t standing = 0;
  while (shortening[standing + 1] == 0.)
    ++standing;
  // A wall may be out of balance by the tenth of a joint's force.
  EXPECT_NEAR(axial[standing] / 10e6, 1., 2e-3);
  for (std::size_t k = standing; k < history.size(); ++k)
    EXPECT_NEAR(side[k] / 10e6, 1., 2e-3) << "line " << k;
  EXPECT_GT(result(summary, "peak_stress"), 60e6);
  EXPECT_TRUE(summary.at("warnings").empty()) << summary.at("warnings");
}

TEST(EventRun, PullsAsGripsInTimeDo)
{
  const TemporaryFolder folder;
  const std::vector<std::string> common{"Layer/Length ratio=3",
                                        "Run/End shortening=5e-5"};
  auto entries = common;
  entries.push_back(events);
  const auto with = run_test("tension.prm", folder.path("with"), entries),
             slow = run_test("tension.prm", folder.path("slow"), common);
  EXPECT_EQ(result(with, "crack_count"), 0.);
  EXPECT_EQ(result(with, "shortening"), -5e-5);
  EXPECT_GT(result(with, "tensile_strength"), 1e6);
  // One linear body; in time the shortening ends within a step of 5e-5.
  EXPECT_NEAR(result(with, "tensile_strength") / result(slow, "tensile_strength"), 1.,
              5e-3);
}

// A pre-bent layer in a matrix of grains.
TEST(EventRun, FoldsALayerAsSlowWallsDoLong)
{
  const TemporaryFolder folder;
  const std::vector<std::string> deck{
      "Components=layer, matrix, walls, damping", "Matrix/Representation=grains",
      "Matrix/Burial depth ratio=1", "Matrix/Base depth ratio=1",
      "Run/End shortening=4e-4"};
  auto entries = deck;
  entries.push_back(events);
  const std::string with = folder.path("with"), slow = folder.path("slow");
  Outcome outcome = run_tiny(with, set(entries));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  entries = deck;
  entries.push_back("Walls/Transits per millistrain=1000");
  outcome = run_tiny(slow, set(entries));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_balances(with);
  // Cracks take their own ways; the fold hardly does. In time the matrix, soft and heavy,
  // is still behind by a per cent.
  for (const char *name : {"fold_amplitude", "limb_dip"})
    EXPECT_NEAR(result(summary_of(with), name) / result(summary_of(slow), name), 1., 0.03)
        << name;
  EXPECT_NEAR(result(summary_of(with), "peak_stress") /
                  result(summary_of(slow), "peak_stress"),
              1., 0.05);
}

namespace
{
/// Everything but the times.
void expect_same_numbers(const std::string &directory, const std::string &other)
{
  expect_same_run(directory, other);
  expect_same_file("fields.pvd", directory, other);
}
} // namespace

// Nothing but its own stiffness holds a slender layer, and where it fails its fold grows
// by 0.4 of its thickness in three load steps: the long way is booked in parts short
// enough for the cracks that close and open on it, and long corrections do not go on
// uphill (open by 0.002 where they do).
TEST(EventRun, KeepsTheBooksOfASlenderLayerThatFails)
{
  const TemporaryFolder folder;
  for (const std::string seed : {"1", "2"})
  {
    const std::string directory = folder.path("slender" + seed);
    const Outcome outcome = run_program(
        "run " ANTIFORM_SOURCE_DIR "/cases/shortening/single-layer.prm -o " + directory +
        set({events, "Layer/Grains across=6", "Layer/Seed=" + seed}));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const auto summary = summary_of(directory);
    EXPECT_LT(summary.at("energy").at("closure_error"), 1e-3) << seed;
    const CsvTable history(directory + "/history.csv");
    const auto stress = history.column("axial_stress_Pa"),
               amplitude = history.column("fold_amplitude_m");
    EXPECT_LT(stress.back(), 0.5 * result(summary, "peak_stress")) << seed;
    EXPECT_GT(amplitude.back(), amplitude.front() + 3.) << seed;
  }
}

TEST(EventRun, GoesOnFromItsLastRecordToTheSameBits)
{
  const TemporaryFolder folder;
  const std::string once = folder.path("once"), often = folder.path("often");
  run_test("biaxial.prm", once, {events, "Run/End shortening=1.5e-3"});
  const std::string run = "run " + laboratory + "biaxial.prm -o " + often +
                          set(small({events, "Run/End shortening=1.5e-3"}));
  // Each start comes one record further before it looks at its clock.
  for (const int records : {1, 2, 3})
  {
    const Outcome outcome =
        run_program(run + " --time-limit 1e-3" + (records > 1 ? " --resume" : ""));
    ASSERT_EQ(outcome.status, 3) << outcome.output;
    EXPECT_EQ(summary_of(often).at("steps"), records);
    EXPECT_EQ(CsvTable(often + "/history.csv").size(), static_cast<std::size_t>(records));
  }
  RunningProgram program(run + " --resume");
  const std::string cracks = often + "/cracks.csv";
  std::error_code error;
  ASSERT_TRUE(
      program.wait_until([&] { return fs::file_size(cracks, error) > 1000 && !error; }))
      << "over before it could be interrupted";
  program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 3);
  EXPECT_EQ(summary_of(often).at("status"), "interrupted");
  const Outcome outcome = run_program(run + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_numbers(often, once);
}

TEST(EventRun, GoesOnAfterAKillLong)
{
  const TemporaryFolder folder;
  const std::string once = folder.path("once"), twice = folder.path("twice");
  const std::vector<std::string> entries{events, "Output/Checkpoint interval=1e-6"};
  run_test("uniaxial.prm", once, entries);
  const std::string run =
      "run " + laboratory + "uniaxial.prm -o " + twice + set(small(entries));
  RunningProgram program(run);
  const std::string cracks = twice + "/cracks.csv";
  std::error_code error;
  ASSERT_TRUE(
      program.wait_until([&] { return fs::file_size(cracks, error) > 3000 && !error; }))
      << "over before it could be killed";
  program.send(SIGKILL);
  EXPECT_EQ(program.wait(), -SIGKILL);
  const Outcome outcome = run_program(run + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_numbers(twice, once);
}

TEST(EventRun, EstimatesWhatItsToleranceIsWorth)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const auto summary = run_test("uniaxial.prm", directory,
                                {events, "Run/Estimate loading-rate error=true"});
  const double peak = result(summary, "peak_stress"),
               at_half = result(summary, "peak_stress_at_half_tolerance");
  EXPECT_DOUBLE_EQ(result(summary, "tolerance_error"), peak / at_half - 1.);
  // The path may change at the first difference: a few per cent of one specimen's peak.
  EXPECT_NEAR(peak / at_half, 1., 0.05);
  EXPECT_EQ(result(summary_of(directory + "/half-tolerance"), "peak_stress"), at_half);
  expect_balances(directory + "/half-tolerance"); // looser, and looser before the peak
  const auto mean =
      CsvTable(directory + "/half-tolerance/history.csv").column("unbalanced_ratio");
  EXPECT_LT(mean.back(), 5e-4);
}

// Nothing comes to rest within a part in 1e15: the run ends with the reason, and the last
// balance stays.
TEST(EventRun, ThatFindsNoBalanceKeepsTheLastOne)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const Outcome outcome = run_program(
      "run " + laboratory + "uniaxial.prm -o " + directory +
      set({events, "Layer/Grains across=8", "Walls/Balance tolerance=1e-17"}));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("does not come to rest"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(summary_of(directory).at("status"), "failed");
  EXPECT_TRUE(fs::exists(directory + "/state.h5"));
  EXPECT_EQ(CsvTable(directory + "/history.csv").size(), 1U);
}

TEST(EventRun, RefusesWhatItDoesNotKnow)
{
  // All problems at once: each part is to be found in what is printed.
  const auto expect_refusals = [](const std::string &deck,
                                  std::vector<std::string> entries,
                                  const std::vector<std::string> &parts)
  {
    entries.push_back(events);
    const Outcome outcome = run_program("check " + deck + set(entries));
    EXPECT_EQ(outcome.status, 1);
    for (const std::string &part : parts)
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << " is not in\n"
                                                              << outcome.output;
  };
  const std::string uniaxial = laboratory + "uniaxial.prm";
  expect_refusals(uniaxial,
                  {"Layer/Bond model=parallel bond",
                   "Layer/Joint types/Slit fraction=0.1", "Layer/Locked-in stress=1e6",
                   "Run/Driver=dynamic", "Components=layer, walls"},
                  {"'Layer/Bond model' = 'flat joint'", "'Layer/Joint types/Slit",
                   "'Layer/Locked-in stress' = 0", "Add 'damping'", "'Run/Driver' ="});
  expect_refusals(uniaxial,
                  {"Components=layer, walls, membrane, fractures, calibration, damping"},
                  {"does not know membrane", "does not know fractures", "trials"});
  expect_refusals(tiny_deck(), {"Components=layer, matrix, gravity, walls, damping"},
                  {"does not know gravity"});
  expect_refusals(tiny_deck(),
                  {"Matrix/Representation=grains", "Matrix/Interface=frictionless"},
                  {"'Matrix/Interface' = 'cemented'"});
  // A contrast that the operator cannot tell from a loose layer, and a cover too thin for
  // a bridging domain, which grains fit.
  expect_refusals(tiny_deck(), {"Matrix/Stiffness contrast=1e9"},
                  {"'Matrix/Stiffness contrast' = '1e", "a contrast of at most 1e+06"});
  expect_refusals(tiny_deck(), {"Matrix/Join=automatic", "Matrix/Burial depth ratio=0.3"},
                  {"does not know a surface interface",
                   "'Matrix/Representation' = 'grains'"});
  EXPECT_EQ(run_program("check " + uniaxial + set({events})).status, 0);
  for (const char *entry :
       {"Matrix/Stiffness contrast=1e6", "Matrix/Representation=grains"})
    EXPECT_EQ(run_program("check " + tiny_deck() + set({events, entry})).status, 0);
}

// The peak of one packing is chaotic: 9 % between drivers at 900 grains in the method's
// own prototype, and sqrt(900 / 430) of that here; all but one are within the 8 % asked
// for. Of eight the mean of the ratios has a standard error of some 1.5 %, and walls at 500
// transits are 1 to 2 % high themselves.
TEST(EventRun, FindsTheStrengthOfSlowWallsInTheMeanLong)
{
  const TemporaryFolder folder;
  constexpr int n_packings = 8;
  double mean = 0.;
  int n_close = 0;
  for (int seed = 1; seed <= n_packings; ++seed)
  {
    const std::string number = "Layer/Seed=" + std::to_string(seed);
    const auto with = run_test("uniaxial.prm", folder.path("with" + number.substr(11)),
                               {number, events}),
               slow = run_test("uniaxial.prm", folder.path("slow" + number.substr(11)),
                               {number, "Walls/Transits per millistrain=400",
                                "Run/Stress ratio of peak=0.9"});
    const double ratio = result(with, "peak_stress") / result(slow, "peak_stress");
    std::printf("seed %d: %.2f MPa, %.2f MPa in time; %.2f s and %.2f s\n", seed,
                1e-6 * result(with, "peak_stress"), 1e-6 * result(slow, "peak_stress"),
                with.at("cpu_seconds").get<double>(),
                slow.at("cpu_seconds").get<double>());
    EXPECT_NEAR(ratio, 1., 0.13) << seed;
    n_close += std::abs(ratio - 1.) < 0.08 ? 1 : 0;
    mean += ratio / n_packings;
  }
  EXPECT_GE(n_close, n_packings - 1);
  EXPECT_NEAR(mean, 1., 0.03);
}
} // namespace event_runs_tests

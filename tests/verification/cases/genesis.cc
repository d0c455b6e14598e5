// How a run makes its rock: the packing that the deck asks for, kept packings,
// measurement circles.
#include "support/tiny_run.h"

#include <cmath>
#include <filesystem>

namespace genesis_tests
{
using namespace antiform::test;

namespace
{
/// A small specimen of rock 1 between platens that ends while it is elastic.
std::string specimen(const std::vector<std::string> &entries)
{
  return "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm" +
         set({"Layer/Grains across=14", "Layer/Breakable=false",
              "Run/End shortening=1e-4", "Run/Stress ratio of peak=0",
              "Output/Samples per millistrain=500"}) +
         set(entries) + " -o ";
}

nlohmann::json run_specimen(const std::vector<std::string> &entries,
                            const std::string &directory)
{
  const Outcome outcome = run_program(specimen(entries) + directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

const std::string circles = "Components=layer, walls, damping, measurement circles";

/// The program with packings kept in @p directory.
Outcome run_with_cache(const std::string &arguments, const std::string &directory)
{
  return run_command(clean_environment() + "ANTIFORM_CACHE=" + directory + " " +
                     ANTIFORM_PROGRAM + " " + arguments);
}
} // namespace

TEST(Genesis, ReportsEveryFigureOfTheCheckList)
{
  const TemporaryFolder folder;
  const nlohmann::json summary = run_specimen({}, folder.path("run"));
  // The check list of material genesis.
  EXPECT_EQ(result(summary, "floaters"), 0.);
  EXPECT_LT(result(summary, "fabric_anisotropy"), 0.05);
  EXPECT_LT(result(summary, "largest_overlap"), 0.01);
  EXPECT_LT(result(summary, "packing_stress_variation"), 0.2);
  EXPECT_NEAR(result(summary, "porosity"), 0.17, 0.02); // jammed, with the walls' share
  EXPECT_GT(result(summary, "coordination_number"), 4.);
  EXPECT_NE(contents(folder.path("run/log.txt")).find("packing of the layer: porosity"),
            std::string::npos);
}

TEST(Genesis, MakesThePorosityAndTheCoordinationOfTheDeck)
{
  const TemporaryFolder folder;
  const nlohmann::json summary = run_specimen(
      {"Layer/Porosity=0.2", "Layer/Coordination number=4.5"}, folder.path("run"));
  EXPECT_NEAR(result(summary, "porosity"), 0.2, 0.005);
  EXPECT_EQ(result(summary, "floaters"), 0.);
  // Twice the joints over the grains, as the scene has them.
  const double grains = summary.at("sizes").at("grains"),
               joints = summary.at("sizes").at("joints");
  EXPECT_NEAR(2. * joints / grains, 4.5, 1. / grains + 1e-12);
  EXPECT_NEAR(result(summary, "coordination_number"), 2. * joints / grains, 1e-12);
}

TEST(Genesis, RefusesWhatNoPackingReachesBeforePacking)
{
  const TemporaryFolder folder;
  for (const auto &[entry, word] :
       {std::pair<std::string, std::string>{"Layer/Porosity=0.05", "jam at about"},
        {"Layer/Porosity=0.6", "too far apart"},
        {"Layer/Coordination number=8", "4 to 6"},
        {"Layer/Locked-in stress=5e9", "beyond the small strains"}})
  {
    const Outcome outcome = run_program("check " + tiny_deck() + set({entry}));
    const std::string name = entry.substr(0, entry.find('='));
    EXPECT_EQ(outcome.status, 1) << entry;
    EXPECT_NE(outcome.output.find(name), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find(word), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("Give"), std::string::npos) << outcome.output;
  }
}

TEST(Genesis, LockedInStressIsOnThePlatensFromTheStart)
{
  const TemporaryFolder folder;
  run_specimen({"Layer/Locked-in stress=1e6", circles,
                "Measurement circles/Radius ratio=6", "Run/End shortening=2e-6",
                "Output/Samples per millistrain=100000"},
               folder.path("run"));
  // 5 % is what is asked of a locked-in stress; the platens lean on 14 grains each.
  EXPECT_NEAR(CsvTable(folder.path("run/history.csv")).column("axial_stress_Pa").front() /
                  1e6,
              1., 0.05);
  // Pressure in the mean over the circles, that of the packing by its homogeneity.
  const CsvTable table(folder.path("run/circles.csv"));
  const std::vector<double> step = table.column("step"),
                            xx = table.column("stress_xx_Pa"),
                            yy = table.column("stress_yy_Pa");
  double sum = 0., n = 0.;
  for (std::size_t k = 0; k < step.size() && step[k] == step[0]; ++k, n += 1.)
    sum -= 0.5 * (xx[k] + yy[k]);
  ASSERT_GE(n, 2.);
  EXPECT_NEAR(sum / n / 1e6, 1., 0.2 / std::sqrt(n));
}

TEST(MeasurementCircles, AgreeWithThePlatens)
{
  const TemporaryFolder folder;
  const nlohmann::json summary =
      run_specimen({circles, "Measurement circles/Radius ratio=6.9",
                    "Measurement circles/Centres=0 0", "Run/End shortening=2e-4"},
                   folder.path("run"));
  const CsvTable history(folder.path("run/history.csv")),
      table(folder.path("run/circles.csv"));
  ASSERT_EQ(table.size(), history.size()); // one circle
  EXPECT_EQ(table.column("step"), history.column("step"));
  // Averages over the middle of a specimen in uniaxial stress. 150 grains are half of its
  // width: gauges and circles see different ones, which scatter by some per cent.
  const double stress = history.column("axial_stress_Pa").back();
  EXPECT_NEAR(-table.column("stress_xx_Pa").back() / stress, 1., 0.1);
  EXPECT_NEAR(table.column("stress_yy_Pa").back() / stress, 0., 0.1);
  EXPECT_NEAR(table.column("stress_xy_Pa").back() / stress, 0., 0.1);
  EXPECT_NEAR(table.column("strain_xx").back() /
                  history.column("gauge_strain_axial").back(),
              1., 0.1);
  EXPECT_GT(table.column("strain_yy").back(), 0.); // it bulges
  // Denser than the specimen with its walls; with as many joints as inside of it.
  EXPECT_LT(table.column("porosity").front(), result(summary, "porosity") + 0.01);
  EXPECT_GT(table.column("porosity").front(), 0.13);
  EXPECT_NEAR(table.column("coordination_number").front(),
              result(summary, "coordination_number"), 0.5);
}

TEST(MeasurementCircles, ExistOnlyWhereListedAndChangeNothing)
{
  const TemporaryFolder folder;
  const std::string listed = "Components=layer, matrix, walls, damping";
  const Outcome without = run_tiny(folder.path("without"), set(unbreakable({listed})));
  const Outcome with = run_tiny(folder.path("with"),
                                set(unbreakable({listed + ", measurement circles",
                                                 "Measurement circles/Radius ratio=3"})));
  ASSERT_EQ(without.status, 0) << without.output;
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_FALSE(std::filesystem::exists(folder.path("without/circles.csv")));
  expect_same_file("history.csv", folder.path("with"), folder.path("without"));
  const nlohmann::json
      absent = summary_of(folder.path("without")).at("effects").at("measurement circles"),
      present = summary_of(folder.path("with")).at("effects").at("measurement circles");
  EXPECT_EQ(absent.at("calls"), 0);
  EXPECT_EQ(absent.at("active"), false);
  EXPECT_EQ(present.at("active"), true);
  const std::size_t samples = CsvTable(folder.path("with/history.csv")).size();
  EXPECT_EQ(present.at("calls"), samples);
  // Six circles side by side along a layer of 36 diameters.
  EXPECT_EQ(CsvTable(folder.path("with/circles.csv")).size(), 6 * samples);
}

TEST(MeasurementCircles, GoOnWhereTheRunWasInterrupted)
{
  const TemporaryFolder folder;
  const std::string options =
      set({"Components=layer, matrix, walls, damping, measurement circles",
           "Measurement circles/Radius ratio=2", "Measurement circles/Across the layer=2",
           "Layer/Breakable=false", "Run/End shortening=2e-4"});
  ASSERT_EQ(run_tiny(folder.path("whole"), options).status, 0);
  Outcome outcome = run_tiny(folder.path("parts"), options + " --time-limit 0.001");
  ASSERT_EQ(outcome.status, 3) << outcome.output;
  EXPECT_LT(CsvTable(folder.path("parts/circles.csv")).size(),
            CsvTable(folder.path("whole/circles.csv")).size());
  outcome = run_tiny(folder.path("parts"), options + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_file("circles.csv", folder.path("parts"), folder.path("whole"));
  expect_same_file("history.csv", folder.path("parts"), folder.path("whole"));
}

TEST(MeasurementCircles, AreRefusedWhereTheyDoNotFit)
{
  const std::string listed =
      "Components=layer, matrix, walls, damping, measurement circles";
  for (const auto &[entry, word] :
       {std::pair<std::string, std::string>{"Measurement circles/Radius ratio=4",
                                            "wider than the layer"},
        {"Measurement circles/Centres=0 0; 1", "not a list of points"},
        {"Measurement circles/Centres=0 40", "is not in the layer"},
        {"Layer/Representation=continuum", "average over grains"}})
  {
    const Outcome outcome = run_program("check " + tiny_deck() + set({listed, entry}));
    EXPECT_EQ(outcome.status, 1) << entry;
    EXPECT_NE(outcome.output.find(word), std::string::npos) << outcome.output;
  }
}

TEST(KeptPackings, GiveTheSameBitsAndAreRemadeWhenDamaged)
{
  const TemporaryFolder folder;
  const std::string cache = folder.path("cache"),
                    run = "run " + tiny_deck() + set(unbreakable()) + " -o ";
  const auto run_to = [&](const std::string &name, const std::string &where)
  {
    const Outcome outcome = run_with_cache(run + folder.path(name), where);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return outcome.output;
  };
  run_to("off", "off");
  EXPECT_EQ(occurrences(run_to("made", cache), "taken from"), 0u);
  // Layer and matrix tile.
  EXPECT_EQ(occurrences(run_to("kept", cache), "taken from"), 2u);
  for (const std::string name : {"made", "kept"})
    expect_same_run(folder.path("off"), folder.path(name));

  for (const auto &file : std::filesystem::directory_iterator(cache))
    std::filesystem::resize_file(file.path(), 100);
  EXPECT_EQ(occurrences(run_to("damaged", cache), "is damaged"), 2u);
  expect_same_run(folder.path("off"), folder.path("damaged"));
  EXPECT_EQ(occurrences(run_to("again", cache), "taken from"), 2u);

  // Where nothing can be written there is no packing kept, and no error.
  std::ofstream(folder.path("file")) << "not a folder";
  run_to("unwritable", folder.path("file"));
  expect_same_run(folder.path("off"), folder.path("unwritable"));
}
} // namespace genesis_tests

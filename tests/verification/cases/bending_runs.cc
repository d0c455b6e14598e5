// Layers that turning walls bend, against closed forms (docs/theory/loading.md).
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>

namespace bending_runs_tests
{
using namespace antiform::test;

namespace
{
constexpr double thickness = 10., degree = M_PI / 180.;

/// A straight layer of @p n grains across that nothing breaks.
std::vector<std::string> straight(const int n,
                                  const double length_ratio,
                                  const std::vector<std::string> &more)
{
  std::vector<std::string> entries{"Components=layer, walls, damping",
                                   "Layer/Breakable=false",
                                   "Layer/Grains across=" + std::to_string(n),
                                   "Layer/Length ratio=" + std::to_string(length_ratio),
                                   "Output/Fields interval=1"};
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

nlohmann::json run_layer(const std::string &directory,
                         const std::vector<std::string> &entries)
{
  const Outcome outcome = run_tiny(directory, set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

/// Pressed by 4e-4 and bent by less, so that no contact opens; @p transits a millistrain.
std::vector<std::string> pressed(const double end_rotation, const int transits)
{
  return straight(8, 8.,
                  {"Walls/Action=turn", "Walls/Shortening before turning=4e-4",
                   "Walls/End rotation=" + std::to_string(end_rotation),
                   "Walls/Transits per millistrain=" + std::to_string(transits),
                   "Walls/Ramp=20"});
}

/// Means over the last lines of a history, in which the walls turn by a tenth of the way.
/// The pressed layer of random grains has a small moment of its own, which is taken off.
struct Ending
{
  double rotation = 0., moment = 0., force = 0.;
  explicit Ending(const std::string &directory)
  {
    const CsvTable history(directory + "/history.csv");
    const auto angle = history.column("wall_rotation_deg"),
               m = history.column("wall_moment_Nm"), f = history.column("wall_force_N");
    double n = 0., before = 0.;
    for (std::size_t k = 0; k < history.size(); ++k)
      if (angle[k] > 0.9 * angle.back())
      {
        rotation += angle[k];
        moment += m[k];
        force += f[k];
        n += 1.;
      }
      else if (angle[k] == 0.)
        before = m[k];
    rotation *= degree / n;
    moment = moment / n - before;
    force /= n;
  }
};
} // namespace

// M = 2 E'I theta/L u/tan u. Half of an outer grain has no joint: bending measures the
// section somewhere between the whole one and one of n - 0.9 grains (the most that case 31
// gives, docs/validation.md), whose moment is 21 % less: within 12 % of the mean of both.
TEST(Bending, OfAPressedLayerHasTheMomentOfABeam)
{
  const TemporaryFolder folder;
  constexpr double n = 8., length = 8. * thickness, pressing = 4e-4;
  const auto summary = run_layer(folder.path("run"), pressed(0.12, 400));
  const Ending end(folder.path("run"));
  const auto moment = [&](const double h) // measured: E'h
  {
    const double bending = end.force / pressing * h * h / 12.;
    const double u = 0.5 * length * std::sqrt(end.force / bending);
    return 2. * bending * end.rotation / length * u / std::tan(u);
  };
  const double mean =
      0.5 * (moment(thickness) + moment(thickness * (1. - 0.9 / n)));
  EXPECT_NEAR(end.moment / mean, 1., 0.12);
  // Of a bent arc nothing shortens, to the second order; the walls stop at a sample.
  EXPECT_NEAR(result(summary, "shortening"), pressing, 1e-8);
  EXPECT_NEAR(result(summary, "wall_rotation"), 0.12, 0.12 * 0.03);
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-9); // elastic
}

TEST(Bending, OfAPressedLayerIsLinearAndDoesNotDependOnTheSpeed)
{
  const TemporaryFolder folder;
  run_layer(folder.path("whole"), pressed(0.12, 400));
  run_layer(folder.path("half"), pressed(0.06, 400));
  run_layer(folder.path("slow"), pressed(0.12, 800));
  const Ending whole(folder.path("whole")), half(folder.path("half")),
      slow(folder.path("slow"));
  const auto stiffness = [](const Ending &end) { return end.moment / end.rotation; };
  // Strains of 4e-4 beside 1; vibrations of the way over the ramp of 20 transits.
  EXPECT_NEAR(stiffness(half) / stiffness(whole), 1., 3e-3);
  EXPECT_NEAR(stiffness(slow) / stiffness(whole), 1., 3e-3);
}

// Walls that cannot pull: the contact has opened, so the eccentricity e = M/N lies
// between h/6 and h/2, and N = E'h^2 theta/4L 8x/(1 + 12 x^2) with x = e/h. What the end is
// indented makes it softer by up to 15 %: a wall contact of 1/2E* and a corner of some
// 3/E' beside 40/E' of the layer.
TEST(Bending, OfALayerThatIsNotGluedLeavesTheWalls)
{
  const TemporaryFolder folder;
  constexpr double length_ratio = 20., length = length_ratio * thickness;
  const auto press = run_layer(
      folder.path("press"),
      straight(6, length_ratio, {"Walls/Loading=event driver", "Walls/Load step=1e-6",
                                 "Run/End shortening=1e-5"}));
  const double modulus = result(press, "section_stiffness"); // E'
  const auto summary = run_layer(
      folder.path("run"),
      straight(6, length_ratio,
               {"Walls/Action=turn", "Walls/End rotation=0.05",
                "Walls/Transits per millistrain=6000", "Walls/Ramp=100",
                "Output/Samples per millistrain=2000"}));
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-9);
  const CsvTable history(folder.path("run") + "/history.csv");
  const auto angle = history.column("wall_rotation_deg"),
             moment = history.column("wall_moment_Nm"),
             force = history.column("wall_force_N");
  ASSERT_GT(history.size(), 20u);
  for (std::size_t k = 0; k < history.size(); ++k)
  {
    if (angle[k] < 0.01) // while it swings in
      continue;
    const double x = moment[k] / force[k] / thickness;
    EXPECT_GT(x, 1. / 6.) << angle[k];
    EXPECT_LT(x, 0.5) << angle[k];
    const double expected = 0.25 * modulus * thickness * thickness * angle[k] * degree /
                            length * 8. * x / (1. + 12. * x * x);
    EXPECT_GT(force[k] / expected, 0.85) << angle[k];
    EXPECT_LT(force[k] / expected, 1.03) << angle[k];
  }
}

// Half the speed: the first crack in the same place, at the same rotation within a sample
// or two (1 %). The moment of the layer, which then tears, vibrates by some percents.
TEST(Bending, BreaksAlikeAtHalfTheSpeed)
{
  const TemporaryFolder folder;
  const auto run_at = [&](const std::string &transits)
  {
    return run_layer(folder.path(transits),
                     {"Components=layer, walls, damping", "Layer/Shape=cosine",
                      "Layer/Straight end ratio=0", "Layer/Amplitude ratio=0.3",
                      "Layer/Length ratio=8", "Layer/Grains across=6",
                      "Walls/Action=turn", "Walls/End rotation=0.3", "Walls/Ramp=20",
                      "Output/Samples per millistrain=1000", "Output/Fields interval=1",
                      "Walls/Transits per millistrain=" + transits});
  };
  const auto fast = run_at("500"), slow = run_at("1000");
  ASSERT_GT(result(slow, "crack_count"), 0.);
  // Tension on the outer arc, near the crest.
  EXPECT_EQ(result(slow, "first_crack_is_tensile"), 1.);
  EXPECT_GT(result(slow, "first_crack_above_axis"), 0.4 * thickness);
  EXPECT_LT(std::abs(result(slow, "first_crack_x")), thickness);
  for (const char *name : {"first_crack_x", "first_crack_above_axis"})
    EXPECT_NEAR(result(fast, name), result(slow, name), 1e-6) << "another bond";
  EXPECT_NEAR(result(fast, "first_crack_rotation") / result(slow, "first_crack_rotation"),
              1., 0.01);
  EXPECT_NEAR(result(fast, "first_crack_moment") / result(slow, "first_crack_moment"), 1.,
              0.02);
  EXPECT_NEAR(result(fast, "peak_moment") / result(slow, "peak_moment"), 1., 0.05);
  for (const auto &summary : {fast, slow})
    EXPECT_LT(summary.at("energy").at("closure_error"), 1e-3);
  // Every crack has its rotation.
  const CsvTable cracks(folder.path("1000") + "/cracks.csv");
  const auto rotation = cracks.column("wall_rotation_deg");
  EXPECT_TRUE(std::is_sorted(rotation.begin(), rotation.end()));
  EXPECT_NEAR(rotation.front(), result(slow, "first_crack_rotation"), 1e-9);
}

// A smoke run: the bent layer tears from the crest, and the moment falls.
TEST(Bending, QuickDeckRuns)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const Outcome outcome = run_program(
      "run " ANTIFORM_SOURCE_DIR "/cases/bending/quick.prm -o " + directory);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const auto summary = summary_of(directory);
  EXPECT_EQ(summary.at("status"), "completed");
  EXPECT_EQ(result(summary, "first_crack_is_tensile"), 1.);
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-3);
  const CsvTable history(directory + "/history.csv");
  EXPECT_LT(history.column("wall_moment_Nm").back(),
            0.5 * result(summary, "peak_moment"));
}

TEST(Bending, OfWhatDoesNotTurnIsRefusedAllAtOnce)
{
  const TemporaryFolder folder;
  const Outcome buried = run_tiny(
      folder.path("run"),
      set({"Walls/Action=turn", "Run/End shortening=1e-3",
           "Walls/Loading=step and relax"}));
  EXPECT_EQ(buried.status, 1) << buried.output;
  for (const char *words :
       {"4 problems", "Remove matrix from 'Components'", "'Walls/End rotation' = '0'",
        "'Run/End shortening' = '1e-3'", "'Walls/Loading' = 'step and relax'"})
    EXPECT_NE(buried.output.find(words), std::string::npos) << words << buried.output;
  const Outcome pressing =
      run_tiny(folder.path("run"), set({"Walls/End rotation=2",
                                        "Walls/Shortening before turning=1e-3"}));
  EXPECT_EQ(pressing.status, 1) << pressing.output;
  for (const char *words : {"2 problems", "'Walls/End rotation' = '2'",
                            "'Walls/Shortening before turning' = '1e-3'"})
    EXPECT_NE(pressing.output.find(words), std::string::npos) << words << pressing.output;
}

// Before the walls turn they must not crush what they are to bend: UCS/E'.
TEST(Bending, OfALayerThatPressingWouldCrushIsRefused)
{
  const double crushing = 162e6 / (56e9 / (1. - 0.2 * 0.2));
  const auto check = [&](const double shortening, const std::string &more)
  {
    return run_program(
        "check " + tiny_deck() +
        set(straight(8, 8.,
                     {"Walls/Action=turn", "Walls/End rotation=2", "Layer/UCS=162e6",
                      "Layer/Young modulus=56e9", "Layer/Poisson ratio=0.2",
                      "Walls/Shortening before turning=" + std::to_string(shortening),
                      more})));
  };
  EXPECT_EQ(check(0.99 * crushing, "Layer/Breakable=true").status, 0);
  const Outcome crushed = check(1.01 * crushing, "Layer/Breakable=true");
  EXPECT_EQ(crushed.status, 1) << crushed.output;
  for (const char *words : {"1 problem", "'Walls/Shortening before turning'",
                            "163.6 MPa", "at most UCS/E' = 0.002777"})
    EXPECT_NE(crushed.output.find(words), std::string::npos) << words << crushed.output;
  EXPECT_EQ(check(1.01 * crushing, "Layer/Breakable=false").status, 0);
  // Beyond small strain nothing helps.
  EXPECT_EQ(check(0.021, "Layer/Breakable=false").status, 1);
}

TEST(Bending, IsSaidByCheck)
{
  const Outcome outcome = run_program(
      "check " + tiny_deck() +
      set(straight(8, 8., {"Walls/Action=turn", "Walls/End rotation=2"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *words : {"walls     turn to 2 degrees each", "a strain of 0.00436",
                            "listed in Components; they turn"})
    EXPECT_NE(outcome.output.find(words), std::string::npos) << words << outcome.output;
}
} // namespace bending_runs_tests

// What 'antiform check' tells before a run: parts of the scene, studies, meshes too
// coarse.
#include "support/tiny_run.h"

#include <cmath>
#include <fstream>

namespace checks_of_scenes_tests
{
using namespace antiform::test;
using nlohmann::json;

namespace
{
std::string cases(const std::string &deck)
{
  return std::string(ANTIFORM_SOURCE_DIR "/cases/") + deck;
}

Outcome check(const std::string &deck, const std::vector<std::string> &entries = {})
{
  return run_program("check " + deck + set(entries));
}

json check_json(const std::string &deck, const std::vector<std::string> &entries = {})
{
  const Outcome outcome = run_program("check " + deck + set(entries) + " --json");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return json::parse(outcome.output);
}

void expect_words(const Outcome &outcome,
                  const int status,
                  const std::vector<std::string> &words)
{
  EXPECT_EQ(outcome.status, status) << outcome.output;
  for (const std::string &part : words)
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n"
                                                            << outcome.output;
}

const std::vector<std::string> straight{"Layer/Shape=straight", "Layer/Length ratio=12"};

std::vector<std::string> with(std::vector<std::string> entries,
                              const std::vector<std::string> &more)
{
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}
} // namespace

TEST(Check, NamesFracturesWithTheirNumberAndDensity)
{
  // 120 m by 10 m, a trace across every 5 m: 24 of them, P21 = 1/spacing.
  const json scene = check_json(cases("fractures/quick.prm"), straight);
  EXPECT_EQ(scene.at("fractures").at("in_the_layer"), 24);
  EXPECT_NEAR(scene.at("fractures").at("P21_per_m").get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(scene.at("fractures").at("trace_length_m").get<double>(), 240., 1e-9);
  expect_words(check(cases("fractures/quick.prm"), straight), 0,
               {"fractures 24 in the layer", "P21 = 0.2 /m", "every 0.5 h (5 m)",
                "at 90 degrees", "bonded"});
}

TEST(Check, NamesWhatConfinesTheLayer)
{
  expect_words(check(cases("laboratory/membrane.prm"), {"Membrane/Pressure=12e6"}), 0,
               {"membrane  12 MPa on the faces", "walls     shorten the section"});
  expect_words(check(cases("laboratory/biaxial.prm"), {"Servo walls/Pressure=12e6"}), 0,
               {"servo     12 MPa"});
  expect_words(check(cases("confinement/quick.prm")), 0, {"pressure  10 MPa on top"});
}

TEST(Check, RefusesFracturesOfWhichNoneIsThere)
{
  // Across traces that stand upright the layer is as wide as it is long.
  expect_words(check(cases("fractures/quick.prm"),
                     with(straight, {"Fractures/Spacing ratio=1000"})),
               1,
               {"1 problem", "'Fractures/Spacing ratio' = '1000'", "leaves no fracture",
                "12 h wide", "another phase"});
  // The only trace of a wide set may lie in the layer all the same.
  EXPECT_EQ(check(cases("fractures/quick.prm"),
                  with(straight, {"Fractures/Spacing ratio=1000", "Fractures/Phase=0"}))
                .status,
            0);
  expect_words(
      check(cases("fractures/quick.prm"),
            with(straight, {"Fractures/Spacing ratio=", "Fractures/List=500 0 600 0"})),
      1, {"'Fractures/List' = '500 0 600 0'", "nothing would be parted", "-60 to 60"});
}

TEST(Check, SaysFirstThatADeckIsAStudy)
{
  const std::string deck = cases("fractures/study-spacing.prm");
  const Outcome outcome = check(deck);
  expect_words(outcome, 0,
               {"varied    Fractures/Spacing ratio", "one run", "of one core", "all runs",
                "at once"});
  EXPECT_EQ(outcome.output.find("A study of "), 0u) << outcome.output;
  const std::size_t base = outcome.output.find("The base deck, which the runs change");
  EXPECT_LT(outcome.output.find("all runs"), base);
  EXPECT_LT(base, outcome.output.find("\nScene\n"));

  const json study = check_json(deck).at("prediction").at("study");
  const double n = study.at("members").get<double>(), all = study.at("core_seconds"),
               least = study.at("least_core_seconds"),
               most = study.at("most_core_seconds");
  EXPECT_LE(n * least, all);
  EXPECT_GE(n * most, all);
  EXPECT_LT(least, most);
  EXPECT_GE(study.at("vary").at("Fractures/Spacing ratio").size(), 3u);
}

TEST(Check, TellsOfTheFirstMemberWhereTheDeckAloneIsNoScene)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("study.prm"))
      << "include " << buried_deck()
      << "\nsubsection Matrix\n  set Burial depth ratio = 0\nend\n"
         "subsection Study\n  set Vary = Matrix/Burial depth ratio = 2, 3\nend\n";
  expect_words(
      check(folder.path("study.prm")), 0,
      {"A study of 2 runs", "The first run, burial-depth-ratio-2", "H/h = 2 above"});
}

// Half a wavelength of the closed form is 482 m. Columns are 40 m wide in one mesh and
// 482 m in the other: that one cannot show the wave at all, and is far too stiff.
TEST(Check, AndTheRunWarnOfColumnsTooWideForTheWave)
{
  const std::string deck = cases("burial-depth/buckling.prm");
  const std::vector<std::string> small{"Layer/Length ratio=192.8", "Run/Modes=3",
                                       "Matrix/Base depth ratio=100"};
  EXPECT_EQ(check_json(deck, small).at("warnings"), json::array());
  const std::vector<std::string> wide =
      with(small, {"Matrix/Cell aspect ratio=96.4", "Matrix/Largest cell ratio=100"});
  const json warnings = check_json(deck, wide).at("warnings");
  ASSERT_EQ(warnings.size(), 1u);
  for (const char *part : {"2 columns of cells in each wavelength", "964 m",
                           "'Matrix/Cell aspect ratio' = 24.1"})
    EXPECT_NE(warnings[0].get<std::string>().find(part), std::string::npos)
        << warnings[0];

  const TemporaryFolder folder;
  const Outcome run =
      run_program("run " + deck + " -o " + folder.path("run") + set(wide));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(summary_of(folder.path("run")).at("warnings").at(0), warnings[0]);
  EXPECT_NE(run.output.find("warning: " + warnings[0].get<std::string>()),
            std::string::npos)
      << run.output;
}

// Free vibrations of scaled masses: the walls' force swings about its mean.
TEST(Check, AndTheRunWarnOfAQuasiStaticSectionWithoutDamping)
{
  const std::string words = "the quasi-static driver without damping";
  const std::vector<std::string> undamped =
      unbreakable({"Components=layer, walls", "Layer/Length ratio=3"});
  expect_words(check(tiny_deck(), undamped), 0, {"Warning: " + words});
  const TemporaryFolder folder;
  const Outcome run = run_tiny(folder.path("run"), set(undamped));
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("warning: " + words), std::string::npos) << run.output;
  for (const std::string other :
       {"Components=layer, walls, damping", "Run/Driver=dynamic"})
    EXPECT_EQ(check(tiny_deck(), with(undamped, {other})).output.find(words),
              std::string::npos)
        << other;
}
} // namespace checks_of_scenes_tests

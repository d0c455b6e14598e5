// Sections at the edge of what a mesh can hold: covers of a hundredth and of a hundred
// thicknesses, a matrix ten thousand times as soft as the layer and one that hardly
// changes its volume. They buckle as the closed forms say, break with a closed ledger of
// energies, or are refused with the remedy.
#include "support/tiny_run.h"

namespace hard_sections_tests
{
using namespace antiform::test;

namespace
{
const std::string deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling.prm";
}

TEST(HardSection, BucklesAsTheClosedFormSays)
{
  const TemporaryFolder folder;
  // Contrast 1e4 in all. Lengths are four half waves of the closed form.
  const struct
  {
    std::string name;
    std::vector<std::string> entries;
  } scenes[] = {
      {"sliver",
       {"Matrix/Burial depth ratio=0.01", "Matrix/Cover rows=1",
        "Layer/Length ratio=187.7"}},
      {"deep", {"Matrix/Burial depth ratio=100", "Layer/Length ratio=149"}},
      {"stuck-sliver",
       {"Matrix/Burial depth ratio=0.01", "Matrix/Cover rows=1",
        "Layer/Length ratio=187.7", "Matrix/Interface=cemented"}},
      {"incompressible", {"Matrix/Poisson ratio=0.4999", "Layer/Length ratio=179"}},
      {"refined",
       {"Matrix/Cell size ratio=2", "Matrix/Refinement rounds=2",
        "Layer/Length ratio=192.8"}},
      {"as-the-deck-has-it",
       {"Matrix/Cell size ratio=2", "Matrix/Largest cell ratio=77",
        "Matrix/Refinement rounds=1", "Layer/Length ratio=192.8"}}};
  for (const auto &scene : scenes)
  {
    const Outcome outcome = run_program(
        "run " + deck + " -o " + folder.path(scene.name) +
        set({"Run/Modes=1", "Matrix/Cell size ratio=1", "Matrix/Largest cell ratio=80",
             "Matrix/Refinement rounds=0"}) +
        set(scene.entries));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const nlohmann::json summary = summary_of(folder.path(scene.name));
    // The tables' 2 %, 3 % where the matrix sticks.
    EXPECT_NEAR(result(summary, "critical_stress") / result(summary, "theory_stress"), 1.,
                scene.name == "stuck-sliver" ? 0.03 : 0.02)
        << scene.name;
    EXPECT_EQ(result(summary, "half_waves"), 4.) << scene.name;
  }
}

// A layer of grains breaks below a cover of 0.1 m, which no overlap fits into, and below
// one of a kilometre.
TEST(HardSection, ClosesItsLedgerWhileItsLayerBreaks)
{
  const TemporaryFolder folder;
  const struct
  {
    std::string name;
    std::vector<std::string> entries;
  } scenes[] = {{"sliver",
                 {"Matrix/Burial depth ratio=0.01", "Matrix/Cover rows=1",
                  "Matrix/Join=surface interface"}},
                {"sliver-of-grains",
                 {"Matrix/Burial depth ratio=0.01", "Matrix/Representation=grains"}},
                {"deep",
                 {"Matrix/Burial depth ratio=100", "Matrix/Largest cell ratio=24"}}};
  for (const auto &scene : scenes)
  {
    SCOPED_TRACE(scene.name);
    const Outcome outcome = run_program(
        "run " ANTIFORM_SOURCE_DIR "/cases/comparison/quick.prm -o " +
        folder.path(scene.name) +
        set({"Layer/Breakable=true", "Run/End shortening=2.5e-3",
             "Walls/Transits per millistrain=50"}) +
        set(scene.entries));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const nlohmann::json summary = summary_of(folder.path(scene.name));
    EXPECT_GT(result(summary, "crack_count"), 100.);
    // Nothing is lost but where bonds break within a step: some 1e-5 here.
    EXPECT_LT(summary.at("energy").at("closure_error").get<double>(), 1e-2);
    EXPECT_GT(summary.at("energy").at("boundary_work").get<double>(), 0.);
  }
}

TEST(HardSection, ThatWouldLockOrHasNoRoomForACellIsRefused)
{
  const TemporaryFolder folder;
  const struct
  {
    std::vector<std::string> entries;
    std::string remedy;
  } cases[] = {{{"Matrix/Poisson ratio=0.4999", "Matrix/Element degree=1",
                 "Matrix/Refinement rounds=4"},
                "'Matrix/Element degree' = 2"},
               {{"Matrix/Burial depth ratio=0.01"}, "'Matrix/Cover rows' = 1"},
               {{"Matrix/Poisson ratio=0.5"}, "< 0.5"},
               {{"Layer/Young modulus=-56e9"}, "Layer/Young modulus"}};
  for (const auto &one : cases)
  {
    const Outcome outcome = run_program("check " + deck + set(one.entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find(one.remedy), std::string::npos) << outcome.output;
  }
}
} // namespace hard_sections_tests

// Entries that are said to change nothing change nothing, and are told of.
#include "support/tiny_run.h"

#include <fstream>

namespace idle_entries_tests
{
using namespace antiform::test;

namespace
{
/// A scene, entries that have no effect there, each with a value that is not the default,
/// and the table that would show one.
struct Case
{
  std::string name, deck;
  std::vector<std::string> scene, idle;
  std::string table;
};

void PrintTo(const Case &one, std::ostream *out)
{
  *out << one.name;
}

class IdleEntries : public ::testing::TestWithParam<Case>
{
};

const std::vector<std::string> of_grains{"Walls/Load step=1e-4",
                                         "Walls/Relaxation tolerance=0.01",
                                         "Walls/Balance tolerance=5e-3",
                                         "Walls/Grip layers=3",
                                         "Run/Strain multiple of peak=5",
                                         "Run/Load steps=3",
                                         "Run/Modes=2",
                                         "Layer/Amplitude ratio=3",
                                         "Layer/Straight end ratio=0.4",
                                         "Layer/Slenderness ratio=5",
                                         "Layer/Joint types/Gap ratio=0.5"};

std::vector<std::string> with(std::vector<std::string> entries,
                              const std::vector<std::string> &more)
{
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}
} // namespace

TEST_P(IdleEntries, ChangeNothingAndAreToldOf)
{
  const Case &one = GetParam();
  const TemporaryFolder folder;
  const std::string plain = folder.path("plain"), idle = folder.path("idle");
  const Outcome first = run_program("run " + one.deck + " -o " + plain + set(one.scene));
  ASSERT_EQ(first.status, 0) << first.output;
  EXPECT_EQ(occurrences(first.output, "changes nothing"), 0u) << first.output;
  const Outcome second =
      run_program("run " + one.deck + " -o " + idle + set(with(one.scene, one.idle)));
  ASSERT_EQ(second.status, 0) << second.output;
  for (const std::string &entry : one.idle)
    EXPECT_EQ(occurrences(second.output, "note: --set: '" +
                                             entry.substr(0, entry.find('=')) +
                                             "' changes nothing: "),
              1u)
        << entry << "\n"
        << second.output;
  expect_same_file(one.table, plain, idle);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    IdleEntries,
    ::testing::Values(
        Case{"Static",
             buried_deck(),
             {"Components=layer, matrix, walls, damping"},
             {"Layer/Radius ratio=1.2",
              "Layer/Installation gap ratio=0.5",
              "Layer/Seed=7",
              "Layer/Breakable=false",
              "Layer/Flat joint/Elements=5",
              "Matrix/Interface friction=0.1",
              "Matrix/Join=grain cover",
              "Matrix/Tile size ratio=30",
              "Matrix/Cohesion=1e5",
              "Matrix/Refinement share=0.2",
              "Layer material/Cohesion=1e3",
              "Layer material/Viscosity=1e3",
              "Layer material/Match=outer",
              "Walls/Transits per millistrain=5",
              "Walls/Ramp=3",
              "Walls/Grip layers=3",
              "Damping/Coefficient=0.2",
              "Run/Step safety=0.5",
              "Run/Strain multiple of peak=3",
              "Run/Modes=2",
              "Output/Samples per millistrain=10",
              "Output/Fields interval=1e-3"},
             "history.csv"},
        Case{"Buckling",
             ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling.prm",
             {"Layer/Length ratio=96.4", "Matrix/Base depth ratio=50", "Run/Modes=2",
              "Matrix/Refinement rounds=0"},
             {"Run/End shortening=1e-3", "Run/Longest shortening=0.5", "Run/Load steps=3",
              "Matrix/Interface cohesion=1e5", "Matrix/Contact stiffness ratio=5",
              "Matrix/Refinement share=0.2", "Walls/Ramp=3",
              "Output/Checkpoint interval=1"},
             "modes.csv"},
        Case{"Fractures", tiny_deck(),
             unbreakable({"Components=layer, walls, fractures, damping",
                          "Fractures/Spacing ratio=2", "Fractures/Orientation=90"}),
             with(of_grains,
                  {"Fractures/Mean length=3", "Fractures/Seed=9",
                   "Fractures/Orientation deviation=20", "Fractures/Cohesion=1e6",
                   "Fractures/Tensile strength=1e6", "Fractures/Bonded friction angle=10",
                   "Layer/Parallel bond/Cohesion=1",
                   "Layer/Contact bond/Shear strength=1"}),
             "history.csv"},
        Case{"ParallelBonds",
             tiny_deck(),
             {"Components=layer, walls, damping", "Layer/Bond model=parallel bond",
              "Run/End shortening=2e-4"},
             with(of_grains,
                  {"Layer/Flat joint/Effective modulus=3e10",
                   "Layer/Flat joint/Cohesion=1e6",
                   "Layer/Flat joint/Residual friction=0.1",
                   "Layer/Flat joint/Elements=5", "Layer/Contact bond/Shear strength=1"}),
             "history.csv"}),
    [](const auto &info) { return info.param.name; });

TEST(IdleLines, OfADeckAreListedByCheckAndThoseOfItsIncludesAreNot)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("idle.prm"))
      << "include " << tiny_deck()
      << "\nsubsection Layer\n  set Amplitude ratio = 0.3\n  set Straight end ratio = "
         "0.115\nend\nsubsection Fractures\n  set Spacing ratio = 1\n  set Seed = 4\n"
         "end\n";
  const Outcome outcome = run_program("check " + folder.path("idle.prm"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *part :
       {"Without effect in this scene",
        "idle.prm:3: 'Layer/Amplitude ratio' changes nothing: the layer is straight",
        "section 'Fractures' is not read here, but with: component fractures"})
    EXPECT_EQ(occurrences(outcome.output, part), 1u) << part << "\n" << outcome.output;
  // It has its default.
  EXPECT_EQ(outcome.output.find("'Layer/Straight end ratio'"), std::string::npos);
  EXPECT_EQ(run_program("check " + tiny_deck()).output.find("Without effect"),
            std::string::npos);
}

TEST(IdleLines, OfAStudyAreToldWhereNoMemberFeelsThem)
{
  const auto check = [](const std::string &vary)
  { return run_program("check " + tiny_deck() + set({"Study/Vary=" + vary})); };
  const Outcome vain = check("Layer/Amplitude ratio = 0.3, 0.4");
  EXPECT_EQ(vain.status, 0) << vain.output;
  EXPECT_NE(vain.output.find("names 'Layer/Amplitude ratio', which changes nothing in "
                             "any run: the layer is straight"),
            std::string::npos)
      << vain.output;
  // One of four is bent.
  const Outcome some =
      check("Layer/Shape = straight, cosine; Layer/Amplitude ratio = 0.3, 0.4");
  EXPECT_EQ(some.output.find("changes nothing"), std::string::npos) << some.output;
}
} // namespace idle_entries_tests

// Whatever is wrong with a deck or a folder: exit 1 before any work, every problem named
// with file, entry, value and remedy, and every file as it was.
#include "support/tiny_run.h"

#include <filesystem>
#include <fstream>

namespace bad_decks_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
struct Refusal
{
  std::string name;
  std::vector<std::string> lines;  ///< of the deck, below the include of tiny.prm
  std::vector<std::string> naming; ///< file with line, entry, value and remedy
};

void PrintTo(const Refusal &refusal, std::ostream *out)
{
  *out << refusal.name;
}

void write(const std::string &path, const std::string &text)
{
  std::ofstream(path) << text;
}

std::string indented(const std::string &section, const std::string &line)
{
  return "subsection " + section + "\n  " + line + "\nend\n";
}

class BadDeck : public ::testing::TestWithParam<Refusal>
{
protected:
  /// A folder with somebody's files, in which nothing may change.
  BadDeck()
  {
    fs::create_directories(output());
    write(output() + "/notes.txt", "mine");
    std::string text = "include " + tiny_deck() + "\n";
    for (const std::string &line : GetParam().lines)
      text += line;
    write(deck(), text);
  }
  std::string output() const { return folder_.path("out"); }
  std::string deck() const { return folder_.path("bad.prm"); }

  TemporaryFolder folder_;
};
} // namespace

TEST_P(BadDeck, IsRefusedBeforeAnyWork)
{
  const std::map<std::string, std::string> before = all_contents(folder_.path(""));
  const Outcome outcome = run_program("run " + deck() + " -o " + output());
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  for (const std::string &part : GetParam().naming)
    EXPECT_NE(outcome.output.find(part), std::string::npos)
        << "'" << part << "' is missing in\n"
        << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "1 problem\n"), 1u) << outcome.output;
  EXPECT_EQ(all_contents(folder_.path("")), before);
}

INSTANTIATE_TEST_SUITE_P(
    Program,
    BadDeck,
    ::testing::Values(
        Refusal{"UnknownEntry",
                {indented("Layer", "set Thicknes = 10")},
                {"bad.prm:3: ", "'Layer/Thicknes'", "Did you mean 'Thickness'?"}},
        Refusal{"UnknownSection",
                {indented("Matirx", "set Stiffness contrast = 10")},
                {"bad.prm:2: ", "'Matirx'", "Did you mean 'Matrix'?"}},
        Refusal{"NegativeRadiusRatio",
                {indented("Layer", "set Radius ratio = -1.66")},
                {"bad.prm:3: ", "'Layer/Radius ratio' = '-1.66'", ">= 1 and <= 3"}},
        Refusal{"NoStrengths",
                {indented("Layer", "set Breakable = true"),
                 indented("Layer/Flat joint", "set Tensile strength = 0"),
                 indented("Layer/Flat joint", "set Cohesion = 0")},
                {"'Layer/Breakable' = 'true'", "Give strengths"}},
        Refusal{"ServoWallsOnABuriedLayer",
                {"set Components = layer, matrix, walls, servo walls, damping\n"},
                {"bad.prm:2: ", "'Components'", "servo walls confine a specimen"}},
        Refusal{"GripsWithoutRoomBetween",
                {"set Components = layer, walls, damping\n",
                 indented("Walls", "set Action = pull"),
                 indented("Walls", "set Grip layers = 17")},
                {"'Walls/Grip layers' = '17'", "2 grain diameters are left"}},
        Refusal{"LimbsTooSteep",
                {indented("Layer", "set Shape = cosine"),
                 indented("Layer", "set Amplitude ratio = 10")},
                {"'Layer/Amplitude ratio' = '10'", "dip by 79.", "Give at most 3.3"}},
        Refusal{"PoissonRatioTooSmall",
                {indented("Matrix", "set Poisson ratio = 0")},
                {"'Matrix/Poisson ratio' = '0'", "reach 0.01 to 0.235"}},
        Refusal{"TileThatTheMachineCannotHold",
                {indented("Matrix", "set Tile size ratio = 1e5")},
                {"bad.prm:3: ", "'Matrix/Tile size ratio' = '1e5'", "GiB of memory",
                 "a smaller tile"}},
        Refusal{"NoThickness",
                {indented("Layer", "set Thickness = 0")},
                {"bad.prm:3: ", "'Layer/Thickness' = '0'", "Give a number > 0 and <= 1e+05 [m]"}},
        Refusal{"NoOverlap",
                {indented("Bridging domain", "set Overlap width ratio = 0")},
                {"bad.prm:3: ", "'Bridging domain/Overlap width ratio' = '0'",
                 "Give a number > 0"}},
        Refusal{"DensityInGramsPerCubicCentimetre",
                {indented("Layer", "set Grain density = 2.5")},
                {"bad.prm:3: ", "'Layer/Grain density' = '2.5'", ">= 100"}},
        Refusal{"EntrySetTwice",
                {indented("Layer", "set Seed = 2"), indented("Layer", "set Seed = 3")},
                {"bad.prm:6: ", "'Layer/Seed' has been set in this file already",
                 "bad.prm:3", "Remove one"}},
        Refusal{"OverlapWiderThanTheCover",
                {indented("Bridging domain", "set Overlap width ratio = 9"),
                 indented("Matrix", "set Base depth ratio = 3")},
                {"bad.prm:3: ", "'Bridging domain/Overlap width ratio' = '9'",
                 "wider than the cover", "overlap 15 m", "the cover is 20 m",
                 "largest overlap width ratio that fits is 8 "}},
        Refusal{"MeshUnlikeMatrixGrainsThatAreNotThere",
                {indented("Matrix", "set Join = surface interface"),
                 indented("Matrix", "set Mesh modulus ratio = 0.5")},
                {"'Matrix/Mesh modulus ratio' = '0.5'", "no matrix grains",
                 "'Matrix/Join' = 'bridging domain'"}},
        Refusal{"FiniteStrainBesideASurface",
                {indented("Matrix", "set Join = surface interface"),
                 indented("Run", "set Strain = finite")},
                {"'Run/Strain' = 'finite'", "mesh of small strain"}},
        Refusal{"LimbsTooSteepForASurface",
                {indented("Matrix", "set Join = surface interface"),
                 indented("Layer", "set Shape = cosine"),
                 indented("Layer", "set Amplitude ratio = 2")},
                {"'Layer/Amplitude ratio' = '2'", "dip by 46", "Give at most 1.8"}},
        Refusal{"CoverThinnerThanACellOnASurface",
                {indented("Matrix", "set Join = surface interface"),
                 indented("Matrix", "set Burial depth ratio = 0.1")},
                {"'Matrix/Burial depth ratio' = '0.1'", "thinner than a cell",
                 "'Matrix/Cover rows' = 1 or more"}},
        Refusal{"OverlapDampingWithoutWaves",
                {indented("Bridging domain", "set Overlap damping = 0.05")},
                {"'Bridging domain/Overlap damping' = '0.05'", "'Run/Driver' = 'dynamic'"}},
        Refusal{"SubCyclesWithoutOverlapDamping",
                {"set Components = layer, matrix, walls\n",
                 indented("Run", "set Driver = dynamic"),
                 indented("Bridging domain", "set Sub-cycles = 3")},
                {"'Bridging domain/Overlap damping' = '0'", "Give 0.05"}},
        Refusal{"SlidingOnMatrixGrains",
                {indented("Matrix", "set Interface = sliding")},
                {"'Matrix/Interface' = 'sliding'",
                 "'Matrix/Join' = 'surface interface'"}},
        Refusal{
            "PoissonRatioOutOfReach",
            {indented("Matrix", "set Poisson ratio = 0.3")},
            {"bad.prm:3: ", "'Matrix/Poisson ratio' = '0.3'", "0.25", "0.01 to 0.235"}},
        Refusal{"MissingInclude",
                {"include rocks/rock-9.prm\n"},
                {"bad.prm:2: ", "cannot open the include 'rock-9.prm'", "/rocks. ",
                 "Give a path"}},
        Refusal{"NoCover",
                {indented("Matrix", "set Burial depth ratio = 0")},
                {"bad.prm:3: ", "'Matrix/Burial depth ratio' = '0'", "Give a value > 0",
                 "bare layer"}},
        Refusal{"MoreGrainsThanTheMachineHolds",
                {indented("Layer", "set Grains across = 13e3")},
                {"bad.prm:3: ", "'Layer/Grains across' = '13e3'", "e+09 grains", "GiB",
                 "fewer grains across"}},
        Refusal{"TextForANumber",
                {indented("Matrix", "set Stiffness contrast = stiff")},
                {"bad.prm:3: ", "'Matrix/Stiffness contrast' = 'stiff'",
                 "is not a number", "Give a number > 0"}},
        Refusal{
            "WordThatDoesNotExist",
            {indented("Matrix", "set Interface = glued")},
            {"bad.prm:3: ", "'Matrix/Interface' = 'glued'", "cemented or sliding or frictional or frictionless"}},
        Refusal{"GrainsWithTheStaticDriver",
                {indented("Run", "set Driver = static\n  set End shortening = 1e-3")},
                {"bad.prm:3: ", "'Run/Driver' = 'static'", "quasi-static"}},
        Refusal{"LoadsThatNeverEnd",
                {"set Components = layer, matrix, gravity\n",
                 indented("Run", "set Driver = dynamic")},
                {"bad.prm:4: ", "'Run/Driver' = 'dynamic'", "Add walls"}},
        Refusal{"UnknownComponent",
                {"set Components = layer, matrix, wall, damping\n"},
                {"bad.prm:2: ", "'wall'", "Did you mean 'walls'?"}}),
    [](const auto &instance) { return instance.param.name; });

TEST(BadDecks, HaveAllTheirProblemsNamedTogether)
{
  const TemporaryFolder folder;
  const Outcome outcome =
      run_tiny(folder.path("run"),
               set({"Layer/Thickness=0", "Matrix/Poisson ratio=0.3", "Matrix/Colour=red",
                    "Matrix/Burial depth ratio=deep", "Run/End shortening=0.03"}));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  for (const char *part :
       {"5 problems", "'Layer/Thickness'", "'Matrix/Poisson ratio'", "'Matrix/Colour'",
        "'Matrix/Burial depth ratio'", "'Run/End shortening'"})
    EXPECT_EQ(occurrences(outcome.output, part), 1u) << part << "\n" << outcome.output;
  EXPECT_FALSE(fs::exists(folder.path("run")));
}

TEST(BadFolder, ThatCannotBeWrittenToIsRefused)
{
  // The tests may run as root, whom permissions do not stop: a folder below a file.
  const TemporaryFolder folder;
  write(folder.path("file"), "a file");
  const std::map<std::string, std::string> before = all_contents(folder.path(""));
  for (const std::string place : {"file", "file/run"})
  {
    const Outcome outcome = run_tiny(folder.path(place));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("output directory '" + folder.path(place) + "'"),
              std::string::npos)
        << outcome.output;
    EXPECT_NE(outcome.output.find("-o DIR"), std::string::npos) << outcome.output;
    EXPECT_EQ(all_contents(folder.path("")), before);
  }
}

TEST(BadFolder, WithADamagedCheckpointIsRefused)
{
  const TemporaryFolder folder;
  const Outcome made = run_tiny(folder.path("run"), set(unbreakable()));
  ASSERT_EQ(made.status, 0) << made.output;
  const std::string state = folder.path("run/state.h5"), whole = contents(state);
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(~flipped[whole.size() / 2]);
  for (const std::string &damaged :
       {whole.substr(0, whole.size() / 2), whole.substr(0, 100), std::string(), flipped})
  {
    write(state, damaged);
    const std::map<std::string, std::string> before = all_contents(folder.path("run"));
    const Outcome outcome =
        run_tiny(folder.path("run"), set(unbreakable()) + " --resume");
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("state.h5"), std::string::npos) << outcome.output;
    EXPECT_EQ(all_contents(folder.path("run")), before);
  }
}
} // namespace bad_decks_tests

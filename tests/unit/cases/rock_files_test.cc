// The rock files of a stack of beds: what they may say, and the copies of a run.
#include "cases/beds.h"
#include "cases/run_deck.h"

#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rock_files_tests
{
using namespace antiform::cases;

namespace
{
const std::string rocks = ANTIFORM_SOURCE_DIR "/cases/rocks/";

std::string deck_text(const std::string &rock)
{
  return "set Components = layer, beds, walls\ninclude " + rocks +
         "rock-1.prm\nsubsection Beds\nset Thickness ratios = 1, 1, 1\nset Rocks = " +
         rocks + "rock-1.prm, " + rock + ", " + rock + "\nend\n";
}

/// Is the only problem of a stack with this rock one that has all the @p parts?
::testing::AssertionResult refuses(const std::string &rock,
                                   const std::vector<std::string> &parts)
{
  const Scratch scratch;
  scratch.write("rock.prm", rock);
  const std::vector<std::string> problems =
      problems_of(scratch.write("deck.prm", deck_text("rock.prm")));
  if (problems.size() == 1 &&
      std::all_of(parts.begin(), parts.end(),
                  [&](const std::string &part)
                  { return problems[0].find(part) != std::string::npos; }))
    return ::testing::AssertionSuccess();
  auto failure = ::testing::AssertionFailure() << problems.size() << " problems";
  for (const std::string &problem : problems)
    failure << "\n  " << problem;
  return failure;
}

std::string of_layer(const std::string &lines)
{
  return "include " + rocks + "rock-1.prm\nsubsection Layer\n" + lines + "end\n";
}
std::string of_joints(const std::string &lines)
{
  return of_layer("subsection Flat joint\n" + lines + "end\n");
}
} // namespace

TEST(RockFiles, WithoutEntriesAreRefused)
{
  for (const char *text : {"", "# Rock 3\n", "subsection Layer\nend\n"})
    EXPECT_TRUE(refuses(text, {"'Beds/Rocks'", "rock.prm", "sets no entry",
                               "Give a file with the moduli"}))
        << text;
}

TEST(RockFiles, WithSubsectionsThatNoRockHasAreRefused)
{
  EXPECT_TRUE(refuses(of_layer("") + "subsection Layr\nend\n",
                      {"rock.prm:4", "there is no subsection 'Layr'", "Leave it out"}));
  EXPECT_TRUE(refuses(of_layer("subsection Flat joints\nset Cohesion = 1\nend\n"),
                      {"rock.prm:3", "there is no subsection 'Layer/Flat joints'"}));
}

TEST(RockFiles, WithNumbersThatNoRockHasAreRefused)
{
  EXPECT_TRUE(
      refuses(of_layer("set Young modulus = 56\n"),
              {"rock.prm:3", "'Layer/Young modulus' = '56'", ">= 1e+06", "[Pa]"}));
  EXPECT_TRUE(
      refuses(of_joints("set Effective modulus = 50\n"),
              {"rock.prm:4", "'Layer/Flat joint/Effective modulus' = '50'", "[Pa]"}));
  EXPECT_TRUE(
      refuses(of_joints("set Stiffness ratio = 1e-9\n"),
              {"rock.prm:4", "'Layer/Flat joint/Stiffness ratio' = '1e-9'", ">= 0.1"}));
  EXPECT_TRUE(
      refuses(of_joints("set Cohesion = much\n"),
              {"'Layer/Flat joint/Cohesion' = 'much'", "Give a number >= 0 [Pa]"}));
}

TEST(RockFiles, OfARunSayTheSameWhereverItsDirectoryIs)
{
  const Scratch scratch;
  scratch.write("rock.prm", of_joints("set Cohesion = 12345678.912345679\n"
                                      "set Friction angle = 33.3333333333333357\n"
                                      "set Element moment = false\n"));
  const Parameters p = read_deck(scratch.write("deck.prm", deck_text("rock.prm")), {});
  scratch.write("run/summary.json", "");
  const RunDeck deck(p);
  deck.write(scratch.path("run"));
  std::filesystem::remove(scratch.path("rock.prm"));
  std::filesystem::rename(scratch.path("run"), scratch.path("elsewhere"));

  const Parameters q = read_deck(scratch.path("elsewhere/deck.prm"), {});
  ASSERT_EQ(q.n_beds(), 3);
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(rock_text(q.bed(k)), rock_text(p.bed(k))) << k;
  EXPECT_EQ(q.bed(1).joint.cohesion, 12345678.912345679);
  EXPECT_EQ(q.bed(1).joint.tan_friction, p.bed(1).joint.tan_friction);
  EXPECT_FALSE(q.bed(2).joint.element_moment);
  EXPECT_EQ(RunDeck(q).everything, deck.everything); // so that it can be resumed
}

TEST(TableOfFractures, GoesWithTheRunByteByByte)
{
  const Scratch scratch;
  const std::string table = "# of a scan line\nx1_m,y1_m,x2_m,y2_m\n-4,-1,-2,1\n";
  scratch.write("mine/scan.csv", table);
  scratch.write("run/x", "");
  const Parameters p = read_deck(
      scratch.write("mine/deck.prm",
                    "set Components = layer, fractures, walls\nsubsection Layer\n"
                    "set Shape = straight\nend\nsubsection Fractures\n"
                    "set Table = scan.csv\nend\n"),
      {});
  const RunDeck deck(p);
  deck.write(scratch.path("run"));
  std::filesystem::remove_all(scratch.path("mine"));
  const Parameters q = read_deck(scratch.path("run/deck.prm"), {});
  EXPECT_EQ(q.fractures.table, scratch.path("run/fractures.csv"));
  std::ifstream copy(q.fractures.table);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(copy), {}), table);
  EXPECT_EQ(RunDeck(q).everything, deck.everything);
  // Repeated where it stands, over itself.
  EXPECT_NO_THROW(RunDeck(q).write(scratch.path("run")));
}

TEST(RockFiles, OfTheUserAreNotWrittenOver)
{
  const Scratch scratch;
  const std::string text = of_layer("");
  scratch.write("rock-2.prm", text);
  const Parameters p = read_deck(scratch.write("mine.prm", deck_text("rock-2.prm")), {});
  EXPECT_THROW(RunDeck(p).write(scratch.path("")), InputError);
  EXPECT_FALSE(std::filesystem::exists(scratch.path("deck.prm")));
  std::ifstream file(scratch.path("rock-2.prm"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
  // A run that has failed before its first step leaves its own.
  scratch.write("run/x", "");
  RunDeck(p).write(scratch.path("run"));
  scratch.write("rock-2.prm", of_layer("set Young modulus = 50e9\n"));
  EXPECT_NO_THROW(
      RunDeck(read_deck(scratch.path("mine.prm"), {})).write(scratch.path("run")));
}

TEST(RockFiles, LeaveTheShapeOfTheJointsOfAMatrixToTheDeck)
{
  const Scratch scratch;
  const std::string deck = scratch.write("deck.prm", deck_text(rocks + "rock-2.prm"));
  const std::string matrix = "Components=layer, beds, matrix, walls";
  EXPECT_TRUE(problems_of(deck, {matrix, "Layer/Flat joint/Elements=2"}).empty());
  EXPECT_EQ(problems_of(deck, {"Layer/Flat joint/Elements=2"}).size(), 1u);
  EXPECT_EQ(problems_of(deck, {matrix, "Layer/Flat joint/Cohesion=1e6"}).size(), 1u);
}
} // namespace rock_files_tests

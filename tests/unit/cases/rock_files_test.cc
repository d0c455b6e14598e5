// The rock files of a stack of beds: what they may say.
#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(RockFiles, LeaveTheShapeOfTheJointsOfAMatrixToTheDeck)
{
  const Scratch scratch;
  const std::string deck = scratch.write("deck.prm", deck_text(rocks + "rock-2.prm"));
  const std::string matrix = "Components=layer, beds, matrix, walls";
  EXPECT_TRUE(problems_of(deck, {matrix, "Layer/Flat joint/Elements=2"}).empty());
  EXPECT_EQ(problems_of(deck, {"Layer/Flat joint/Elements=2"}).size(), 1u);
  EXPECT_EQ(problems_of(deck, {matrix, "Layer/Flat joint/Cohesion=1e6"}).size(), 1u);
}

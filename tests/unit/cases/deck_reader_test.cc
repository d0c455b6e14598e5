#include "cases/deck_reader.h"

#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

namespace deck_reader_tests
{
using namespace antiform::cases;

namespace
{
std::string value_of(const DeckText &deck, const std::string &path)
{
  for (const DeckLine &line : deck.entries)
    if (line.path == path)
      return line.value;
  return "(not set)";
}
} // namespace

TEST(DeckReader, ReadsSubsectionsCommentsAndContinuedLines)
{
  const Scratch scratch;
  const std::string file =
      scratch.write("a.prm", "# a comment\n"
                             "set Title = one \\\n   two # and a comment\n"
                             "subsection Layer\r\n"
                             "  set   Radius   ratio=1.5\n"
                             "  subsection Flat joint\n"
                             "    set Cohesion = 1e6\n"
                             "  end\n"
                             "end\n");
  std::vector<std::string> problems;
  const DeckText deck = scan_deck(file, problems);
  EXPECT_TRUE(problems.empty()) << join(problems, "\n");
  ASSERT_EQ(deck.entries.size(), 3u);
  EXPECT_EQ(value_of(deck, "Title"), "one two");
  EXPECT_EQ(value_of(deck, "Layer/Radius ratio"), "1.5");
  EXPECT_EQ(value_of(deck, "Layer/Flat joint/Cohesion"), "1e6");
  EXPECT_EQ(deck.entries[0].place, file + ":2");
  EXPECT_EQ(deck.entries[2].place, file + ":7");
}

TEST(DeckReader, LooksForIncludesBesideTheFileThatIncludes)
{
  const Scratch scratch;
  const std::string deck_file =
      scratch.write("study/deck.prm", "include ../rocks/a.prm\n");
  scratch.write("rocks/a.prm", "include b.prm\nset Title = from a\n");
  const std::string inner = scratch.write("rocks/b.prm", "set Components = layer\n");
  std::vector<std::string> problems;
  const DeckText deck = scan_deck(deck_file, problems);
  EXPECT_TRUE(problems.empty()) << join(problems, "\n");
  EXPECT_EQ(value_of(deck, "Title"), "from a");
  EXPECT_EQ(value_of(deck, "Components"), "layer");
  EXPECT_TRUE(std::filesystem::equivalent(
      inner, deck.entries[0].place.substr(0, deck.entries[0].place.rfind(':'))));
}

TEST(DeckReader, ReadsAnIncludeWithinASubsection)
{
  const Scratch scratch;
  scratch.write("joint.prm", "subsection Flat joint\nset Cohesion = 3\nend\n");
  const std::string file =
      scratch.write("a.prm", "subsection Layer\ninclude joint.prm\nset Seed = 4\nend\n");
  std::vector<std::string> problems;
  const DeckText deck = scan_deck(file, problems);
  EXPECT_TRUE(problems.empty()) << join(problems, "\n");
  EXPECT_EQ(value_of(deck, "Layer/Flat joint/Cohesion"), "3");
  EXPECT_EQ(value_of(deck, "Layer/Seed"), "4");
}

TEST(DeckReader, SaysWhereAMissingIncludeWasLookedFor)
{
  const Scratch scratch;
  const std::string file = scratch.write("a.prm", "\ninclude rocks/none.prm\n");
  std::vector<std::string> problems;
  scan_deck(file, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find(file + ":2"), std::string::npos) << problems[0];
  EXPECT_NE(problems[0].find(scratch.path("rocks")), std::string::npos) << problems[0];
  EXPECT_NE(problems[0].find("none.prm"), std::string::npos) << problems[0];
}

TEST(DeckReader, RefusesAFileThatIncludesItself)
{
  const Scratch scratch;
  const std::string file = scratch.write("a.prm", "include b.prm\n");
  scratch.write("b.prm", "include a.prm\n");
  std::vector<std::string> problems;
  scan_deck(file, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("includes itself"), std::string::npos) << problems[0];
}

TEST(DeckReader, CollectsEveryUnreadableLine)
{
  const Scratch scratch;
  const std::string file = scratch.write("a.prm", "end\n"
                                                  "Thickness = 10\n"
                                                  "set Title\n"
                                                  "subsection Layer\n"
                                                  "subsection Flat joint\n"
                                                  "end\n");
  std::vector<std::string> problems;
  scan_deck(file, problems);
  ASSERT_EQ(problems.size(), 4u) << join(problems, "\n");
  EXPECT_EQ(problems[0].find(file + ":1: 'end'"), 0u) << problems[0];
  EXPECT_EQ(problems[1].find(file + ":2: cannot read 'Thickness = 10'"), 0u)
      << problems[1];
  EXPECT_EQ(problems[2].find(file + ":3: cannot read 'set Title'"), 0u) << problems[2];
  EXPECT_EQ(problems[3].find(file + ":4: 'subsection Layer' is not closed"), 0u)
      << problems[3];
}

TEST(DeckReader, NamesThreeLinesOfWhatIsNoDeckAndCountsTheOthers)
{
  const Scratch scratch;
  std::string text;
  for (int k = 0; k < 1000; ++k)
    text += std::string(500, 'x') + "\n";
  const std::string file = scratch.write("a.vtu", text);
  std::vector<std::string> problems;
  scan_deck(file, problems);
  ASSERT_EQ(problems.size(), 4u);
  EXPECT_LT(problems[0].size(), file.size() + 300);
  EXPECT_NE(problems[3].find("997 more lines"), std::string::npos) << problems[3];
}

TEST(DeckReader, RefusesAnEntryThatAFileSetsTwiceButNotOneThatItsIncludeSets)
{
  const Scratch scratch;
  scratch.write("rock.prm", "subsection Layer\nset Seed = 1\nend\n");
  const std::string file = scratch.write("a.prm", "include rock.prm\n"
                                                  "subsection Layer\n"
                                                  "set Seed = 2\n"
                                                  "end\n"
                                                  "subsection Layer\n"
                                                  "set Seed = 3\n"
                                                  "end\n");
  std::vector<std::string> problems;
  scan_deck(file, problems);
  ASSERT_EQ(problems.size(), 1u) << join(problems, "\n");
  EXPECT_EQ(problems[0].find(file + ":6: 'Layer/Seed'"), 0u) << problems[0];
  EXPECT_NE(problems[0].find(file + ":3"), std::string::npos) << problems[0];
}

TEST(DeckReader, ReadsAnIncludeTwice)
{
  const Scratch scratch;
  scratch.write("rock.prm", "set Title = of the rock\n");
  const std::string file = scratch.write(
      "a.prm", "include rock.prm\nset Title = mine\ninclude rock.prm\n");
  std::vector<std::string> problems;
  const DeckText deck = scan_deck(file, problems);
  EXPECT_TRUE(problems.empty()) << join(problems, "\n");
  EXPECT_EQ(deck.entries.back().value, "of the rock");
}

TEST(DeckReader, TellsWhatTwoDecksSetDifferently)
{
  const std::string one = "set Title = a\nsubsection Layer\nset Seed = 1\nend\n",
                    other = "set Title = a\nsubsection Layer\nset Seed = 2\nend\n";
  EXPECT_TRUE(deck_differences(one, one).empty());
  const std::vector<std::string> differences = deck_differences(one, other);
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0], "'Layer/Seed' = '1' and not '2'");
}

TEST(DeckReader, NamesAComponentThatOnlyOneDeckHasInPlaceOfItsSections)
{
  const std::string section = "subsection Layer\nset Seed = 1\nend\n",
                    beds = "subsection Beds\nset Friction = 0.6\nset Rocks = a, b\nend\n"
                           "subsection Bed 1\nset Seed = 3\nend\n",
                    one = "set Components = layer, beds, walls\n" + section + beds,
                    other = "set Components = layer, walls, damping\n" + section;
  EXPECT_EQ(deck_differences(one, other),
            (std::vector<std::string>{"a component 'beds' too many",
                                      "no component 'damping'"}));
  // Another order is another deck too, and has no other name.
  EXPECT_EQ(deck_differences("set Components = a, b\n", "set Components = b, a\n"),
            (std::vector<std::string>{"'Components' = 'a, b' and not 'b, a'"}));
  // What else differs is named still.
  EXPECT_EQ(deck_differences(one, "set Components = layer, walls\n"
                                  "subsection Layer\nset Seed = 2\nend\n"),
            (std::vector<std::string>{"a component 'beds' too many",
                                      "'Layer/Seed' = '1' and not '2'"}));
}

TEST(DeckReader, RefusesAFolderAndAMissingDeck)
{
  const Scratch scratch;
  for (const std::string &file : {scratch.path("none.prm"), scratch.path("")})
  {
    std::vector<std::string> problems;
    scan_deck(file, problems);
    ASSERT_EQ(problems.size(), 1u) << file;
    EXPECT_EQ(problems[0].find(file + ": cannot open"), 0u) << problems[0];
  }
}

TEST(DeckReader, SplitsAnOverrideAtItsFirstEqualsSign)
{
  DeckText deck;
  std::vector<std::string> problems;
  scan_override("Layer/Flat joint/Cohesion = 1e6", deck, problems);
  scan_override("Title=a=b", deck, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(value_of(deck, "Layer/Flat joint/Cohesion"), "1e6");
  EXPECT_EQ(value_of(deck, "Title"), "a=b");
}

TEST(DeckReader, RefusesOverridesThatDeckPrmCouldNotHold)
{
  for (const std::string text :
       {"Title", "=3", "Title=a # b", "Title=a\nset Components=b"})
  {
    DeckText deck;
    std::vector<std::string> problems;
    scan_override(text, deck, problems);
    EXPECT_EQ(problems.size(), 1u) << text;
    EXPECT_TRUE(deck.entries.empty()) << text;
  }
}

TEST(DeckReader, SuggestsTheNearestNameOrNone)
{
  const std::vector<std::string> names = {"Thickness", "Radius ratio", "Length ratio"};
  EXPECT_EQ(nearest_name("thicknes", names), "Thickness");
  EXPECT_EQ(nearest_name("Radius ration", names), "Radius ratio");
  EXPECT_EQ(nearest_name("Viscosity", names), "");
}
} // namespace deck_reader_tests

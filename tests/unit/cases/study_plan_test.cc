#include "cases/study_plan.h"

#include "cases/study_tables.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace study_plan_tests
{
using namespace antiform::cases;
using Texts = std::vector<std::string>;

namespace
{
/// The axes of @p text, which must have no problem.
std::vector<StudyAxis> axes_of(const std::string &text)
{
  Texts problems;
  const std::vector<StudyAxis> axes = read_axes(text, problems);
  for (const std::string &problem : problems)
    ADD_FAILURE() << text << ": " << problem;
  return axes;
}

Texts values_of(const std::string &text)
{
  return axes_of("Layer/Thickness = " + text).at(0).at(0).values;
}

Texts problems_of(const std::string &text)
{
  Texts problems;
  read_axes(text, problems);
  return problems;
}

Texts names_of(const std::string &text)
{
  Texts names;
  for (const StudyMember &member : members_of(axes_of(text)))
    names.push_back(member.name);
  return names;
}

void expect_one_problem(const std::string &text, const std::string &part)
{
  const Texts problems = problems_of(text);
  ASSERT_EQ(problems.size(), 1u) << text;
  EXPECT_NE(problems[0].find(part), std::string::npos) << problems[0];
}
} // namespace

TEST(StudyPlan, ReadsListsAsTheyAreWritten)
{
  EXPECT_EQ(values_of("0.01, 3,1e4"), (Texts{"0.01", "3", "1e4"}));
  EXPECT_EQ(axes_of("Matrix/Interface = sliding , cemented").at(0).at(0).values,
            (Texts{"sliding", "cemented"}));
  EXPECT_EQ(values_of("one  word"), Texts{"one word"});
}

TEST(StudyPlan, KeepsCommasWithinBraces)
{
  const auto axes = axes_of("Components = {layer, walls}, {layer}; Title = {a;b&c}, {}");
  EXPECT_EQ(axes.at(0).at(0).values, (Texts{"layer, walls", "layer"}));
  EXPECT_EQ(axes.at(1).at(0).values, (Texts{"a;b&c", ""}));
}

TEST(StudyPlan, MakesEvenRangesWithBothEnds)
{
  EXPECT_EQ(values_of("0 to 1 in 5"), (Texts{"0", "0.25", "0.5", "0.75", "1"}));
  EXPECT_EQ(values_of("0.1 to 0.5 in 5"), (Texts{"0.1", "0.2", "0.3", "0.4", "0.5"}));
  EXPECT_EQ(values_of("5 to -5 in 2"), (Texts{"5", "-5"}));
  EXPECT_EQ(values_of("7, 1 to 2 in 3"), (Texts{"7", "1", "1.5", "2"}));
}

TEST(StudyPlan, MakesLogarithmicRangesOfEqualRatios)
{
  EXPECT_EQ(values_of("0.01 to 100 in 5 logarithmic"),
            (Texts{"0.01", "0.1", "1", "10", "100"}));
  const Texts nine = values_of("0.01 to 100 in 9 logarithmic");
  ASSERT_EQ(nine.size(), 9u);
  for (std::size_t i = 1; i < nine.size(); ++i) // six digits each: 1e-6 at most
    EXPECT_NEAR(std::stod(nine[i]) / std::stod(nine[i - 1]), std::sqrt(10.), 1e-5);
  EXPECT_EQ(values_of("100 to 1 in 3 logarithmic"), (Texts{"100", "10", "1"}));
}

TEST(StudyPlan, MakesSeeds)
{
  EXPECT_EQ(values_of("seeds 3 to 6"), (Texts{"3", "4", "5", "6"}));
  EXPECT_EQ(values_of("seeds 2 to 2"), Texts{"2"});
}

TEST(StudyPlan, SaysWhatIsWrongWithARange)
{
  expect_one_problem("A = 1 to 5", "'1 to 5 in 9'");
  expect_one_problem("A = 1 to 5 in 1", "2 or more");
  expect_one_problem("A = 1 to 5 in 2.5", "whole number");
  expect_one_problem("A = 1 to 1 in 3", "differ");
  expect_one_problem("A = 0 to 1 in 3 logarithmic", "> 0");
  expect_one_problem("A = 1 to 5 in 9 log", "'1 to 5 in 9'");
  expect_one_problem("A = 1 to 5 in 1e9", "2 or more");
  expect_one_problem("A = seeds 5", "'seeds 1 to 5'");
  expect_one_problem("A = seeds 5 to 1", "'seeds 1 to 5'");
  expect_one_problem("A = seeds 1.5 to 3", "'seeds 1 to 5'");
}

TEST(StudyPlan, SaysWhatIsWrongWithAnAxis)
{
  expect_one_problem("", "names no entry");
  expect_one_problem("A", "cannot read 'A'");
  expect_one_problem("= 1", "cannot read '= 1'");
  expect_one_problem("A = 1; A = 2", "'A' twice");
  expect_one_problem("A = 1, 2 & B = 1", "equally many");
  expect_one_problem("A = 1,, 2", "no value");
  expect_one_problem("A =", "no value");
  expect_one_problem("A = {1, 2", "brace");
  expect_one_problem("A = {{1}}", "brace");
  // All at once.
  EXPECT_EQ(problems_of("A = 1 to 5; B; C = 1, 2 & D = 1").size(), 3u);
}

TEST(StudyPlan, CrossesAxesTheLastOneFastest)
{
  const auto members = members_of(axes_of("A = 1, 2; B = x, y, z"));
  ASSERT_EQ(members.size(), 6u);
  EXPECT_EQ(members[0].values, (Texts{"1", "x"}));
  EXPECT_EQ(members[1].values, (Texts{"1", "y"}));
  EXPECT_EQ(members[5].values, (Texts{"2", "z"}));
  EXPECT_EQ(n_members(axes_of("A = 1, 2; B = x, y, z")), 6.);
}

TEST(StudyPlan, ZipsEntriesOfOneAxis)
{
  const auto members = members_of(axes_of("A = 1, 2 & B = x, y; C = u, v"));
  ASSERT_EQ(members.size(), 4u);
  EXPECT_EQ(members[0].values, (Texts{"1", "x", "u"}));
  EXPECT_EQ(members[3].values, (Texts{"2", "y", "v"}));
  EXPECT_EQ(paths_of(axes_of("A = 1, 2 & B = x, y; C = u, v")), (Texts{"A", "B", "C"}));
}

TEST(StudyPlan, CountsMembersBeyondAnyIntWithoutMakingThem)
{
  std::string text;
  for (const char *name : {"A", "B", "C", "D"})
    text += std::string(name) + " = seeds 1 to 1000; ";
  EXPECT_EQ(n_members(axes_of(text)), 1e12);
}

TEST(StudyPlan, NamesMembersByEntryAndValue)
{
  EXPECT_EQ(names_of("Matrix/Burial depth ratio = 0.01, 1e2; Matrix/Interface = sliding"),
            (Texts{"burial-depth-ratio-0.01_interface-sliding",
                   "burial-depth-ratio-1e2_interface-sliding"}));
  EXPECT_EQ(members_of(axes_of("Layer/Seed = 4; Run/Strain = small")).at(0).label,
            "seed 4, strain small");
}

TEST(StudyPlan, NamesTheFirstOfZippedEntriesWhereItTellsThemApart)
{
  EXPECT_EQ(names_of("Layer/A = 1, 2 & Layer/B = 7, 8"), (Texts{"a-1", "a-2"}));
  EXPECT_EQ(names_of("Layer/A = 1, 1 & Layer/B = 7, 8"), (Texts{"a-1_b-7", "a-1_b-8"}));
}

TEST(StudyPlan, NamesTheSectionWhereEntriesAreAlike)
{
  EXPECT_EQ(names_of("Layer/Poisson ratio = 0.2; Matrix/Poisson ratio = 0.3"),
            (Texts{"layer-poisson-ratio-0.2_matrix-poisson-ratio-0.3"}));
  EXPECT_EQ(short_names({"Layer/Seed", "Matrix/Cell size ratio"}, '_'),
            (Texts{"seed", "cell_size_ratio"}));
}

TEST(StudyPlan, MakesEveryNameAFolderOfItsOwn)
{
  // Alike as files, different as texts; and far too long.
  const std::string longer(300, 'x');
  const Texts names =
      names_of("Title = a/b, a:b, ../a, " + longer + "1, " + longer + "2");
  const std::set<std::string> different(names.begin(), names.end());
  EXPECT_EQ(different.size(), 5u);
  for (const std::string &name : names)
  {
    EXPECT_LT(name.size(), 128u);
    EXPECT_EQ(name.find('/'), std::string::npos) << name;
  }
}

TEST(StudyPlan, KeepsNamesWhenValuesAreAdded)
{
  const Texts before = names_of("A = 1, 10; B = x, y"),
              after = names_of("A = 0.1, 1, 10, 100; B = x, y, z");
  for (const std::string &name : before)
    EXPECT_NE(std::find(after.begin(), after.end(), name), after.end()) << name;
}

TEST(StudyTable, NamesColumnsWithTheirUnits)
{
  EXPECT_EQ(column_name("peak_stress", "Pa"), "peak_stress_Pa");
  EXPECT_EQ(column_name("energy/fracture", "J"), "energy_fracture_J");
  EXPECT_EQ(column_name("wall_seconds", "s"), "wall_seconds");
  EXPECT_EQ(column_name("peak_memory_bytes", "bytes"), "peak_memory_bytes");
  EXPECT_EQ(column_name("critical_stress over theory_stress", "-"),
            "critical_stress_over_theory_stress");
  EXPECT_EQ(column_name("grain_density", "kg/m^3"), "grain_density_kg_per_m3");
}

TEST(StudyTable, TakesFiguresWithUnitsAndWarningsFromASummary)
{
  const antiform::test::TemporaryFolder folder;
  std::ofstream(folder.path("summary.json")) << R"({"status": "failed",
    "warnings": ["a coarse mesh", "no balance"], "wall_seconds": 2,
    "energy": {"slip": 3.5, "closure_error": 1e-6}})";
  const RunOutcome outcome = read_outcome(folder.path(""));
  EXPECT_EQ(outcome.figures.at("energy/slip").unit, "J");
  EXPECT_EQ(outcome.figures.at("energy/closure_error").unit, "-");
  EXPECT_EQ(outcome.figures.at("wall_seconds").unit, "s");
  EXPECT_EQ(outcome.reason, "no balance");
  EXPECT_EQ(outcome.warnings, Texts{"a coarse mesh"});
}

TEST(StudyTable, FindsFiguresAndRatios)
{
  RunOutcome outcome;
  outcome.figures = {
      {"a", {6., "Pa"}}, {"b", {3., "Pa"}}, {"c", {2., "m"}}, {"d", {0., "m"}}};
  Result figure;
  ASSERT_TRUE(find_figure(outcome, "a", figure));
  EXPECT_EQ(figure.value, 6.);
  ASSERT_TRUE(find_figure(outcome, "a over b", figure));
  EXPECT_EQ(figure.value, 2.);
  EXPECT_EQ(figure.unit, "-");
  ASSERT_TRUE(find_figure(outcome, "a over c", figure));
  EXPECT_EQ(figure.unit, "Pa/m");
  EXPECT_FALSE(find_figure(outcome, "a over d", figure)); // none is infinite
  EXPECT_FALSE(find_figure(outcome, "a over e", figure));
  EXPECT_FALSE(find_figure(outcome, "e", figure));
}
} // namespace study_plan_tests

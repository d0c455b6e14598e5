// A simulation holds only what its scene calls for: the loop counts the calls of each
// effect, and summary.json gives them.
#include "support/tiny_run.h"

namespace effects_tests
{
using namespace antiform::test;

namespace
{
nlohmann::json run_and_summarise(const std::string &directory,
                                 const std::vector<std::string> &entries)
{
  const Outcome outcome = run_tiny(directory, set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

std::int64_t calls(const nlohmann::json &summary, const std::string &effect)
{
  return summary.at("effects").at(effect).at("calls");
}

void expect_absent(const nlohmann::json &summary, const std::string &effect)
{
  const nlohmann::json &entry = summary.at("effects").at(effect);
  EXPECT_EQ(entry.at("calls"), 0) << effect;
  EXPECT_EQ(entry.at("seconds"), 0.) << effect;
  EXPECT_EQ(entry.at("active"), false) << effect;
  EXPECT_NE(entry.at("reason"), "") << effect;
}

void expect_in_every_step(const nlohmann::json &summary, const std::string &effect)
{
  const nlohmann::json &entry = summary.at("effects").at(effect);
  EXPECT_EQ(entry.at("calls"), summary.at("steps")) << effect;
  EXPECT_EQ(entry.at("active"), true) << effect;
}
} // namespace

TEST(Effects, ThatAreNotListedCostNothing)
{
  const TemporaryFolder folder;
  const nlohmann::json summary = run_and_summarise(
      folder.path("run"), unbreakable({"Components=layer, matrix, walls"}));
  ASSERT_GT(summary.at("steps"), 100);
  for (const char *effect : {"gravity", "surface pressure", "prestress", "foundation",
                             "base", "damping", "friction", "contacts", "search"})
    expect_absent(summary, effect);
  for (const char *effect : {"bonds", "mesh", "bridging domain", "walls"})
    expect_in_every_step(summary, effect);
}

TEST(Effects, ThatAreListedActInEveryStep)
{
  const TemporaryFolder folder;
  const nlohmann::json summary = run_and_summarise(
      folder.path("run"),
      unbreakable({"Components=layer, matrix, gravity, surface pressure, foundation, "
                   "walls, damping",
                   "Surface pressure/Pressure=1e5"}));
  ASSERT_GT(summary.at("steps"), 100);
  for (const char *effect : {"gravity", "surface pressure", "prestress", "foundation",
                             "damping", "bonds", "mesh", "bridging domain", "walls"})
    expect_in_every_step(summary, effect);
  for (const char *effect : {"base", "friction", "contacts", "search"})
    expect_absent(summary, effect);
}

TEST(Effects, OfPureGrainsHaveABaseAndNoMesh)
{
  const TemporaryFolder folder;
  const nlohmann::json summary =
      run_and_summarise(folder.path("run"), unbreakable({"Matrix/Representation=grains",
                                                         "Matrix/Burial depth ratio=0.5",
                                                         "Matrix/Base depth ratio=0.5"}));
  ASSERT_GT(summary.at("steps"), 100);
  for (const char *effect : {"bonds", "base", "walls", "damping"})
    expect_in_every_step(summary, effect);
  for (const char *effect : {"mesh", "bridging domain", "foundation", "search"})
    expect_absent(summary, effect);
}

TEST(Effects, OfBreakageBeginWithTheFirstBrokenBond)
{
  const TemporaryFolder folder;
  const nlohmann::json summary = run_and_summarise(folder.path("run"), {});
  const std::vector<double> crack_steps =
      CsvTable(folder.path("run/cracks.csv")).column("step");
  ASSERT_FALSE(crack_steps.empty());
  const auto first = static_cast<std::int64_t>(crack_steps.front());
  ASSERT_GT(first, 100);
  const std::int64_t steps_after = summary.at("steps").get<std::int64_t>() - first - 1;
  ASSERT_GT(steps_after, 100);
  EXPECT_EQ(calls(summary, "friction"), steps_after);
  EXPECT_EQ(calls(summary, "contacts"), steps_after);
  // Loose grains move by a fraction of their size: few searches, and at least the first.
  EXPECT_GE(calls(summary, "search"), 1);
  EXPECT_LT(calls(summary, "search"), steps_after / 10);
}

// The shell of candidates is as wide as grains can move in many steps: of a run that ends
// right after its first break, loose grains are searched for once.
TEST(Effects, OfTheSearchAreOneCallRightAfterTheFirstBreak)
{
  const TemporaryFolder folder;
  const std::vector<std::string> fine{"Output/Samples per millistrain=2000"};
  run_and_summarise(folder.path("whole"), fine);
  const CsvTable cracks(folder.path("whole/cracks.csv"));
  const double first = cracks.column("shortening").front();
  std::vector<std::string> entries = fine;
  entries.push_back("Run/End shortening=" + std::to_string(first + 2e-6));
  const nlohmann::json summary = run_and_summarise(folder.path("short"), entries);
  const CsvTable same(folder.path("short/cracks.csv"));
  ASSERT_FALSE(same.column("step").empty());
  EXPECT_EQ(same.column("step").front(), cracks.column("step").front());
  ASSERT_GT(summary.at("steps"), same.column("step").front() + 1.);
  EXPECT_EQ(calls(summary, "search"), 1);
}

TEST(Effects, AreTheSameInCheckAndInTheSummary)
{
  const TemporaryFolder folder;
  for (const std::string components :
       {"layer, matrix, walls", "layer, matrix, gravity, foundation, walls, damping"})
  {
    const std::vector<std::string> entries = unbreakable({"Components=" + components});
    const Outcome check = run_program("check --json " + tiny_deck() + set(entries));
    ASSERT_EQ(check.status, 0) << check.output;
    const nlohmann::json announced = nlohmann::json::parse(check.output).at("effects");
    const nlohmann::json effects =
        run_and_summarise(folder.path(std::to_string(components.size())), entries)
            .at("effects");
    EXPECT_EQ(announced.size(), effects.size());
    for (const auto &[name, effect] : effects.items())
    {
      ASSERT_TRUE(announced.contains(name)) << name;
      EXPECT_EQ(announced.at(name).at("reason"), effect.at("reason")) << name;
      EXPECT_EQ(announced.at(name).at("state") == "present", effect.at("active")) << name;
    }
  }
}
} // namespace effects_tests

// cases/accuracy: its studies, and runs whose resolution follows from the error wanted.
#include "support/tiny_run.h"

#include <cmath>

namespace accuracy_cases_tests
{
using namespace antiform::test;

namespace
{
std::string deck(const std::string &name)
{
  return std::string(ANTIFORM_SOURCE_DIR) + "/cases/accuracy/" + name;
}

double mean(const std::vector<double> &values, const std::size_t from)
{
  return 0.5 * (values.at(from) + values.at(from + 1));
}
} // namespace

// Half of an outer grain has no joint: a section of n grains has up to one grain less
// that carries, in bending its cube. Moduli of single packings scatter by 2 %, here two
// of each.
TEST(AccuracyCases, SmallTwinRunsThroughAndFinerGrainsCarryMore)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("quick");
  const Outcome outcome =
      run_program("study " + deck("quick.prm") + " -o " + directory + " --jobs 2");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json study = nlohmann::json::parse(contents(directory + "/study.json"));
  ASSERT_EQ(study.at("members").size(), 4u);
  std::vector<double> critical, modulus;
  for (const nlohmann::json &member : study.at("members"))
  {
    EXPECT_EQ(member.at("status"), "completed");
    critical.push_back(member.at("figures").at("critical_stress_Pa"));
    modulus.push_back(member.at("figures").at("layer_plane_modulus_Pa"));
  }
  const double least = 1. - 1. / 6.; // a whole grain at 6, nothing at 10
  EXPECT_GT(mean(modulus, 0) / mean(modulus, 2), least - 0.03);
  EXPECT_LT(mean(modulus, 0) / mean(modulus, 2), 1.);
  EXPECT_GT(mean(critical, 0) / mean(critical, 2), std::pow(least, 3) - 0.06);
  EXPECT_LT(mean(critical, 0) / mean(critical, 2), 1.);
}
// What is printed, written and repeated of a choice.
TEST(AccuracyCases, RunSaysWhatItChoseAndItsDeckRepeatsIt)
{
  const TemporaryFolder folder;
  const std::string first = folder.path("first"), second = folder.path("second");
  const std::string small = set({"Layer/Length ratio=6", "Run/End shortening=5e-4"});
  const Outcome outcome =
      run_program("run " + deck("wanted.prm") + " -o " + first + small);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("Accuracy: 20 % wanted"), std::string::npos)
      << outcome.output;

  const nlohmann::json accuracy = summary_of(first).at("accuracy");
  EXPECT_EQ(accuracy.at("wanted_percent"), 20.);
  EXPECT_LE(accuracy.at("sum_percent").get<double>(), 20.);
  ASSERT_EQ(accuracy.at("settings").size(), 2u); // grains across, balance tolerance
  const std::string text = contents(first + "/deck.prm");
  for (const nlohmann::json &setting : accuracy.at("settings"))
  {
    EXPECT_TRUE(setting.at("chosen"));
    const std::string entry = setting.at("entry"), value = setting.at("value");
    EXPECT_NE(outcome.output.find(entry), std::string::npos);
    // In full in deck.prm: "set Grains across   = 14"
    const std::string name = "set " + entry.substr(entry.find('/') + 1) + " ";
    const std::size_t at = text.find(name);
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_EQ(text.substr(text.find('=', at) + 2, value.size() + 1), value + "\n");
  }

  ASSERT_EQ(run_program("run " + first + "/deck.prm -o " + second).status, 0);
  expect_same_run(first, second);

  const Outcome page = draw_page("report " + first, folder.path("matplotlib"));
  ASSERT_EQ(page.status, 0) << page.output;
  const std::string html = contents(first + "/report.html");
  EXPECT_NE(html.find("What another error takes"), std::string::npos);
  EXPECT_NE(html.find("not in the record"), std::string::npos); // 1 % of a bent layer
  ASSERT_EQ(
      run_program("run " + deck("quick.prm") + " -o " + folder.path("plain")).status, 0);
  EXPECT_FALSE(summary_of(folder.path("plain")).contains("accuracy"));
}

TEST(AccuracyCases, CheckTellsTheChoiceToPeopleAndPrograms)
{
  const std::string options =
      "check " + deck("wanted.prm") + set({"Layer/Grains across=12"});
  const Outcome words = run_program(options), json = run_program(options + " --json");
  ASSERT_EQ(words.status, 0) << words.output;
  EXPECT_NE(words.output.find("the deck's"), std::string::npos) << words.output;
  const nlohmann::json accuracy = nlohmann::json::parse(json.output).at("accuracy");
  EXPECT_EQ(accuracy.at("settings").at(0).at("value"), "12");
  EXPECT_EQ(accuracy.at("settings").at(0).at("chosen"), false);
  EXPECT_EQ(accuracy.at("settings").at(1).at("chosen"), true);
  // Each of the alternatives is what that wish would get, where it is in the record.
  const nlohmann::json free = nlohmann::json::parse(
      run_program("check " + deck("wanted.prm") + " --json").output)["accuracy"];
  int n_reached = 0;
  for (const nlohmann::json &other : free.at("alternatives"))
  {
    const std::string wish =
        "Accuracy=" + std::to_string(other.at("wanted_percent").get<int>()) + " %";
    const Outcome wished =
        run_program("check " + deck("wanted.prm") + " --json" + set({wish}));
    if (other.at("values").empty())
    {
      EXPECT_EQ(wished.status, 1) << wish;
      continue;
    }
    ++n_reached;
    const nlohmann::json plan = nlohmann::json::parse(wished.output).at("accuracy");
    for (const nlohmann::json &setting : plan.at("settings"))
      EXPECT_EQ(other.at("values").at(setting.at("entry").get<std::string>()),
                setting.at("value"))
          << wish;
  }
  EXPECT_GE(n_reached, 1);
}
} // namespace accuracy_cases_tests

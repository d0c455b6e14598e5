// 'antiform study' as a whole: what it leaves, how it goes on, what it refuses.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

namespace studies_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
std::string study(const std::string &deck,
                  const std::string &directory,
                  const std::vector<std::string> &entries,
                  const std::string &options = "--jobs 2")
{
  return "study " + deck + " -o " + directory + set(entries) + " " + options;
}

/// Two shortenings of a static section, smooth and cemented: half a second each.
const std::vector<std::string> four{
    "Study/Vary=Run/End shortening = 1e-3, 2e-3; Matrix/Interface = cemented, sliding",
    "Study/Collect=wall_force, shortening, theory/strut/buckling_stress"};

nlohmann::json record_of(const std::string &directory)
{
  return nlohmann::json::parse(contents(directory + "/study.json"));
}

std::vector<std::string> lines_of(const std::string &text)
{
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

/// Status of each member, by its name.
std::map<std::string, std::string> statuses(const std::string &directory)
{
  std::map<std::string, std::string> result;
  const nlohmann::json record = record_of(directory);
  for (const nlohmann::json &member : record.at("members"))
    result[member.at("name")] = member.at("status");
  return result;
}

/// The time at which each member's summary was written.
std::map<std::string, fs::file_time_type> ends_of(const std::string &directory)
{
  std::map<std::string, fs::file_time_type> result;
  std::error_code error;
  for (fs::directory_iterator entry(directory + "/members", error), end;
       !error && entry != end; entry.increment(error))
    if (fs::exists(entry->path() / "summary.json", error))
      result[entry->path().filename().string()] =
          fs::last_write_time(entry->path() / "summary.json", error);
  return result;
}
} // namespace

TEST(Study, LeavesALineAMemberAndRunsNoneTwice)
{
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  const Outcome first = run_program(study(buried_deck(), out, four));
  ASSERT_EQ(first.status, 0) << first.output;
  EXPECT_EQ(occurrences(first.output, " completed in "), 4u) << first.output;
  const std::string table = contents(out + "/study.csv");
  const std::vector<std::string> lines = lines_of(table);
  ASSERT_EQ(lines.size(), 5u) << table;
  EXPECT_EQ(lines[0].find("member,end_shortening,interface,status"), 0u) << table;
  EXPECT_EQ(
      lines[2].find("end-shortening-1e-3_interface-sliding,1e-3,sliding,completed,"), 0u)
      << table;

  // A member is the run that its user would have made by hand.
  const Outcome alone =
      run_program("run " + buried_deck() + " -o " + folder.path("alone") +
                  set({"Run/End shortening=2e-3", "Matrix/Interface=sliding"}));
  ASSERT_EQ(alone.status, 0) << alone.output;
  expect_same_file("history.csv", folder.path("alone"),
                   out + "/members/end-shortening-2e-3_interface-sliding");

  // Theory's value is that of 'antiform theory'.
  const Outcome theory = run_program("theory " + buried_deck() + " --json");
  const nlohmann::json strut = nlohmann::json::parse(theory.output).at("strut");
  EXPECT_EQ(record_of(out).at("members").at(0).at("figures").at(
                "theory_strut_buckling_stress_Pa"),
            strut.at("buckling_stress").at("value"));

  // Once more: nothing is run, nothing changes.
  const auto ends = ends_of(out);
  const Outcome again = run_program(study(buried_deck(), out, four));
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_NE(again.output.find("4 completed (4 of them found)"), std::string::npos)
      << again.output;
  EXPECT_EQ(contents(out + "/study.csv"), table);
  EXPECT_EQ(ends_of(out), ends);

  const Outcome page = draw_page("report " + out, folder.path("matplotlib"));
  EXPECT_EQ(page.status, 0) << page.output;
  const std::string html = contents(out + "/study.html");
  EXPECT_EQ(occurrences(html, "<svg"), 3u); // a chart each, the strut's stress too
  EXPECT_EQ(occurrences(html, "<tr class=\"completed\">"), 4u);
  EXPECT_EQ(occurrences(html, "src="), 0u); // it needs no other file

  // One at a time: the same table.
  const std::string single = folder.path("single");
  ASSERT_EQ(run_program(study(buried_deck(), single, four, "--jobs 1")).status, 0);
  expect_same_file("study.csv", out, single);
}

TEST(Study, GoesOnAfterThreeKillsToTheSameTable)
{
  // Members long enough to be met at work, which leave checkpoints often.
  const std::vector<std::string> three =
      unbreakable({"Run/End shortening=2e-3", "Output/Checkpoint interval=0.001",
                   "Study/Vary=Matrix/Stiffness contrast = 20, 25, 30"});
  const TemporaryFolder folder;
  const std::string whole = folder.path("whole"), parts = folder.path("parts");
  ASSERT_EQ(run_program(study(tiny_deck(), whole, three)).status, 0);

  const auto member = [&](const std::string &contrast, const std::string &file)
  { return parts + "/members/stiffness-contrast-" + contrast + "/" + file; };
  const auto is_completed = [&](const std::string &contrast)
  {
    const std::string file = member(contrast, "summary.json");
    return fs::exists(file) &&
           nlohmann::json::parse(contents(file)).at("status") == "completed";
  };
  const std::function<bool()> moments[] = {
      [&] { return fs::exists(member("20", "state.h5")); },
      [&] { return is_completed("20"); },
      [&] { return fs::exists(member("25", "state.h5")); }};
  std::map<std::string, fs::file_time_type> ended;
  for (const auto &moment : moments)
  {
    RunningProgram program(study(tiny_deck(), parts, three, "--jobs 1"));
    ASSERT_TRUE(program.wait_until(moment));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait(), -SIGKILL);
    for (const auto &[name, time] : ends_of(parts))
      if (summary_of(parts + "/members/" + name).at("status") == "completed")
        ended.insert({name, time});
  }
  const Outcome resumed = run_program(study(tiny_deck(), parts, three));
  ASSERT_EQ(resumed.status, 0) << resumed.output;
  // What had ended has not been touched.
  EXPECT_GE(ended.size(), 1u);
  for (const auto &[name, time] : ended)
    EXPECT_EQ(ends_of(parts).at(name), time) << name;
  expect_same_file("study.csv", whole, parts);
  for (const auto &[name, time] : ends_of(whole))
    expect_same_file("history.csv", whole + "/members/" + name,
                     parts + "/members/" + name);
  for (const auto &[name, status] : statuses(parts))
    EXPECT_EQ(status, "completed") << name;
}

TEST(Study, WaitsForARunThatAKilledStudyHasLeft)
{
  // As when a study is killed whose member does not hear of it.
  const std::vector<std::string> one =
      unbreakable({"Run/End shortening=6e-3", "Run/Longest shortening=1e-2",
                   "Walls/Transits per millistrain=60", // outlasts the study's beginning
                   "Study/Vary=Layer/Seed = 1"});
  const TemporaryFolder folder;
  const std::string out = folder.path("out"), member = out + "/members/seed-1";
  {
    RunningProgram stopped(study(tiny_deck(), out, one));
    ASSERT_TRUE(stopped.wait_until([&] { return fs::exists(member + ".prm"); }));
    stopped.send(SIGINT);
    EXPECT_EQ(stopped.wait(), 3);
  }
  fs::remove_all(member);
  RunningProgram left("run " + member + ".prm -o " + member);
  ASSERT_TRUE(left.wait_until([&] { return fs::exists(member + "/history.csv"); }));
  const Outcome outcome = run_program(study(tiny_deck(), out, one));
  EXPECT_EQ(left.wait(), 0); // nobody has disturbed it
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  for (const char *part : {"waiting for it", "1 completed (1 of them found)"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
}

TEST(Study, StopsAtASignalWithCheckpoints)
{
  const std::vector<std::string> two = unbreakable(
      {"Run/End shortening=6e-3", "Run/Longest shortening=1e-2",
       "Walls/Transits per millistrain=60", // longer than a second study takes to begin
       "Output/Checkpoint interval=10", "Study/Vary=Matrix/Stiffness contrast = 20, 25"});
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  {
    RunningProgram program(study(tiny_deck(), out, two));
    const std::string member = out + "/members/stiffness-contrast-25/history.csv";
    ASSERT_TRUE(program.wait_until(
        [&] { return fs::exists(member) && fs::file_size(member) > 4000; }));
    // A second study must not meet this one.
    const Outcome second = run_program(study(tiny_deck(), out, two));
    EXPECT_EQ(second.status, 1);
    EXPECT_NE(second.output.find("another study is at work there"), std::string::npos)
        << second.output;
    program.send(SIGINT);
    EXPECT_EQ(program.wait(), 3);
  }
  EXPECT_EQ(record_of(out).at("status"), "interrupted");
  EXPECT_TRUE(fs::exists(out + "/members/stiffness-contrast-25/state.h5"));
  EXPECT_NE(contents(out + "/log.txt").find("the same command goes on"),
            std::string::npos);
  const Outcome resumed = run_program(study(tiny_deck(), out, two));
  EXPECT_EQ(resumed.status, 0) << resumed.output;
  EXPECT_NE(contents(out + "/members/stiffness-contrast-25.out").find("resumed"),
            std::string::npos)
      << contents(out + "/members/stiffness-contrast-25.out");
}

TEST(Study, GoesOnWithTheOthersWhenOneFails)
{
  // A layer twelve times as heavy as the mud it lies in sinks; in stiff clay it does not.
  const std::vector<std::string> mud{"Components=layer, matrix, walls, gravity",
                                     "Layer/Grain density=30000",
                                     "Matrix/Stiffness contrast=1e3",
                                     "Matrix material/Law=Mohr-Coulomb",
                                     "Matrix material/Friction angle=0",
                                     "Study/Vary=Matrix material/Cohesion = 1e3, 1e9"};
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  const Outcome outcome = run_program(study(buried_deck(), out, mud, "--jobs 1"));
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_EQ(statuses(out).at("cohesion-1e3"), "failed");
  EXPECT_EQ(statuses(out).at("cohesion-1e9"), "completed");
  EXPECT_NE(outcome.output.find("does not bear its loads"), std::string::npos)
      << outcome.output;
  EXPECT_NE(record_of(out).at("members").at(0).at("reason").get<std::string>().find(
                "does not bear its loads"),
            std::string::npos);
  EXPECT_NE(contents(out + "/study.csv").find("\ncohesion-1e3,1e3,failed"),
            std::string::npos);
  // It is not run again, and the study still says so.
  const auto ends = ends_of(out);
  EXPECT_EQ(run_program(study(buried_deck(), out, mud)).status, 2);
  EXPECT_EQ(ends_of(out), ends);
}

TEST(Study, GivesItsMembersTheThreadsThatTheUserSays)
{
  const TemporaryFolder folder;
  const std::vector<std::string> one{"Study/Vary=Run/End shortening = 1e-3"};
  const auto threads = [&](const std::string &options, const int environment)
  {
    const std::string out = folder.path("out" + std::to_string(environment));
    const Outcome outcome =
        run_program(study(buried_deck(), out, one, options), 1, environment);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(out + "/members/end-shortening-1e-3").at("threads").get<int>();
  };
  EXPECT_EQ(threads("--jobs 1", 1), 1); // whatever the cores
  EXPECT_EQ(threads("--jobs 1 --threads 3", 2), 3);
}

TEST(Study, TellsOfItsMembersWarnings)
{
  // Six of the columns of half a wave are enough; three and four are not.
  const std::vector<std::string> three{
      "Layer/Length ratio=192.8", "Matrix/Base depth ratio=100", "Run/Modes=3",
      "Matrix/Refinement rounds=0", "Matrix/Largest cell ratio=100",
      "Study/Vary=Matrix/Cell aspect ratio = 16, 24.1, 32.1"};
  const TemporaryFolder folder;
  const std::string out = folder.path("out"),
                    deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling.prm";
  const Outcome outcome = run_program(study(deck, out, three));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const std::string text = "2 of 3 members warn (the first: cell-aspect-ratio-24.1): ";
  EXPECT_EQ(occurrences(outcome.output, "warning: " + text), 1u) << outcome.output;
  const nlohmann::json record = record_of(out);
  ASSERT_EQ(record.at("warnings").size(), 1u);
  EXPECT_EQ(record.at("warnings").at(0).get<std::string>().find(text), 0u);
  EXPECT_FALSE(record.at("members").at(0).contains("warnings"));
  for (const std::size_t k : {1u, 2u})
    EXPECT_EQ(record.at("members").at(k).at("warnings"),
              summary_of(out + "/members/" +
                         record.at("members").at(k).at("name").get<std::string>())
                  .at("warnings"));
  const Outcome page = draw_page("report " + out, folder.path("matplotlib"));
  EXPECT_EQ(page.status, 0) << page.output;
  EXPECT_NE(contents(out + "/study.html").find("<li>" + text), std::string::npos);
}

TEST(Study, KeepsItsMembersWhenTheChoiceChanges)
{
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  const auto with = [](const std::string &values, const std::string &more = "")
  {
    std::vector<std::string> entries{"Study/Vary=Run/End shortening = " + values};
    if (!more.empty())
      entries.push_back(more);
    return entries;
  };
  ASSERT_EQ(run_program(study(buried_deck(), out, with("1e-3, 2e-3"))).status, 0);
  const auto ends = ends_of(out);

  const Outcome other = run_program(study(buried_deck(), out, with("5e-4, 2e-3")));
  EXPECT_EQ(other.status, 0) << other.output;
  EXPECT_NE(other.output.find("1 new: end-shortening-5e-4"), std::string::npos)
      << other.output;
  EXPECT_NE(other.output.find("1 of before are not in it any more"), std::string::npos)
      << other.output;
  EXPECT_EQ(ends_of(out).at("end-shortening-2e-3"), ends.at("end-shortening-2e-3"));
  EXPECT_EQ(ends_of(out).at("end-shortening-1e-3"), ends.at("end-shortening-1e-3"));
  EXPECT_EQ(lines_of(contents(out + "/study.csv")).size(), 3u);

  // Another rock is another study; the tables stay as they are.
  const std::string table = contents(out + "/study.csv");
  const Outcome rock = run_program(
      study(buried_deck(), out, with("5e-4, 2e-3", "Layer/Young modulus=4e10")));
  EXPECT_EQ(rock.status, 1);
  for (const char *part :
       {"its members are of another deck", "'Layer/Young modulus'", "-o DIR"})
    EXPECT_NE(rock.output.find(part), std::string::npos) << rock.output;
  EXPECT_EQ(contents(out + "/study.csv"), table);

  // What is collected may change at any time.
  const Outcome collected = run_program(study(
      buried_deck(), out, with("5e-4, 2e-3", "Study/Collect=sizes/cells, pek_stress")));
  EXPECT_EQ(collected.status, 0) << collected.output;
  EXPECT_EQ(lines_of(contents(out + "/study.csv"))[0],
            "member,end_shortening,status,sizes_cells,pek_stress");
  EXPECT_NE(collected.output.find("'pek_stress', which no member has"), std::string::npos)
      << collected.output;
}

TEST(Study, RefusesWhatIsWrongBeforeAnyWork)
{
  const TemporaryFolder folder;
  const std::string out = folder.path("never");
  struct
  {
    std::vector<std::string> entries;
    std::vector<std::string> naming;
  } const cases[] = {
      {{}, {"'Study/Vary' is missing"}},
      {{"Study/Vary=Matrix/Burial deth ratio = 1, 2; Layer/Thickness = 1, -1, thick"},
       {"'Matrix/Burial deth ratio'", "Did you mean 'Burial depth ratio'?",
        "'Layer/Thickness' = '-1'", "'Layer/Thickness' = 'thick'", "a number > 0"}},
      {{"Study/Vary=Layer/Thickness = 1, 2", "Study/Colect=peak_stress"},
       {"'Study/Colect'", "Did you mean 'Collect'?"}},
      {{"Study/Vary=Layer/Thickness = seeds 1 to 300"},
       {"300 members", "'Study/Most members' = 200"}},
      {{"Study/Vary=Study/Most members = 1, 2"}, {"does not vary itself"}},
      {{"Study/Vary=Layer/Thickness = 1, 2", "Layer/Thickness=3"},
       {"the study varies 'Layer/Thickness'"}},
      // Of the members: alike, without use, each with its own fault.
      {{"Study/Vary=Layer/Thickness = 1, 1.0"}, {"is the same run as member"}},
      {{"Study/Vary=Walls/Action = press; Damping/Coefficient = 0.5, 0.7"},
       {"'Study/Vary'", "has no use for", "Damping"}},
      {{"Study/Vary=Matrix/Burial depth ratio = 0, 3; Layer/Length ratio = 16, 17",
        "Run/Driver=nonsense"},
       {"'Run/Driver' = 'nonsense'"}}};
  for (const auto &one : cases)
  {
    const Outcome outcome = run_program(study(buried_deck(), out, one.entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    for (const std::string &part : one.naming)
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n"
                                                              << outcome.output;
    EXPECT_FALSE(fs::exists(out)) << outcome.output;
  }
  // The directory of a run.
  fs::create_directories(folder.path("run"));
  std::ofstream(folder.path("run/history.csv")) << "step\n";
  const Outcome run = run_program(study(buried_deck(), folder.path("run"), four));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("holds something else than a study"), std::string::npos)
      << run.output;
  EXPECT_FALSE(fs::exists(folder.path("run/members")));
}

TEST(Study, OfADeckLeavesRunAndCheckAlone)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("study.prm"))
      << "include " << buried_deck()
      << "\nsubsection Study\n  set Vary = Run/End shortening = 1e-3, 2e-3\nend\n";
  const std::string deck = folder.path("study.prm");
  EXPECT_EQ(run_program("check " + deck).status, 0);
  const Outcome run = run_program("run " + deck + " -o " + folder.path("run"));
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(contents(folder.path("run/deck.prm")).find("subsection Study"),
            std::string::npos);
  // Without -o beside the deck.
  EXPECT_EQ(run_program("study " + deck).status, 0);
  EXPECT_TRUE(fs::exists(folder.path("study-output/study.csv")));
}

TEST(Study, OfBurialDepthMeetsTheClosedFormsFromThinToDeepLong)
{
  // Three contrasts, the middle one that of study.prm.
  const TemporaryFolder folder;
  const std::string out = folder.path("depths"),
                    deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/study-contrasts.prm";
  const Outcome outcome = run_program(study(deck, out, {}));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  ASSERT_EQ(lines_of(contents(out + "/study.csv")).size(), 67u);
  const nlohmann::json record = record_of(out);
  std::map<std::string, std::vector<double>> sliding; // stresses by contrast
  for (const nlohmann::json &member : record.at("members"))
  {
    // Smooth and bonded cover on a half-space. The mesh leaves 0.5 to 0.9 %; at a
    // contrast of 1e3 the closed form, of a thin layer in a matrix without stress of its
    // own, is 1 to 2.2 % too high (docs/theory/continuum.md 12).
    const double ratio = member.at("figures").at("critical_stress_over_theory_stress");
    EXPECT_NEAR(ratio, 1., 0.03) << member.at("name");
    if (member.at("values").at("interface") == "sliding")
      sliding[member.at("values").at("stiffness_contrast")].push_back(
          member.at("figures").at("critical_stress_Pa"));
  }
  ASSERT_EQ(sliding.size(), 3u);
  for (const auto &[contrast, stresses] : sliding)
  {
    // From a cover that does nothing to one as good as the rock below: two half-spaces
    // hold with 2^(2/3) of the stress of one; at 1e5 a cover of 100 h is 1.2 % short of
    // it.
    ASSERT_EQ(stresses.size(), 11u);
    EXPECT_NEAR(stresses.back() / stresses.front(), std::cbrt(4.), 0.03 * std::cbrt(4.))
        << contrast;
  }
}
} // namespace studies_tests

#include "cases/command_line.h"

#include "cases/deck_reader.h"
#include "cases/interrupt.h"

#include <gtest/gtest.h>

namespace command_line_tests
{
using namespace antiform::cases;
using Command = CommandLine::Command;

namespace
{
std::string refusal_of(const std::vector<std::string> &arguments)
{
  try
  {
    parse_command_line(arguments);
  }
  catch (const InputError &error)
  {
    return error.what();
  }
  return "";
}
} // namespace

TEST(CommandLine, ReadsEveryOptionOfRun)
{
  const CommandLine line = parse_command_line(
      {"run", "--set", "Layer/Seed=2", "deck.prm", "-o", "out", "--set", "Title=a b, c",
       "--threads", "3", "--resume", "--time-limit", "1.5"});
  EXPECT_EQ(line.command, Command::run);
  EXPECT_EQ(line.run.deck, "deck.prm");
  EXPECT_EQ(line.run.output, "out");
  EXPECT_EQ(line.run.overrides,
            (std::vector<std::string>{"Layer/Seed=2", "Title=a b, c"}));
  EXPECT_EQ(line.run.threads, 3);
  EXPECT_TRUE(line.run.resume);
  EXPECT_EQ(line.run.time_limit, 1.5);
}

TEST(CommandLine, LeavesOutWhatIsNotGiven)
{
  const CommandLine line = parse_command_line({"run", "deck.prm"});
  EXPECT_TRUE(line.run.output.empty());
  EXPECT_TRUE(line.run.overrides.empty());
  EXPECT_EQ(line.run.threads, 0);
  EXPECT_FALSE(line.run.resume);
  EXPECT_EQ(line.run.time_limit, 0.);
}

TEST(CommandLine, ReadsCheckAndParameters)
{
  const CommandLine check =
      parse_command_line({"check", "d.prm", "--json", "--set", "a=b"});
  EXPECT_EQ(check.command, Command::check);
  EXPECT_TRUE(check.json);
  EXPECT_EQ(check.run.overrides.size(), 1u);
  const CommandLine parameters = parse_command_line({"parameters", "overlap"});
  EXPECT_EQ(parameters.command, Command::parameters);
  EXPECT_EQ(parameters.name, "overlap");
  EXPECT_TRUE(parse_command_line({"parameters", "--markdown"}).markdown);
}

TEST(CommandLine, ReadsTheory)
{
  const CommandLine line =
      parse_command_line({"theory", "d.prm", "--json", "--plot", "a.svg",
                          "--friction-angle", "45", "--set", "a=b"});
  EXPECT_EQ(line.command, Command::theory);
  EXPECT_EQ(line.run.deck, "d.prm");
  EXPECT_EQ(line.run.overrides.size(), 1u);
  EXPECT_TRUE(line.theory.json);
  EXPECT_EQ(line.theory.plot, "a.svg");
  EXPECT_EQ(line.theory.friction_angle, 45.);
  EXPECT_NE(refusal_of({"theory", "d.prm", "--plot", "a.png"}).find(".svg"),
            std::string::npos);
  EXPECT_NE(refusal_of({"theory", "d.prm", "--friction-angle", "90"}).find("--friction"),
            std::string::npos);
}

TEST(CommandLine, ReadsCalibrate)
{
  const CommandLine line =
      parse_command_line({"calibrate", "d.prm", "-o", "out", "--resume", "--set", "a=b"});
  EXPECT_EQ(line.command, Command::calibrate);
  EXPECT_EQ(line.run.deck, "d.prm");
  EXPECT_EQ(line.run.output, "out");
  EXPECT_TRUE(line.run.resume);
  EXPECT_EQ(line.run.overrides.size(), 1u);
}

TEST(CommandLine, ReadsStudy)
{
  const CommandLine line =
      parse_command_line({"study", "d.prm", "-o", "out", "--jobs", "3", "--set", "a=b"});
  EXPECT_EQ(line.command, Command::study);
  EXPECT_EQ(line.run.deck, "d.prm");
  EXPECT_EQ(line.run.output, "out");
  EXPECT_EQ(line.run.overrides.size(), 1u);
  EXPECT_EQ(line.jobs, 3);
  EXPECT_EQ(parse_command_line({"study", "d.prm"}).jobs, 0);
  EXPECT_NE(refusal_of({"study", "d.prm", "--jobs", "0"}).find("--jobs"),
            std::string::npos);
}

TEST(CommandLine, EveryCommandHasHelpWithAnExample)
{
  for (const std::string command : {"", "run", "check", "theory", "parameters", "calibrate",
                                    "study"})
  {
    std::vector<std::string> arguments = {"--help"};
    if (!command.empty())
      arguments.insert(arguments.begin(), command);
    const CommandLine line = parse_command_line(arguments);
    EXPECT_EQ(line.command, Command::help);
    EXPECT_NE(line.help_text.find("Example:\n  antiform"), std::string::npos) << command;
  }
}

TEST(CommandLine, HelpSaysWhichOfTwoOverridesCounts)
{
  for (const std::string command : {"run", "check", "theory", "calibrate"})
  {
    const std::string help = parse_command_line({command, "--help"}).help_text;
    EXPECT_NE(tidy(help).find("of two for one entry the last counts"), std::string::npos)
        << help;
  }
}

TEST(CommandLine, RefusesWhatItDoesNotKnow)
{
  EXPECT_NE(refusal_of({"run", "d.prm", "--fast"}).find("--fast"), std::string::npos);
  EXPECT_NE(refusal_of({"run"}).find("DECK"), std::string::npos);
  EXPECT_NE(refusal_of({"run", "d.prm", "--threads", "0"}).find("--threads"),
            std::string::npos);
  EXPECT_NE(refusal_of({"run", "d.prm", "--time-limit", "-1"}).find("--time-limit"),
            std::string::npos);
  EXPECT_NE(refusal_of({"run", "a.prm", "b.prm"}).find("b.prm"), std::string::npos);
  EXPECT_NE(refusal_of({}), "");
  EXPECT_NE(refusal_of({"fold"}), "");
}

TEST(CommandLine, ReadsWhatPagesAreAskedFor)
{
  const CommandLine line =
      parse_command_line({"report", "out", "-o", "a.html", "--steps", "peak,12"});
  EXPECT_EQ(line.command, CommandLine::Command::report);
  EXPECT_EQ(line.report.directory, "out");
  EXPECT_EQ(line.report.page, "a.html");
  EXPECT_EQ(line.report.steps, "peak,12");
  EXPECT_NE(refusal_of({"report"}).find("DIR"), std::string::npos);

  const CommandLine comparison = parse_command_line({"compare", "a", "b", "-o", "c"});
  EXPECT_EQ(comparison.command, CommandLine::Command::compare);
  EXPECT_EQ(comparison.comparison.runs, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(comparison.comparison.output, "c");
}

TEST(Interrupt, RemembersTheSignalAndGoesOn)
{
  catch_interrupts();
  EXPECT_EQ(interrupt_signal(), 0);
  raise(SIGTERM);
  EXPECT_EQ(interrupt_signal(), SIGTERM);
  raise(SIGINT);
  EXPECT_EQ(interrupt_signal(), SIGINT);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}
} // namespace command_line_tests

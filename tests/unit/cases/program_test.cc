// The program as its users meet it: exit status and what it prints.
#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <sys/wait.h>

namespace program_tests
{
namespace
{
struct Outcome
{
  int status = -1;
  std::string output; ///< both streams
};

/// Run the program on @p n_ranks. The environment is emptied first: within a test that
/// mpiexec has started, its variables would make this a part of that job.
Outcome run_program(const std::string &arguments, const int n_ranks = 1)
{
  std::string command = "env -i PATH=\"$PATH\" OMPI_ALLOW_RUN_AS_ROOT=1 "
                        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                        "OMPI_MCA_rmaps_base_oversubscribe=1 ";
  if (n_ranks > 1)
    command += "mpirun -np " + std::to_string(n_ranks) + " ";
  command += std::string(ANTIFORM_PROGRAM) + " " + arguments + " 2>&1";

  Outcome outcome;
  FILE *pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), buffer.size(), pipe) != nullptr)
    outcome.output += buffer.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::size_t occurrences(const std::string &text, const std::string &part)
{
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1))
    ++n;
  return n;
}
} // namespace

TEST(Program, PrintsEveryProblemOfADeckOnceOnAnyNumberOfRanks)
{
  const Scratch scratch;
  const std::string deck =
      scratch.write("bad.prm", "set Components = layer, walls\nsubsection Layer\n"
                               "set Thickness = 0\nset Seed = ten\nend\n");
  for (const int n_ranks : {1, 2})
  {
    const Outcome outcome = run_program("run " + deck, n_ranks);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_EQ(occurrences(outcome.output, deck + ":3: 'Layer/Thickness'"), 1u)
        << outcome.output;
    EXPECT_EQ(occurrences(outcome.output, deck + ":4: 'Layer/Seed'"), 1u)
        << outcome.output;
    EXPECT_EQ(occurrences(outcome.output, "2 problems"), 1u) << outcome.output;
  }
  EXPECT_FALSE(std::filesystem::exists(scratch.path("bad-output")));
}

TEST(Program, RefusesADirectoryThatCannotBeWrittenTo)
{
  const std::string deck =
      std::string(ANTIFORM_SOURCE_DIR) + "/cases/burial-depth/quick.prm";
  const Outcome outcome = run_program("run " + deck + " -o /proc/antiform");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("'/proc/antiform': cannot be created"), std::string::npos)
      << outcome.output;
}

TEST(Program, HelpsOnceAndEndsWell)
{
  const Outcome outcome = run_program("run --help", 2);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "Example:"), 1u) << outcome.output;
}

TEST(Program, NamesNoDefaultWhereThereIsNone)
{
  const std::string deck =
      std::string(ANTIFORM_SOURCE_DIR) + "/cases/fractures/quick.prm";
  const Outcome outcome =
      run_program("check " + deck + " --set Fractures/Intensity=much");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("'Fractures/Intensity' = 'much' is no such list"),
            std::string::npos)
      << outcome.output;
  EXPECT_EQ(outcome.output.find("the default is"), std::string::npos) << outcome.output;
  const Outcome page = run_program("parameters \"Fractures/Table\"");
  EXPECT_NE(page.output.find("default: (empty)"), std::string::npos) << page.output;
}

TEST(Program, EndsWithOneForACommandThatDoesNotExist)
{
  const Outcome outcome = run_program("fold out");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("antiform fold"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("run, check"), std::string::npos) << outcome.output;
}
} // namespace program_tests

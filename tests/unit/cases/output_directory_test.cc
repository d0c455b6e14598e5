#include "cases/output_directory.h"

#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

namespace output_directory_tests
{
using namespace antiform::cases;

namespace
{
RunOptions options_for(const std::string &output, const bool resume = false)
{
  RunOptions options;
  options.deck = "deck.prm";
  options.output = output;
  options.resume = resume;
  return options;
}

std::string refusal_of(RunOptions options)
{
  try
  {
    prepare_output_directory(options);
  }
  catch (const InputError &error)
  {
    return error.what();
  }
  return "";
}
} // namespace

TEST(OutputDirectory, IsBesideTheDeckByDefault)
{
  const Scratch scratch;
  RunOptions options;
  options.deck = scratch.write("fold.prm", "");
  prepare_output_directory(options);
  EXPECT_EQ(options.output, scratch.path("fold-output"));
  EXPECT_TRUE(std::filesystem::is_empty(options.output));
}

TEST(OutputDirectory, AcceptsAnEmptyOrForeignDirectoryAndRefusesAnotherRun)
{
  const Scratch scratch;
  EXPECT_EQ(refusal_of(options_for(scratch.path("a/b"))), "");
  EXPECT_EQ(refusal_of(options_for(scratch.path("a/b"))), ""); // empty, made just now
  scratch.write("a/b/notes.txt", "mine");
  EXPECT_EQ(refusal_of(options_for(scratch.path("a/b"))), "");
  scratch.write("run/state.h5", "old");
  const std::string text = refusal_of(options_for(scratch.path("run")));
  EXPECT_NE(text.find("holds another run (state.h5"), std::string::npos) << text;
  EXPECT_NE(text.find("--resume"), std::string::npos) << text;
}

TEST(OutputDirectory, ResumesWhereThereIsAStateAndElseSaysThatItStartsAfresh)
{
  const Scratch scratch;
  scratch.write("with/state.h5", "state");
  RunOptions with = options_for(scratch.path("with"), true);
  EXPECT_EQ(prepare_output_directory(with).message, "");
  EXPECT_TRUE(with.resume);

  // What failed before its first step has left a deck and a summary.
  scratch.write("without/deck.prm", "old");
  scratch.write("without/summary.json", "old");
  RunOptions without = options_for(scratch.path("without"), true);
  EXPECT_NE(prepare_output_directory(without).message.find("starts afresh"),
            std::string::npos);
  EXPECT_FALSE(without.resume);
}

TEST(OutputDirectory, KeepsResultsThatNoStateGoesWith)
{
  const Scratch scratch;
  scratch.write("static/history.csv", "old");
  for (const bool resume : {false, true})
  {
    const std::string text = refusal_of(options_for(scratch.path("static"), resume));
    EXPECT_NE(text.find("no state.h5"), std::string::npos) << text;
  }
}

TEST(OutputDirectory, RefusesWhatStandsInTheWayOfItsFiles)
{
  const Scratch scratch;
  scratch.write("run/fields", "a file");
  const std::string text = refusal_of(options_for(scratch.path("run")));
  EXPECT_NE(text.find("'fields' is not a folder"), std::string::npos) << text;
  scratch.write("other/log.txt/inside", "a folder");
  EXPECT_NE(
      refusal_of(options_for(scratch.path("other"))).find("'log.txt' is not a file"),
      std::string::npos);
}

TEST(OutputDirectory, RefusesWhatCannotBeWrittenTo)
{
  const Scratch scratch;
  const std::string file = scratch.write("file", "");
  EXPECT_NE(refusal_of(options_for(file)).find("is a file"), std::string::npos);
  EXPECT_NE(refusal_of(options_for(file + "/below")).find("cannot be created"),
            std::string::npos);
  // Not even root may create files in the process file system.
  EXPECT_NE(refusal_of(options_for("/proc")).find("cannot be written to"),
            std::string::npos);
}

TEST(OutputDirectory, BelongsToOneRunAtATime)
{
  const Scratch scratch;
  scratch.write("run/state.h5", "state");
  RunOptions first = options_for(scratch.path("run"), true);
  {
    const OutputDirectory held = prepare_output_directory(first);
    ASSERT_TRUE(held.lock->is_held());
    const std::string text = refusal_of(options_for(scratch.path("run"), true));
    EXPECT_NE(text.find("another run is at work there"), std::string::npos) << text;
    EXPECT_EQ(refusal_of(options_for(scratch.path("other"))), "");
  }
  EXPECT_EQ(refusal_of(options_for(scratch.path("run"), true)), "");
}
} // namespace output_directory_tests

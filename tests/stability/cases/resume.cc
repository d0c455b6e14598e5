// A run that is killed, interrupted or out of time goes on from its checkpoint to the
// same bits as one that was left alone.
#include "support/tiny_run.h"

#include <filesystem>

namespace resume_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
struct Variant
{
  std::string name;
  std::vector<std::string> entries;
};

void PrintTo(const Variant &variant, std::ostream *out)
{
  *out << variant.name;
}

// Checkpoints every 30 ms, so that the test need not wait for one.
const std::string checkpoint_often = "Output/Checkpoint interval=5e-4";

/// Wait for cracks, then for a checkpoint that holds them, then for history beyond it.
bool wait_for_checkpoint_with_cracks(RunningProgram &program,
                                     const std::string &directory)
{
  std::error_code error;
  const std::string cracks = directory + "/cracks.csv", state = directory + "/state.h5",
                    history = directory + "/history.csv";
  if (!program.wait_until([&] { return fs::file_size(cracks, error) > 4000 && !error; }))
    return false;
  const auto before = fs::last_write_time(state);
  if (!program.wait_until([&] { return fs::last_write_time(state) != before; }))
    return false;
  const auto length = fs::file_size(history);
  return program.wait_until([&] { return fs::file_size(history) > length; });
}

std::size_t step_resumed_at(const std::string &output)
{
  const std::string words = "resumed at step ";
  const std::size_t at = output.find(words);
  return at == std::string::npos ? 0 : std::stoul(output.substr(at + words.size()));
}

class Resume : public ::testing::TestWithParam<Variant>
{
protected:
  /// A run of @p variant that nobody disturbed; made once.
  static std::string undisturbed(const Variant &variant)
  {
    static const TemporaryFolder folder;
    std::string directory = folder.path(variant.name);
    if (!fs::exists(directory))
    {
      std::vector<std::string> entries = variant.entries;
      entries.push_back(checkpoint_often);
      const Outcome outcome = run_tiny(directory, set(entries));
      EXPECT_EQ(outcome.status, 0) << outcome.output;
    }
    return directory;
  }

  std::string options() const
  {
    std::vector<std::string> entries = GetParam().entries;
    entries.push_back(checkpoint_often);
    return set(entries);
  }
  std::string directory() const { return folder_.path("run"); }

  /// Start a run and disturb it by @p signal when a checkpoint holds cracks.
  int disturb(const int signal) const
  {
    RunningProgram program("run " + tiny_deck() + " -o " + directory() + options());
    if (!wait_for_checkpoint_with_cracks(program, directory()))
      return program.wait() + 1000; // ended before: the deck is too short for this test
    program.send(signal);
    return program.wait();
  }

  void resume_to_the_same_bits()
  {
    const std::vector<double> crack_steps =
        CsvTable(undisturbed(GetParam()) + "/cracks.csv").column("step");
    ASSERT_GT(crack_steps.size(), 20u);
    const Outcome outcome = run_tiny(directory(), options() + " --resume");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_GT(step_resumed_at(outcome.output), crack_steps.front()) << outcome.output;
    expect_same_run(directory(), undisturbed(GetParam()));
  }

  TemporaryFolder folder_;
};

TEST_P(Resume, AfterAKillGivesTheSameBits)
{
  ASSERT_EQ(disturb(SIGKILL), -SIGKILL);
  resume_to_the_same_bits();
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    Resume,
    ::testing::Values(
        Variant{"Coupled", {}},
        Variant{"Frictionless", {"Matrix/Interface=frictionless"}},
        Variant{"OnTheSurface", {"Matrix/Join=surface interface"}},
        Variant{"RubbingOnTheSurface",
                {"Matrix/Join=surface interface", "Matrix/Interface=frictional",
                 "Components=layer, matrix, surface pressure, walls, damping",
                 "Surface pressure/Pressure=1e6"}},
        Variant{"PureGrains",
                {"Matrix/Representation=grains", "Matrix/Burial depth ratio=1",
                 "Matrix/Base depth ratio=1"}},
        Variant{"Slit",
                {"Layer/Joint types/Slit fraction=0.1",
                 "Layer/Joint types/Gapped fraction=0.1",
                 "Layer/Joint types/Gap ratio=1e-3",
                 "Layer/Joint types/Gap deviation=0.3"}},
        Variant{"ParallelBonds", {"Layer/Bond model=parallel bond"}},
        Variant{"ContactBonds", {"Layer/Bond model=contact bond"}},
        Variant{"Fractured",
                {"Components=layer, walls, servo walls, fractures, damping",
                 "Layer/Length ratio=3", "Layer/Grains across=10",
                 "Servo walls/Pressure=5e6", "Servo walls/Ramp=5",
                 "Fractures/List=-4 -4 4 3; 1 -2 6 4", "Fractures/Bonded=true",
                 "Fractures/Cohesion=1e7", "Fractures/Tensile strength=1e6"}},
        Variant{"Confined",
                {"Components=layer, walls, servo walls, damping", "Layer/Length ratio=3",
                 "Layer/Grains across=10", "Servo walls/Pressure=5e6",
                 "Servo walls/Ramp=5"}},
        Variant{"InAMembrane",
                {"Components=layer, walls, membrane, damping", "Layer/Length ratio=3",
                 "Layer/Grains across=10", "Membrane/Pressure=5e6", "Membrane/Ramp=5"}},
        Variant{"StepAndRelax", {"Walls/Loading=step and relax"}},
        Variant{"Pulled",
                {"Components=layer, walls, damping", "Walls/Action=pull",
                 "Layer/Length ratio=5", "Layer/Grains across=8",
                 "Walls/Transits per millistrain=100", "Run/Strain multiple of peak=1.05",
                 "Output/Samples per millistrain=4000"}},
        Variant{"Turned",
                {"Components=layer, walls, damping", "Walls/Action=turn",
                 "Walls/End rotation=3", "Walls/Shortening before turning=1e-3",
                 "Output/Samples per millistrain=4000"}},
        Variant{"Loaded",
                {"Components=layer, matrix, gravity, surface pressure, "
                 "foundation, walls, damping",
                 "Surface pressure/Pressure=1e6"}}),
    [](const auto &instance) { return instance.param.name; });

class ResumeTiny : public Resume
{
};

TEST_P(ResumeTiny, AfterSigtermGivesTheSameBits)
{
  ASSERT_EQ(disturb(SIGTERM), 3);
  EXPECT_EQ(summary_of(directory()).at("status"), "interrupted");
  resume_to_the_same_bits();
}

TEST_P(ResumeTiny, AfterTheTimeLimitGivesTheSameBits)
{
  // The program looks at its clock every 64 steps.
  const Outcome first = run_tiny(directory(), options() + " --time-limit 1e-3");
  ASSERT_EQ(first.status, 3) << first.output;
  EXPECT_EQ(summary_of(directory()).at("status"), "interrupted");
  EXPECT_EQ(summary_of(directory()).at("steps"), 64);
  const Outcome second = run_tiny(directory(), options() + " --resume --time-limit 1e-3");
  ASSERT_EQ(second.status, 3) << second.output;
  EXPECT_EQ(summary_of(directory()).at("steps"), 128);

  const Outcome third = run_tiny(directory(), options() + " --resume");
  ASSERT_EQ(third.status, 0) << third.output;
  EXPECT_EQ(step_resumed_at(third.output), 128u) << third.output;
  expect_same_run(directory(), undisturbed(GetParam()));
}

TEST_P(ResumeTiny, OfACompletedRunChangesNothing)
{
  fs::copy(undisturbed(GetParam()), directory(), fs::copy_options::recursive);
  const std::map<std::string, std::string> before = all_contents(directory());
  const Outcome outcome = run_tiny(directory(), options() + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_run(directory(), undisturbed(GetParam()));
  for (const auto &[name, text] : all_contents(directory()))
  {
    if (name == "log.txt" || name == "summary.json")
      continue; // these hold times
    EXPECT_TRUE(before.count(name) == 1 && before.at(name) == text) << name;
  }
}

TEST_P(ResumeTiny, WithAnotherDeckIsRefused)
{
  fs::copy(undisturbed(GetParam()), directory(), fs::copy_options::recursive);
  const std::map<std::string, std::string> before = all_contents(directory());
  const Outcome outcome =
      run_tiny(directory(), options() + " --set \"Layer/Seed=2\" --resume");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("is the checkpoint of another deck"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("'Layer/Seed' = '1' and not '2'"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(all_contents(directory()), before);
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         ResumeTiny,
                         ::testing::Values(Variant{"Coupled", {}}),
                         [](const auto &instance) { return instance.param.name; });

// Choices of the overlap, in scenes that nothing breaks in.
TEST(ResumeOfTheOverlap, AfterTheTimeLimitGivesTheSameBits)
{
  const TemporaryFolder folder;
  for (const Variant &variant :
       {Variant{"SubCycled",
                {"Components=layer, matrix, walls", "Run/Driver=dynamic",
                 "Matrix/Cell size ratio=16", "Matrix/Largest cell ratio=16",
                 "Matrix/Burial depth ratio=9", "Matrix/Base depth ratio=9",
                 "Bridging domain/Overlap width ratio=32",
                 "Bridging domain/Overlap damping=0.05", "Bridging domain/Sub-cycles=5"}},
        Variant{"Tied",
                {"Layer/Flat joint/Elements=1", "Layer/Flat joint/Element moment=false",
                 "Layer/Installation gap ratio=0.15", "Layer/Seed=4"}}})
  {
    SCOPED_TRACE(variant.name);
    const std::string options = set(unbreakable(variant.entries)),
                      whole = folder.path(variant.name),
                      parts = folder.path(variant.name + "InParts");
    ASSERT_EQ(run_tiny(whole, options).status, 0);
    ASSERT_EQ(run_tiny(parts, options + " --time-limit 1e-3").status, 3);
    const Outcome resumed = run_tiny(parts, options + " --resume");
    ASSERT_EQ(resumed.status, 0) << resumed.output;
    EXPECT_EQ(step_resumed_at(resumed.output), 64u);
    expect_same_run(parts, whole);
  }
}
} // namespace
} // namespace resume_tests

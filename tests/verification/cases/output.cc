// What a run leaves in its directory.
#include "support/tiny_run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

namespace output_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
const std::string python = "/usr/bin/python3 ";

class OutputOfARun : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    folder_ = std::make_unique<TemporaryFolder>();
    const Outcome outcome = run_tiny(directory());
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    printed_ = outcome.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string directory() { return folder_->path("run"); }

  static std::unique_ptr<TemporaryFolder> folder_;
  static std::string printed_;
};
std::unique_ptr<TemporaryFolder> OutputOfARun::folder_;
std::string OutputOfARun::printed_;
} // namespace

TEST_F(OutputOfARun, IsComplete)
{
  for (const char *file : {"deck.prm", "summary.json", "history.csv", "cracks.csv",
                           "fields.pvd", "state.h5", "log.txt"})
    EXPECT_GT(contents(directory() + "/" + file).size(), 0u) << file;
  EXPECT_EQ(contents(directory() + "/log.txt"), printed_);

  const nlohmann::json summary = summary_of(directory());
  EXPECT_EQ(summary.at("status"), "completed");
  for (const char *entry : {"warnings", "wall_seconds", "cpu_seconds",
                            "peak_memory_bytes", "ranks", "threads", "steps", "solves"})
    EXPECT_TRUE(summary.contains(entry)) << entry;
  for (const char *size : {"grains", "joints", "cells", "dofs", "multipliers"})
    EXPECT_GT(summary.at("sizes").at(size), 0) << size;
  for (const char *energy :
       {"boundary_work", "kinetic", "strain_grains", "strain_continuum", "slip",
        "damping", "fracture", "closure_error"})
    EXPECT_TRUE(summary.at("energy").at(energy).is_number()) << energy;
  for (const auto &[name, effect] : summary.at("effects").items())
    for (const char *entry : {"active", "reason", "calls", "seconds"})
      EXPECT_TRUE(effect.contains(entry)) << name << ", " << entry;
}

TEST_F(OutputOfARun, AgreesWithItself)
{
  const nlohmann::json summary = summary_of(directory());
  const CsvTable history(directory() + "/history.csv"),
      cracks(directory() + "/cracks.csv");
  EXPECT_EQ(result(summary, "crack_count"), static_cast<double>(cracks.size()));
  EXPECT_EQ(result(summary, "cracks_tensile"), history.column("cracks_tensile").back());
  EXPECT_EQ(result(summary, "cracks_shear"), history.column("cracks_shear").back());
  const std::vector<double> stress = history.column("axial_stress_Pa");
  EXPECT_EQ(result(summary, "peak_stress"),
            *std::max_element(stress.begin(), stress.end()));
  EXPECT_EQ(result(summary, "shortening"), history.column("shortening").back());
  EXPECT_EQ(result(summary, "fold_amplitude"), history.column("fold_amplitude_m").back());
  EXPECT_EQ(summary.at("energy").at("fracture"), history.column("fracture_J").back());
}

TEST_F(OutputOfARun, IsNotOverwrittenByAnotherRun)
{
  const std::map<std::string, std::string> before = all_contents(directory());
  const Outcome outcome = run_tiny(directory());
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("holds another run"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("--resume"), std::string::npos) << outcome.output;
  EXPECT_EQ(all_contents(directory()), before);
}

TEST_F(OutputOfARun, HasFieldsThatRead)
{
  const std::string script = R"(
import sys
sys.path.insert(0, sys.argv[1] + '/cases')
from run_files import Run
run = Run(sys.argv[2])
sizes, results = run.summary['sizes'], run.summary['results']
assert len(run.times) > 5, run.times
for number in run.step_numbers:
    frame = run.frame(number)
    assert len(frame.grains.points) == sizes['grains']
    assert len(frame.joints.lines()) <= sizes['joints']
    assert len(frame.continuum.quads()) == sizes['cells']
    assert frame.grains.field('radius_m').min() > 0
assert len(frame.cracks.points) == results['crack_count']['value']
# The last frame is written a step after the last sample.
assert abs(frame.time / results['shortening']['value'] - 1) < 1e-3
)";
  const std::string file = folder_->path("read.py");
  std::ofstream(file) << script;
  const Outcome outcome =
      run_command(python + file + " " ANTIFORM_SOURCE_DIR " " + directory());
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST_F(OutputOfARun, MakesPictures)
{
  const std::string out =
      directory() + "/pictures"; // where they go unless told otherwise
  const Outcome outcome =
      run_command("MPLCONFIGDIR=" + folder_->path("matplotlib") + " " + python +
                  ANTIFORM_SOURCE_DIR "/cases/pictures.py " + directory());
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *name :
       {"fracture_map", "force_chains", "displacement", "stress", "curves"})
  {
    const std::string picture = contents(out + "/" + name + ".png");
    EXPECT_EQ(picture.substr(1, 3), "PNG") << name;
    EXPECT_GT(picture.size(), 10000u) << name; // an empty frame compresses to less
  }
}

TEST(OutputDirectory, IsBesideTheDeckUnlessNamed)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("mine.prm")) << "include " << tiny_deck() << "\n";
  const Outcome outcome =
      run_program("run " + folder.path("mine.prm") + set(unbreakable()));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(summary_of(folder.path("mine-output")).at("status"), "completed");
}

TEST(OutputDirectory, HoldsASummaryWhenThePhysicsFails)
{
  // Two cells in the overlap that barely touch it: nothing that a check could foresee.
  const TemporaryFolder folder;
  const Outcome outcome = run_tiny(
      folder.path("run"),
      set({"Run/Step safety=0.99", "Damping/Coefficient=0.01", "Layer/Shape=cosine",
           "Layer/Amplitude ratio=1", "Matrix/Stiffness contrast=1e6",
           "Layer/Breakable=false", "Walls/Transits per millistrain=1",
           "Run/End shortening=0.5", "Run/Longest shortening=0.6"}));
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_EQ(summary.at("status"), "failed");
  ASSERT_FALSE(summary.at("warnings").empty());
  EXPECT_NE(summary.at("warnings").back().get<std::string>().find("small-strain"),
            std::string::npos)
      << summary.at("warnings");
  EXPECT_GT(contents(folder.path("run/state.h5")).size(), 0u);
}
} // namespace output_tests

// What a run leaves in its directory.
#include "support/tiny_run.h"

#include <algorithm>
#include <cstdio>
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

TEST_F(OutputOfARun, MakesAPageThatStandsAlone)
{
  const std::string page = folder_->path("page.html");
  const Outcome outcome = draw_page("report " + directory() + " -o " + page,
                                    folder_->path("matplotlib"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find(page), std::string::npos) << outcome.output;
  const std::string text = contents(page);
  EXPECT_EQ(text.find("http"), std::string::npos) << "it asks for a network";
  EXPECT_LT(text.size(), 15e6);
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = text.find("<img", at)) != std::string::npos; ++at)
    ++pictures;
  std::size_t inside = 0;
  for (std::size_t at = 0; (at = text.find("src=\"data:image/", at)) != std::string::npos;
       ++at)
    ++inside;
  EXPECT_EQ(pictures, inside);
  EXPECT_GE(pictures, 8u); // curves, four sections at one step at least, rose, ledger, cost
  const nlohmann::json summary = summary_of(directory());
  char peak[40];
  std::snprintf(peak, sizeof peak, "%.4g MPa", result(summary, "peak_stress") / 1e6);
  EXPECT_NE(text.find(peak), std::string::npos) << peak;
  for (const auto &[name, effect] : summary.at("effects").items())
    EXPECT_NE(text.find("<td>" + name + "</td>"), std::string::npos) << name;
}

TEST_F(OutputOfARun, CountsFracturesNotCracks)
{
  // Five cracks a grain's diameter apart across the layer, at three places; two cracks
  // alone; five in shear; five in the matrix.
  const std::string script = R"(
import sys
sys.path.insert(0, sys.argv[1] + '/cases')
import numpy as np
from report_figures import fractures
x = np.concatenate([np.full(5, at) for at in (25., 0., 10., 40., 50.)] + [[33., 60.]])
y = np.concatenate([np.tile(np.arange(5.), 5), [0., 0.]])
mode = np.array(['tension'] * 15 + ['shear'] * 5 + ['tension'] * 7)
layer = np.array([0.] * 20 + [1.] * 5 + [0.] * 2)
table = {'reference_x_m': x, 'reference_y_m': y, 'mode': mode, 'layer': layer}
assert fractures(table, 1., 10.).tolist() == [0., 10., 25.]
assert fractures(table, 1., 30.).tolist() == []
assert fractures(table, 0.5, 1.).tolist() != [0., 10., 25.]
)";
  const std::string file = folder_->path("fractures.py");
  std::ofstream(file) << script;
  const Outcome outcome = run_command("MPLCONFIGDIR=" + folder_->path("matplotlib") + " " +
                                      python + "-B " + file + " " ANTIFORM_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(Report, RefusesWhatIsNoRun)
{
  const TemporaryFolder folder;
  for (const std::string where : {folder.path("nowhere"), folder.path(".")})
  {
    const Outcome outcome = run_program("report " + where);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find(where), std::string::npos) << outcome.output;
  }
  EXPECT_FALSE(fs::exists(folder.path("report.html")));
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

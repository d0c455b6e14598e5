// A layer of several beds: materials by bed, and what joins them.
#include "support/tiny_run.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace beds_tests
{
using namespace antiform::test;

namespace
{
const std::string rocks = ANTIFORM_SOURCE_DIR "/cases/rocks/";
const std::string rock_1 = rocks + "rock-1.prm", rock_2 = rocks + "rock-2.prm";

std::string stack(const std::vector<std::string> &files)
{
  std::string text = "Beds/Rocks=";
  for (const std::string &file : files)
    text += (file == files.front() && text.back() == '=' ? "" : ", ") + file;
  return text;
}

nlohmann::json run_stack(const std::string &deck,
                         const std::vector<std::string> &entries,
                         const std::string &directory)
{
  const Outcome outcome =
      run_program("run " ANTIFORM_SOURCE_DIR "/cases/" + deck + ".prm -o " + directory +
                  set({"Components=layer, beds, walls, damping"}) + set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

const std::vector<std::string> elastic{
    "Layer/Grains across=18", "Layer/Breakable=false", "Run/End shortening=1e-4",
    "Output/Samples per millistrain=2000"};
std::vector<std::string> elastic_and(std::vector<std::string> more)
{
  more.insert(more.end(), elastic.begin(), elastic.end());
  return more;
}
} // namespace

TEST(Beds, ShareTheLoadByTheirModuli)
{
  // Between frictionless platens all beds have one strain: Voigt's mean. Their Poisson
  // ratios differ by 0.03; what that adds is of its square.
  const TemporaryFolder folder;
  const auto stiffness = [&](const std::string &name, const std::vector<std::string> &files)
  {
    const std::string ratios = files.size() == 2 ? "1, 1" : "1, 1, 1";
    return result(run_stack("laboratory/uniaxial",
                            elastic_and({stack(files), "Beds/Thickness ratios=" + ratios}),
                            folder.path(name)),
                  "section_stiffness");
  };
  const double E1 = stiffness("one", {rock_1, rock_1}),
               E2 = stiffness("two", {rock_2, rock_2});
  EXPECT_NEAR(E1 / E2, 2.57, 0.15); // 56/21.9, Table 4.3 of Gioiello (2018)
  // Joints across the two planes, one row each of the 18, have the harmonic mean.
  const double voigt = (2. * E1 + E2) / 3.;
  const double across = 0.5 * (E1 + E2) - 2. / (1. / E1 + 1. / E2);
  EXPECT_NEAR(stiffness("stack", {rock_1, rock_2, rock_1}) / voigt,
              1. - 2. / 18. * across / voigt, 0.01);
}

TEST(Beds, OfOneRockAndCementedAreTheLayer)
{
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program("run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " +
                  folder.path("layer") + set(elastic));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const double E = result(summary_of(folder.path("layer")), "section_stiffness");
  const nlohmann::json beds = run_stack(
      "laboratory/uniaxial",
      elastic_and({stack({rock_1, rock_1}), "Beds/Thickness ratios=1, 2"}),
      folder.path("beds"));
  // The same grains and joints, summed in another order; damping looks at signs, which a
  // rounding can turn.
  EXPECT_NEAR(result(beds, "section_stiffness") / E, 1., 1e-6);
}

TEST(Beds, ThatSlideFreelyBendAloneLong)
{
  // Two beds of half the thickness have a quarter of the bending stiffness; an arch under
  // a small load grows by P a0/(D q^2).
  const TemporaryFolder folder;
  const auto growth = [&](const std::string &name, const std::vector<std::string> &more)
  {
    std::vector<std::string> entries{stack({rock_1, rock_1}),
                                     "Beds/Thickness ratios=1, 1",
                                     "Layer/Grains across=12",
                                     "Layer/Length ratio=16",
                                     "Layer/Breakable=false",
                                     "Walls/Transits per millistrain=700",
                                     "Run/End shortening=1e-4",
                                     "Output/Samples per millistrain=1000"};
    entries.insert(entries.end(), more.begin(), more.end());
    const nlohmann::json summary =
        run_stack("shortening/single-layer", entries, folder.path(name));
    const CsvTable history(folder.path(name + "/history.csv"));
    const std::vector<double> amplitude = history.column("fold_amplitude_m"),
                              stress = history.column("axial_stress_Pa");
    return (amplitude.back() - amplitude.front()) / stress.back();
  };
  const double cemented = growth("cemented", {}),
               sliding = growth("sliding", {"Beds/Interface=frictional",
                                            "Beds/Friction=0"});
  // The joints that a plane cuts carry no load along it any more, those of a row about a
  // grain wide: each bed is between 5 and 6 grains thick, the layer 12.
  EXPECT_GT(sliding / cemented, 0.95 * 4.); // the layer shears a little
  EXPECT_LT(sliding / cemented, 12. * 12. * 12. / (2. * 5. * 5. * 5.));
}

TEST(Beds, CrackWhereTheyAreWeak)
{
  const TemporaryFolder folder;
  run_stack("laboratory/uniaxial",
            {stack({rock_1, rock_2, rock_1}), "Beds/Thickness ratios=1, 1, 1",
             "Layer/Grains across=18", "Walls/Transits per millistrain=100",
             "Run/End shortening=1.2e-3"},
            folder.path("run"));
  const std::vector<double> layer =
      CsvTable(folder.path("run/cracks.csv")).column("layer");
  ASSERT_GT(layer.size(), 20u);
  // Bonds of rock 2 break at half the strain of those of rock 1. Its region is number 2:
  // 0 is the lowest bed, 1 the matrix.
  for (int k = 0; k < 20; ++k)
    EXPECT_EQ(layer[k], 2.) << k;
}

TEST(Beds, AreRefusedWithoutRocksThatExistOrWithoutAThicknessForEach)
{
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<std::string> &entries)
  {
    const Outcome outcome =
        run_program("run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " +
                    folder.path("run") +
                    set({"Components=layer, beds, walls, damping"}) + set(entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(refusal({"Beds/Rocks=" + rock_1}).find("as many of both"), std::string::npos);
  EXPECT_NE(refusal({"Beds/Rocks=" + rock_1 + ", " + rocks + "rock-9.prm",
                     "Beds/Thickness ratios=1, 1"})
                .find("rock-9.prm"),
            std::string::npos);
  EXPECT_NE(refusal({stack({rock_1, rock_2}), "Beds/Thickness ratios=1, 100"})
                .find("Give at least two"),
            std::string::npos);
  EXPECT_NE(refusal({stack({rock_1, rock_2}), "Beds/Thickness ratios=1, 1",
                     "Layer/Flat joint/Cohesion=1e6"})
                .find("the rocks of 'Beds/Rocks' say this"),
            std::string::npos);
  std::ofstream(folder.path("weak.prm"))
      << "include " + rock_2 + "\nsubsection Layer\nsubsection Flat joint\n"
         "set Tensile strength = 100e6\nset Friction angle = 60\nend\nend\n";
  EXPECT_NE(refusal({"Beds/Rocks=" + rock_1 + ", " + folder.path("weak.prm"),
                     "Beds/Thickness ratios=1, 1"})
                .find("bed 2 from below, 'Layer/Flat joint/Tensile strength'"),
            std::string::npos);
  std::ofstream(folder.path("seed.prm")) << "subsection Layer\nset Seed = 3\nend\n";
  EXPECT_NE(refusal({"Beds/Rocks=" + rock_1 + ", " + folder.path("seed.prm"),
                     "Beds/Thickness ratios=1, 1"})
                .find("is of the whole layer"),
            std::string::npos);
  std::ofstream(folder.path("wrong.prm")) << "subsection Matrix\nset Seed = 1\nend\n";
  EXPECT_NE(refusal({"Beds/Rocks=" + rock_1 + ", " + folder.path("wrong.prm"),
                     "Beds/Thickness ratios=1, 1"})
                .find("a rock file has entries of 'Layer'"),
            std::string::npos);
}

TEST(Beds, AreNotResumedWithAnotherRock)
{
  const TemporaryFolder folder;
  const std::string rock = folder.path("rock.prm");
  const auto write = [&](const char *strength)
  {
    std::ofstream(rock) << "include " + rock_1 + "\nsubsection Layer\n"
                           "subsection Flat joint\nset Tensile strength = "
                        << strength << "\nend\nend\n";
  };
  write("15e6");
  const std::string command =
      "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " +
      folder.path("run") +
      set({"Components=layer, beds, walls, damping", stack({rock_1, rock}),
           "Beds/Thickness ratios=1, 1", "Layer/Grains across=12",
           "Run/End shortening=1e-3"});
  EXPECT_EQ(run_program(command + " --time-limit 0.01").status, 3);
  write("14e6");
  const Outcome outcome = run_program(command + " --resume");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("'Bed 2/Layer/Flat joint/Tensile strength'"),
            std::string::npos)
      << outcome.output;
}

TEST(Beds, AreResumedFromTheDeckOfTheRunWhereverItStands)
{
  const TemporaryFolder folder;
  const std::string rock = folder.path("rock.prm");
  std::ofstream(rock) << contents(rock_1);
  const std::string options =
      set({"Components=layer, beds, walls, damping", stack({rock, rock_2}),
           "Beds/Thickness ratios=1, 1", "Layer/Grains across=12",
           "Run/End shortening=1e-4"});
  const std::string deck = ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm";
  EXPECT_EQ(run_program("run " + deck + options + " -o " + folder.path("run")).status, 0);
  EXPECT_EQ(run_program("run " + deck + options + " -o " + folder.path("cut") +
                        " --time-limit 0.01")
                .status,
            3);
  std::filesystem::remove(rock);
  std::filesystem::rename(folder.path("cut"), folder.path("moved"));
  const Outcome resumed = run_program("run " + folder.path("moved/deck.prm") + " -o " +
                                      folder.path("moved") + " --resume");
  EXPECT_EQ(resumed.status, 0) << resumed.output;
  expect_same_run(folder.path("moved"), folder.path("run"));
  // Or repeated, into a directory that then holds the rocks too.
  const Outcome repeated = run_program("run " + folder.path("moved/deck.prm") + " -o " +
                                       folder.path("again"));
  EXPECT_EQ(repeated.status, 0) << repeated.output;
  expect_same_run(folder.path("again"), folder.path("run"));
  expect_same_file("rock-1.prm", folder.path("again"), folder.path("run"));
}

TEST(Beds, AreNamedAloneWhereAResumedRunHasNone)
{
  const TemporaryFolder folder;
  const std::string command =
      "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm -o " +
      folder.path("run") + set({"Layer/Grains across=10", "Run/End shortening=1e-3"});
  EXPECT_EQ(run_program(command + " --time-limit 0.01" +
                        set({"Components=layer, beds, walls, damping",
                             stack({rock_1, rock_2}), "Beds/Thickness ratios=1, 1"}))
                .status,
            3);
  const Outcome outcome = run_program(command + " --resume");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("a component 'beds' too many"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "beds"), 1u) << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "Beds/"), 0u) << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "'Bed 1/"), 0u) << outcome.output;
}

TEST(Beds, ThatSlideAreNotCountedAsFractures)
{
  const TemporaryFolder folder;
  const std::vector<std::string> sliding{stack({rock_1, rock_1}),
                                         "Beds/Thickness ratios=1, 1",
                                         "Beds/Interface=frictional",
                                         "Layer/Grains across=10",
                                         "Layer/Breakable=false",
                                         "Run/End shortening=1e-5"};
  const nlohmann::json alone =
      run_stack("laboratory/uniaxial", sliding, folder.path("alone")).at("results");
  EXPECT_FALSE(alone.contains("fractures"));
  EXPECT_GT(alone.at("smooth_joints").at("value"), 10.);
  std::vector<std::string> fractured = sliding;
  fractured.push_back("Components=layer, beds, walls, fractures, damping");
  fractured.push_back("Fractures/List=-0.03 -0.02 0 -0.01");
  EXPECT_EQ(result(run_stack("laboratory/uniaxial", fractured, folder.path("both")),
                   "fractures"),
            1.);
}
} // namespace beds_tests

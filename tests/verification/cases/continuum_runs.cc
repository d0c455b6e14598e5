// Scenes without grains: what they report, where they stop, what they refuse.
#include "support/tiny_run.h"

#include <cmath>

namespace continuum_runs_tests
{
using namespace antiform::test;

namespace
{
std::string run_into(const std::string &directory,
                     const std::vector<std::string> &entries,
                     const int status = 0)
{
  const Outcome outcome =
      run_program("run " + tiny_deck() + " -o " + directory +
                  set({"Layer/Representation=continuum"}) + set(entries));
  EXPECT_EQ(outcome.status, status) << outcome.output;
  return outcome.output;
}
} // namespace

TEST(ContinuumRun, WithoutWallsIsNotShortened)
{
  const TemporaryFolder folder;
  run_into(folder.path("run"),
           {"Run/Driver=static", "Components=layer, matrix, gravity"});
  const CsvTable history(folder.path("run") + "/history.csv");
  EXPECT_EQ(history.column("shortening"), std::vector<double>{0.});
}

TEST(ContinuumRun, GivesTheLayerItsShareOfTheWallForce)
{
  const TemporaryFolder folder;
  run_into(folder.path("run"), {"Run/End shortening=1e-3"});
  const CsvTable history(folder.path("run") + "/history.csv");
  // A straight layer takes E' times the shortening. The axial waves of the drive are what
  // is left, some per cent at this speed.
  const double modulus = 56e9 / (1. - 0.2 * 0.2);
  const double ratio = history.column("axial_stress_Pa").back() /
                       (modulus * history.column("shortening").back());
  EXPECT_NEAR(ratio, 1., 0.05);
}

TEST(ContinuumRun, StopsBeyondSmallStrainInTheStaticDriverToo)
{
  const TemporaryFolder folder;
  run_into(folder.path("run"),
           {"Run/Driver=static", "Run/End shortening=0.5", "Run/Longest shortening=0.6"},
           2);
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_EQ(summary.at("status"), "failed");
  EXPECT_NE(summary.at("warnings").dump().find("20 %"), std::string::npos);
}

TEST(ContinuumRun, RefusesALayerThatSlidesInTime)
{
  const TemporaryFolder folder;
  const std::string text =
      run_into(folder.path("run"),
               {"Run/End shortening=1e-3", "Matrix/Interface=frictionless"}, 1);
  EXPECT_NE(text.find("Matrix/Interface"), std::string::npos) << text;
}

TEST(GrainRun, EndsWhereItsSamplesDoNotMatter)
{
  const TemporaryFolder folder;
  std::vector<double> ends;
  for (const char *samples : {"50", "200"})
  {
    const std::string directory = folder.path(samples);
    const Outcome outcome = run_tiny(
        directory, set({std::string("Output/Samples per millistrain=") + samples}));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    ends.push_back(result(summary_of(directory), "shortening"));
  }
  EXPECT_NEAR(ends[0] / ends[1], 1., 0.02); // a sample is 1 % of it
}

TEST(ContinuumRun, IsPressedByTheWeightOfTheMatrix)
{
  // With the shortening the same, wall forces differ by that of the weights:
  // 1/2 rho g H^2 with H = 50 m, the bulk density 0.84 of the grains'.
  const TemporaryFolder folder;
  std::vector<double> forces;
  for (const char *density : {"2500", "5000"})
  {
    run_into(folder.path(density), {"Run/Driver=static", "Run/End shortening=1e-3",
                                    "Components=layer, matrix, walls, gravity",
                                    std::string("Matrix/Grain density=") + density});
    forces.push_back(result(summary_of(folder.path(density)), "wall_force"));
  }
  const double weight = 0.5 * 0.84 * 2500. * 9.81 * 50. * 50.;
  EXPECT_NEAR((forces[1] - forces[0]) / weight, 1., 1e-3); // g: 9.80665 or 9.81
}

TEST(GrainRun, FeelsAFixedBase)
{
  const TemporaryFolder folder;
  std::vector<double> stiffness;
  for (const char *base : {"roller", "fixed"})
  {
    const std::string directory = folder.path(base);
    const Outcome outcome =
        run_tiny(directory, set(unbreakable({"Matrix/Representation=grains",
                                             std::string("Matrix/Base=") + base})));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    stiffness.push_back(result(summary_of(directory), "section_stiffness"));
  }
  EXPECT_GT(stiffness[1] / stiffness[0],
            1.01); // held between the walls, it must yield less
}

TEST(GrainRun, CountsJointsOverACohesionAlone)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_tiny(
      folder.path("run"), set({"Layer/Breakable=false", "Run/End shortening=2e-3",
                               "Layer/Flat joint/Tensile strength=0"}));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_GT(result(summary_of(folder.path("run")), "unbreakable_joints_over_strength"),
            0.);
}

TEST(GrainRun, StartsUnderItsPrestress)
{
  // At rest under its own weight and a surface pressure the section presses the walls
  // with the pressure times its height H = 5 h, and half its weight on a square of H.
  const TemporaryFolder folder;
  const Outcome outcome =
      run_tiny(folder.path("run"),
               set(unbreakable(
                   {"Components=layer, matrix, gravity, surface pressure, walls, damping",
                    "Surface pressure/Pressure=1e6"})));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const CsvTable history(folder.path("run/history.csv"));
  const double height = 50., density = 0.84 * 2500.;
  const double wanted = 1e6 * height + 0.5 * density * 9.81 * height * height;
  // The density of this packing is not exactly 0.84 of the grains'.
  EXPECT_NEAR(history.column("wall_force_N").front() / wanted, 1., 0.02);
  EXPECT_LT(history.column("unbalanced_ratio").front(), 1e-6);
}
} // namespace continuum_runs_tests

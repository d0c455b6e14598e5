// Pre-existing fractures and the older bond models, in the specimens that users run.
#include "support/tiny_run.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace fractures_tests
{
using namespace antiform::test;

namespace
{
/// A specimen of rock 1, 0.1 m by 0.05 m, its axis along x, with fractures.
std::string specimen(const std::vector<std::string> &entries)
{
  return "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/biaxial.prm" +
         set({"Layer/Grains across=14", "Walls/Transits per millistrain=75"}) +
         set(entries) + " -o ";
}

nlohmann::json run_specimen(const std::vector<std::string> &entries,
                            const std::string &directory)
{
  const Outcome outcome = run_program(specimen(entries) + directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

constexpr double degree = M_PI / 180.;

// A plane through the middle of the specimen, at 30 degrees to its axis.
const std::string plane = "Fractures/List=-0.052 -0.03 0.052 0.03";
const double alpha = M_PI / 2. - std::atan(0.06 / 0.104); // of its normal
// Where blocks slide, the corners beyond the plane leave the rigid side walls, and the
// whole force p L of a wall acts on one block: over the plane's length along the axis.
const double rigid_sides = 0.1 / (0.05 * std::tan(alpha));

/// Axial stress at which a plane slides whose normal is @p alpha from the axis, under
/// confinement @p p: a circle of Mohr that touches c + sigma mu.
double sliding_stress(const double alpha,
                      const double mu,
                      const double cohesion,
                      const double p)
{
  const double s = std::sin(alpha), c = std::cos(alpha);
  return (p * (s * c + mu * s * s) + cohesion) / (s * c - mu * c * c);
}
} // namespace

TEST(Fractures, ASpecimenSlidesOnAPlaneAtTheStressOfMohrsCircle)
{
  for (const int seed : {1, 2})
    for (const double angle : {20., 30.})
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << angle << " degrees");
      const TemporaryFolder folder;
      const nlohmann::json run = run_specimen(
          {"Components=layer, walls, servo walls, fractures, damping", plane,
           "Servo walls/Pressure=10e6", "Layer/Seed=" + std::to_string(seed),
           "Fractures/Friction angle=" + std::to_string(angle),
           "Run/End shortening=1.2e-3", "Run/Stress ratio of peak=0"},
          folder.path("run"));
      const double slides =
          sliding_stress(alpha, std::tan(angle * degree), 0., rigid_sides * 10e6);
      // Peak of a stress that moves with the grains that leave and meet the walls; the
      // walls' pressure is that of the section's width, which its grains fill to 2 %.
      EXPECT_NEAR(result(run, "peak_stress") / slides, 1., 0.04);
      EXPECT_GT(result(run, "largest_fracture_slip"), 1e-5); // it did slide
      EXPECT_EQ(result(run, "fractures"), 1.);
      EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
    }
}

// Jaeger's plane of weakness (1960): with beta from the axis to the plane's normal,
//   sigma_1 - sigma_3 = 2 (c + mu sigma_3) / ((1 - mu cot beta) sin 2 beta).
// A membrane puts sigma_3 on the faces of both blocks, as the law has it.
TEST(Fractures, StrengthIsThatOfThePlaneOfWeaknessUnlessItCannotSlide)
{
  const double mu = std::tan(20. * degree), p = 10e6;
  const auto run_in_membrane = [&](const std::string &components,
                                   const std::vector<std::string> &more)
  {
    const TemporaryFolder folder;
    std::vector<std::string> entries{"Components=" + components + ", damping",
                                     "Membrane/Pressure=10e6"};
    entries.insert(entries.end(), more.begin(), more.end());
    return run_specimen(entries, folder.path("run"));
  };
  const auto run_with_plane = [&](const double dip, const std::string &until)
  {
    const std::string x = std::to_string(0.06 * std::cos(dip * degree)),
                      y = std::to_string(0.06 * std::sin(dip * degree));
    return run_in_membrane("layer, walls, membrane, fractures",
                           {"Fractures/List=-" + x + " -" + y + " " + x + " " + y,
                            "Fractures/Friction angle=20", until});
  };
  // The membrane runs through the centres of the outer grains: on either side half a
  // diameter, 1/28 of the width, of what the plane cuts is not pressed upon.
  const double on_blocks = p * (1. - 1. / 14.);
  for (const double dip : {32., 40., 50.})
  {
    SCOPED_TRACE(dip);
    const nlohmann::json run = run_with_plane(dip, "Run/End shortening=1.2e-3");
    const double beta = (90. - dip) * degree;
    const double slides =
        on_blocks * (1. + 2. * mu / ((1. - mu / std::tan(beta)) * std::sin(2. * beta)));
    // Which grain of the outer row the plane passes is known to half a diameter, 1/28.
    EXPECT_NEAR(result(run, "peak_stress") / slides, 1., 1. / 28.);
    EXPECT_GT(result(run, "largest_fracture_slip"), 1e-4); // a tenth of all shortening
  }
  // Nearer to across than its angle of friction (beta = 12 degrees), or along the axis, the
  // plane cannot slide: ten times as strong, as the rock, whose packings scatter by 5 %
  // and which has lost a row of joints.
  const std::string until = "Run/Stress ratio of peak=0.8";
  const nlohmann::json intact = run_in_membrane("layer, walls, membrane", {until});
  for (const double dip : {78., 0.})
  {
    SCOPED_TRACE(dip);
    const nlohmann::json run = run_with_plane(dip, until);
    EXPECT_NEAR(result(run, "peak_stress") / result(intact, "peak_stress"), 1., 0.1);
  }
}

TEST(Fractures, ParallelSetsAreLaidAtTheirSpacing)
{
  const std::vector<std::string> scene{
      "Components=layer, walls, servo walls, fractures, damping",
      "Run/End shortening=5e-5", "Fractures/Orientation=90"};
  const TemporaryFolder folder;
  std::vector<std::string> entries = scene;
  entries.emplace_back("Fractures/Spacing ratio=0.5");
  const nlohmann::json run = run_specimen(entries, folder.path("run"));
  // 25 mm apart, at 12.5 and 37.5 mm on either side of the middle of 0.1 m.
  EXPECT_EQ(result(run, "fractures"), 4.);
  EXPECT_NEAR(result(run, "fracture_intensity"), 1. / 0.025, 1e-9);

  entries = scene;
  for (const char *entry : {"Fractures/Spacing ratio=0.5, 0.1", "Fractures/Intensity=20",
                            "Fractures/Phase=0, 0.2, 0.4"})
    entries.emplace_back(entry);
  const Outcome outcome = run_program(specimen(entries) + folder.path("refused"));
  EXPECT_EQ(outcome.status, 1);
  for (const char *what : {"sets are drawn or parallel, not both",
                           "a spacing of 0.1 h is less than two grain diameters",
                           "'Fractures/Phase'"})
    EXPECT_NE(outcome.output.find(what), std::string::npos) << what << outcome.output;
}

TEST(Fractures, OfABentLayerWeakenItWhereTheySlideAndNotAcrossIt)
{
  const auto run_quick = [&](const std::vector<std::string> &entries)
  {
    const TemporaryFolder folder;
    const Outcome outcome =
        run_program("run " ANTIFORM_SOURCE_DIR "/cases/fractures/quick.prm" +
                    set(entries) + " -o " + folder.path("run"));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const nlohmann::json run = summary_of(folder.path("run"));
    EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
    return run;
  };
  const nlohmann::json intact = run_quick({"Components=layer, walls, damping"});
  const nlohmann::json oblique = run_quick({"Fractures/Orientation=45"});
  const nlohmann::json across = run_quick({});
  // Every h/2 of L = 12 h and two straight ends of 0.115 L each: 14.76 h.
  EXPECT_EQ(result(across, "fractures"), 30.);
  // A straight piece slides on healed planes at 45 degrees at 2 c / (1 - mu) = 47 MPa; its
  // bending, which opens them, leaves the layer less. Planes across it only open.
  EXPECT_LT(result(oblique, "peak_stress"), 47e6);
  EXPECT_LT(result(oblique, "peak_stress"), 0.5 * result(intact, "peak_stress"));
  EXPECT_GT(result(across, "peak_stress"), 0.7 * result(intact, "peak_stress"));
}

TEST(Fractures, AHealedPlaneHoldsUpToItsCohesion)
{
  const TemporaryFolder folder;
  const nlohmann::json run = run_specimen(
      {"Components=layer, walls, servo walls, fractures, damping",
       plane, "Servo walls/Pressure=10e6",
       "Fractures/Bonded=true", "Fractures/Friction angle=20", "Fractures/Cohesion=10e6",
       "Fractures/Tensile strength=1e7", "Fractures/Bonded friction angle=20",
       "Run/End shortening=2e-3", "Run/Stress ratio of peak=0.7"},
      folder.path("run"));
  // Its bonds do not fail all at once, so the peak lies between friction alone and the
  // strength of all; that of one bond is exact (verification/discrete/smooth_joints.cc).
  const double mu = std::tan(20. * degree), p = rigid_sides * 10e6;
  EXPECT_LT(result(run, "peak_stress"), sliding_stress(alpha, mu, 10e6, p));
  EXPECT_GT(result(run, "peak_stress"), 1.2 * sliding_stress(alpha, mu, 0., p));
  const CsvTable cracks(folder.path("run/cracks.csv"));
  EXPECT_GT(cracks.column("step").size(), 10u);
  EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
}

TEST(Fractures, ATableIsReadAndAllThatIsWrongWithItIsSaid)
{
  const TemporaryFolder folder;
  {
    std::ofstream table(folder.path("good.csv"));
    table << "# of the test\nx1_m,y1_m,x2_m,y2_m,friction_angle_deg,dip_deg\n"
          << "-0.02,-0.02,0.02,0.02,25,45\n0,-0.02,0.01,0.02,,\n";
  }
  const std::vector<std::string> scene{
      "Components=layer, walls, servo walls, fractures, damping",
      "Run/End shortening=5e-5"};
  std::vector<std::string> entries = scene;
  entries.push_back("Fractures/Table=" + folder.path("good.csv"));
  const nlohmann::json run = run_specimen(entries, folder.path("run"));
  EXPECT_EQ(result(run, "fractures"), 2.);
  // Length of traces over the area of the specimen.
  const double length = std::hypot(0.04, 0.04) + std::hypot(0.01, 0.04);
  EXPECT_NEAR(result(run, "fracture_intensity"), length / 5e-3, 1e-9);

  {
    std::ofstream table(folder.path("bad.csv"));
    table << "x1_m,y1_m,x2_m,y2_m,friction_angle_deg,dilation_angle_deg,dip_deg\n"
          << "0,0,0,0,,,\n0,0,1,x,,,\n0,0,1,1,20,30,\n0,0,1,1,20,10,80\n0,0,1\n";
  }
  entries = scene;
  entries.push_back("Fractures/Table=" + folder.path("bad.csv"));
  const Outcome outcome = run_program(specimen(entries) + folder.path("refused"));
  EXPECT_EQ(outcome.status, 1);
  for (const char *what :
       {"bad.csv:2: the fracture has both tips at one place",
        "bad.csv:3: 'x' is not a number", "bad.csv:4: the fracture dilates by more",
        "bad.csv:5: the fracture has a dip", "bad.csv:6: the fracture has no y2_m"})
    EXPECT_NE(outcome.output.find(what), std::string::npos) << what << outcome.output;
}

TEST(Fractures, ANetworkWeakensTheRock)
{
  const TemporaryFolder folder;
  const std::vector<std::string> common{"Run/Stress ratio of peak=0.8",
                                        "Servo walls/Pressure=5e6"};
  const nlohmann::json intact = run_specimen(common, folder.path("intact"));
  std::vector<std::string> entries = common;
  for (const char *entry :
       {"Components=layer, walls, servo walls, fractures, damping",
        "Fractures/Intensity=20, 20", "Fractures/Orientation=30, -35",
        "Fractures/Mean length=0.015", "Fractures/Length law=exponential",
        "Fractures/Friction angle=30"})
    entries.emplace_back(entry);
  const nlohmann::json fractured = run_specimen(entries, folder.path("fractured"));
  EXPECT_NEAR(result(fractured, "fracture_intensity"), 40., 1e-6);
  EXPECT_LT(result(fractured, "peak_stress"), 0.9 * result(intact, "peak_stress"));
  EXPECT_LT(result(fractured, "young_modulus"), result(intact, "young_modulus"));
  EXPECT_GT(result(fractured, "smooth_joints"), 50.);
}

TEST(BondModels, RunWithALedgerThatCloses)
{
  for (const std::string model : {"parallel bond", "contact bond"})
  {
    SCOPED_TRACE(model);
    const TemporaryFolder folder;
    const nlohmann::json run = run_specimen(
        {"Components=layer, walls, damping", "Layer/Bond model=" + model},
        folder.path("run"));
    EXPECT_EQ(run.at("status"), "completed");
    EXPECT_GT(result(run, "crack_count"), 100.);
    EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
    const auto &effects = run.at("effects");
    EXPECT_FALSE(effects.at("friction").at("active").get<bool>());
    EXPECT_FALSE(effects.at("smooth joints").at("active").get<bool>());
    if (model == "parallel bond") // its contacts act from the first step on
      EXPECT_EQ(effects.at("contacts").at("calls"), run.at("steps"));
    else
      EXPECT_LT(effects.at("contacts").at("calls"), run.at("steps"));
  }
}

// A checkpoint holds what the table was when the run began, whatever becomes of it later.
TEST(Fractures, AreNotResumedWithATableEditedWhileTheRunWasGoing)
{
  const TemporaryFolder folder;
  const std::string table = folder.path("table.csv"), run = folder.path("run");
  const auto write = [&](const char *angle)
  {
    std::ofstream(table) << "x1_m,y1_m,x2_m,y2_m,friction_angle_deg\n"
                            "-0.02,-0.02,0.02,0.02,"
                         << angle << "\n";
  };
  write("30");
  const std::string command =
      specimen({"Components=layer, walls, servo walls, fractures, damping",
                "Fractures/Table=" + table, "Output/Checkpoint interval=5e-4"}) +
      run;
  {
    RunningProgram program(command);
    ASSERT_TRUE(
        program.wait_until([&] { return std::filesystem::exists(run + "/state.h5"); }));
    write("1");
    const auto before = std::filesystem::last_write_time(run + "/state.h5");
    ASSERT_TRUE(program.wait_until(
        [&] { return std::filesystem::last_write_time(run + "/state.h5") != before; }));
  } // killed
  const Outcome outcome = run_program(command + " --resume");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("Checksum of Fractures/Table"), std::string::npos)
      << outcome.output;
}
} // namespace fractures_tests

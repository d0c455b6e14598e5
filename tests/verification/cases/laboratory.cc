// The laboratory: specimens between platens, side walls and grips.
#include "support/tiny_run.h"

#include <cmath>

namespace laboratory_tests
{
using namespace antiform::test;

namespace
{
/// A specimen twice as long as wide, 16 grains across, of rock 1.
std::string specimen(const std::string &deck, const std::vector<std::string> &entries)
{
  return "run " ANTIFORM_SOURCE_DIR "/cases/laboratory/" + deck + ".prm" +
         set({"Layer/Grains across=16"}) + set(entries) + " -o ";
}

nlohmann::json run_specimen(const std::string &deck,
                            const std::vector<std::string> &entries,
                            const std::string &directory)
{
  const Outcome outcome = run_program(specimen(deck, entries) + directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

const std::vector<std::string> elastic{"Layer/Breakable=false", "Run/End shortening=1e-4",
                                       "Run/Stress ratio of peak=0",
                                       "Output/Samples per millistrain=2000"};
std::vector<std::string> elastic_and(std::vector<std::string> more)
{
  more.insert(more.end(), elastic.begin(), elastic.end());
  return more;
}
} // namespace

TEST(Laboratory, ElasticModuliDoNotDependOnHowTheSpecimenIsLoaded)
{
  const TemporaryFolder folder;
  const nlohmann::json pressed =
      run_specimen("uniaxial", elastic, folder.path("pressed"));
  const nlohmann::json confined = run_specimen(
      "biaxial", elastic_and({"Servo walls/Pressure=5e6"}), folder.path("confined"));
  const nlohmann::json pulled =
      run_specimen("tension", elastic_and({"Walls/Transits per millistrain=300"}),
                   folder.path("pulled"));
  // Gauges lie where the ends are not felt; their grains scatter by the packing, and
  // gauges of a confined specimen move with its sides.
  const double modulus = result(pressed, "young_modulus"),
               ratio = result(pressed, "poisson_ratio");
  EXPECT_NEAR(result(confined, "young_modulus") / modulus, 1., 0.01);
  EXPECT_NEAR(result(pulled, "young_modulus") / modulus, 1., 0.03);
  EXPECT_NEAR(result(confined, "poisson_ratio"), ratio, 0.01);
  EXPECT_NEAR(result(pulled, "poisson_ratio"), ratio, 0.03);
  // Rock 1 has 56 GPa (Gioiello 2018, 4.3). A disk packing has at least the Poisson ratio
  // of affine motion, (k - 1) / (3 k + 1) (Chang and Liao 1994), and at most 1/3.
  EXPECT_NEAR(modulus / 56e9, 1., 0.1);
  EXPECT_GT(ratio, (2.2 - 1.) / (3. * 2.2 + 1.) - 0.03);
  EXPECT_LT(ratio, 1. / 3.);
}

TEST(Laboratory, AMembraneConfinesAsSideWallsDoUntilTheRockBulges)
{
  const TemporaryFolder folder;
  const nlohmann::json walls =
      run_specimen("biaxial", elastic_and({"Run/End shortening=3e-4"}),
                   folder.path("walls"));
  const nlohmann::json membrane =
      run_specimen("membrane", elastic_and({"Run/End shortening=3e-4"}),
                   folder.path("membrane"));
  // The same rock under the same stress. What differs is a rough side against a straight
  // one, of the grains beside it: less than their share of a sixteenth.
  EXPECT_NEAR(result(membrane, "young_modulus") / result(walls, "young_modulus"), 1.,
              0.02);
  EXPECT_EQ(result(membrane, "confining_pressure"), 10e6);
  EXPECT_TRUE(membrane.at("warnings").empty()); // the platens had the pressure in time
  EXPECT_EQ(membrane.at("effects").at("membrane").at("calls"), membrane.at("steps"));
  EXPECT_EQ(walls.at("effects").at("membrane").at("calls"), 0);
  EXPECT_LT(membrane.at("energy").at("closure_error").get<double>(), 1e-4);

  // Broken, it gives way to the side, which rigid walls do not let it.
  const std::vector<std::string> to_the_end{"Walls/Transits per millistrain=75",
                                            "Run/End shortening=6e-3",
                                            "Run/Stress ratio of peak=0"};
  const nlohmann::json held = run_specimen("biaxial", to_the_end, folder.path("held"));
  const nlohmann::json free = run_specimen("membrane", to_the_end, folder.path("free"));
  EXPECT_LT(result(free, "peak_stress"), result(held, "peak_stress"));
  EXPECT_GT(result(free, "peak_stress"), 0.75 * result(held, "peak_stress"));
  EXPECT_LT(free.at("energy").at("closure_error").get<double>(), 1e-3);
}

TEST(Laboratory, SideWallsKeepTheirPressure)
{
  const TemporaryFolder folder;
  run_specimen("biaxial", elastic_and({"Run/End shortening=5e-4"}), folder.path("run"));
  const CsvTable history(folder.path("run/history.csv"));
  const std::vector<double> pressure = history.column("lateral_stress_Pa"),
                            axial = history.column("axial_stress_Pa"),
                            shortening = history.column("shortening");
  std::size_t checked = 0;
  for (std::size_t k = 0; k < pressure.size(); ++k)
    if (shortening[k] > 0.)
    {
      EXPECT_NEAR(pressure[k] / 10e6, 1., 0.005);
      if (checked++ == 0)
      {
        EXPECT_NEAR(axial[k] / 10e6, 1., 0.02); // on the platens too, before they move on
      }
    }
  EXPECT_GT(checked, 100u);
}

TEST(Laboratory, APressurePutOnAtOnceDoesNotOvershoot)
{
  const TemporaryFolder folder;
  run_specimen(
      "biaxial",
      elastic_and({"Servo walls/Ramp=3", "Servo walls/Gain=0.5",
                   "Run/End shortening=2e-5", "Output/Samples per millistrain=20000"}),
      folder.path("run"));
  double largest = 0.;
  for (const double p :
       CsvTable(folder.path("run/history.csv")).column("lateral_stress_Pa"))
    largest = std::max(largest, p);
  EXPECT_GT(largest, 9.95e6);
  EXPECT_LT(largest, 10.5e6);
}

TEST(Laboratory, TensionBreaksOneSectionAndClosesItsLedger)
{
  const TemporaryFolder folder;
  const nlohmann::json summary =
      run_specimen("tension", {"Walls/Transits per millistrain=500"}, folder.path("run"));
  EXPECT_LT(summary.at("energy").at("closure_error").get<double>(), 1e-3);
  // A bonded section cannot carry more than its joints: sigma_b times the part of a line
  // across that they cover, at most 1.
  EXPECT_LT(result(summary, "tensile_strength"), 15e6);
  EXPECT_GT(result(summary, "tensile_strength"), 0.3 * 15e6);
  EXPECT_GT(result(summary, "cracks_tensile"), 16. * 3.); // a section has 16 grains
  EXPECT_EQ(summary.at("effects").at("walls").at("active"), true);
}

TEST(Laboratory, GaugesLieBetweenTheGripsAndHoldGrains)
{
  const TemporaryFolder folder;
  // Ten layers are left between the grips; the modulus is that of few grains.
  const nlohmann::json pulled = run_specimen(
      "tension",
      elastic_and({"Layer/Grains across=12.5", "Walls/Transits per millistrain=300"}),
      folder.path("pulled"));
  EXPECT_NEAR(result(pulled, "young_modulus") / 56e9, 1., 0.15);
  // So few grains that windows of the usual size are empty.
  const nlohmann::json few = run_specimen(
      "uniaxial",
      elastic_and({"Layer/Grains across=3", "Layer/Length ratio=1", "Layer/Seed=3"}),
      folder.path("few"));
  EXPECT_GT(result(few, "young_modulus"), 0.);
}

TEST(Laboratory, TellsOfAConfinementThatIsNotReached)
{
  const TemporaryFolder folder;
  const nlohmann::json reached = run_specimen(
      "biaxial", elastic_and({"Run/End shortening=2e-5"}), folder.path("reached"));
  EXPECT_TRUE(reached.at("warnings").empty()) << reached.at("warnings");
  const nlohmann::json missed =
      run_specimen("biaxial",
                   elastic_and({"Run/End shortening=2e-5", "Servo walls/Ramp=0.5",
                                "Servo walls/Gain=0.001"}),
                   folder.path("missed"));
  ASSERT_EQ(missed.at("warnings").size(), 1u) << missed.at("warnings");
  EXPECT_NE(missed.at("warnings")[0].get<std::string>().find("confinement"),
            std::string::npos);
}
} // namespace laboratory_tests

// Envelopes of laboratory tests, against the regressions of the source's appendix.
#include "cases/parameters.h"
#include "cases/strength_envelope.h"
#include "support/tiny_run.h"

#include <cmath>
#include <fstream>

namespace envelopes_tests
{
using namespace antiform;
using namespace antiform::test;

namespace
{
double value(const nlohmann::json &envelope, const std::string &name)
{
  return envelope.at(name).at("value").get<double>();
}
} // namespace

// Cases 27 and 28 of docs/validation.md: least squares by hand.
TEST(Envelope, OfTheLimestonesIsThatOfTheSource)
{
  const Outcome outcome = run_program("envelope --json " ANTIFORM_SOURCE_DIR
                                      "/cases/laboratory/limestones.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  struct Expected
  {
    const char *site;
    double mi, r, printed_mi, printed_r, sigma_ci, tension, cohesion, angle;
  };
  for (const Expected &e : {Expected{"Rapsomati", 22.182, 0.9623, 22.1, 0.96, 45.340e6,
                                     2.040e6, 11.120e6, 45.305},
                            Expected{"Pelasgia", 13.196, 0.9366, 13.2, 0.93, 154.913e6,
                                     11.672e6, 36.322e6, 41.960}})
  {
    const nlohmann::json &site = json.at(e.site);
    EXPECT_NEAR(value(site, "hoek_brown_mi") / e.mi, 1., 1e-3);
    EXPECT_NEAR(value(site, "hoek_brown_r") / e.r, 1., 1e-3);
    EXPECT_NEAR(value(site, "hoek_brown_sigma_ci") / e.sigma_ci, 1., 1e-3);
    EXPECT_NEAR(value(site, "hoek_brown_tensile_strength") / e.tension, 1., 1e-3);
    EXPECT_NEAR(value(site, "cohesion") / e.cohesion, 1., 1e-3);
    EXPECT_NEAR(value(site, "friction_angle") / e.angle, 1., 1e-3);
    // As printed by the source, to its digits.
    EXPECT_NEAR(value(site, "hoek_brown_mi") / e.printed_mi, 1., 0.01);
    EXPECT_NEAR(value(site, "hoek_brown_r") / e.printed_r, 1., 0.01);
  }
}

TEST(Envelope, FindsTheLineThatItsPointsLieOn)
{
  std::vector<cases::StrengthPoint> line, curve;
  for (const double p : {0., 3e6, 11e6, 40e6})
  {
    line.push_back({p, 2. * 20e6 * std::sqrt(3.) + 3. * p}); // c = 20 MPa, phi = 30 deg
    curve.push_back({p, p + std::sqrt(10. * 100e6 * p + 100e6 * 100e6)});
  }
  const cases::MohrCoulombFit coulomb = cases::fit_mohr_coulomb(line);
  EXPECT_NEAR(coulomb.cohesion / 20e6, 1., 1e-12);
  EXPECT_NEAR(coulomb.friction_angle, M_PI / 6., 1e-12);
  EXPECT_NEAR(coulomb.correlation, 1., 1e-12);
  const cases::HoekBrownFit hoek = cases::fit_hoek_brown(curve);
  EXPECT_NEAR(hoek.sigma_ci / 100e6, 1., 1e-12);
  EXPECT_NEAR(hoek.mi, 10., 1e-10);
  // sigma_1 = 0 at sigma_3 = -t: t^2 = -m_i sigma_ci t + sigma_ci^2.
  const double t = hoek.tensile_strength;
  EXPECT_NEAR((t * t + 10. * 100e6 * t) / (100e6 * 100e6), 1., 1e-10);
}

TEST(Envelope, TellsWhatItCannotFit)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("one.csv")) << "sigma3_MPa,sigma1_MPa\n5,80\n5,90\n";
  std::ofstream(folder.path("text.csv")) << "sigma3_MPa,sigma1_MPa\n5,much\n";
  std::ofstream(folder.path("other.csv")) << "a,b\n5,1\n";
  const Outcome outcome =
      run_program("envelope " + folder.path("one.csv") + " " + folder.path("text.csv") +
                  " " + folder.path("none"));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("two confinements"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("text.csv:2: 'much' is not a number"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("none/summary.json' cannot be read"), std::string::npos)
      << outcome.output;
  const Outcome other = run_program("envelope " + folder.path("other.csv"));
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.output.find("no column 'sigma3_MPa'"), std::string::npos)
      << other.output;
}
} // namespace envelopes_tests

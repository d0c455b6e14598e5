// Bent layers of grains under a pressure: in a matrix that carries it, in a membrane.
#include "support/tiny_run.h"

#include <cstddef>

namespace confined_layers_tests
{
using namespace antiform::test;

namespace
{
nlohmann::json run_quick(const std::vector<std::string> &entries,
                         const std::string &directory)
{
  const Outcome outcome = run_program(
      "run " ANTIFORM_SOURCE_DIR "/cases/confinement/quick.prm" + set(entries) + " -o " +
      directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json run = summary_of(directory);
  EXPECT_EQ(run.at("status"), "completed");
  EXPECT_LT(run.at("energy").at("closure_error").get<double>(), 1e-3);
  return run;
}

const std::string membrane_deck = ANTIFORM_SOURCE_DIR "/cases/confinement/membrane.prm";

/// Growth of the fold since the walls began to shorten the layer, when its axial stress
/// has come to be @p more than the pressure @p p around it [m].
double growth_at(const std::string &directory, const double p, const double more)
{
  const CsvTable history(directory + "/history.csv");
  const std::vector<double> shortening = history.column("shortening"),
                            stress = history.column("axial_stress_Pa"),
                            amplitude = history.column("fold_amplitude_m");
  std::size_t first = 0;
  while (first + 1 < shortening.size() && shortening[first + 1] <= 0.)
    ++first;
  for (std::size_t k = first + 1; k < stress.size(); ++k)
    if (stress[k] - p >= more)
    {
      const double s = (p + more - stress[k - 1]) / (stress[k] - stress[k - 1]);
      return amplitude[k - 1] + s * (amplitude[k] - amplitude[k - 1]) - amplitude[first];
    }
  return 0.;
}
} // namespace

TEST(ConfinedLayers, StartUnderTheirPressureAndAreStrongerByMoreThanIt)
{
  const TemporaryFolder folder;
  const nlohmann::json confined = run_quick({}, folder.path("confined"));
  const nlohmann::json bare =
      run_quick({"Components=layer, walls, damping"}, folder.path("bare"));
  // Laid down under 10 MPa: its ends begin with them, nothing is shortened first.
  const CsvTable history(folder.path("confined/history.csv"));
  EXPECT_NEAR(history.column("axial_stress_Pa").front() / 10e6, 1., 1e-6);
  EXPECT_EQ(history.column("shortening").front(), 0.);
  // The inner arc of the bent layer fails at UCS + N p of the rock, with N > 1, under a
  // stress that its bending has raised 2.5 times: twice the pressure is a lower bound of
  // what the matrix, which keeps it from bending on, lets it gain.
  EXPECT_GT(result(confined, "peak_stress"), result(bare, "peak_stress") + 2. * 10e6);
  // Pressure closes what would open.
  const auto share_in_tension = [](const nlohmann::json &run)
  { return result(run, "cracks_tensile") / result(run, "crack_count"); };
  EXPECT_LT(share_in_tension(confined), share_in_tension(bare));
}

// A pressure that follows both faces acts like an axial tension p h: what bends a layer
// on is sigma_1 - p. One that stays upright as the layer turns would add a compression p h
// instead, so that sigma_1 + p counts (docs/theory/continuum.md, 14).
TEST(ConfinedLayers, BendOnByTheStressBeyondThePressureOfTheirMembrane)
{
  const TemporaryFolder folder;
  const auto run = [&](const std::string &entry, const std::string &name)
  {
    const Outcome outcome = run_program(
        "run " + membrane_deck +
        set({"Layer/Grains across=6", "Layer/Breakable=false", "Layer/Length ratio=30",
             "Layer/Straight end ratio=0", "Walls/Transits per millistrain=150",
             "Run/End shortening=3e-4", entry}) +
        " -o " + folder.path(name));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(folder.path(name));
  };
  const nlohmann::json bare = run("Components=layer, walls, damping", "bare");
  const nlohmann::json held = run("Membrane/Pressure=40e6", "held");
  EXPECT_EQ(result(held, "confining_pressure"), 40e6);
  EXPECT_FALSE(bare.at("results").contains("confining_pressure"));
  EXPECT_EQ(held.at("effects").at("membrane").at("calls"), held.at("steps"));
  EXPECT_LT(held.at("energy").at("closure_error").get<double>(), 1e-4);

  // Between guided ends the wave buckles at sigma_E = pi^2 E (2 h/L)^2 / 12 = 205 MPa and
  // has grown to sigma_E / (sigma_E - y) of what it was. With y = sigma_1 - p both layers
  // grow alike; were y sigma_1 + p, from 80 to 88 MPa, the confined one 2.8 times as much.
  const double more = 8e6;
  const double free = growth_at(folder.path("bare"), 0., more),
               confined = growth_at(folder.path("held"), 40e6, more);
  // 5 m high; the walls' ramp and the layer's inertia act on both alike.
  EXPECT_NEAR(free / (5. * more / (205e6 - more)), 1., 0.25);
  EXPECT_NEAR(confined / free, 1., 0.1);
}

TEST(ConfinedLayers, RigidWallsAreRefusedOnBentFacesAndAMembraneBesideAMatrix)
{
  const auto refusal = [](const std::string &components)
  {
    const Outcome outcome =
        run_program("check " + membrane_deck + set({"Components=" + components}));
    EXPECT_EQ(outcome.status, 1);
    return outcome.output;
  };
  EXPECT_NE(refusal("layer, servo walls, walls, damping")
                .find("around a bent layer give membrane"),
            std::string::npos);
  EXPECT_NE(refusal("layer, matrix, membrane, walls, damping")
                .find("a membrane confines a layer between walls, straight or bent"),
            std::string::npos);
  EXPECT_NE(refusal("layer, membrane, damping").find("Give walls, and no matrix"),
            std::string::npos);
}
} // namespace confined_layers_tests

// The buckling driver: loads, waves and files of whole runs, and what it refuses.
#include "support/tiny_run.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace buckling_runs_tests
{
using namespace antiform::test;

namespace
{
const std::string deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling.prm";

Outcome run_deck(const std::string &directory,
                 const std::vector<std::string> &entries,
                 const int n_ranks = 1)
{
  return run_program("run " + deck + " -o " + directory + set(entries), n_ranks);
}

/// Four half waves in even cells, coarse far off.
const std::vector<std::string> coarse{
    "Layer/Length ratio=192.8", "Run/Modes=3",
    "Matrix/Cell size ratio=1", "Matrix/Largest cell ratio=80",
    "Matrix/Refinement rounds=0"};
} // namespace

TEST(BucklingRun, FindsStressAndWaveOfTheClosedForm)
{
  const TemporaryFolder folder;
  // Closed forms: rows 1e-4, 10 of critical_stress_vs_cover.csv. Smooth 2 %, bonded 3 %.
  struct
  {
    std::string interface;
    double stress, wavelength, tolerance;
  } const cases[] = {{"sliding", 1.15360901e-3, 96.405257, 0.02},
                     {"cemented", 1.34614103e-03, 96.013438, 0.03}};
  const double modulus = 56e9 / (1. - 0.25 * 0.25);
  for (const auto &one : cases)
  {
    const std::string directory = folder.path(one.interface);
    std::vector<std::string> entries = coarse;
    entries.push_back("Matrix/Interface=" + one.interface);
    const Outcome outcome = run_deck(directory, entries);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const nlohmann::json summary = summary_of(directory);
    EXPECT_NEAR(result(summary, "critical_stress") / (one.stress * modulus), 1.,
                one.tolerance)
        << one.interface;
    EXPECT_NEAR(result(summary, "dominant_wavelength") / (10. * one.wavelength), 1., 0.05)
        << one.interface;
    EXPECT_EQ(result(summary, "half_waves"), 4.);
    EXPECT_EQ(summary.at("effects").at("bonds").at("calls"), 0);

    const CsvTable modes(directory + "/modes.csv");
    const std::vector<double> stress = modes.column("layer_stress_Pa"),
                              shortening = modes.column("shortening");
    ASSERT_EQ(stress.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k)
    {
      // Nothing holds the section across: E' in the layer.
      EXPECT_NEAR(stress[k] / (modulus * shortening[k]), 1., 1e-3);
      EXPECT_TRUE(std::filesystem::exists(directory + "/fields/mode_000" +
                                          std::to_string(k + 1) + ".vtu"));
    }
  }
}

TEST(BucklingRun, IsTheSameOnTwoRanks)
{
  const TemporaryFolder folder;
  double stress[2];
  for (const int n : {1, 2})
  {
    const std::string directory = folder.path(std::to_string(n));
    const Outcome outcome = run_deck(directory, coarse, n);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    stress[n - 1] = result(summary_of(directory), "critical_stress");
  }
  EXPECT_NEAR(stress[1] / stress[0], 1., 1e-8);
}

TEST(BucklingRun, OfABareLayerIsEulers)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("bare.prm")) << R"(set Title      = bare
set Components = layer, walls
subsection Layer
  set Representation = continuum
  set Shape          = straight
  set Length ratio   = 40
  set Grains across  = 24
end
subsection Run
  set Driver = buckling
end
)";
  const Outcome outcome =
      run_program("run " + folder.path("bare.prm") + " -o " + folder.path("bare"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  // Guided ends that may slide along the walls: half a wave in L. Bilinear cells of h/12
  // are too stiff by some (1/12)^2, and shear and shortening take some (pi h/L)^2.
  const double modulus = 56e9 / (1. - 0.2 * 0.2);
  const double euler = M_PI * M_PI * modulus / 12. / (40. * 40.);
  const nlohmann::json summary = summary_of(folder.path("bare"));
  EXPECT_NEAR(result(summary, "critical_stress") / euler, 1., 0.005);
  EXPECT_EQ(result(summary, "half_waves"), 1.);
}

TEST(BucklingRun, OfABareLayerConvergesWithTheMeshOfTheDeck)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("bare.prm")) << R"(set Title      = bare
set Components = layer, walls
subsection Layer
  set Representation = continuum
  set Shape          = straight
  set Length ratio   = 20
  set Grains across  = 16
end
subsection Run
  set Driver = buckling
  set Modes  = 1
end
)";
  const auto stress = [&](const std::string &name, const std::string &entry)
  {
    const Outcome outcome = run_program("run " + folder.path("bare.prm") + " -o " +
                                        folder.path(name) + set({entry}));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return result(summary_of(folder.path(name)), "critical_stress");
  };
  // Quadratic elements err by the fourth power of the cells: they stand for the exact
  // load.
  const double exact = stress("quadratic", "Matrix/Element degree=2"),
               coarse = stress("coarse", "Matrix/Cell size ratio=2") / exact - 1.,
               fine = stress("fine", "Matrix/Cell size ratio=1") / exact - 1.;
  EXPECT_NEAR(std::log2(coarse / fine), 2., 0.1) << coarse << " -> " << fine;
}

TEST(BucklingRun, RefusesWhatTheLinearTheoryLeavesOut)
{
  const TemporaryFolder folder;
  struct
  {
    std::vector<std::string> entries;
    std::vector<std::string> naming;
  } const cases[] = {
      {{"Layer/Shape=cosine", "Components=layer, matrix, walls, gravity"},
       {"'Layer/Shape' = 'cosine'", "straight", "Remove gravity"}},
      {{"Layer/Representation=grains"},
       {"'Matrix/Refinement rounds' = '1'", "'Matrix/Cell aspect ratio'"}},
      {{"Matrix/Interface=frictional"},
       {"'Matrix/Interface' = 'frictional'", "cemented or sliding", "'static'"}},
      {{"Components=layer, matrix, walls, foundation", "Foundation/Lifts off=true"},
       {"'Foundation/Lifts off' = 'true'", "'Run/Driver' = 'static'"}},
      {{"Matrix/Burial depth ratio=0.1"},
       {"the cover of 1 m is thinner than a cell of 5 m", "'Matrix/Cover rows' = 1"}},
      {{"Matrix/Element degree=1", "Matrix/Refinement rounds=0"},
       {"'Matrix/Element degree' = '1'", "Give 2"}},
      {{"Components=layer, matrix"}, {"Components", "walls"}}};
  for (const auto &one : cases)
  {
    const Outcome outcome = run_deck(folder.path("refused"), one.entries);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    for (const std::string &part : one.naming)
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n"
                                                              << outcome.output;
  }
}
} // namespace buckling_runs_tests

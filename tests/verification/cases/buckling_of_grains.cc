// The buckling driver on layers of grains: against grains alone, closed forms and a slow
// run; what it refuses.
#include "support/tiny_run.h"

#include "cases/closed_forms.h"
#include "cases/mechanism.h"

#include <cmath>
#include <filesystem>

namespace buckling_of_grains_tests
{
using namespace antiform::test;

namespace
{
const std::string deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling_grains.prm";

nlohmann::json run_deck(const std::string &directory,
                        const std::vector<std::string> &entries)
{
  const Outcome outcome = run_program("run " + deck + " -o " + directory + set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}
} // namespace

TEST(BucklingOfGrains, CoupledIsThatOfGrainsAlone)
{
  const TemporaryFolder folder;
  const std::string joined = folder.path("joined"), alone = folder.path("alone");
  const nlohmann::json coupled = run_deck(joined, {}),
                       grains = run_deck(alone, {"Matrix/Representation=grains"});
  EXPECT_LT(coupled.at("sizes").at("grains"),
            0.45 * grains.at("sizes").at("grains").get<double>());
  EXPECT_GT(coupled.at("sizes").at("multipliers"), 0);
  const CsvTable one(joined + "/modes.csv"), other(alone + "/modes.csv");
  const auto of = [](const CsvTable &table, const std::string &name)
  { return table.column(name); };
  ASSERT_EQ(of(one, "mode").size(), 4u);
  ASSERT_EQ(of(other, "mode").size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
  {
    // 2 % is what coupling is asked for; the packing of the overlap scatters by some
    // tenths of a percent (coupled_buckling.md 5).
    EXPECT_NEAR(of(one, "layer_stress_Pa")[k] / of(other, "layer_stress_Pa")[k], 1.,
                0.02);
    EXPECT_NEAR(of(one, "shortening")[k] / of(other, "shortening")[k], 1., 0.02);
    EXPECT_EQ(of(one, "half_waves")[k], of(other, "half_waves")[k]);
  }
  for (const char *file :
       {"mode_0001", "mode_0004_grains", "straight_joints", "straight"})
    EXPECT_TRUE(std::filesystem::exists(joined + "/fields/" + file + ".vtu")) << file;
  EXPECT_FALSE(std::filesystem::exists(alone + "/fields/mode_0001.vtu")); // no mesh there
  EXPECT_NE(contents(joined + "/fields.pvd").find("mode_0004_grains.vtu"),
            std::string::npos);
}

// Neither packing nor mesh of the closed form. What a packing has of its own is its
// modulus and its bending stiffness; the bare layer of the same grains tells them.
TEST(BucklingOfGrains, IsThatOfABeamAsStiffInItsMatrix)
{
  const TemporaryFolder folder;
  const nlohmann::json bare =
      run_deck(folder.path("bare"), {"Components=layer, walls", "Run/Modes=1"});
  EXPECT_EQ(result(bare, "half_waves"), 1.); // guided ends
  const double euler = M_PI * M_PI / 12. / (20. * 20.),
               bending = result(bare, "critical_stress") / euler,
               stretching = result(bare, "layer_plane_modulus");
  // Rock 1 is calibrated to its modulus on specimens, within some percents. Six grains
  // across bend as a layer thinner by up to half of one on either side: (1 - 1/6)^2.
  EXPECT_NEAR(stretching / (56e9 / (1. - 0.2 * 0.2)), 1., 0.1);
  EXPECT_LT(bending, 0.98 * stretching);
  EXPECT_GT(bending, std::pow(1. - 1. / 6., 2) * stretching);

  const nlohmann::json buried =
      run_deck(folder.path("buried"), {"Matrix/Stiffness contrast=1e3",
                                       "Layer/Length ratio=43.6", "Run/Modes=1"});
  antiform::cases::Parameters p = antiform::cases::read_deck(
      deck, {"Matrix/Stiffness contrast=1e3", "Layer/Length ratio=43.6"});
  antiform::continuum::theory::SupportedLayer layer = antiform::cases::supported_layer(p);
  layer.layer.young_modulus *= bending / layer.layer.plane_modulus();
  layer.thick = true;
  const double n = result(buried, "half_waves"),
               expected = layer.buckling_force(n * M_PI / (43.6 * 10.)) / 10.;
  EXPECT_NEAR(n, 3., 0.5);
  // The band of the finite-element driver for a cemented layer: what the closed form
  // leaves out is the matrix' own stress, 8 E0 of the layer's E = 0.8 %, and the shear
  // that Euler's load of the bare layer has in it, 0.8 % of D.
  EXPECT_NEAR(result(buried, "critical_stress") / expected, 1., 0.03)
      << expected << " against " << result(buried, "critical_stress");
}

TEST(BucklingOfGrains, IsTheSameOnFinerAndOnQuadraticCells)
{
  const TemporaryFolder folder;
  const double coarse = result(
                   run_deck(folder.path("2"), {"Run/Modes=1", "Layer/Length ratio=12"}),
                   "critical_stress"),
               fine = result(
                   run_deck(folder.path("1.5"), {"Run/Modes=1", "Layer/Length ratio=12",
                                                 "Matrix/Cell size ratio=1.5",
                                                 "Matrix/Largest cell ratio=3"}),
                   "critical_stress"),
               quadratic = result(
                   run_deck(folder.path("q2"), {"Run/Modes=1", "Layer/Length ratio=12",
                                                "Matrix/Element degree=2"}),
                   "critical_stress");
  // Cells of 2 d beside a wave of 72 d or more: h^2 k^2 / 12 of a share of the matrix'
  // part.
  EXPECT_NEAR(fine / coarse, 1., 5e-3);
  EXPECT_NEAR(quadratic / coarse, 1., 5e-3);
}

// The straight layer is the one that a slow run shortens.
TEST(BucklingOfGrains, StraightLayerIsThatOfASlowRun)
{
  const TemporaryFolder folder;
  const std::vector<std::string> bare{"Components=layer, walls, damping",
                                      "Layer/Length ratio=8"};
  std::vector<std::string> slow = bare;
  slow.insert(slow.end(),
              {"Run/Driver=quasi-static", "Run/End shortening=1e-4",
               "Layer/Breakable=false", "Walls/Transits per millistrain=3000"});
  std::vector<std::string> linear = bare;
  linear.emplace_back("Run/Modes=1");
  const double modulus =
      result(run_deck(folder.path("linear"), linear), "layer_plane_modulus");
  run_deck(folder.path("slow"), slow);
  const CsvTable history(folder.path("slow") + "/history.csv");
  const double found =
      history.column("axial_stress_Pa").back() / history.column("shortening").back();
  // Rate error: damped waves of 300 transits, a percent at most; finite strain 1e-4.
  EXPECT_NEAR(found / modulus, 1., 0.01);
}

TEST(BucklingOfGrains, HasOnlyTheEffectsThatAreLinear)
{
  const TemporaryFolder folder;
  const nlohmann::json summary =
      run_deck(folder.path("run"), {"Run/Modes=1", "Layer/Length ratio=12"});
  const nlohmann::json &effects = summary.at("effects");
  for (const char *name : {"friction", "contacts", "search", "motion of the grains"})
  {
    EXPECT_EQ(effects.at(name).at("active"), false) << name;
    EXPECT_EQ(effects.at(name).at("calls"), 0) << name;
  }
  for (const char *name : {"bonds", "mesh", "bridging domain"})
  {
    EXPECT_EQ(effects.at(name).at("active"), true) << name;
    EXPECT_EQ(effects.at(name).at("calls"), summary.at("solves")) << name;
  }
  const Outcome outcome =
      run_program("check " + deck + " --json --set \"Layer/Length ratio=12\"");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json checked = nlohmann::json::parse(outcome.output);
  // Predicted without packing or mesh. Rows of cells are counted as they are.
  const auto ratio = [&](const char *size)
  {
    return checked.at("sizes").at(size).get<double>() /
           summary.at("sizes").at(size).get<double>();
  };
  EXPECT_NEAR(ratio("grains"), 1., 0.1);
  EXPECT_NEAR(ratio("cells"), 1., 0.01);
  EXPECT_NEAR(ratio("dofs"), 1., 0.01);
  const double memory = checked.at("prediction").at("memory_bytes").get<double>() /
                        summary.at("peak_memory_bytes").get<double>();
  EXPECT_GT(memory, 0.5);
  EXPECT_LT(memory, 2.);
  EXPECT_EQ(checked.at("effects").at("friction").at("state"), "absent");
}

TEST(BucklingOfGrains, RefusesWhatIsNotLinear)
{
  const TemporaryFolder folder;
  struct
  {
    std::vector<std::string> entries;
    std::vector<std::string> naming;
  } const cases[] = {
      {{"Matrix/Interface=frictionless", "Matrix/Representation=grains",
        "Layer/Bond model=parallel bond"},
       {"'Matrix/Interface' = 'frictionless'", "Give cemented",
        "'Layer/Bond model' = 'parallel bond'", "flat joint or contact bond"}},
      {{"Components=layer, matrix, walls, fractures", "Layer/Locked-in stress=1e6",
        "Fractures/List=0 -5 0 5"},
       {"Remove fractures", "'Layer/Locked-in stress'", "Give 0"}},
      {{"Layer/Joint types/Slit fraction=0.1", "Layer/Shape=cosine"},
       {"'Layer/Joint types/Slit fraction' = '0.1'", "begin without bonds", "straight"}},
      {{"Matrix/Refinement rounds=2", "Bridging domain/Constraint=false"},
       {"'Matrix/Refinement rounds' = '2'", "'Bridging domain/Constraint' = 'false'"}},
      {{"Components=layer, walls, membrane", "Membrane/Pressure=1e6"},
       {"Remove membrane from"}},
      {{"Components=layer, walls", "Walls/Action=pull"},
       {"'Walls/Action'", "Give press"}}};
  for (const auto &one : cases)
  {
    const Outcome outcome =
        run_program("run " + deck + " -o " + folder.path("no") + set(one.entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    for (const std::string &part : one.naming)
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n"
                                                              << outcome.output;
  }
}

TEST(BucklingOfGrains, EndsWhereItsTimeIsUp)
{
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program("run " + deck + " -o " + folder.path("run") + " --time-limit 1e-3");
  EXPECT_EQ(outcome.status, 3) << outcome.output;
  EXPECT_EQ(summary_of(folder.path("run")).at("status"), "interrupted");
}
} // namespace buckling_of_grains_tests

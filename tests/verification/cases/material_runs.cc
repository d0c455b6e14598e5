// Whole static runs of finite elements that yield, creep or strain much, against closed
// forms; and what is refused.
#include "support/tiny_run.h"

#include <cmath>
#include <fstream>

namespace material_runs_tests
{
using namespace antiform::test;

namespace
{
/// A bare straight layer, L/h = 4, of E = 56 GPa and nu = 0.2.
void write_bare(const std::string &path, const std::string &more)
{
  std::ofstream(path) << R"(set Title      = bare
set Components = layer, walls
subsection Layer
  set Representation = continuum
  set Shape          = straight
  set Length ratio   = 4
  set Grains across  = 4
  set Young modulus  = 56e9
  set Poisson ratio  = 0.2
end
subsection Matrix
  set Cell size ratio = 1
  set Element degree  = 2
end
subsection Run
  set Driver         = static
  set End shortening = 2e-3
  set Load steps     = 4
end
)" << more;
}

nlohmann::json run_bare(const TemporaryFolder &folder,
                        const std::string &name,
                        const std::vector<std::string> &entries,
                        const bool may_fail = false)
{
  write_bare(folder.path(name + ".prm"), "");
  const Outcome outcome = run_program("run " + folder.path(name + ".prm") + " -o " +
                                      folder.path(name) + set(entries));
  EXPECT_TRUE(outcome.status == 0 || (may_fail && outcome.status == 2)) << outcome.output;
  return summary_of(folder.path(name));
}

constexpr double modulus = 56e9 / (1. - 0.2 * 0.2); ///< E'
} // namespace

TEST(MaterialRun, AStrongPlasticLayerIsTheElasticOne)
{
  const TemporaryFolder folder;
  const nlohmann::json linear = run_bare(folder, "linear", {});
  const nlohmann::json plastic =
      run_bare(folder, "plastic",
               {"Layer material/Law=Mohr-Coulomb", "Layer material/Cohesion=1e12"});
  EXPECT_NEAR(result(plastic, "wall_force") / result(linear, "wall_force"), 1., 1e-9);
  EXPECT_NEAR(result(plastic, "peak_stress") / (modulus * 2e-3), 1., 1e-9);
  EXPECT_EQ(result(plastic, "plastic_share_at_peak"), 0.);
}

TEST(MaterialRun, ALayerCrushesAtItsUniaxialStrength)
{
  const TemporaryFolder folder;
  for (const std::string law : {"Mohr-Coulomb", "Drucker-Prager"})
  {
    // Associated flow: in plane strain the cone collapses with Mohr-Coulomb then, here
    // under no pressure across: 2 c cos phi / (1 - sin phi). Once all of it yields there
    // is no one equilibrium, and the run says so; the state before is kept.
    const nlohmann::json summary =
        run_bare(folder, law.substr(0, 4),
                 {"Layer material/Law=" + law, "Layer material/Cohesion=10e6",
                  "Layer material/Friction angle=30", "Layer material/Dilation angle=30",
                  "Run/Load steps=40"},
                 2);
    const double ucs = 2. * 10e6 * std::sqrt(3.);
    EXPECT_NEAR(result(summary, "peak_stress") / ucs, 1., law[0] == 'M' ? 2e-4 : 0.05)
        << law; // the cone yields first where zz is not at rest yet
    EXPECT_EQ(summary.at("effects").at("yielding").at("active"), true);
    EXPECT_EQ(summary.at("effects").at("creep").at("active"), false);
  }
}

TEST(MaterialRun, ALayerThatCreepsPushesByItsViscosity)
{
  const TemporaryFolder folder;
  // 400 relaxation times: plane-strain flow, sigma = 4 eta times the rate.
  const double mu = 56e9 / 2.4, eta = 1e20, duration = 400. * eta / mu;
  const nlohmann::json summary =
      run_bare(folder, "creep",
               {"Layer material/Law=Maxwell", "Layer material/Viscosity=1e20",
                "Run/Duration=" + std::to_string(duration), "Run/Load steps=20"});
  EXPECT_NEAR(result(summary, "peak_stress") / (4. * eta * 2e-3 / duration), 1., 1e-6);
}

TEST(MaterialRun, FiniteStrainIsSmallStrainWhereStrainIsSmall)
{
  const TemporaryFolder folder;
  double ratio[2];
  int k = 0;
  for (const std::string law : {"elastic", "St Venant-Kirchhoff"})
  {
    const nlohmann::json summary = run_bare(
        folder, std::to_string(k), {"Run/Strain=finite", "Layer material/Law=" + law});
    ratio[k++] = result(summary, "peak_stress") / (modulus * 2e-3);
  }
  // Of the order of the strain; St Venant-Kirchhoff softens by 3/2 of it.
  EXPECT_NEAR(ratio[0], 1., 6e-3);
  EXPECT_NEAR(ratio[1], 1., 6e-3);
  EXPECT_NE(ratio[0], ratio[1]);
  EXPECT_LT(ratio[1], 1.);
}

TEST(MaterialRun, ASectionUnderItsLoadsRestsAndIsTheSameOnTwoRanks)
{
  const TemporaryFolder folder;
  nlohmann::json summary[2];
  for (const int n : {1, 2})
  {
    const std::string directory = folder.path(std::to_string(n));
    const Outcome outcome =
        run_program("run " + buried_deck() + " -o " + directory +
                        set({"Components=layer, matrix, walls, gravity, surface pressure",
                             "Matrix material/Law=Drucker-Prager",
                             "Matrix material/Cohesion=3e6",
                             "Matrix material/Friction angle=30", "Run/Strain=finite",
                             "Run/End shortening=4e-3", "Run/Load steps=4"}),
                    n);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    summary[n - 1] = summary_of(directory);
  }
  for (const char *name : {"wall_force", "peak_stress", "fold_amplitude"})
    EXPECT_NEAR(result(summary[1], name) / result(summary[0], name), 1., 1e-6) << name;

  // Before it is shortened: a lithostatic stress of 5 MPa and the weight above, and no
  // motion. The layer lies 40 m deep beside the fold.
  const CsvTable history(folder.path("1") + "/history.csv");
  const double lithostatic = 5e6 + 0.84 * 2500. * 9.81 * 40.;
  EXPECT_NEAR(history.column("axial_stress_Pa").front() / lithostatic, 1., 1e-6);
  EXPECT_NEAR(history.column("fold_amplitude_m").front(), 5., 1e-9);
  EXPECT_GT(history.column("fold_amplitude_m").back(), 5.);
}

TEST(MaterialRun, RefusesWhatDoesNotGoTogether)
{
  const TemporaryFolder folder;
  struct
  {
    std::vector<std::string> entries;
    std::vector<std::string> naming;
  } const cases[] = {
      {{"Layer material/Law=St Venant-Kirchhoff"}, {"Run/Strain", "finite"}},
      {{"Layer material/Law=Maxwell"}, {"Run/Duration"}},
      {{"Layer material/Law=Mohr-Coulomb", "Layer material/Dilation angle=50"},
       {"'Layer material/Dilation angle' = '50'", "friction angle"}},
      {{"Layer material/Law=Mohr-Coulomb", "Layer material/Tensile strength=1e9"},
       {"apex"}},
      {{"Matrix/Element degree=1", "Layer/Poisson ratio=0.49"},
       {"'Layer/Poisson ratio' = '0.49'", "Give 'Matrix/Element degree' = 2"}},
      {{"Layer material/Law=Mohr-Coulomb", "Run/Driver=buckling"}, {"'Run/Driver'"}}};
  write_bare(folder.path("bad.prm"), "");
  for (const auto &one : cases)
  {
    const Outcome outcome = run_program("run " + folder.path("bad.prm") + " -o " +
                                        folder.path("bad") + set(one.entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    for (const std::string &part : one.naming)
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n"
                                                              << outcome.output;
  }
}

TEST(MaterialRun, ASectionThatDoesNotBearItsLoadsSaysSo)
{
  const TemporaryFolder folder;
  // A layer twelve times as heavy as the mud it lies in sinks.
  const Outcome outcome = run_program(
      "run " + buried_deck() + " -o " + folder.path("mud") +
      set({"Components=layer, matrix, walls, gravity", "Layer/Grain density=30000",
           "Matrix/Stiffness contrast=1e3", "Matrix material/Law=Mohr-Coulomb",
           "Matrix material/Cohesion=1e3", "Matrix material/Friction angle=0"}));
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  for (const char *part : {"does not bear its loads", "'Matrix material'"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
}

TEST(MaterialRun, ASectionThatCouldFloatAwayIsRefused)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      std::string("check ") + ANTIFORM_SOURCE_DIR +
      "/cases/burial-depth/upheaval.prm --set \"Components=layer, walls, foundation\"");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("Add gravity"), std::string::npos) << outcome.output;
}

// Case 36: the thesis' plot of strength against slenderness, by finite elements that
// yield.
TEST(MaterialRun, ALayerCrushesOrBucklesByItsSlendernessLong)
{
  const TemporaryFolder folder;
  const std::string deck = ANTIFORM_SOURCE_DIR "/cases/shortening/strut.prm";
  const double phi = 42. * M_PI / 180.,
               ucs = 2. * 36.06e6 * std::cos(phi) / (1. - std::sin(phi)),
               imperfection = 1e-3; // of the wave about its mean, over h
  for (const double slenderness : {0.6, 0.9, 1.1, 1.5, 2., 3.})
  {
    const double length = 2. * slenderness * M_PI * std::sqrt(modulus / (12. * ucs)),
                 euler = 1. / (slenderness * slenderness),
                 strain = ucs / modulus * std::min(1., euler);
    const std::string name = std::to_string(slenderness);
    const auto entry = [](const char *path, const double value)
    { return std::string(path) + "=" + std::to_string(value); };
    const Outcome outcome = run_program(
        "run " + deck + " -o " + folder.path(name) +
        set({entry("Layer/Length ratio", length),
             entry("Matrix/Cell aspect ratio", std::max(1., length / 16.)),
             entry("Run/End shortening", (slenderness < 1. ? 1.08 : 1.4) * strain),
             "Run/Load steps=100"}));
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 2) << outcome.output;
    const nlohmann::json summary = summary_of(folder.path(name));
    // Perry and Robertson: the inner arc yields at s (1 + 6 a / (1 - s / euler)) = 1.
    const double b = 1. + euler * (1. + 6. * imperfection),
                 yields = 0.5 * (b - std::sqrt(b * b - 4. * euler));
    EXPECT_NEAR(result(summary, "peak_stress") / ucs / yields, 1., 0.03) << slenderness;
    const double growth =
        result(summary, "fold_amplitude_at_peak") / (2. * imperfection * 10.);
    // Grown tenfold: within a tenth of the Euler load.
    EXPECT_EQ(growth > 10., slenderness > 1.) << slenderness << " grew by " << growth;
  }
}
} // namespace material_runs_tests

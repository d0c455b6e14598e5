// What carries, presses on and touches sections of finite elements, as decks say it:
// foundations, membranes, interfaces that are not cemented, quiet boundaries; against
// closed forms, and on any number of ranks.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace solid_decks_tests
{
using namespace antiform::test;

namespace
{
nlohmann::json run_deck(const TemporaryFolder &folder,
                        const std::string &deck,
                        const std::string &name,
                        const std::vector<std::string> &entries,
                        const int n_ranks = 1)
{
  const Outcome outcome =
      run_program("run " + deck + " -o " + folder.path(name) + set(entries), n_ranks);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(folder.path(name));
}

const std::string decks = std::string(ANTIFORM_SOURCE_DIR) + "/cases/";
} // namespace

TEST(FoundationDeck, LongBareLayersBuckleAsOnWinklersAndPasternaksSprings)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("bare.prm")) << R"(set Title      = on springs
set Components = layer, walls, foundation
subsection Layer
  set Representation = continuum
  set Shape          = straight
  # Guided ends: the wave of the long layer fits, four half waves.
  set Length ratio   = 104.719755
  set Young modulus  = 48e9
  set Poisson ratio  = 0
  set Grains across  = 2
end
subsection Matrix
  set Cell size ratio   = 1
  set Cell aspect ratio = 4
  set Element degree    = 2
end
subsection Run
  set Driver = buckling
  set Modes  = 1
end
)";
  // D = 4e12 N m, k = (k_w/D)^(1/4) = 0.012 1/m: k_w = 82944 Pa/m.
  const double D = 4e12, k_w = 82944., h = 10.;
  for (const std::string faces : {"base", "base and top"})
    for (const double shear : {0., 20.}) // G_p / (k_w h^2)
    {
      const double n_faces = faces == "base" ? 1. : 2.;
      const nlohmann::json summary = run_deck(
          folder, folder.path("bare.prm"),
          std::to_string(faces.size()) + "-" + std::to_string(shear),
          {"Foundation/Faces=" + faces, "Foundation/Shear ratio=" + std::to_string(shear),
           "Foundation/Stiffness=" + std::to_string(k_w / n_faces)});
      // Both faces share the springs, so the wave stays the same.
      const double force = 2. * std::sqrt(k_w * D) + shear * k_w * h * h;
      // Shear of the layer takes up to E/G (k h)^2/12 of D: 3e-3.
      EXPECT_NEAR(result(summary, "critical_stress") * h / force, 1., 5e-3)
          << faces << ' ' << shear;
      EXPECT_NEAR(result(summary, "theory_stress") * h / force, 1., 1e-6);
      EXPECT_EQ(result(summary, "half_waves"), 4.);
    }
}

TEST(FoundationDeck, WithoutAMatrixIsGivenInPascalsPerMetre)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("bare.prm"))
      << "set Components = layer, walls, foundation\nsubsection Layer\nset "
         "Representation = continuum\nset Shape = straight\nend\nsubsection Run\nset "
         "Driver = static\nset End shortening = 1e-3\nend\n";
  const Outcome outcome = run_program("check " + folder.path("bare.prm"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("Foundation/Stiffness"), std::string::npos)
      << outcome.output;
}

TEST(FoundationDeck, ALayerOnHardRockRisesAsTheClosedFormSays)
{
  const TemporaryFolder folder;
  const nlohmann::json summary =
      run_deck(folder, decks + "burial-depth/upheaval.prm", "up",
               {"Matrix/Cell aspect ratio=8", "Run/Load steps=30"});
  const CsvTable history(folder.path("up") + "/history.csv");
  const std::vector<double> rise = history.column("crest_height_m"),
                            stress = history.column("axial_stress_Pa"),
                            lifted = history.column("lifted_length_m");
  const auto top = std::max_element(stress.begin(), stress.end()) - stress.begin();
  // It snaps: past the peak both fall while the crest rises.
  EXPECT_LT(stress.back(), 0.8 * stress[top]);
  // From a flat base: P l^2 / D = 80.763, height 2.4068e-3 q l^4 / D (Hobbs 1984). The
  // bump of 1.5 m is some 6 % of the height here; slopes squared are 1 %.
  const double D = 56e9 / 0.96 * 1e3 / 12., q = 0.84 * 2500. * 9.81 * 10.;
  std::size_t i = top;
  while (i + 1 < rise.size() && rise[i] < 25.)
    ++i;
  ASSERT_GT(rise[i], 24.);
  const double length = std::pow(rise[i] * D / (2.4068e-3 * q), 0.25);
  EXPECT_NEAR(stress[i] * 10. * length * length / (80.763 * D), 1., 0.03) << rise[i];
  // Cells are 40 m wide, 6 % of the length, at either end.
  EXPECT_NEAR(lifted[i] / length, 1., 0.12);
  EXPECT_EQ(summary.at("effects").at("lift-off").at("active"), true);
}

TEST(MembraneDeck, APressureThatFollowsDoesNotKeepALayerFromBuckling)
{
  const TemporaryFolder folder;
  const double euler = M_PI * M_PI * 56e9 / 0.96 / 12. / 1600.; // guided: L/2
  std::vector<double> over;
  for (const std::string pressure : {"1e6", "20e6"})
  {
    run_deck(folder, decks + "confinement/strut.prm", pressure,
             {"Membrane/Pressure=" + pressure, "Run/Load steps=20",
              "Matrix/Cell aspect ratio=10", "Layer material/Law=elastic",
              "Run/End shortening=7e-4"});
    const CsvTable history(folder.path(pressure) + "/history.csv");
    // Southwell: sigma_1 - p = sigma_E (1 - a0/a), from two states of a bent layer.
    const std::vector<double> a = history.column("fold_amplitude_m"),
                              s = history.column("axial_stress_Pa");
    const std::size_t i = a.size() - 1, j = a.size() - 4;
    const double slope = (s[i] - s[j]) / (1. / a[i] - 1. / a[j]);
    over.push_back(s[i] - slope / a[i] - std::stod(pressure));
    EXPECT_NEAR(over.back() / euler, 1., 0.01) << pressure;
  }
  EXPECT_NEAR(over[1] / over[0], 1., 2e-3); // 0.13 of sigma_E if the pressure were dead
}

TEST(InterfaceDeck, ContactsOrderTheSectionByWhatTheyHold)
{
  const TemporaryFolder folder;
  const auto run = [&](const std::string &word, const std::vector<std::string> &more)
  {
    std::vector<std::string> entries = {
        "Matrix/Interface=" + word.substr(0, word.find('-')), "Run/End shortening=5e-4"};
    entries.insert(entries.end(), more.begin(), more.end());
    return run_deck(folder, buried_deck(), word, entries);
  };
  const nlohmann::json cemented = run("cemented", {"Run/Strain=finite"}),
                       sliding = run("sliding", {"Run/Strain=finite"}),
                       frictionless = run("frictionless", {"Run/Strain=finite"}),
                       rough = run("frictional", {"Run/Strain=finite",
                                                  "Matrix/Interface friction=0.02"}),
                       glued = run("frictional-glued",
                                   {"Run/Strain=finite", "Matrix/Interface cohesion=1e12",
                                    "Matrix/Contact stiffness ratio=1e4"});
  const auto rise = [](const nlohmann::json &s) { return result(s, "fold_amplitude"); };
  // Under pressure nothing opens, so frictionless is sliding; the less an interface
  // holds, the more the layer folds; what cannot slip is cemented but for 1e-4 of a cell.
  EXPECT_EQ(result(frictionless, "open_length"), 0.);
  EXPECT_NEAR(rise(frictionless) / rise(sliding), 1., 1e-9);
  EXPECT_GT(rise(sliding) - rise(rough), 0.05 * (rise(sliding) - rise(cemented)));
  EXPECT_GT(rise(rough) - rise(cemented), 0.05 * (rise(sliding) - rise(cemented)));
  EXPECT_NEAR(rise(glued) / rise(cemented), 1., 1e-4);
  EXPECT_EQ(result(glued, "open_length"), 0.);
  EXPECT_GT(result(rough, "relative_slip"), 1e-4);
  EXPECT_EQ(cemented.at("effects").at("interface").at("active"), false);
  EXPECT_EQ(rough.at("effects").at("interface").at("active"), true);
}

TEST(InterfaceDeck, IsTheSameOnOneTwoAndFourRanks)
{
  const TemporaryFolder folder;
  const auto force = [&](const std::string &word, const int n)
  {
    return result(run_deck(folder, buried_deck(), word + std::to_string(n),
                           {"Matrix/Interface=" + word}, n),
                  "wall_force");
  };
  const double alone = force("frictional", 1);
  EXPECT_NEAR(force("frictional", 2) / alone, 1., 1e-8);
  EXPECT_NEAR(force("frictional", 4) / alone, 1., 1e-8);
  EXPECT_NEAR(force("cemented", 4) / force("cemented", 1), 1., 1e-8);
}

TEST(InterfaceDeck, ThatNothingHoldsTogetherIsRefused)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      "check " + buried_deck() +
      set({"Matrix/Interface=frictionless", "Components=layer, matrix, walls"}));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("could float away"), std::string::npos) << outcome.output;
}

TEST(FoundationDeck, UnderALoadedSectionRestsAsItWasLaidDown)
{
  const TemporaryFolder folder;
  // A lithostatic section in equilibrium stays where it is, whatever the driver: linear,
  // of laws, on springs or on a base that only pushes.
  for (const std::string more :
       {"Foundation/Lifts off=false", "Foundation/Lifts off=true"})
  {
    run_deck(folder, buried_deck(), more.substr(more.size() - 4),
             {"Components=layer, matrix, walls, surface pressure, gravity, foundation",
              "Matrix/Grain density=2500", "Layer/Grain density=2500", more,
              "Run/Strain=finite", "Run/End shortening=1e-6", "Run/Load steps=1"});
    const CsvTable history(folder.path(more.substr(more.size() - 4)) + "/history.csv");
    EXPECT_NEAR(history.column("fold_amplitude_m")[0], 5., 1e-8) << more;
    // 5 MPa, and the weight of the cover and half of the layer at its ends.
    const double depth = 30. + 5. + 5.; // cover above the crest, fold, half of the layer
    EXPECT_NEAR(history.column("axial_stress_Pa")[0], 5e6 + 0.84 * 2500. * 9.81 * depth,
                2e-3 * 5e6)
        << more;
  }
}

TEST(LoadDeck, AnOverburdenPressesByItsWeight)
{
  const TemporaryFolder folder;
  // 5 MPa or 0.84 rho g of 24.2716 h: the same, but for the weight inside the section.
  const std::string components =
      "Components=layer, matrix, walls, surface pressure, gravity";
  const double ratio = 5e6 / (0.84 * 2500. * 9.81 * 10.);
  const nlohmann::json pressed = run_deck(folder, buried_deck(), "pressed", {components}),
                       covered = run_deck(folder, buried_deck(), "covered",
                                          {components, "Surface pressure/Pressure=0",
                                           "Surface pressure/Overburden ratio=" +
                                               std::to_string(ratio)});
  EXPECT_NEAR(result(covered, "wall_force") / result(pressed, "wall_force"), 1., 1e-6);
}

TEST(QuietBoundaryDeck, LetsOutTheWavesOfTheWalls)
{
  const TemporaryFolder folder;
  // Walls that come up to speed within a transit: waves all over the section.
  const std::vector<std::string> sudden = {
      "Run/Driver=dynamic", "Run/End shortening=1e-3",
      "Walls/Transits per millistrain=20", "Walls/Ramp=1", "Matrix/Element degree=1"};
  std::vector<std::string> quiet = sudden;
  quiet.push_back(
      "Components=layer, matrix, walls, surface pressure, absorbing boundary");
  const nlohmann::json loud = run_deck(folder, buried_deck(), "loud", sudden),
                       still = run_deck(folder, buried_deck(), "still", quiet);
  const auto energy = [](const nlohmann::json &s, const char *name)
  { return s.at("energy").at(name).get<double>(); };
  EXPECT_EQ(energy(loud, "damping"), 0.);
  EXPECT_GT(energy(still, "damping"), 0.);
  // Undamped but for the dashpots the ledger closes to round-off; the walls still move.
  EXPECT_LT(std::abs(energy(still, "closure_error")), 1e-10);
  EXPECT_LT(energy(still, "kinetic"), 0.9 * energy(loud, "kinetic"));
  const auto &effect = still.at("effects").at("absorbing boundary");
  EXPECT_EQ(effect.at("active"), true);
  EXPECT_EQ(effect.at("calls"), still.at("steps"));
  EXPECT_EQ(loud.at("effects").at("absorbing boundary").at("calls"), 0);
}
} // namespace solid_decks_tests

// antiform theory: the closed forms for the scenes of decks, as users ask for them. The
// forms themselves are in tests/unit/continuum.
#include "support/files.h"
#include "support/table.h"
#include "support/tiny_run.h"

#include <cmath>

namespace theory_tests
{
using namespace antiform::test;
using Json = nlohmann::json;

namespace
{
std::string deck(const std::string &name)
{
  return std::string(ANTIFORM_SOURCE_DIR) + "/cases/" + name + ".prm";
}

Json theory_of(const std::string &name, const std::vector<std::string> &entries = {})
{
  const Outcome outcome = run_program("theory --json " + deck(name) + set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return Json::parse(outcome.output, nullptr, false);
}

/// The figure @p names lead to; its unit must be @p unit.
double value(Json json, const std::vector<std::string> &names, const std::string &unit)
{
  for (const std::string &name : names)
    json = json.at(name);
  EXPECT_EQ(json.at("unit"), unit) << names.back();
  return json.at("value");
}

std::string reason(const Json &json, const std::string &section, const std::string &row)
{
  const Json &entry = json.at(section).at(row);
  EXPECT_EQ(entry.at("applies"), false) << row;
  return entry.at("reason");
}

// Rock 1 in anticline.prm: nu = nu0 = 0.2.
constexpr double E = 56e9, UCS = 162e6, h = 10., plane = E / 0.96;
} // namespace

TEST(Theory, OfTheAnticlineIsThatOfTheClosedForms)
{
  const Json json = theory_of("burial-depth/anticline");
  const double critical = M_PI * std::sqrt(E / UCS),
               L = 2. * critical / std::sqrt(12.) * h;
  const auto strut = [&](const std::string &name, const std::string &unit = "-") {
    return value(json, {"strut", name}, unit);
  };
  EXPECT_NEAR(strut("critical_slenderness") / critical, 1., 1e-12);
  EXPECT_NEAR(strut("slenderness") / (2. * critical), 1., 1e-12);
  EXPECT_NEAR(strut("slenderness_ratio"), 2., 1e-12);
  EXPECT_NEAR(strut("gamma"), 0.25, 1e-12);
  EXPECT_NEAR(strut("buckling_stress", "Pa") / (0.25 * UCS), 1., 1e-12);
  EXPECT_NEAR(strut("length_ratio") * h / L, 1., 1e-12);

  EXPECT_NEAR(value(json, {"regime", "theta"}, "-"), 3. * std::cbrt(1e-4), 1e-12);
  // Two half-spaces: Biot's; with printed digits of the constant.
  const double soft = 1e-4 * plane;
  const double deep = std::cbrt(9. / 16. * plane * soft * soft);
  EXPECT_NEAR(value(json, {"critical", "half_spaces_smooth", "critical_stress"}, "Pa") /
                  deep,
              1., 1e-11);
  EXPECT_NEAR(value(json, {"critical", "half_spaces_smooth", "wavelength"}, "m") /
                  (2. * M_PI * h * std::cbrt(1e4 / 6.)),
              1., 1e-7);

  // Arch: q* of the pinned and of the guided layer.
  const double D = plane * h * h * h / 12., rise = 5.;
  EXPECT_NEAR(value(json, {"loads_across", "arch", "pinned"}, "Pa") /
                  (std::pow(M_PI, 5) * D * rise / (4. * std::pow(L, 4))),
              1., 1e-11);
  EXPECT_NEAR(value(json, {"loads_across", "arch", "guided"}, "Pa") /
                  (4. * std::pow(M_PI, 4) * D * rise / std::pow(L, 4)),
              1., 1e-11);
  EXPECT_NE(reason(json, "loads_across", "snap_through").find("at most 2"),
            std::string::npos); // a0 = 1.73 r
  EXPECT_NE(reason(json, "loads_across", "upheaval").find("cemented"), std::string::npos);
  EXPECT_NE(reason(json, "confinement", "pressure").find("neither"), std::string::npos);
  EXPECT_EQ(json.at("mechanism").at("by_thesis_plot"), "buckle, then crush");
}

TEST(Theory, UnderACoverIsThatOfTheTable)
{
  // The table's nu = nu0 = 0.25, which matrix grains do not reach: finite elements.
  for (const double H : {1., 10., 30.})
  {
    const Json json = theory_of("burial-depth/anticline",
                                {"Layer/Representation=continuum",
                                 "Layer/Poisson ratio=0.25", "Matrix/Poisson ratio=0.25",
                                 "Matrix/Burial depth ratio=" + std::to_string(H)});
    unsigned int n = 0;
    for (const auto &row : table("critical_stress_vs_cover.csv"))
      if (std::stod(row[1]) == 1e-4 && std::stod(row[2]) == H)
      {
        ++n;
        const std::string name = "cover_on_half_space_" + row[0];
        const double stress = value(json, {"critical", name, "critical_stress"}, "Pa"),
                     wave = value(json, {"critical", name, "wavelength"}, "m");
        const double expected = std::stod(row[3]) * E / (1. - 0.25 * 0.25);
        EXPECT_NEAR(stress, expected, 1e-8 * expected) << name; // nine printed digits
        EXPECT_NEAR(wave / (std::stod(row[4]) * h), 1., 1e-7) << name; // a flat minimum
      }
    EXPECT_EQ(n, 2u);
  }
}

TEST(Theory, SaysWhereThetaAndTheThesisDisagree)
{
  const std::string deep_by_thesis = "Matrix/Burial depth ratio=10";
  const Json json = theory_of("burial-depth/anticline", {deep_by_thesis});
  EXPECT_EQ(json.at("regime").at("by_theta"), "transition"); // Theta = 0.464
  EXPECT_EQ(json.at("regime").at("by_thesis_limits"), "deep");
  EXPECT_NE(json.at("regime").at("agreement").get<std::string>().find("disagree"),
            std::string::npos);
  const Outcome outcome =
      run_program("theory " + deck("burial-depth/anticline") + set({deep_by_thesis}));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("disagree: with this matrix a cover is shallow to H/h = "
                                "6.463 and deep from 43.09"),
            std::string::npos)
      << outcome.output;
  const Json both = theory_of("burial-depth/anticline", {"Matrix/Burial depth ratio=60"});
  EXPECT_EQ(both.at("regime").at("by_theta"), "deep"); // Theta = 2.8
  EXPECT_EQ(both.at("regime").at("agreement"), "agree");
}

TEST(Theory, ConfinementWidensTheRangeOfFolding)
{
  const Outcome outcome =
      run_program("theory --json --friction-angle 30 " + deck("burial-depth/anticline") +
                  set({"Components=layer, matrix, foundation, surface pressure, gravity, "
                       "walls, damping",
                       "Surface pressure/Pressure=10e6", "Matrix/Grain density=2500",
                       "Gravity/Acceleration=10"}));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const Json json = Json::parse(outcome.output);
  // Cover of 30 m at 2100 kg/m^3, and half of the layer.
  const double cover = 10e6 + 21e3 * 30., p = cover + 21e3 * 5., N = 3.;
  const auto figure = [&](const std::string &name, const std::string &unit) {
    return value(json, {"confinement", name}, unit);
  };
  EXPECT_NEAR(figure("pressure", "Pa") / p, 1., 1e-12);
  EXPECT_NEAR(figure("buckling_stress", "Pa") / (p + 0.25 * UCS), 1., 1e-12);
  EXPECT_NEAR(figure("failure_stress", "Pa") / (UCS + N * p), 1., 1e-12);
  const double failure = 1. + (N - 1.) * p / UCS;
  EXPECT_NEAR(figure("failure_ratio", "-"), failure, 1e-12);
  EXPECT_NEAR(figure("critical_slenderness_ratio", "-"), 1. / std::sqrt(failure), 1e-12);
  EXPECT_NEAR(value(json, {"loads_across", "cover_load"}, "Pa") / cover, 1., 1e-12);
  EXPECT_EQ(json.at("loads_across").at("arch_grows"), "is pressed down");
  // A top that carries its relief is stiffer than a weightless one.
  const auto stress = [&](const std::string &name) {
    return value(json, {"critical", name, "critical_stress"}, "Pa");
  };
  EXPECT_GT(stress("scene_with_relief_smooth"), stress("scene_smooth"));
  EXPECT_GT(stress("scene_with_relief_bonded"), stress("scene_bonded"));
}

TEST(Theory, LiftsALayerThatMayLeaveAStiffBase)
{
  const auto with_pressure = [](const std::string &pressure)
  {
    return theory_of("burial-depth/anticline",
                     {"Components=layer, matrix, surface pressure, walls, damping",
                      "Matrix/Representation=grains", "Matrix/Interface=frictionless",
                      "Matrix/Stiffness contrast=2", "Matrix/Burial depth ratio=0.3",
                      "Matrix/Base depth ratio=0.5",
                      "Surface pressure/Pressure=" + pressure});
  };
  // l^9 = 2 a / (7 b), a = 80.763 D, b = E' h / (2 L) 3.194e-5 (q/D)^2; P_0 = 9/7 a /
  // l^2.
  const double q = 1e6, D = plane * h * h * h / 12.;
  const double L =
      1.23 * 2. * M_PI * std::sqrt(E / UCS) / std::sqrt(12.) * h; // with straight ends
  const double b = plane * h / (2. * L) * 3.194e-5 * q * q / (D * D), a = 80.763 * D;
  const double length = std::pow(2. * a / (7. * b), 1. / 9.);
  const Json json = with_pressure("1e6");
  // Five printed digits of the constants.
  EXPECT_NEAR(value(json, {"loads_across", "upheaval", "length"}, "m") / length, 1.,
              1e-4);
  EXPECT_NEAR(value(json, {"loads_across", "upheaval", "stress"}, "Pa") /
                  (9. / 7. * a / (length * length * h)),
              1., 1e-4);
  EXPECT_NEAR(value(json, {"loads_across", "upheaval", "deflection"}, "m") /
                  (2.4068e-3 * q * std::pow(length, 4) / D),
              1., 1e-4);
  // Less weight is lifted over more than there is.
  EXPECT_NE(reason(with_pressure("1e4"), "loads_across", "upheaval")
                .find("longer than the section"),
            std::string::npos);
}

TEST(Theory, OfALayerWithoutMatrixHasNoRegime)
{
  const Json json = theory_of("shortening/single-layer", {"Layer/Amplitude ratio=2"});
  EXPECT_EQ(reason(json, "regime", "theta"), "there is no matrix");
  EXPECT_NE(reason(json, "critical", "critical_stress").find("the length decides"),
            std::string::npos);
  EXPECT_NEAR(value(json, {"strut", "gamma"}, "-"), 0.25, 1e-12);
  // e0 = 2 sqrt(12) = 6.93, above sqrt(22): sways at e = sqrt(e0^2 - 16), uniform load.
  const double L = 2. * M_PI * std::sqrt(E / UCS) / std::sqrt(12.) * h;
  const double e0 = 2. * std::sqrt(12.), rise = std::sqrt(e0 * e0 - 16.);
  const double unit =
      plane * h * h * h / 12. * std::pow(M_PI / L, 4) * h / std::sqrt(12.);
  EXPECT_NEAR(value(json, {"loads_across", "snap_through", "load"}, "Pa") /
                  (0.25 * M_PI * (e0 + 3. * rise) * unit),
              1., 1e-11);
  EXPECT_NE(
      json.at("loads_across").at("snap_through_mode").get<std::string>().find("swaying"),
      std::string::npos);
}

TEST(Theory, OfBedsIsThatOfEachAlone)
{
  const Json json = theory_of("shortening/multilayer");
  for (const auto &[bed, modulus, strength] :
       {std::tuple{"bed_1", E, UCS}, std::tuple{"bed_2", 21.9e9, 50e6}})
    EXPECT_NEAR(value(json, {"strut", bed, "slenderness_ratio"}, "-") /
                    (std::sqrt(12.) * 33.72 / (M_PI * std::sqrt(modulus / strength))),
                1., 1e-12)
        << bed; // L = 11.24 times three beds
  const double stick = value(json, {"strut", "stack_cemented"}, "Pa"),
               slide = value(json, {"strut", "stack_sliding"}, "Pa");
  EXPECT_GT(stick, 9. * slide); // n^2 for equal beds, more with the stiff ones outside
  EXPECT_NE(reason(json, "critical", "critical_stress").find("there is no matrix"),
            std::string::npos);
  EXPECT_EQ(json.at("mechanism").at("bed_2"), "buckle, then crush");
}

TEST(Theory, OfASpecimenIsThatItCrushes)
{
  const Json bare = theory_of("laboratory/uniaxial");
  EXPECT_EQ(bare.at("mechanism").at("by_thesis_plot"), "crush");
  EXPECT_EQ(bare.at("mechanism").at("by_scene"), "crush");
  for (const std::string row : {"arch", "snap_through", "upheaval"})
    EXPECT_NE(reason(bare, "loads_across", row), "") << row;
  const Json confined = theory_of("laboratory/biaxial");
  EXPECT_EQ(value(confined, {"confinement", "pressure"}, "Pa"), 10e6);
  const Json pulled = theory_of("laboratory/tension");
  EXPECT_NE(reason(pulled, "mechanism", "by_thesis_plot").find("tears"),
            std::string::npos);
}

TEST(Theory, DrawsTheDiagram)
{
  const TemporaryFolder folder;
  const std::string file = folder.path("diagram.svg");
  const Outcome outcome =
      run_program("theory --json --plot " + file + " " + deck("burial-depth/anticline") +
                  set({"Title=Fold <A> & B"}));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_FALSE(Json::parse(outcome.output, nullptr, false).is_discarded());
  const std::string picture = contents(file);
  EXPECT_EQ(picture.substr(0, 5), "<?xml");
  for (const char *part :
       {"Fold &lt;A&gt; &amp; B", "slenderness ratio", "stress ratio", "(MPa)", "L/h (-)",
        "shear failure only", "\u039b = 2, \u03b3 = 0.25", "Perry-Robertson", "</svg>"})
    EXPECT_NE(picture.find(part), std::string::npos) << part;
  EXPECT_EQ(occurrences(picture, "<text"), occurrences(picture, "</text>"));
  EXPECT_EQ(picture.find("nan"), std::string::npos);
  EXPECT_EQ(picture.find("inf"), std::string::npos);
}

TEST(Theory, RefusesWhatItCannotAnswer)
{
  const Outcome calibration =
      run_program("theory " + deck("laboratory/calibrate-rock-1"));
  EXPECT_EQ(calibration.status, 1) << calibration.output;
  EXPECT_NE(calibration.output.find("'antiform calibrate DECK'"), std::string::npos)
      << calibration.output;
  const TemporaryFolder folder;
  const Outcome nowhere =
      run_program("theory " + tiny_deck() + " --plot " + folder.path("no/where.svg"));
  EXPECT_EQ(nowhere.status, 1) << nowhere.output;
  EXPECT_NE(nowhere.output.find("cannot be written"), std::string::npos);
  const Outcome unknown =
      run_program("theory " + tiny_deck() + set({"Matrix/Colour=red"}));
  EXPECT_EQ(unknown.status, 1) << unknown.output;
  EXPECT_NE(unknown.output.find("'Matrix/Colour'"), std::string::npos);
}
TEST(Theory, IsTabulatedAlongValuesOfEntries)
{
  const TemporaryFolder folder;
  const Outcome outcome = run_command(clean_environment() + ANTIFORM_PROGRAM " theory " +
                                      deck("burial-depth/anticline") +
                                      " --along \"Matrix/Burial depth ratio = 1, 3, 30 & "
                                      "Layer/Length ratio = 50, 60, 70\"" +
                                      " >" + folder.path("table.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const CsvTable lines(folder.path("table.csv"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines.names().at(0), "burial_depth_ratio");
  EXPECT_EQ(lines.column("length_ratio"), (std::vector<double>{50., 60., 70.}));
  // The numbers of 'antiform theory' with these values, by the names of study.csv.
  const Json json = theory_of("burial-depth/anticline",
                              {"Matrix/Burial depth ratio=30", "Layer/Length ratio=70"});
  EXPECT_EQ(lines.column("theory_regime_theta").at(2),
            value(json, {"regime", "theta"}, "-"));
  EXPECT_EQ(lines.column("theory_at_length_with_matrix_guided_Pa").at(2),
            value(json, {"at_length", "with_matrix", "guided"}, "Pa"));
}

TEST(Theory, RefusesValuesThatMakeNoSceneAllAtOnce)
{
  const std::string begin = "theory " + deck("burial-depth/anticline") + " --along ";
  const Outcome outcome =
      run_program(begin + "\"Matrix/Burial depth ratio = 3, -1, x; Layr/Thickness = 1\"");
  EXPECT_EQ(outcome.status, 1);
  for (const char *part : {"'-1'", "'x'", "Layr/Thickness", "--along"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << outcome.output;
  for (const char *wrong : {"Matrix/Burial", "\"Layer/Seed = seeds 1 to 20000\""})
    EXPECT_EQ(run_program(begin + wrong).status, 1) << wrong;
}
} // namespace theory_tests

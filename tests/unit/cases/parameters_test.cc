#include "cases/parameters.h"

#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace parameters_tests
{
using namespace antiform::cases;

namespace
{
const std::string coupled = "set Components = layer, matrix, walls\n";

/// Is there one problem that holds all of these?
::testing::AssertionResult tells(const std::vector<std::string> &problems,
                                 const std::vector<std::string> &parts)
{
  for (const std::string &problem : problems)
    if (std::all_of(parts.begin(), parts.end(),
                    [&](const std::string &part)
                    { return problem.find(part) != std::string::npos; }))
      return ::testing::AssertionSuccess();
  auto failure = ::testing::AssertionFailure() << "no problem tells all of:";
  for (const std::string &part : parts)
    failure << " <" << part << ">";
  failure << "\namong\n";
  for (const std::string &problem : problems)
    failure << "  " << problem << "\n";
  return failure;
}

std::string read(const std::string &file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

const std::vector<std::string> all_decks = {"burial-depth/anticline.prm",
                                            "burial-depth/quick.prm",
                                            "burial-depth/comparison.prm",
                                            "comparison/buried.prm",
                                            "comparison/quick.prm"};

std::string deck_of_repository(const std::string &name)
{
  return std::string(ANTIFORM_SOURCE_DIR) + "/cases/" + name;
}
} // namespace

TEST(Parameters, EveryKindOfBadEntryIsReportedAtOnce)
{
  const Scratch scratch;
  const std::string deck = scratch.write("bad.prm",
                                         coupled +                        // line 1
                                             "include no-such-rock.prm\n" // 2
                                             "subsection Layer\n"
                                             "  set Thickness = 0\n"     // 4
                                             "  set Radius ratio = -1\n" // 5
                                             "  set Thicknes = 3\n"      // 6
                                             "  set Seed = ten\n"        // 7
                                             "end\n"
                                             "subsection Matrix\n"
                                             "  set Burial depth ratio = 0\n" // 10
                                             "  set Poisson ratio = 0.3\n"    // 11
                                             "end\n"
                                             "subsection Bridgin domain\n" // 13
                                             "  set Ramp = cubic\n"
                                             "end\n");
  const std::vector<std::string> problems = problems_of(deck);
  const auto at = [&](const int line) { return deck + ":" + std::to_string(line) + ":"; };
  EXPECT_TRUE(tells(problems, {at(2), "no-such-rock.prm", scratch.path("")}));
  EXPECT_TRUE(tells(problems, {at(4), "Layer/Thickness", "'0'", "> 0 and <= 1e+05 [m]"}));
  EXPECT_TRUE(tells(problems, {at(5), "Layer/Radius ratio", "'-1'", ">= 1"}));
  EXPECT_TRUE(tells(problems, {at(6), "Layer/Thicknes", "Did you mean 'Thickness'?"}));
  EXPECT_TRUE(tells(problems, {at(7), "Layer/Seed", "'ten'", "not a number", "whole"}));
  EXPECT_TRUE(tells(problems, {at(10), "Matrix/Burial depth ratio", "'0'", "no cover"}));
  EXPECT_TRUE(tells(problems, {at(11), "Matrix/Poisson ratio", "'0.3'", "0.25"}));
  EXPECT_TRUE(
      tells(problems, {at(13), "Bridgin domain", "Did you mean 'Bridging domain'?"}));
  // Each once, and nothing that merely follows from a value that was refused.
  EXPECT_EQ(problems.size(), 8u);
}

TEST(Parameters, OverlapWiderThanTheCoverSaysWhatFits)
{
  // d = 1 m; the cover of 8 m must hold buffer 4 + overlap + one row of cells 2.
  const Scratch scratch;
  const std::string deck =
      scratch.write("a.prm", coupled + "subsection Layer\n"
                                       "set Thickness = 10\nset Grains across = 10\n"
                                       "end\nsubsection Matrix\n"
                                       "set Burial depth ratio = 0.8\nend\n"
                                       "subsection Bridging domain\n"
                                       "set Overlap width ratio = 5\nend\n");
  const std::vector<std::string> problems = problems_of(deck);
  EXPECT_TRUE(
      tells(problems, {deck + ":10:", "Bridging domain/Overlap width ratio",
                       "wider than the cover", "11 m", "8 m", "fits is 2 (2 m)"}));
  EXPECT_EQ(problems.size(), 1u);
  EXPECT_TRUE(problems_of(deck, {"Bridging domain/Overlap width ratio=2"}).empty());
  EXPECT_TRUE(problems_of(deck, {"Matrix/Representation=grains"}).empty());
}

TEST(Parameters, RefusesMoreGrainsThanTheMachineHolds)
{
  // L/h = 10: 1e4 grains across make 1e9 grains in the layer alone.
  const Scratch scratch;
  const std::string deck =
      scratch.write("a.prm", "set Components = layer, walls\nsubsection Layer\n"
                             "set Shape = straight\nset Length ratio = 10\n"
                             "set Grains across = 1e4\nend\n");
  EXPECT_TRUE(tells(problems_of(deck),
                    {deck + ":5:", "Layer/Grains across", "1.055e+09 grains", "GiB"}));
  EXPECT_TRUE(problems_of(deck, {"Layer/Grains across=20"}).empty());
}

TEST(Parameters, RefusesWhatCannotGoTogether)
{
  const Scratch scratch;
  const std::string deck = scratch.write("a.prm", coupled);
  ASSERT_TRUE(problems_of(deck).empty());
  const auto refused = [&](const std::vector<std::string> &overrides,
                           const std::vector<std::string> &parts)
  { EXPECT_TRUE(tells(problems_of(deck, overrides), parts)); };
  refused({"Components=layer, matrix"}, {"Run/Driver", "Add walls"});
  refused({"Components=matrix, walls"}, {"Components", "Add layer"});
  refused({"Components=layer, foundation, walls"}, {"foundation without matrix"});
  refused({"Components=layer, gravity, walls"}, {"gravity without matrix"});
  refused({"Components=layer", "Run/Driver=static"}, {"nothing loads the scene"});
  refused({"Components=layer, matrix, gravity", "Run/Driver=dynamic"},
          {"Run/Driver", "Add walls"});
  refused({"Matrix/Cell size ratio=1.2"}, {"multiplier space too rich"});
  refused({"Matrix/Base depth ratio=0"}, {"Matrix/Base depth ratio"});
  refused({"Matrix/Base depth ratio=0.1"}, {"wider than the base"});
  refused({"Matrix/Stiffness contrast=0"}, {"Matrix/Stiffness contrast", "> 0"});
  refused({"Matrix/Breakable=true"}, {"Matrix/Breakable", "break in the first step"});
  refused({"Layer/Representation=continuum", "Matrix/Representation=grains"},
          {"Matrix/Representation", "does not exist"});
  refused({"Layer/Flat joint/Tensile strength=5e8"},
          {"Tensile strength", "4.269e+08 Pa"});
  refused({"Run/End shortening=0.03"}, {"Run/End shortening", "Longest shortening"});
  refused({"Run/Driver=static"}, {"Run/End shortening", "does not look for a peak"});
  refused({"Run/Driver=static", "Run/End shortening=1e-3"},
          {"Run/Driver", "the layer is grains"});
}

TEST(Parameters, NamesWhatExistsForWhatDoesNotExistYet)
{
  const Scratch scratch;
  const std::string deck = scratch.write("a.prm", coupled);
  const std::string yet = "does not exist yet";
  const auto problems = problems_of(
      deck, {"Layer/Representation=manifold", "Matrix/Representation=adaptive",
             "Components=layer, matrix, walls, confinement"});
  EXPECT_TRUE(tells(problems, {"'Layer/Representation'", yet, "grains or continuum"}));
  EXPECT_TRUE(tells(problems, {"'Matrix/Representation'", yet, "continuum or grains"}));
  EXPECT_TRUE(tells(problems, {"'confinement'", "does not exist", "surface pressure"}));
}

TEST(Parameters, ReadsOnlyTheSectionsOfListedComponents)
{
  const Scratch scratch;
  const std::string deck =
      scratch.write("a.prm", "set Components = layer, walls\n"
                             "subsection Gravity\nset Acceleration = wrong\nend\n"
                             "subsection Damping\nset Nonsense = 1\nend\n"
                             "subsection Bridging domain\nset Ramp = 3\nend\n");
  EXPECT_TRUE(problems_of(deck).empty());
  const std::string effective = effective_deck(read_deck(deck, {}));
  EXPECT_EQ(effective.find("Gravity"), std::string::npos);
  EXPECT_EQ(effective.find("subsection Matrix"), std::string::npos);
  EXPECT_NE(effective.find("subsection Layer"), std::string::npos);
  EXPECT_TRUE(
      tells(problems_of(deck, {"Components=layer, walls, damping"}),
            {deck + ":6:", "Damping/Nonsense", "Entries here: Form, Coefficient"}));
}

TEST(Parameters, TheLastSetWinsAndTheCommandLineIsLast)
{
  const Scratch scratch;
  scratch.write("rock.prm", "subsection Layer\nset Thickness = 1\nset Seed = 1\nend\n");
  const std::string deck =
      scratch.write("a.prm", coupled + "include rock.prm\nsubsection Layer\n"
                                       "set Thickness = 3\nend\n");
  EXPECT_EQ(read_deck(deck, {}).layer.thickness, 3.);
  EXPECT_EQ(read_deck(deck, {}).layer.seed, 1);
  const Parameters p =
      read_deck(deck, {"Layer/Thickness=4", "Layer/Thickness = 5.6e1",
                       "Layer/Flat joint/Elements=2", "Title=of the command line"});
  EXPECT_EQ(p.layer.thickness, 56.);
  EXPECT_EQ(p.layer.joint.n_elements, 2);
  EXPECT_EQ(p.title, "of the command line");
}

TEST(Parameters, ChecksTheCommandLineLikeTheDeck)
{
  const Scratch scratch;
  const std::string deck = scratch.write("a.prm", coupled);
  const auto problems = problems_of(deck, {"Layer/Thickness=thick", "Layer/Thicknes=3",
                                           "Layers/Seed=3", "Seed=3", "nothing"});
  EXPECT_TRUE(tells(problems, {"--set", "Layer/Thickness", "'thick'", "not a number"}));
  EXPECT_TRUE(
      tells(problems, {"--set \"Layer/Thicknes=3\"", "Did you mean 'Thickness'?"}));
  EXPECT_TRUE(tells(problems, {"--set \"Layers/Seed=3\"", "Did you mean 'Layer'?"}));
  EXPECT_TRUE(tells(problems, {"--set \"Seed=3\"", "There is 'Layer/Seed'"}));
  EXPECT_TRUE(tells(problems, {"--set \"nothing\"", "Section/Entry=value"}));
  EXPECT_EQ(problems.size(), 5u);
}

TEST(Parameters, RefusesNumbersThatAreNone)
{
  const Scratch scratch;
  const std::string deck = scratch.write("a.prm", coupled);
  for (const std::string value : {"", "nan", "inf", "1e999", "10 m", "1,5", "0x10", "1e"})
    EXPECT_TRUE(tells(problems_of(deck, {"Layer/Thickness=" + value}),
                      {"'Layer/Thickness' = '" + value + "'", "not a number"}));
  for (const std::string value : {"2.5", "99999999999"})
    EXPECT_TRUE(tells(problems_of(deck, {"Layer/Seed=" + value}), {"Layer/Seed"}));
  EXPECT_EQ(
      read_deck(deck, {"Matrix/Stiffness contrast=+1.5E3"}).matrix.stiffness_contrast,
      1500.);
}

TEST(Parameters, RefusesModuliAndStiffnessRatiosThatNoRockHas)
{
  const Scratch scratch;
  const std::string deck = scratch.write("a.prm", coupled);
  const std::string bonds = "Layer/Flat joint/Effective modulus",
                    ratio = "Layer/Flat joint/Stiffness ratio";
  // In GPa both, as which they belong together.
  const auto problems =
      problems_of(deck, {"Layer/Young modulus=56", bonds + "=50", "Layer/UCS=162"});
  EXPECT_TRUE(tells(problems, {"--set", "'Layer/Young modulus' = '56'",
                               "Give a number >= 1e+06 and <= 1e+12 [Pa]"}));
  EXPECT_TRUE(tells(problems, {"'" + bonds + "' = '50'", ">= 1e+06", "[Pa]"}));
  EXPECT_TRUE(tells(problems, {"'Layer/UCS' = '162'", ">= 10000", "[Pa]"}));
  EXPECT_EQ(problems.size(), 3u);
  for (const std::string value : {"1e-9", "0.09", "1e3"})
    EXPECT_TRUE(tells(problems_of(deck, {ratio + "=" + value}),
                      {"'" + ratio + "' = '" + value + "'", ">= 0.1 and <= 100"}));
  // Clay and diamond.
  EXPECT_TRUE(problems_of(deck, {"Layer/Young modulus=2e6", bonds + "=1e6",
                                 "Layer/UCS=1e4"})
                  .empty());
  EXPECT_TRUE(problems_of(deck, {"Layer/Young modulus=1e12", bonds + "=1e12"}).empty());
}

TEST(Parameters, BareLayerOfFiniteElementsHasTheMeshOfTheMatrixSection)
{
  const Scratch scratch;
  const std::string deck = scratch.write(
      "a.prm", "set Components = layer, walls\nsubsection Layer\nset Representation = "
               "continuum\nend\nsubsection Matrix\nset Burial depth ratio = 5\n"
               "set Cell size ratio = 0.5\nend\nsubsection Run\nset Driver = static\n"
               "set End shortening = 1e-3\nend\n");
  const Parameters p =
      read_deck(deck, {"Matrix/Element degree=2", "Matrix/Cell aspect ratio=3"});
  EXPECT_EQ(p.matrix.cell_size, 0.5);
  EXPECT_EQ(p.matrix.element_degree, 2);
  EXPECT_EQ(p.matrix.cell_aspect, 3.);
  const std::string effective = effective_deck(p);
  EXPECT_EQ(effective.find("Burial depth ratio"), std::string::npos);
  const Parameters again = read_deck(scratch.write("deck.prm", effective), {});
  EXPECT_EQ(again.matrix.cell_size, 0.5);
  EXPECT_EQ(again.matrix.element_degree, 2);
  EXPECT_EQ(effective_deck(again), effective);
  // What is of the matrix alone is of no use here, nor is any of it to bare grains.
  for (const char *entry : {"Matrix/Burial depth ratio=3", "Matrix/Largest cell ratio=9",
                            "Matrix/Stiffness contrast=10"})
    EXPECT_TRUE(tells(problems_of(deck, {entry}),
                      {std::string("--set \"") + entry, "no use for", "Element degree"}));
  EXPECT_TRUE(tells(problems_of(deck, {"Layer/Representation=grains",
                                       "Run/Driver=dynamic", "Matrix/Element degree=2"}),
                    {"no use for 'Matrix'"}));
}

TEST(Parameters, EffectiveDeckGivesTheSameParametersToTheLastBit)
{
  const Scratch scratch;
  for (const std::string &name : all_decks)
  {
    // Values whose decimal text is long, an angle among them (the struct has its
    // tangent).
    const Parameters p = read_deck(deck_of_repository(name),
                                   {"Layer/Thickness=10.123456789012345",
                                    "Layer/Flat joint/Friction angle=33.3333333333333357",
                                    "Layer/Flat joint/Element moment=false",
                                    "Matrix/Friction angle=0.1234567890123456",
                                    "Run/Step safety=0.70000000000000007"});
    const std::string file = scratch.write("deck.prm", effective_deck(p));
    const Parameters q = read_deck(file, {});
    EXPECT_EQ(effective_deck(q), effective_deck(p)) << name;
    EXPECT_EQ(q.components, p.components);
    EXPECT_EQ(q.layer.thickness, p.layer.thickness);
    EXPECT_EQ(q.layer.thickness, 10.123456789012345);
    EXPECT_EQ(q.layer.joint.tan_friction, p.layer.joint.tan_friction);
    EXPECT_EQ(q.layer.joint.tan_friction, std::tan(33.3333333333333357 * M_PI / 180.));
    EXPECT_FALSE(q.layer.joint.element_moment);
    EXPECT_EQ(q.matrix.tan_friction, p.matrix.tan_friction);
    EXPECT_EQ(q.run.safety, 0.70000000000000007);
    EXPECT_EQ(q.layer_length(), p.layer_length());
  }
}

TEST(Parameters, DefaultsAreThoseOfTheStructs)
{
  const Scratch scratch;
  const Parameters p = read_deck(scratch.write("a.prm", coupled), {});
  const Parameters defaults;
  EXPECT_EQ(p.layer.joint.effective_modulus, defaults.layer.joint.effective_modulus);
  EXPECT_EQ(p.layer.joint.tan_friction, defaults.layer.joint.tan_friction);
  EXPECT_EQ(p.output.fields_interval, defaults.output.fields_interval);
  EXPECT_EQ(p.matrix.poisson_ratio, defaults.matrix.poisson_ratio);
}

TEST(Parameters, LengthFollowsFromTheSlendernessRatio)
{
  // Rock 1: lambda_c = pi sqrt(56e9 / 162e6) = 58.41, L/h = 2 lambda_c / sqrt(12)
  // = 33.72.
  Parameters p;
  p.components = {"layer"};
  EXPECT_NEAR(p.layer_length() / p.layer.thickness, 33.72, 0.005);
  EXPECT_NEAR(p.section_length() / p.layer_length(), 1.23, 1e-12);
  // Slenderness 1: Euler stress of a pinned column is the UCS.
  p.layer.slenderness_ratio = 1.;
  p.layer.shape = "straight";
  EXPECT_EQ(p.section_length(), p.layer_length());
  const double slenderness = std::sqrt(12.) * p.layer_length() / p.layer.thickness;
  EXPECT_NEAR(M_PI * M_PI * p.layer.young_modulus / (slenderness * slenderness),
              p.layer.compressive_strength,
              1e-6 * p.layer.compressive_strength); // rounding
  p.layer.length_ratio = 8.;
  EXPECT_EQ(p.layer_length(), 80.);
  EXPECT_EQ(p.grain_diameter(), 10. / 12.);
  EXPECT_NEAR(p.matrix_modulus(), 5.6e6, 1e-6);
}

TEST(Parameters, RockOneIsThatOfItsSource)
{
  // Gioiello 2018, Table 4.3.
  const auto &layer =
      read_deck(deck_of_repository("burial-depth/anticline.prm"), {}).layer;
  EXPECT_EQ(layer.joint.effective_modulus, 50e9);
  EXPECT_EQ(layer.joint.stiffness_ratio, 2.2);
  EXPECT_EQ(layer.joint.tensile_strength, 15e6);
  EXPECT_EQ(layer.joint.cohesion, 60e6);
  EXPECT_NEAR(layer.joint.tan_friction, std::tan(8. * M_PI / 180.), 1e-15);
  EXPECT_EQ(layer.joint.residual_friction, 0.4);
  EXPECT_EQ(layer.joint.n_elements, 3);
  EXPECT_EQ(layer.grain_density, 2500.);
  EXPECT_EQ(layer.radius_ratio, 1.66);
  EXPECT_EQ(layer.young_modulus, 56e9);
  EXPECT_EQ(layer.compressive_strength, 162e6);
}

TEST(Parameters, DecksAreAcceptedInBothRepresentations)
{
  for (const std::string &name : all_decks)
    for (const std::string representation : {"continuum", "grains"})
    {
      const auto problems = problems_of(deck_of_repository(name),
                                        {"Matrix/Representation=" + representation});
      EXPECT_TRUE(problems.empty()) << name << "\n" << problems.front();
    }
}

TEST(Parameters, DescriptionSuggestsWhenNothingMatches)
{
  EXPECT_NE(describe_parameters("overlap").find("Bridging domain/Overlap width ratio"),
            std::string::npos);
  EXPECT_EQ(describe_parameters("overlap").find("Layer/Seed"), std::string::npos);
  try
  {
    describe_parameters("overlep");
    FAIL() << "accepted";
  }
  catch (const InputError &error)
  {
    EXPECT_NE(std::string(error.what()).find("Did you mean 'Overlap'?"),
              std::string::npos)
        << error.what();
  }
}

TEST(Parameters, PageOfTheDocumentationIsUpToDate)
{
  const std::string page = read(std::string(ANTIFORM_SOURCE_DIR) + "/docs/parameters.md");
  EXPECT_EQ(page, parameters_markdown())
      << "run: build/antiform parameters --markdown > docs/parameters.md";
}

TEST(Parameters, WhatIsSetOnTheCommandLineMustBeOfUse)
{
  const Scratch scratch;
  const std::string deck =
      scratch.write("deck.prm", coupled + "subsection Gravity\n"
                                          "  set Acceleration = 5\nend\n");
  EXPECT_NO_THROW(read_deck(deck, {})); // a deck may hold what another scene needs
  try
  {
    read_deck(deck, {"Gravity/Acceleration=5"});
    FAIL() << "taken, and without effect";
  }
  catch (const InputError &error)
  {
    EXPECT_TRUE(
        tells(error.problems(), {"--set", "no use for 'Gravity'", "component gravity"}));
  }
}
} // namespace parameters_tests

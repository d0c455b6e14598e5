// What a deck asks of a calibration, and what is refused.
#include "cases/calibrate.h"
#include "cases/calibration_problem.h"
#include "cases/declarations.h"
#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace calibration_problem_tests
{
using namespace antiform::cases;

namespace
{
const std::string folder = ANTIFORM_SOURCE_DIR "/cases/laboratory/";
const std::string rock_1 = folder + "calibrate-rock-1.prm";
const std::string rock_2 = folder + "calibrate-rock-2.prm";

/// Is there exactly one problem, and does it hold all of these?
void expect_problem(const std::vector<std::string> &overrides,
                    const std::vector<std::string> &parts,
                    const std::string &deck = rock_1)
{
  const std::vector<std::string> problems = problems_of(deck, overrides);
  ASSERT_EQ(problems.size(), 1u) << overrides.front();
  for (const std::string &part : parts)
    EXPECT_NE(problems[0].find(part), std::string::npos)
        << part << " is not in: " << problems[0];
}
} // namespace

TEST(CalibrationProblem, HasTheTargetsOfTheDecks)
{
  // Of the appendix' Hoek-Brown lines, as printed with four digits.
  const struct
  {
    std::string deck;
    std::vector<double> values;
  } decks[] = {{rock_1, {56e9, 11.7e6, 154.9e6, 220.8e6, 274.7e6}},
               {rock_2, {21.9e9, 2.04e6, 45.3e6, 120.1e6, 168.9e6}}};
  for (const auto &deck : decks)
  {
    const CalibrationProblem problem = calibration_problem(read_deck(deck.deck, {}));
    ASSERT_EQ(problem.targets.size(), deck.values.size());
    for (std::size_t i = 0; i < deck.values.size(); ++i)
      EXPECT_NEAR(problem.targets[i].value / deck.values[i], 1., 1.5e-3)
          << problem.targets[i].name;
    EXPECT_EQ(problem.free.size(), 4u);
    EXPECT_EQ(tests_of(problem.targets).size(), 5u);
  }
}

TEST(CalibrationProblem, MeasuresModulusAndStrengthInOneTestIfAsked)
{
  const CalibrationProblem problem =
      calibration_problem(read_deck(rock_1, {"Calibration/Modulus from=uniaxial"}));
  EXPECT_EQ(tests_of(problem.targets).size(), 4u);
}

TEST(CalibrationProblem, TakesTheSameTargetsFromTheTable)
{
  const auto typed = calibration_problem(read_deck(rock_1, {})).targets;
  const auto fitted =
      calibration_problem(
          read_deck(rock_1, {"Calibration/Laboratory data=" + folder + "limestones.csv",
                             "Calibration/Site=Pelasgia", "Calibration/UCS=0",
                             "Calibration/Tensile strength=0", "Calibration/Strengths="}))
          .targets;
  ASSERT_EQ(typed.size(), fitted.size());
  for (std::size_t i = 0; i < typed.size(); ++i) // typed with three or four digits
    EXPECT_NEAR(typed[i].value / fitted[i].value, 1., 3e-3) << typed[i].name;
}

TEST(CalibrationProblem, RefusesBadDecksWithARemedy)
{
  expect_problem({"Calibration/Young modulus=0"},
                 {"Calibration/Young modulus", "missing", "effective modulus"});
  expect_problem({"Calibration/UCS=-3e6"}, {"Calibration/UCS", "'-3e6'", ">= 0", "[Pa]"});
  expect_problem({"Calibration/Strengths=220.8e6"},
                 {"Calibration/Strengths", "1 strengths for 2 confinements"});
  expect_problem({"Calibration/Strengths=220.8e6, lots"},
                 {"Calibration/Strengths", "lots", "numbers > 0"});
  expect_problem({"Calibration/Strengths=274.7e6, 220.8e6"},
                 {"Calibration/Strengths", "rising order"});
  expect_problem({"Calibration/Tensile strength=200e6"},
                 {"Calibration/UCS", "not above the tensile strength"});
  expect_problem({"Calibration/Free=cohesion, friktion angle"},
                 {"Calibration/Free", "Did you mean 'friction angle'?"});
  expect_problem({"Calibration/Free=cohesion, cohesion"}, {"Calibration/Free", "twice"});
  expect_problem({"Calibration/Friction angle bounds=40, 20"},
                 {"Calibration/Friction angle bounds", "two numbers"});
  expect_problem({"Components=layer, walls, damping, calibration"},
                 {"Components", "servo walls"});
  expect_problem({"Calibration/Laboratory data=nowhere.csv"},
                 {"Calibration/Laboratory data", "nowhere.csv", "cannot be opened"});
  expect_problem({"Walls/Grip layers=28"},
                 {"Walls/Grip layers", "at least 5", "tension"});
  expect_problem({"Calibration/Site=Rapsomaty"}, {"Rapsomaty", "Pelasgia, Rapsomati"},
                 rock_2);
  expect_problem({"Calibration/Free=cohesion, friction angle, slit fraction, tensile "
                  "strength, effective modulus, residual friction"},
                 {"Calibration/Free", "6 free micro-parameters for 5 targets"});
}

TEST(CalibrationProblem, RefusesTheWrongCommand)
{
  EXPECT_THROW(demand_calibration(read_deck(rock_1, {}), false), InputError);
  EXPECT_THROW(demand_calibration(read_deck(folder + "uniaxial.prm", {}), true),
               InputError);
  EXPECT_NO_THROW(demand_calibration(read_deck(rock_1, {}), true));
}

TEST(Trial, DecksDifferOnlyInTheTest)
{
  const Parameters deck = read_deck(rock_1, {});
  const MicroParameters micro{50e9, 14e6, 60e6, 12., 0.4, 0.};
  const auto make = [&](const antiform::cases::Test &test) {
    return deck_of({test, 7, micro}, deck);
  };
  const Parameters tension = make({antiform::cases::Test::Kind::tension, 0.}),
                   confined = make({antiform::cases::Test::Kind::compression, 20e6}),
                   uniaxial = make({antiform::cases::Test::Kind::compression, 0.}),
                   elastic = make({antiform::cases::Test::Kind::elastic, 0.});
  for (const Parameters &p : {tension, confined, uniaxial, elastic})
  {
    EXPECT_TRUE(check_parameters(p).empty());
    EXPECT_FALSE(p.has("calibration"));
    EXPECT_EQ(p.layer.seed, 7);
    EXPECT_EQ(micro_parameters_of(p.layer).friction_angle, 12.);
    EXPECT_EQ(p.layer.joint.cohesion, 60e6);
  }
  EXPECT_EQ(tension.walls.action, "pull");
  EXPECT_FALSE(tension.has("servo walls"));
  EXPECT_FALSE(uniaxial.has("servo walls"));
  EXPECT_EQ(confined.servo_walls.pressure, 20e6);
  EXPECT_FALSE(elastic.layer.joint.breakable);
  // The name tells apart what the deck tells apart.
  EXPECT_NE(trial_name({{}, 7, micro}, confined), trial_name({{}, 7, micro}, uniaxial));
  EXPECT_EQ(trial_name({{}, 7, micro}, confined), trial_name({{}, 7, micro}, confined));
}

TEST(RockFile, ReadsBackAsTheRockThatWasFound)
{
  const Parameters deck = read_deck(rock_2, {});
  const CalibrationProblem problem = calibration_problem(deck);
  CalibrationResult result;
  result.micro = {19.87e9, 2.451e6, 17.93e6, 12.34, 0.3, 0.};
  result.rounds = 1;
  result.met = true;
  result.check = {"check", result.micro, {4, 5}, {}};
  for (const Target &target : problem.targets)
  {
    result.expected.push_back(target.value);
    result.check.results.push_back({0.99 * target.value, 1.01 * target.value});
  }
  const Scratch scratch;
  scratch.write("rock.prm", rock_file(deck, problem, result, "2026-01-02"));
  const Parameters read =
      read_deck(scratch.write("deck.prm", "set Components = layer, walls\n"
                                          "include rock.prm\nsubsection Layer\n"
                                          "set Shape = straight\n"
                                          "set Length ratio = 2\nend\n"),
                {});
  const MicroParameters micro = micro_parameters_of(read.layer);
  for (const MicroName &name : micro_names())
    EXPECT_EQ(micro.*name.value, result.micro.*name.value) << name.name;
  EXPECT_EQ(read.layer.young_modulus, 21.9e9);
  EXPECT_EQ(read.layer.installation_gap, deck.layer.installation_gap);
  EXPECT_EQ(read.layer.joint.stiffness_ratio, 2.6);
  EXPECT_EQ(read.layer.joint.radius_multiplier, deck.layer.joint.radius_multiplier);
}
} // namespace calibration_problem_tests

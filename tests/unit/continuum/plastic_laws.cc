// Plastic laws at a point: derivatives, turned axes, refusals.
#include "continuum/plastic_laws.h"
#include "continuum/errors.h"
#include "support/material_point.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace plastic_laws_tests
{
using namespace antiform::continuum;
using namespace antiform::test;
using Match = DruckerPragerParameters::Match;

namespace
{
constexpr double cohesion = 10e6, friction = 0.6;
const auto rock = LameConstants::from_young_poisson(20e9, 0.25);
constexpr double oedometer = 24e9;
const double apex = cohesion / std::tan(friction);

struct Case
{
  std::string name;
  std::unique_ptr<MaterialLaw> law;
};

std::vector<Case> mohr_coulomb_laws()
{
  std::vector<Case> laws;
  const auto add = [&](const std::string &name, const MohrCoulombParameters &parameters) {
    laws.push_back({name, std::make_unique<MohrCoulomb>(rock, parameters)});
  };
  add("associated", {cohesion, friction, friction, {}});
  add("own dilation", {cohesion, friction, 0.2, {}});
  add("isochoric", {cohesion, friction, 0., {}});
  add("associated, cut off", {cohesion, friction, friction, 0.3 * apex});
  add("isochoric, cut off", {cohesion, friction, 0., 0.3 * apex});
  add("no tension", {cohesion, friction, 0.2, 0.});
  add("no friction", {cohesion, 0., 0., {}});
  return laws;
}

std::vector<Case> drucker_prager_laws()
{
  std::vector<Case> laws;
  for (const auto &[name, match] :
       {std::pair{"outer", Match::outer},
        {"inner", Match::inner},
        {"plane strain, associated", Match::plane_strain_associated},
        {"plane strain, isochoric", Match::plane_strain_isochoric}})
    for (const double dilation : {0., 0.3, friction})
      laws.push_back(
          {std::string(name) + ", psi " + std::to_string(dilation),
           std::make_unique<DruckerPrager>(
               rock, DruckerPragerParameters{cohesion, friction, dilation, match})});
  return laws;
}

/// A state with a trial stress of 1e-2 to 10 cohesions about the tensile end.
struct State
{
  PointInput input;
  std::vector<double> history;
};
State random_state(Dice &dice)
{
  State state;
  const double size = 0.5e-3 * std::pow(10., dice(-2., 1.5));
  const auto draw = [&] { return dice(-size, size); };
  state.input.strain = {draw(), draw(), 2. * draw()};
  state.history = {draw(), draw(), draw(), draw()};
  const double mean = apex * dice(-2., 1.) + 20e9 * size * dice(-1., 1.);
  state.input.initial = {mean + dice(-1., 1.) * cohesion, mean + dice(-1., 1.) * cohesion,
                         mean + dice(-1., 1.) * cohesion, dice(-1., 1.) * cohesion};
  return state;
}

PointResponse respond(const MaterialLaw &law, const State &state)
{
  std::vector<double> end(state.history.size());
  return law.respond(state.input, state.history.data(), end.data());
}

/// How many principal stresses are equal, and which of them is zz: what decides how the
/// tangent is put together.
std::string arrangement(const PointStress &s)
{
  const auto p = principal(s);
  const double near = 1e-6 * cohesion;
  std::string text = std::abs(p[0] - p[1]) < near ? "I=II" : "I II";
  text += std::abs(p[1] - p[2]) < near ? "=III" : " III";
  int place = 0;
  while (p[place] != s.zz)
    ++place;
  return text + ", zz " + std::to_string(place + 1);
}
} // namespace

TEST(MohrCoulombLaw, TangentIsTheDerivative)
{
  Dice dice(1);
  double worst = 0.;
  std::map<std::string, int> count;
  for (const Case &one : mohr_coulomb_laws())
    for (int n = 0; n < 4000; ++n)
    {
      const State state = random_state(dice);
      // A step of 24 Pa: the round-off of 1e8 Pa is 1e-9 of it, and hardly any state is
      // so near to the border of a region that the step crosses it.
      const double error =
          tangent_error(*one.law, state.input, state.history, 1e-9, oedometer);
      worst = std::max(worst, error);
      EXPECT_LT(error, 1e-6) << one.name << ", " << n << ": "
                             << arrangement(respond(*one.law, state).stress);
      std::vector<double> end(4);
      const auto response =
          one.law->respond(state.input, state.history.data(), end.data());
      if (end != state.history)
        ++count[arrangement(response.stress)];
    }
  RecordProperty("worst_of_1e-12", static_cast<int>(worst * 1e12));
  // Plane or cut-off with zz greatest, between, least; edges with zz tied or not; points.
  for (const char *name :
       {"I II III, zz 1", "I II III, zz 2", "I II III, zz 3", "I=II III, zz 1",
        "I=II III, zz 3", "I II=III, zz 1", "I II=III, zz 2", "I=II=III, zz 1"})
    EXPECT_GT(count[name], 50) << name;
}

TEST(DruckerPragerLaw, TangentIsTheDerivative)
{
  Dice dice(2);
  double worst = 0.;
  int n_cone = 0, n_apex = 0, n_elastic = 0;
  for (const Case &one : drucker_prager_laws())
    for (int n = 0; n < 4000; ++n)
    {
      const State state = random_state(dice);
      const double error =
          tangent_error(*one.law, state.input, state.history, 1e-9, oedometer);
      worst = std::max(worst, error);
      EXPECT_LT(error, 1e-6) << one.name << ", " << n;
      std::vector<double> end(4);
      const auto response =
          one.law->respond(state.input, state.history.data(), end.data());
      const auto p = principal(response.stress);
      ++(end == state.history ? n_elastic : p[0] - p[2] == 0. ? n_apex : n_cone);
    }
  RecordProperty("worst_of_1e-12", static_cast<int>(worst * 1e12));
  for (const int n : {n_cone, n_apex, n_elastic})
    EXPECT_GT(n, 1000);
}

TEST(PlasticLaws, TangentIsSymmetricIfTheFlowIsAssociated)
{
  Dice dice(3);
  for (const auto &laws : {std::function(mohr_coulomb_laws), {drucker_prager_laws}})
    for (const Case &one : laws())
    {
      double worst = 0.;
      for (int n = 0; n < 1000; ++n)
      {
        const auto tangent = respond(*one.law, random_state(dice)).tangent;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < i; ++j)
            worst = std::max(worst, std::abs(tangent[i][j] - tangent[j][i]));
      }
      if (one.law->has_symmetric_tangent())
        EXPECT_LT(worst, 1e-13 * oedometer) << one.name;
      else
        EXPECT_GT(worst, 1e-3 * oedometer) << one.name;
    }
  EXPECT_TRUE(MohrCoulomb(rock, {1., 0.5, 0.5, 0.1}).has_symmetric_tangent());
  EXPECT_FALSE(MohrCoulomb(rock, {1., 0.5, 0.4, {}}).has_symmetric_tangent());
}

TEST(PlasticLaws, StressTurnsWithTheStrain)
{
  Dice dice(4);
  double worst = 0.;
  for (const auto &laws : {std::function(mohr_coulomb_laws), {drucker_prager_laws}})
    for (const Case &one : laws())
      for (int n = 0; n < 300; ++n)
      {
        const State state = random_state(dice);
        State other = state;
        // A quarter turn swaps the axes, half of one mirrors the shear.
        const double angle = n % 3 == 0 ? M_PI / 2. : dice(0., 2. * M_PI);
        other.input.strain = turned(state.input.strain, angle);
        other.input.initial = turned(state.input.initial, angle);
        const PlaneVector plastic = turned(
            PlaneVector{state.history[0], state.history[1], state.history[3]}, angle);
        other.history = {plastic[0], plastic[1], state.history[2], plastic[2]};
        const PointStress s = respond(*one.law, state).stress;
        const PointStress t = respond(*one.law, other).stress;
        worst = std::max(worst, distance(turned(s, angle), t));
      }
  EXPECT_LT(worst, 1e-12 * 1e9); // stresses of up to 1 GPa
}

TEST(PlasticLaws, SwappedAxesSwapTheTangent)
{
  Dice dice(5);
  for (const auto &laws : {std::function(mohr_coulomb_laws), {drucker_prager_laws}})
    for (const Case &one : laws())
      for (int n = 0; n < 300; ++n)
      {
        State state = random_state(dice);
        if (n % 2 == 0) // axes of the trial stress along x and y
          state.input.strain[2] = state.history[3] = state.input.initial.xy = 0.;
        State other = state;
        std::swap(other.input.strain[0], other.input.strain[1]);
        std::swap(other.input.initial.xx, other.input.initial.yy);
        std::swap(other.history[0], other.history[1]);
        const auto a = respond(*one.law, state), b = respond(*one.law, other);
        const int mirror[] = {1, 0, 2};
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(a.tangent[i][j], b.tangent[mirror[i]][mirror[j]],
                        1e-11 * oedometer);
        EXPECT_LT(
            distance({a.stress.yy, a.stress.xx, a.stress.zz, a.stress.xy}, b.stress),
            1e-12 * 1e9);
      }
}

TEST(PlasticLaws, RoundStressInThePlaneHasATangent)
{
  // Equal or nearly equal stretches: the axes of the stress mean nothing. Shear then
  // keeps its stiffness where zz alone yields, and has none where the surface ties both
  // stresses of the plane to each other.
  struct Round
  {
    const char *name;
    double strain, initial_zz, shear_stiffness;
  };
  const MohrCoulomb law(rock, {cohesion, friction, 0.2, 0.3 * apex});
  const std::vector<double> still(4, 0.);
  std::vector<double> end(4);
  for (const Round &round : {Round{"zz cut off", 0., 5. * cohesion, rock.mu},
                             {"all cut off", 5e-3, 0., 0.},
                             {"xx and yy cut off", 1e-3, -3. * cohesion, 0.},
                             {"edge, zz the greatest", -5e-3, 5. * cohesion, 0.},
                             {"edge, zz the least", 1e-4, -20. * cohesion, 0.}})
    for (const double uneven : {0., 1e-18, 1e-16, 1e-14, 1e-12})
    {
      PointInput input;
      input.strain = {round.strain + uneven, round.strain, 0.3 * uneven};
      input.initial.zz = round.initial_zz;
      const PointResponse response = law.respond(input, still.data(), end.data());
      EXPECT_NE(end, still) << round.name;
      EXPECT_NEAR(response.tangent[2][2], round.shear_stiffness, 1e-12 * rock.mu)
          << round.name << ", " << uneven;
      EXPECT_LT(tangent_error(law, input, still, 1e-9, oedometer), 1e-6) << round.name;
    }
}

TEST(PlasticLaws, UnloadingIsElastic)
{
  const LinearElastic elastic(rock);
  for (const auto &laws : {std::function(mohr_coulomb_laws), {drucker_prager_laws}})
    for (const Case &one : laws())
    {
      MaterialPoint point(*one.law);
      const PointStress top = point.move({-8e-3, 2e-3, 3e-3}).stress;
      const std::vector<double> plastic = point.history;
      EXPECT_NE(plastic[0], 0.) << one.name;
      const PlaneVector back{4e-4, -1e-4, -1.5e-4};
      const PointResponse response = point.move(back);
      EXPECT_EQ(point.history, plastic) << one.name;
      PointInput input;
      input.strain = back;
      const auto hooke = elastic.respond(input, nullptr, nullptr);
      const PointStress &s = response.stress;
      EXPECT_LT(distance({s.xx - top.xx, s.yy - top.yy, s.zz - top.zz, s.xy - top.xy},
                         hooke.stress),
                1e-12 * 1e9)
          << one.name;
      EXPECT_EQ(response.tangent, hooke.tangent) << one.name;
    }
}

TEST(PlasticLaws, RefuseParametersOutOfRange)
{
  const auto mohr = [](const MohrCoulombParameters &p) { MohrCoulomb(rock, p); };
  EXPECT_THROW(mohr({-1., 0.5, 0., {}}), std::invalid_argument);
  EXPECT_THROW(mohr({0., 0., 0., {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., -0.1, 0., {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., M_PI / 2., 0., {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., 0.5, 0.6, {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., 0.5, -0.1, {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., NAN, 0., {}}), std::invalid_argument);
  EXPECT_THROW(mohr({1., 0.5, 0., -0.1}), std::invalid_argument);
  EXPECT_THROW(mohr({1., 0.5, 0., 1.001 / std::tan(0.5)}), std::invalid_argument);
  EXPECT_NO_THROW(mohr({1., 0.5, 0., 1. / std::tan(0.5)}));
  EXPECT_NO_THROW(mohr({0., 0.5, 0.5, 0.}));
  EXPECT_THROW(DruckerPrager(rock, {-1., 0.5, 0., Match::outer}), std::invalid_argument);
  EXPECT_THROW(DruckerPrager(rock, {1., 0.5, 0.6, Match::inner}), std::invalid_argument);
  try
  {
    mohr({1e6, 0.5, 0.75, {}});
  }
  catch (const std::invalid_argument &error)
  {
    EXPECT_STREQ(error.what(), "Dilation angle is 0.75 rad; it must be >= 0 and at most "
                               "the friction angle.");
  }
}

TEST(PlasticLaws, RefuseStrainThatIsNotANumber)
{
  PointInput input;
  input.strain = {NAN, 0., 0.};
  const double begin[4] = {};
  double end[4];
  for (const auto &laws : {std::function(mohr_coulomb_laws), {drucker_prager_laws}})
    for (const Case &one : laws())
      EXPECT_THROW(one.law->respond(input, begin, end), antiform::NumericalError)
          << one.name;
}
} // namespace plastic_laws_tests

#include "cases/accuracy.h"

#include "cases/declarations.h"
#include "cases/parameters.h"
#include "unit/cases/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace accuracy_tests
{
using namespace antiform::cases;

namespace
{
const double e = std::exp(1.);

/// Errors in hundredths, each row e times as long as the one before.
AccuracyCurve curve(const std::vector<double> &errors)
{
  AccuracyCurve result;
  double seconds = 1.;
  for (std::size_t k = 0; k < errors.size(); ++k, seconds *= e)
    result.rows.push_back({exact_text(std::pow(10., k)), 0.01 * errors[k], seconds});
  return result;
}

using Rows = std::vector<std::size_t>;

const std::string specimen = "set Components = layer, walls, damping\n"
                             "subsection Layer\n"
                             "  set Shape        = straight\n"
                             "  set Length ratio = 2\n"
                             "end\n";
const std::string buried = "set Components = layer, matrix, walls\n"
                           "subsection Layer\n"
                           "  set Shape        = straight\n"
                           "  set Length ratio = 4\n"
                           "end\n"
                           "subsection Matrix\n"
                           "  set Burial depth ratio = 5\n"
                           "  set Base depth ratio   = 5\n"
                           "end\n"
                           "subsection Run\n"
                           "  set Driver = buckling\n"
                           "end\n";

const std::string bent = "set Components = layer, walls, damping\n"
                         "subsection Layer\n"
                         "  set Shape        = cosine\n"
                         "  set Length ratio = 12\n"
                         "end\n";
const std::string rate = "Walls/Transits per millistrain";

const AccuracySetting *find(const AccuracyPlan &plan, const std::string &entry)
{
  const auto found = std::find_if(plan.settings.begin(), plan.settings.end(),
                                  [&](const AccuracySetting &setting)
                                  { return setting.entry == entry; });
  return found == plan.settings.end() ? nullptr : &*found;
}

/// What this deck is refused for when it wants @p accuracy.
std::string refusal(const std::string &deck, const std::string &accuracy)
{
  const std::vector<std::string> problems = problems_of(deck, {"Accuracy=" + accuracy});
  return problems.empty() ? "" : problems.front();
}

/// The smallest error that @p deck may want [%], as the program says it.
double smallest(const std::string &deck)
{
  const std::string text = refusal(deck, "1e-6 %"), before = "possible is ";
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << text;
  return std::stod(text.substr(at + before.size()));
}
} // namespace

// 8 + 6: the first curve gains 5 a step at first, the second 2, so it goes first.
TEST(Accuracy, RefinesFirstWhatGainsMostForItsTime)
{
  const std::vector<AccuracyCurve> curves = {curve({8., 3., 1.}), curve({6., 4., 3.})};
  EXPECT_EQ(choose_rows(curves, 0.14), (Rows{0, 0}));
  EXPECT_EQ(choose_rows(curves, 0.139), (Rows{1, 0}));
  EXPECT_EQ(choose_rows(curves, 0.0899), (Rows{2, 0})); // 2 and 2: the first in order
  EXPECT_EQ(choose_rows(curves, 0.0699), (Rows{2, 1}));
  EXPECT_EQ(choose_rows(curves, 0.0401), (Rows{2, 2}));
  EXPECT_TRUE(choose_rows(curves, 0.0399).empty());
}

// A row that is dearer and no nearer is never the end of a way.
TEST(Accuracy, StepsOverRowsThatGainNothing)
{
  const std::vector<AccuracyCurve> curves = {curve({5., 5., 5., 1., 1.})};
  EXPECT_EQ(choose_rows(curves, 0.05), Rows{0});
  EXPECT_EQ(choose_rows(curves, 0.04), Rows{3});
}

TEST(Accuracy, ErrorBetweenRowsIsStraightOverTheLogarithm)
{
  const AccuracyCurve of = curve({9., 5., 1.}); // at 1, 10, 100
  EXPECT_NEAR(*error_of(of, "10"), 0.05, 1e-15);
  EXPECT_NEAR(*error_of(of, "3.1622776601683795"), 0.07, 1e-12); // half of the way
  EXPECT_FALSE(error_of(of, "0.5"));
  EXPECT_FALSE(error_of(of, "101"));
}

// Every curve of the record is one that a choice can be made from.
TEST(Accuracy, RecordFallsFromCoarseToFine)
{
  for (const char *knob :
       {"grains in bending", "grains in stiffness", "loading rate of a layer",
        "loading rate of a specimen", "balance tolerance", "load step",
        "relaxation tolerance", "cells beside grains", "overlap", "buffer",
        "bilinear cells", "quadratic cells"})
  {
    const AccuracyCurve of = accuracy_curve(knob);
    ASSERT_GE(of.rows.size(), 2u) << knob;
    for (std::size_t k = 1; k < of.rows.size(); ++k)
      EXPECT_LE(of.rows[k].error, of.rows[k - 1].error) << knob;
    for (const AccuracyCurve::Row &row : of.rows)
    {
      EXPECT_GT(row.error, 0.) << knob;
      EXPECT_LT(row.error, 1.) << knob;
      EXPECT_GT(row.seconds, 0.) << knob;
    }
  }
}

TEST(Accuracy, LessErrorIsNeverCoarser)
{
  const Scratch scratch;
  for (const auto &[name, text] :
       {std::pair{"specimen.prm", specimen}, std::pair{"buried.prm", buried}})
  {
    const std::string deck = scratch.write(name, text);
    const double least = smallest(deck);
    double across = 0., cell = 1e9, transits = 0., sum = 1e9;
    for (double percent = 60.; percent > least; percent *= 0.93)
    {
      const Parameters p = read_deck(deck, {"Accuracy=" + exact_text(percent) + " %"});
      EXPECT_GE(p.layer.grains_across, across) << percent;
      EXPECT_LE(p.matrix.cell_size, cell) << percent;
      EXPECT_GE(p.walls.transits_per_millistrain, transits) << percent;
      EXPECT_LE(100. * p.accuracy.sum_of_errors(), percent);
      EXPECT_LE(p.accuracy.sum_of_errors(), sum);
      across = p.layer.grains_across;
      cell = p.matrix.cell_size;
      transits = p.walls.transits_per_millistrain;
      sum = p.accuracy.sum_of_errors();
    }
    EXPECT_GT(across, 6.) << name; // something has been refined on the way
  }
}

// The record's smallest sum is accepted, a thousandth less is not.
TEST(Accuracy, RefusesLessThanTheRecordHas)
{
  const Scratch scratch;
  const std::string deck = scratch.write("specimen.prm", specimen);
  const double least = smallest(deck);
  EXPECT_EQ(refusal(deck, exact_text(least) + " %"), "");
  // It is rounded up to a tenth of a percent.
  const std::string text = refusal(deck, exact_text(least - 0.11) + " %");
  EXPECT_NE(text.find("'Accuracy' = '"), std::string::npos) << text;
  EXPECT_NE(text.find("smallest possible is " + short_text(least)), std::string::npos)
      << text;
}

TEST(Accuracy, EntriesOfTheDeckStay)
{
  const Scratch scratch;
  const std::string deck = scratch.write("specimen.prm", specimen);
  const std::string entry = "Layer/Grains across";
  const Parameters free = read_deck(deck, {"Accuracy=30 %"});
  ASSERT_NE(find(free.accuracy, entry), nullptr);
  EXPECT_TRUE(find(free.accuracy, entry)->is_chosen);
  EXPECT_EQ(find(free.accuracy, entry)->value, exact_text(free.layer.grains_across));

  const Parameters held = read_deck(deck, {"Accuracy=30 %", "Layer/Grains across=7"});
  EXPECT_EQ(held.layer.grains_across, 7.);
  EXPECT_FALSE(find(held.accuracy, entry)->is_chosen);
  EXPECT_TRUE(held.accuracy.warnings().empty());
  EXPECT_EQ(find(held.accuracy, entry)->value, "7");
  const std::vector<std::string> lines = accuracy_in_words(held.accuracy);
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                          [&](const std::string &line)
                          {
                            return line.find(entry) != std::string::npos &&
                                   line.find("the deck's") != std::string::npos;
                          }));
  // Of a value that no row is near nothing is known.
  const Parameters beyond = read_deck(deck, {"Accuracy=30 %", "Layer/Grains across=3"});
  EXPECT_FALSE(find(beyond.accuracy, entry)->error);
  ASSERT_EQ(beyond.accuracy.warnings().size(), 1u);
  EXPECT_NE(beyond.accuracy.warnings()[0].find("goes from 6 to 60"), std::string::npos);
}

// By record.csv, size of the error plus scatter over the root of the packings: 20 grains
// 6.992 %, 30 grains 4.564 %, so 20.86 grains 6.740 %; 200 transits 4.061 %, 300 transits
// 3.114 %, 800 transits 0.730 %.
TEST(Accuracy, ErrorsOfTheDecksEntriesCountFirst)
{
  const Scratch scratch;
  const std::string deck = scratch.write("bent.prm", bent);
  const auto with = [&](const std::string &accuracy)
  {
    return std::vector<std::string>{"Accuracy=" + accuracy, "Layer/Grains across=20.86"};
  };
  const Parameters ten = read_deck(deck, with("10 %"));
  EXPECT_EQ(ten.walls.transits_per_millistrain, 300.); // 9.85 %; 200: 10.8 %
  EXPECT_NEAR(ten.accuracy.sum_of_errors(), 0.09854, 1e-5);
  const Parameters least = read_deck(deck, with("7.5 %"));
  EXPECT_EQ(least.walls.transits_per_millistrain, 800.); // 7.47 %
  EXPECT_LE(least.accuracy.sum_of_errors(), 0.075);

  const std::vector<std::string> problems = problems_of(deck, with("7 %"));
  ASSERT_EQ(problems.size(), 1u);
  for (const char *text : {"'Layer/Grains across' = 20.86 is off by 6.7 %",
                           "smallest possible is 7.5 %",
                           "leave 'Layer/Grains across' out of the deck"})
    EXPECT_NE(problems[0].find(text), std::string::npos) << text << "\n" << problems[0];
  // What stands at its finest is not in the way.
  std::vector<std::string> slow = with("7 %");
  slow.push_back(rate + "=800");
  EXPECT_EQ(problems_of(deck, slow).at(0).find(rate), std::string::npos);
}

// Each scene against its own reference.
TEST(Accuracy, TruthIsThatOfTheScene)
{
  const auto truth = [](const double length_ratio)
  {
    return accuracy_curve("balance tolerance", length_ratio).truth;
  };
  EXPECT_NE(truth(12.).find("tolerance of 1e-4"), std::string::npos) << truth(12.);
  EXPECT_NE(truth(33.7).find("tolerance of 3e-4"), std::string::npos) << truth(33.7);
  EXPECT_TRUE(accuracy_curve("balance tolerance", 50.).rows.empty());
}

// A long layer bends more slowly than the one that its rate has been measured of; how a
// straight one buckles between walls has not been measured.
TEST(Accuracy, ChoosesNoRateForLayersMoreSlenderThanTheRecord)
{
  const Scratch scratch;
  for (const std::string &text : {bent, specimen})
  {
    const std::vector<std::string> wish = {"Accuracy=30 %", "Layer/Length ratio=50"};
    const Parameters p = read_deck(scratch.write("long.prm", text), wish);
    const AccuracySetting *setting = find(p.accuracy, rate);
    ASSERT_NE(setting, nullptr);
    EXPECT_FALSE(setting->is_chosen);
    EXPECT_FALSE(setting->error);
    EXPECT_EQ(p.walls.transits_per_millistrain, 300.); // the default
    EXPECT_TRUE(find(p.accuracy, "Layer/Grains across")->is_chosen);
    ASSERT_EQ(p.accuracy.warnings().size(), 1u);
    EXPECT_NE(p.accuracy.warnings()[0].find("L/h = 50"), std::string::npos);
    const std::vector<std::string> lines = accuracy_in_words(p.accuracy);
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                            [](const std::string &line)
                            { return line.find("warning: '" + rate) != line.npos; }));
  }
}

// cases/shortening/README.md, L/h = 33.7, 10.43 grains across: 31.24 MPa at 282 transits,
// 26.36 at 940 and 21.34 at 7520, which is not the limit yet. So 282 are off by 46 % at
// least, 940 by 23 %; and by no more than twice that, since each doubling changes less.
TEST(Accuracy, SlenderLayersNeedSlowerWalls)
{
  const Scratch scratch;
  const std::string deck = scratch.write("bent.prm", bent);
  const auto error_at = [&](const std::string &length, const std::string &transits)
  {
    const Parameters p =
        read_deck(deck, {"Accuracy=100 %", "Layer/Length ratio=" + length,
                         rate + "=" + transits});
    return find(p.accuracy, rate)->error.value_or(-1.);
  };
  for (const auto &[transits, least] : {std::pair{"282", 0.464}, std::pair{"940", 0.235}})
  {
    EXPECT_GT(error_at("33.7", transits), least) << transits;
    EXPECT_LT(error_at("33.7", transits), 2. * least) << transits;
    // Between two records that of the more slender layer is on the safe side.
    EXPECT_EQ(error_at("20", transits), error_at("33.7", transits)) << transits;
  }
  EXPECT_LT(error_at("12", "282"), 0.04);

  const std::vector<std::string> problems =
      problems_of(deck, {"Accuracy=10 %", "Layer/Length ratio=33.7", rate + "=282"});
  ASSERT_EQ(problems.size(), 1u);
  for (const std::string &text : {"'" + rate + "' = 282 is off by",
                                  std::string("'Walls/Loading = event driver'")})
    EXPECT_NE(problems[0].find(text), std::string::npos) << problems[0];
  // The event driver reaches it.
  const Parameters events =
      read_deck(deck, {"Accuracy=10 %", "Layer/Length ratio=33.7",
                       "Walls/Loading=event driver"});
  EXPECT_LE(events.accuracy.sum_of_errors(), 0.1);
  EXPECT_TRUE(events.accuracy.warnings().empty());
}

TEST(Accuracy, EffectiveDeckGivesTheSame)
{
  const Scratch scratch;
  for (const auto &[name, text] :
       {std::pair{"specimen.prm", specimen}, std::pair{"buried.prm", buried}})
  {
    const Parameters p = read_deck(scratch.write(name, text), {"Accuracy=30 %"});
    const std::string once = effective_deck(p);
    EXPECT_NE(once.find("set Accuracy   = 30 %"), std::string::npos) << once;
    const Parameters again = read_deck(scratch.write("deck.prm", once), {});
    EXPECT_EQ(effective_deck(again), once);
    EXPECT_EQ(again.accuracy.sum_of_errors(), p.accuracy.sum_of_errors());
    EXPECT_EQ(again.accuracy.settings.size(), p.accuracy.settings.size());
  }
}

TEST(Accuracy, IsAPercentageOrNothing)
{
  const Scratch scratch;
  const std::string deck = scratch.write("specimen.prm", specimen);
  for (const char *text : {"30 %", "30%", "3e1 %", " +30  % "})
    EXPECT_EQ(read_deck(deck, {std::string("Accuracy=") + text}).accuracy.percent, 30.)
        << text;
  EXPECT_EQ(read_deck(deck, {"Accuracy="}).accuracy.percent, 0.);
  EXPECT_TRUE(accuracy_in_words(read_deck(deck, {"Accuracy="}).accuracy).empty());
  EXPECT_EQ(read_deck(deck, {"Accuracy="}).layer.grains_across, 12.); // the default
  for (const char *text : {"5", "0.05", "five %", "%", "0 %", "-1 %", "101 %", "5 % %",
                           "nan %", "5 percent"})
  {
    const std::string problem = refusal(deck, text);
    EXPECT_NE(problem.find("'Accuracy' = '"), std::string::npos) << text << problem;
    EXPECT_NE(problem.find("Give a percentage > 0 % and <= 100 %, as 5 %"),
              std::string::npos)
        << text << ": " << problem;
  }
}

// Grains times steps: twice the grains across take eight times as long. Of a specimen
// that is pulled grains across are all that the record has.
TEST(Accuracy, PricesGrainsOfARunInSteps)
{
  const Scratch scratch;
  const Parameters p =
      read_deck(scratch.write("specimen.prm", specimen),
                {"Accuracy=10 %", "Walls/Action=pull", "Layer/Length ratio=6"});
  ASSERT_EQ(p.accuracy.settings.size(), 1u);
  int n_priced = 0;
  for (const AccuracyAlternative &other : p.accuracy.alternatives)
    if (!other.values.empty())
    {
      const double ratio = std::stod(other.values[0].second) / p.layer.grains_across;
      EXPECT_NEAR(other.relative_seconds, std::pow(ratio, 3), 1e-12);
      ++n_priced;
    }
  EXPECT_GE(n_priced, 3); // 20, 10 and 5 %
}

// Nothing breaks by the linear theory, and bare finite elements have no grains.
TEST(Accuracy, ChoosesOnlyWhatTheSceneHas)
{
  const Scratch scratch;
  const Parameters p = read_deck(scratch.write("buried.prm", buried), {"Accuracy=30 %"});
  EXPECT_EQ(find(p.accuracy, "Walls/Transits per millistrain"), nullptr);
  EXPECT_NE(find(p.accuracy, "Bridging domain/Overlap width ratio"), nullptr);
  EXPECT_FALSE(p.accuracy.packing_scatter);

  const Parameters q = read_deck(scratch.write("specimen.prm", specimen),
                                 {"Accuracy=30 %", "Walls/Loading=event driver"});
  EXPECT_EQ(find(q.accuracy, "Walls/Transits per millistrain"), nullptr);
  EXPECT_NE(find(q.accuracy, "Walls/Balance tolerance"), nullptr);
  EXPECT_TRUE(q.accuracy.packing_scatter);

  const std::string mesh = scratch.write("mesh.prm", buried);
  const std::vector<std::string> of_mesh = {"Accuracy=3 %",
                                            "Layer/Representation=continuum"};
  const Parameters m = read_deck(mesh, of_mesh);
  ASSERT_EQ(m.accuracy.settings.size(), 1u);
  EXPECT_EQ(m.accuracy.settings[0].entry, "Matrix/Cell size ratio");
  // The same cells over h, however many diameters of grains that is.
  std::vector<std::string> finer = of_mesh;
  finer.emplace_back("Layer/Grains across=24"); // the default is 12
  EXPECT_NEAR(read_deck(mesh, finer).matrix.cell_size, 2. * m.matrix.cell_size, 1e-12);

  const std::vector<std::string> problems =
      problems_of(mesh, {"Accuracy=3 %", "Layer/Representation=continuum",
                         "Matrix/Refinement rounds=2"});
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("the record has nothing of this scene"), std::string::npos);
}
} // namespace accuracy_tests

// What runs from event to event answer, whatever load step the deck asks for.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>

namespace event_results_tests
{
using namespace antiform::test;

namespace
{
const std::string tension = ANTIFORM_SOURCE_DIR "/cases/laboratory/tension.prm";
const std::string uniaxial = ANTIFORM_SOURCE_DIR "/cases/laboratory/uniaxial.prm";
const std::string events = "Walls/Loading=event driver";
const std::string estimate = "Run/Estimate loading-rate error=true";

nlohmann::json run_deck(const std::string &deck,
                        const std::string &directory,
                        const std::vector<std::string> &entries)
{
  const Outcome outcome = run_program("run " + deck + " -o " + directory + set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

/// Of the body that nothing breaks, in time. Walls at 200 transits a millistrain leave
/// vibrations of some 0.2 %.
double stiffness_in_time(const std::string &directory)
{
  return result(run_deck(tiny_deck(), directory,
                         unbreakable({"Walls/Transits per millistrain=200",
                                      "Output/Samples per millistrain=200"})),
                "section_stiffness");
}
} // namespace

// A first load step of 2e-3 would pass all first cracks; and where strengths scatter by a
// half the first crack comes at a twentieth of the strain at the peak.
TEST(EventResults, HaveAStiffnessHoweverSoonTheBodyBreaks)
{
  const TemporaryFolder folder;
  const double stiffness = stiffness_in_time(folder.path("slow"));
  for (const char *entry :
       {"Walls/Load step=2e-3", "Layer/Strength scatter/Tensile strength deviation=0.5"})
  {
    const std::string directory = folder.path(std::string(entry).substr(6, 4));
    const auto summary =
        run_deck(tiny_deck(), directory, {events, entry, "Run/End shortening=1e-3"});
    ASSERT_GT(result(summary, "crack_count"), 0.);
    EXPECT_NEAR(result(summary, "section_stiffness") / stiffness, 1., 5e-3) << entry;
    EXPECT_TRUE(summary.at("warnings").empty()) << summary.at("warnings");
    // Ten steps to the first crack, and one more that ends just short of it.
    const CsvTable history(directory + "/history.csv");
    const auto tensile = history.column("cracks_tensile"),
               shear = history.column("cracks_shear");
    std::size_t whole = 0;
    while (tensile[whole] + shear[whole] == 0.)
      ++whole;
    EXPECT_NEAR(static_cast<double>(whole), 11., 1.) << entry;
  }
}

// A specimen parts within a per cent of its strain, so that its strength lies within one
// load step of it: of a hundredth. Walls in time are slow here, 700 transits.
TEST(EventResults, HaveTheStrengthInTensionOfSlowGrips)
{
  const TemporaryFolder folder;
  for (const std::string seed : {"1", "2", "3"})
  {
    const std::vector<std::string> common{"Layer/Grains across=14", "Layer/Seed=" + seed};
    auto entries = common;
    entries.push_back(events);
    const auto with = run_deck(tension, folder.path("with" + seed), entries),
               slow = run_deck(tension, folder.path("slow" + seed), common);
    EXPECT_GT(result(with, "crack_count"), 10.);
    for (const char *name : {"tensile_strength", "strain_at_peak", "first_crack_stress"})
      EXPECT_NEAR(result(with, name) / result(slow, name), 1.,
                  name[0] == 's' ? 0.03 : 0.01) // the curve is flat at its peak
          << name << " of packing " << seed;
    for (const char *name : {"young_modulus", "section_stiffness"})
      EXPECT_NEAR(result(with, name) / result(slow, name), 1., 2e-3)
          << name << " of packing " << seed;
  }
}

// No number is better than one that is none.
TEST(EventResults, LeaveOutWhatTooFewRecordsTellInAnyDriver)
{
  const TemporaryFolder folder;
  const auto summary =
      run_deck(uniaxial, folder.path("rare"),
               {"Layer/Grains across=8", "Output/Samples per millistrain=1",
                "Walls/Transits per millistrain=50", "Run/End shortening=1e-3"});
  ASSERT_GT(result(summary, "peak_stress"), 0.);
  for (const char *name : {"section_stiffness", "young_modulus", "poisson_ratio"})
    EXPECT_EQ(summary.at("results").count(name), 0U) << name;
  const std::string warnings = summary.at("warnings").dump();
  for (const char *part :
       {"section stiffness", "Young's modulus", "Output/Samples per millistrain"})
    EXPECT_NE(warnings.find(part), std::string::npos) << part << " is not in " << warnings;
}

// Load steps of 2e-3, of which events leave a tenth, let a peak of some 126 MPa come out
// per cents low. The estimate sees most of that, as of the loading rate in time.
TEST(EventResults, TellWhatTheLoadStepIsWorth)
{
  const TemporaryFolder folder;
  const auto entry_of_half = [](const std::string &directory, const std::string &name)
  {
    const std::string deck = contents(directory + "/half-tolerance/deck.prm");
    const std::size_t place = deck.find("=", deck.find("set " + name + " "));
    return std::stod(deck.substr(place + 1));
  };
  const std::string coarse = folder.path("coarse"), fine = folder.path("fine");
  const auto with =
      run_deck(tiny_deck(), coarse, {events, estimate, "Walls/Load step=2e-3"});
  const auto usual = run_deck(tiny_deck(), fine, {events, estimate});
  const double change =
      result(with, "peak_stress") / result(usual, "peak_stress") - 1.;
  EXPECT_LT(change, -0.03);
  EXPECT_NEAR(result(with, "tolerance_error"), change, 0.03);
  EXPECT_NEAR(result(usual, "tolerance_error"), 0., 0.01);
  // Half of the usual 4e-5; of a long one a hundredth of UCS over Young's modulus.
  EXPECT_NEAR(entry_of_half(fine, "Load step"), 2e-5, 1e-12);
  EXPECT_NEAR(entry_of_half(coarse, "Load step"), 0.01 * 162. / 56e3, 1e-9);
  EXPECT_NEAR(entry_of_half(fine, "Balance tolerance"), 5e-4, 1e-12);
}

// The third packing breaks as a whole at its first crack: nothing is kept after that.
TEST(EventResults, TellItOfABodyWithoutWarningCracks)
{
  const TemporaryFolder folder;
  const std::vector<std::string> brittle{"Layer/Grains across=14", "Layer/Seed=3",
                                         estimate};
  auto entries = brittle;
  entries.push_back(events);
  const auto with = run_deck(tension, folder.path("with"), entries);
  ASSERT_EQ(result(with, "first_crack_stress"), result(with, "tensile_strength"));
  EXPECT_TRUE(with.at("warnings").empty()) << with.at("warnings");
  // Either lies within its load step below the strength.
  EXPECT_NEAR(result(with, "tolerance_error"), 0., 0.01);
  EXPECT_GT(result(summary_of(folder.path("with") + "/half-tolerance"), "load_steps"),
            1.8 * result(with, "load_steps"));
  // Of walls in time nothing was kept; it is not for want of a peak.
  const std::string warnings =
      run_deck(tension, folder.path("slow"), brittle).at("warnings").dump();
  EXPECT_NE(warnings.find("first crack came at 0.95 of the peak"), std::string::npos)
      << warnings;
  EXPECT_EQ(warnings.find("has not passed a peak"), std::string::npos) << warnings;
}
} // namespace event_results_tests

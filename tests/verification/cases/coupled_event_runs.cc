// Layers of grains joined to a mesh, run from event to event, against the same decks in
// time.
#include "support/tiny_run.h"

#include <algorithm>
#include <cmath>

namespace coupled_event_runs_tests
{
using namespace antiform::test;

namespace
{
const std::string events = "Walls/Loading=event driver";

/// The tiny deck, or another, with @p entries.
nlohmann::json run_deck(const std::string &directory,
                        const std::vector<std::string> &entries,
                        const std::string &deck = tiny_deck())
{
  const Outcome outcome = run_program("run " + deck + " -o " + directory + set(entries));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return summary_of(directory);
}

/// Every line of the history is a balance of the constrained forces, grains and mesh have
/// not parted, and the ledger is closed.
void expect_balances(const std::string &directory, const double closure = 1e-3)
{
  constexpr double tolerance = 1e-3;
  const CsvTable history(directory + "/history.csv");
  const auto mean = history.column("unbalanced_ratio"),
             largest = history.column("largest_unbalanced_ratio"),
             of_strength = history.column("unbalanced_over_strength"),
             gap = history.column("displacement_gap_m");
  ASSERT_GT(history.size(), 10U);
  for (std::size_t k = 0; k < history.size(); ++k)
  {
    EXPECT_LT(mean[k], tolerance) << "line " << k;
    EXPECT_LT(largest[k], 100. * tolerance) << "line " << k;
    EXPECT_LT(of_strength[k], 150. * tolerance) << "line " << k;
    EXPECT_LT(gap[k], 1e-12) << "line " << k; // of displacements of 1e-2 m and more
  }
  EXPECT_LT(summary_of(directory).at("energy").at("closure_error"), closure);
}

/// The ledger's limit where a layer has come down in a few long sweeps: kinks of the law
/// within a move are not those of a trapezoid.
constexpr double after_collapse = 5e-3;
} // namespace

TEST(CoupledEventRun, BeginsToBreakAsSlowWallsDo)
{
  const TemporaryFolder folder;
  // Strengths a fifth of the rock's, to come to its first cracks soon.
  const std::vector<std::string> weak{"Layer/Flat joint/Tensile strength=3e6",
                                      "Layer/Flat joint/Cohesion=12e6",
                                      "Run/End shortening=2.5e-4"};
  auto entries = weak;
  entries.push_back(events);
  const auto with = run_deck(folder.path("with"), entries);
  entries = weak;
  entries.insert(entries.end(), {"Walls/Transits per millistrain=200",
                                 "Output/Samples per millistrain=2000"});
  const auto slow = run_deck(folder.path("slow"), entries);
  ASSERT_GT(result(slow, "crack_count"), 0.);
  for (const char *name : {"first_crack_x", "first_crack_above_axis"})
    EXPECT_NEAR(result(with, name), result(slow, name), 1e-6) << "another bond";
  EXPECT_NEAR(result(with, "first_crack_stress") / result(slow, "first_crack_stress"), 1.,
              5e-3);
  EXPECT_NEAR(result(with, "section_stiffness") / result(slow, "section_stiffness"), 1.,
              5e-3);
  for (const char *term : {"boundary_work", "strain_grains", "strain_continuum"})
    EXPECT_NEAR(with.at("energy").at(term).get<double>() /
                    slow.at("energy").at(term).get<double>(),
                1., 1e-2)
        << term;
  EXPECT_GT(with.at("sizes").at("multipliers").get<int>(), 0);
  expect_balances(folder.path("with"));
}

TEST(CoupledEventRun, GoesThroughThePeakInBalance)
{
  const TemporaryFolder folder;
  const auto summary = run_deck(folder.path("run"), {events});
  expect_balances(folder.path("run"), after_collapse);
  EXPECT_EQ(summary.at("status"), "completed");
  EXPECT_GT(result(summary, "crack_count"), 20.);
  EXPECT_GT(result(summary, "load_steps"), 20.);
  const auto &energy = summary.at("energy");
  EXPECT_EQ(energy.at("kinetic"), 0.);
  for (const char *term : {"strain_grains", "strain_continuum", "fracture"})
    EXPECT_GT(energy.at(term).get<double>(),
              5e-3 * energy.at("boundary_work").get<double>())
        << term;
}

// With the walls' displacement given, a bent layer is followed through its largest load
// and well down from it: the path after it is chaotic, half of it is about where it ends.
TEST(CoupledEventRun, FollowsABentLayerThroughItsLargestLoad)
{
  const TemporaryFolder folder;
  const std::string directory = folder.path("run");
  const auto summary = run_deck(directory, {events, "Layer/Shape=cosine"});
  expect_balances(directory, after_collapse);
  EXPECT_EQ(summary.at("status"), "completed");
  const CsvTable history(directory + "/history.csv");
  const auto stress = history.column("axial_stress_Pa"),
             shortening = history.column("shortening");
  EXPECT_EQ(result(summary, "peak_stress"),
            *std::max_element(stress.begin(), stress.end()));
  EXPECT_LT(stress.back(), 0.7 * result(summary, "peak_stress"));
  for (std::size_t k = 1; k < history.size(); ++k)
  {
    EXPECT_GT(shortening[k], shortening[k - 1]) << "line " << k;
    EXPECT_LT(shortening[k] - shortening[k - 1], 4e-5 * (1. + 1e-6)) << "line " << k;
  }
}

TEST(CoupledEventRun, GoesOnFromItsLastRecordToTheSameBits)
{
  const TemporaryFolder folder;
  const std::string once = folder.path("once"), often = folder.path("often");
  const std::vector<std::string> entries{events, "Run/End shortening=1.2e-3"};
  run_deck(once, entries);
  const std::string run = "run " + tiny_deck() + " -o " + often + set(entries);
  for (const int records : {1, 2, 3})
  {
    const Outcome outcome =
        run_program(run + " --time-limit 1e-3" + (records > 1 ? " --resume" : ""));
    ASSERT_EQ(outcome.status, 3) << outcome.output;
  }
  const Outcome outcome = run_program(run + " --resume");
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  expect_same_run(often, once);
  expect_same_file("fields.pvd", often, once);
}

// A mesh without a constraint would be another body.
TEST(CoupledEventRun, RefusesAMeshThatIsNotJoined)
{
  const Outcome outcome = run_program("check " + tiny_deck() +
                                      set({events, "Bridging domain/Constraint=false"}));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("'Bridging domain/Constraint' = true"), std::string::npos)
      << outcome.output;
}

// A pre-bent layer in a matrix of grains and mesh, past its first cracks.
TEST(CoupledEventRun, FoldsALayerAsSlowWallsDoLong)
{
  const TemporaryFolder folder;
  const std::vector<std::string> deck{"Layer/Shape=cosine", "Run/End shortening=1e-3"};
  auto entries = deck;
  entries.push_back(events);
  const auto with = run_deck(folder.path("with"), entries);
  entries = deck;
  entries.push_back("Walls/Transits per millistrain=300");
  const auto slow = run_deck(folder.path("slow"), entries);
  expect_balances(folder.path("with"));
  EXPECT_GT(result(with, "crack_count"), 5.);
  for (const char *name : {"first_crack_x", "first_crack_above_axis"})
    EXPECT_NEAR(result(with, name), result(slow, name), 1e-6) << "another bond";
  // What the fold has grown by.
  for (const char *column : {"fold_amplitude_m", "limb_dip_deg"})
  {
    const auto grown = [&](const char *directory)
    {
      const auto values =
          CsvTable(folder.path(directory) + "/history.csv").column(column);
      return values.back() - values.front();
    };
    std::printf("  %s grown by %.5f, in time %.5f\n", column, grown("with"),
                grown("slow"));
    EXPECT_NEAR(grown("with") / grown("slow"), 1., 0.03) << column;
  }
  EXPECT_NEAR(result(with, "section_stiffness") / result(slow, "section_stiffness"), 1.,
              5e-3);
  EXPECT_NEAR(result(with, "peak_stress") / result(slow, "peak_stress"), 1., 0.03);
}

// A straight layer that does not break buckles, and its section's load has a maximum.
TEST(CoupledEventRun, FollowsABucklingLayerThroughItsLargestLoadLong)
{
  const TemporaryFolder folder;
  const std::vector<std::string> deck{"Layer/Breakable=false",
                                      "Matrix/Stiffness contrast=100",
                                      "Run/Longest shortening=0.1"};
  const auto with_deck = [&](const char *name, std::vector<std::string> entries)
  {
    entries.insert(entries.end(), deck.begin(), deck.end());
    return run_deck(folder.path(name), entries);
  };
  with_deck("with", {events, "Walls/Load step=5e-4", "Walls/Balance tolerance=1e-4",
                     "Run/End shortening=0.0525"});
  with_deck("slow", {"Walls/Transits per millistrain=20",
                     "Output/Samples per millistrain=4", "Run/End shortening=0.0525"});
  const double linear = result(
      with_deck("linear", {"Run/Driver=buckling", "Components=layer, matrix, walls"}),
      "critical_shortening");
  expect_balances(folder.path("with"));

  struct Largest
  {
    double force = 0., shortening = 0., amplitude = 0., last = 0.;
  };
  const auto largest = [&](const char *name)
  {
    const CsvTable history(folder.path(name) + "/history.csv");
    const auto force = history.column("wall_force_N"),
               shortening = history.column("shortening"),
               amplitude = history.column("fold_amplitude_m");
    const auto k = static_cast<std::size_t>(std::max_element(force.begin(), force.end()) -
                                            force.begin());
    std::printf("  %s: largest load %.5g N at %.5f, amplitude %.4f m\n", name, force[k],
                shortening[k], amplitude[k]);
    return Largest{force[k], shortening[k], amplitude[k], force.back()};
  };
  const Largest with = largest("with"), slow = largest("slow");
  EXPECT_LT(with.last, 0.998 * with.force); // beyond it, in balance
  // Twenty transits a millistrain leave some tenths of a per cent.
  EXPECT_NEAR(with.force / slow.force, 1., 5e-3);
  EXPECT_NEAR(with.shortening / slow.shortening, 1., 0.02);
  EXPECT_NEAR(with.amplitude / slow.amplitude, 1., 0.02);
  // An imperfect layer comes to it beyond the load at which a perfect one buckles.
  EXPECT_GT(with.shortening, linear);
  EXPECT_LT(with.shortening, 1.25 * linear);
}
} // namespace coupled_event_runs_tests

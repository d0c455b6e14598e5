// The same deck gives the same bits: again, from its deck.prm, on another number of
// threads; on another number of ranks the same force to round-off.
#include "support/tiny_run.h"

#include <filesystem>

namespace repeatability_tests
{
using namespace antiform::test;

TEST(Repeatability, ThreadsDoNotChangeABit)
{
  const TemporaryFolder folder;
  for (const int n_threads : {1, 2})
  {
    const Outcome outcome =
        run_tiny(folder.path(std::to_string(n_threads)), "", n_threads);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_EQ(summary_of(folder.path(std::to_string(n_threads))).at("threads"),
              n_threads);
  }
  ASSERT_GT(CsvTable(folder.path("1/cracks.csv")).size(), 20u);
  expect_same_run(folder.path("1"), folder.path("2"));
}

// Loops over fewer than 2000 grains stay on one thread: here is a scene beyond that, with
// mesh and bridging domain.
TEST(Repeatability, ThreadsDoNotChangeABitOfALargerSceneLong)
{
  const TemporaryFolder folder;
  for (const int n_threads : {1, 2, 4, 16})
  {
    const std::string directory = folder.path(std::to_string(n_threads));
    const Outcome outcome =
        run_program("run " ANTIFORM_SOURCE_DIR "/cases/burial-depth/quick.prm -o " +
                        directory + set({"Run/End shortening=5e-5"}),
                    1, n_threads);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
  }
  ASSERT_GT(summary_of(folder.path("1")).at("sizes").at("grains"), 2000);
  for (const char *n_threads : {"2", "4", "16"})
    expect_same_run(folder.path("1"), folder.path(n_threads));
}

TEST(Repeatability, DeckPrmRepeatsTheRun)
{
  const TemporaryFolder folder;
  const Outcome first = run_tiny(folder.path("first"), set({"Layer/Seed=3"}));
  ASSERT_EQ(first.status, 0) << first.output;
  const Outcome again =
      run_program("run " + folder.path("first/deck.prm") + " -o " + folder.path("again"));
  ASSERT_EQ(again.status, 0) << again.output;
  expect_same_run(folder.path("first"), folder.path("again"));
}

namespace
{
/// Wall force and strain energy of a bent, buried layer of continuum on @p n_ranks.
CsvTable static_history(const std::string &directory, const int n_ranks)
{
  const Outcome outcome = run_program(
      "run " + tiny_deck() + " -o " + directory +
          set({"Layer/Representation=continuum", "Layer/Shape=cosine",
               "Components=layer, matrix, foundation, walls", "Run/Driver=static",
               "Run/End shortening=1e-3", "Run/Load steps=2"}),
      n_ranks);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(summary_of(directory).at("ranks"), n_ranks);
  return CsvTable(directory + "/history.csv");
}
} // namespace

TEST(Repeatability, RanksAgreeOnTheForceOfAContinuum)
{
  const TemporaryFolder folder;
  const CsvTable one = static_history(folder.path("one"), 1),
                 two = static_history(folder.path("two"), 2);
  // The solver's tolerance is 1e-10 of the load; on other ranks it stops elsewhere in it.
  for (const char *name : {"wall_force_N", "strain_continuum_J"})
  {
    const std::vector<double> a = one.column(name), b = two.column(name);
    ASSERT_EQ(a.size(), 2u);
    ASSERT_EQ(b.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k)
    {
      EXPECT_GT(a[k], 0.);
      EXPECT_NEAR(b[k] / a[k], 1., 1e-8) << name;
    }
  }
  // Work of the walls, force times way over two, is the energy (Clapeyron).
  const std::vector<double> force = one.column("wall_force_N"),
                            energy = one.column("strain_continuum_J"),
                            shortening = one.column("shortening");
  const nlohmann::json check = nlohmann::json::parse(
      run_program("check --json " + tiny_deck() + set({"Layer/Shape=cosine"})).output);
  const double length = check.at("geometry").at("length_m");
  EXPECT_NEAR(0.5 * force[1] * shortening[1] * length / energy[1], 1., 1e-6);
}

namespace
{
/// A bent, loaded layer of continuum that moves in time.
std::string moving_continuum(const std::string &directory)
{
  return "run " + tiny_deck() + " -o " + directory +
         set({"Layer/Representation=continuum", "Layer/Shape=cosine",
              "Components=layer, matrix, foundation, gravity, surface pressure, walls, "
              "damping",
              "Surface pressure/Pressure=1e6", "Run/End shortening=2e-4"});
}
} // namespace

TEST(Repeatability, RanksAgreeOnAContinuumThatMoves)
{
  const TemporaryFolder folder;
  for (const int n_ranks : {1, 3})
  {
    const std::string directory = folder.path(std::to_string(n_ranks));
    const Outcome outcome = run_program(moving_continuum(directory), n_ranks);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_EQ(summary_of(directory).at("ranks"), n_ranks);
    EXPECT_LT(summary_of(directory).at("energy").at("closure_error"), 1e-3);
  }
  const CsvTable one(folder.path("1/history.csv")), three(folder.path("3/history.csv"));
  ASSERT_GT(one.size(), 10u);
  ASSERT_EQ(one.size(), three.size());
  // Sums in another order, and damping that turns with the sign of what is almost at
  // rest.
  for (const char *name : {"wall_force_N", "axial_stress_Pa", "fold_amplitude_m",
                           "surface_uplift_m", "boundary_work_J", "kinetic_J",
                           "strain_continuum_J", "damping_J", "unbalanced_ratio"})
  {
    const std::vector<double> a = one.column(name), b = three.column(name);
    double largest = 0., difference = 0.;
    for (std::size_t k = 0; k < a.size(); ++k)
    {
      largest = std::max(largest, std::abs(a[k]));
      difference = std::max(difference, std::abs(a[k] - b[k]));
    }
    EXPECT_GT(largest, 0.) << name;
    EXPECT_LT(difference / largest, 1e-8) << name;
  }
}

TEST(Repeatability, RanksResumeToTheSameBits)
{
  const TemporaryFolder folder;
  const std::string left_alone = folder.path("left_alone"), run = folder.path("run");
  ASSERT_EQ(run_program(moving_continuum(left_alone), 2).status, 0);
  const Outcome first = run_program(moving_continuum(run) + " --time-limit 1e-3", 2);
  ASSERT_EQ(first.status, 3) << first.output;
  EXPECT_EQ(occurrences(first.output, "time limit reached"), 1u) << first.output;

  const Outcome alone = run_program(moving_continuum(run) + " --resume", 1);
  EXPECT_EQ(alone.status, 1) << alone.output;
  EXPECT_NE(alone.output.find("mpirun -np 2"), std::string::npos) << alone.output;

  const Outcome second = run_program(moving_continuum(run) + " --resume", 2);
  ASSERT_EQ(second.status, 0) << second.output;
  EXPECT_NE(second.output.find("resumed at step 64"), std::string::npos) << second.output;
  expect_same_file("history.csv", run, left_alone);
  expect_same_answers(run, left_alone);
}

TEST(Repeatability, GrainsRefuseTwoRanks)
{
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program("run " + tiny_deck() + " -o " + folder.path("run"), 2);
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "on 2 MPI ranks"), 1u) << outcome.output;
  EXPECT_EQ(occurrences(outcome.output, "--threads"), 1u) << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(folder.path("run"))); // before any work
}
} // namespace repeatability_tests

// Meshes of finite strain in runs that step in time, as decks ask for them.
#include "support/table.h"
#include "support/tiny_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::test::finite_strain_runs_tests
{
namespace
{
double last(const std::string &directory, const std::string &column)
{
  return CsvTable(directory + "/history.csv").column(column).back();
}
} // namespace

TEST(FiniteStrainRun, OfAMeshAloneFollowsTheStaticDriver)
{
  // A pre-bent layer of finite elements shortened by 1 %, by Newton's method and slowly
  // in time. Both are neo-Hookean of finite strain.
  const TemporaryFolder folder;
  const std::vector<std::string> common{"Run/Strain=finite", "Run/End shortening=1e-2",
                                        "Matrix/Element degree=1",
                                        "Matrix/Cell aspect ratio=1"};
  const auto run = [&](const std::string &name, const std::string &strain,
                       std::vector<std::string> more, const int n_ranks)
  {
    std::vector<std::string> entries = common;
    entries[0] = "Run/Strain=" + strain;
    entries.insert(entries.end(), more.begin(), more.end());
    const Outcome outcome = run_program(
        "run " + buried_deck() + " -o " + folder.path(name) + set(entries), n_ranks);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return folder.path(name);
  };
  const std::vector<std::string> in_time{"Components=layer, matrix, walls, damping",
                                         "Run/Driver=quasi-static",
                                         "Walls/Transits per millistrain=30"};
  const std::string by_newton =
      run("static", "finite", {"Components=layer, matrix, walls"}, 1);
  const std::string slowly = run("slow", "finite", in_time, 1);
  const std::string on_two = run("ranks", "finite", in_time, 2);
  const std::string small = run("small", "small", in_time, 1);
  for (const char *column : {"wall_force_N", "fold_amplitude_m"})
  {
    const double expected = last(by_newton, column);
    std::printf("  %s: %.6g; in time %+.2e, small strain %+.2e\n", column, expected,
                last(slowly, column) / expected - 1.,
                last(small, column) / expected - 1.);
    // Inertia at 30 transits a millistrain; measured 9e-5 and 6e-5.
    EXPECT_NEAR(last(slowly, column) / expected, 1., 5e-4);
    EXPECT_NEAR(last(on_two, column) / last(slowly, column), 1., 1e-8);
  }
  // A linear mesh has no geometric stiffness, by which the fold grows: 0.3 % of the
  // amplitude, 6 % of its growth.
  EXPECT_GT(
      std::abs(last(small, "fold_amplitude_m") / last(by_newton, "fold_amplitude_m") -
               1.),
      2e-3);
  const nlohmann::json summary = summary_of(slowly);
  EXPECT_GE(summary.at("effects").at("finite strain").at("calls").get<int>(), 2);
}

TEST(FiniteStrainRun, BesideGrainsIsTheLinearMeshWhereStrainIsSmall)
{
  const TemporaryFolder folder;
  std::vector<double> force;
  for (const std::string strain : {"small", "finite"})
  {
    const Outcome outcome =
        run_tiny(folder.path(strain), set(unbreakable({"Run/Strain=" + strain})));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    force.push_back(last(folder.path(strain), "wall_force_N"));
    EXPECT_LE(
        summary_of(folder.path(strain)).at("energy").at("closure_error").get<double>(),
        1e-6);
  }
  // Of the order of the strain, 2e-4, in the mesh's part of the force; not nothing.
  EXPECT_NEAR(force[1] / force[0], 1., 2e-4);
  EXPECT_NE(force[1], force[0]);
}

TEST(FiniteStrainRun, RefusesWhatDoesNotTurn)
{
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<std::string> &entries)
  {
    const Outcome outcome = run_tiny(folder.path("never"), set(entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(
      refusal({"Run/Strain=finite", "Components=layer, matrix, walls, damping, gravity"})
          .find("does not turn with the section"),
      std::string::npos);
  EXPECT_NE(refusal({"Run/Strain=finite", "Matrix/Representation=grains"})
                .find("grains turn by any angle anyway"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path("never/history.csv")));
}
TEST(FiniteStrainRun, FoldsAPackingAsGrainsAloneDoLong)
{
  // Random packings of layer and matrix, cut from the same tiles in every run.
  const TemporaryFolder folder;
  const std::string deck = std::string(ANTIFORM_SOURCE_DIR) + "/tests/decks/fold.prm";
  const auto run = [&](const std::string &name, const std::string &entry)
  { return run_program("run " + deck + " -o " + folder.path(name) + set({entry})); };
  const Outcome grains = run("grains", "Matrix/Representation=grains");
  ASSERT_EQ(grains.status, 0) << grains.output;
  const Outcome finite = run("finite", "Run/Strain=finite");
  ASSERT_EQ(finite.status, 0) << finite.output;
  const Outcome small = run("small", "Run/Strain=small");
  EXPECT_EQ(small.status, 2) << small.output; // beyond small-strain theory

  const CsvTable expected(folder.path("grains") + "/history.csv");
  const auto error = [&](const std::string &name, const std::string &column)
  {
    const CsvTable table(folder.path(name) + "/history.csv");
    const std::size_t end = table.column(column).size() - 1;
    EXPECT_NEAR(table.column("shortening")[end], expected.column("shortening")[end],
                1e-5); // samples are at the same shortenings
    return table.column(column)[end] / expected.column(column)[end] - 1.;
  };
  const double of_finite = error("finite", "fold_amplitude_m"),
               of_small = error("small", "fold_amplitude_m");
  const double dip = last(folder.path("finite"), "limb_dip_deg");
  std::printf(
      "  dip %.2f degrees (grains alone %.2f): amplitude %+.2f %%, force %+.2f %%; "
      "small strain, until it gives up, %+.2f %%\n",
      dip, expected.column("limb_dip_deg").back(), 100. * of_finite,
      100. * error("finite", "wall_force_N"), 100. * of_small);
  EXPECT_NEAR(dip, 20., 1.);
  // Demanded: 3 %; the packing of the matrix beyond the overlap scatters about its mean.
  EXPECT_LE(std::abs(of_finite), 0.015);
  EXPECT_LE(std::abs(of_small), 0.03);
  EXPECT_GE(std::abs(of_small), 1.5 * std::abs(of_finite));
  const nlohmann::json summary = summary_of(folder.path("finite"));
  EXPECT_LE(summary.at("energy").at("closure_error").get<double>(), 1e-8);
  EXPECT_LE(last(folder.path("finite"), "displacement_gap_m"), 1e-9);
}
} // namespace antiform::test::finite_strain_runs_tests

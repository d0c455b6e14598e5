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
} // namespace antiform::test::finite_strain_runs_tests

// Buckling loads on meshes with hanging nodes: between those of the even meshes that hold
// them and that they hold. Each rank solves alone but in the last test: quicker.
#include "continuum/error_indicator.h"
#include "continuum/hanging_nodes.h"
#include "continuum/linear_buckling.h"
#include "continuum/refinement.h"
#include "continuum/sliding_interface.h"
#include "support/refined_meshes.h"

#include <gtest/gtest.h>

#include <numeric>

namespace adaptive_buckling_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double length = 20.;
const std::vector<ElasticMaterial> materials{ElasticMaterial::isotropic(10e6, 0.3, 1.),
                                             ElasticMaterial::isotropic(1e9, 0.25, 1.)};

/// A layer 1 thick between 10 m of weak matrix below and 5 m above, all in coarse cells.
void make_layer(Triangulation &triangulation, const bool bonded)
{
  const auto level = [](const double y) { return [y](double) { return y; }; };
  make_section(
      triangulation, 0., length, 10,
      {{level(-10.), level(0.), graded_rows(10., 1., 0., 2., 4., true), 0, false},
       {level(0.), level(1.), even_rows(1), 1, bonded},
       {level(1.), level(6.), graded_rows(5., 1., 0., 2., 4., false), 0, bonded}});
}

struct Solution
{
  double load;     ///< lowest factor of a shortening by 1e-6
  double estimate; ///< of its relative error, times the indicator's factor
  double n_unknowns;
  bool has_hanging_nodes;
  std::vector<double> indicators; ///< of the lowest mode
};

Solution
solve_on(const Triangulation &triangulation, const unsigned int degree, const bool bonded)
{
  const ElasticSolid solid(triangulation, materials, degree);
  const auto zero = [](const Point<2> &) { return 0.; };
  Surroundings surroundings;
  surroundings.slides = !bonded;
  prescribe(solid, boundary::bottom, 1, zero, surroundings.displacements);
  prescribe(solid, boundary::left, 0, zero, surroundings.displacements);
  prescribe(
      solid, boundary::right, 0, [](const Point<2> &) { return -1e-6 * length; },
      surroundings.displacements);
  const DofReduction reduction(solid, surroundings.displacements,
                               bonded ? std::vector<Tie>() : sliding_interfaces(solid));
  const Vector straight = solve_reduced(solid, reduction, solid.make_vector());
  const auto modes = lowest_buckling_modes(solid, solid.geometric_stiffness(straight),
                                           reduction, {1, 1e-10, 200});
  Solution result{modes.front().load_factor, 0.,
                  static_cast<double>(reduction.make_vector().size()),
                  solid.hanging_nodes() != nullptr,
                  error_indicators(solid, straight, modes.front(), surroundings)};
  result.estimate = dealii::Utilities::MPI::sum(
      std::accumulate(result.indicators.begin(), result.indicators.end(), 0.),
      triangulation.get_communicator());
  return result;
}

/// On even cells, halved @p n_levels times.
Solution
on_even_cells(const unsigned int n_levels, const unsigned int degree, const bool bonded)
{
  Triangulation triangulation(MPI_COMM_SELF);
  make_layer(triangulation, bonded);
  triangulation.refine_global(n_levels);
  return solve_on(triangulation, degree, bonded);
}

/// From coarse cells on, after each of the rounds.
std::vector<Solution> on_refined_cells(const unsigned int n_rounds,
                                       const unsigned int degree,
                                       const bool bonded,
                                       const MPI_Comm communicator = MPI_COMM_SELF)
{
  Triangulation triangulation(communicator);
  make_layer(triangulation, bonded);
  std::vector<Solution> result{solve_on(triangulation, degree, bonded)};
  for (unsigned int round = 0; round < n_rounds; ++round)
  {
    refine(triangulation, result.back().indicators, {0.6});
    result.push_back(solve_on(triangulation, degree, bonded));
  }
  return result;
}

/// Loads of nested spaces fall, as Rayleigh quotients do: straight strips under uniform
/// stress are exact on every mesh, so the prestress is the same.
void expect_load_between_those_of_even_cells(const unsigned int n_rounds,
                                             const unsigned int degree,
                                             const bool bonded)
{
  const auto refined = on_refined_cells(n_rounds, degree, bonded);
  const Solution finest = on_even_cells(n_rounds, degree, bonded);
  for (std::size_t k = 1; k < refined.size(); ++k)
  {
    EXPECT_TRUE(refined[k].has_hanging_nodes);
    EXPECT_LT(refined[k].load, refined[k - 1].load) << k;
  }
  EXPECT_LT(refined.back().n_unknowns, 0.85 * finest.n_unknowns);
  EXPECT_GT(refined.back().load, finest.load);
}

/// What two rounds leave of the error is told by the indicators, with a factor of some 4
/// to 9 that depends on the shapes of cells. The load without error is that of even Q2
/// cells by extrapolation of their order 4, of which less than a tenth of that is left.
void expect_estimate_of_the_error(const bool bonded)
{
  const Solution coarse = on_even_cells(0, 2, bonded), fine = on_even_cells(1, 2, bonded),
                 refined = on_refined_cells(2, 2, bonded).back();
  const double exact = fine.load - (coarse.load - fine.load) / 15.;
  const double error = refined.load / exact - 1.;
  EXPECT_GT(error, 0.);
  EXPECT_LT(error, 1e-3);
  EXPECT_GT(refined.estimate / error, 3.5);
  EXPECT_LT(refined.estimate / error, 10.);
}
} // namespace

TEST(AdaptiveBuckling, LoadOfABondedLayerIsBetweenThoseOfEvenCells)
{
  expect_load_between_those_of_even_cells(2, 1, true);
  expect_load_between_those_of_even_cells(1, 2, true);
}

TEST(AdaptiveBuckling, LoadOfASlidingLayerIsBetweenThoseOfEvenCells)
{
  expect_load_between_those_of_even_cells(2, 1, false);
  expect_load_between_those_of_even_cells(1, 2, false);
}

TEST(AdaptiveBuckling, IndicatorsTellTheErrorOfTheLoad)
{
  expect_estimate_of_the_error(true);
  expect_estimate_of_the_error(false);
}

TEST(AdaptiveBuckling, IsTheSameOnAnyRanks)
{
  for (const bool bonded : {true, false})
  {
    const auto all = on_refined_cells(2, 1, bonded, MPI_COMM_WORLD),
               alone = on_refined_cells(2, 1, bonded);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
      EXPECT_EQ(all[k].n_unknowns, alone[k].n_unknowns) << k;
      EXPECT_NEAR(all[k].load, alone[k].load, 1e-8 * alone[k].load) << k;
      EXPECT_NEAR(all[k].estimate, alone[k].estimate, 1e-6 * alone[k].estimate) << k;
    }
  }
}
} // namespace adaptive_buckling_tests

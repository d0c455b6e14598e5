// What indicators are 0 of, one by hand, and cells that are halved by them.
#include "continuum/dof_reduction.h"
#include "continuum/error_indicator.h"
#include "continuum/foundation.h"
#include "continuum/hanging_nodes.h"
#include "continuum/refinement.h"
#include "continuum/sliding_interface.h"
#include "support/refined_meshes.h"

#include <gtest/gtest.h>

#include <numeric>

namespace error_indicator_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;
using dealii::Tensor;

namespace
{
const auto rock = ElasticMaterial::isotropic(20e9, 0.25, 2500.),
           weak = ElasticMaterial::isotropic(20e6, 0.4, 2000.);

double sum_of(const std::vector<double> &indicators)
{
  return dealii::Utilities::MPI::sum(
      std::accumulate(indicators.begin(), indicators.end(), 0.), MPI_COMM_WORLD);
}

std::function<double(double)> level(const double y)
{
  return [y](double) { return y; };
}

/// A strong strip between weak ones, 2 m long, each 1 m high in 4 x 2 cells.
void make_stack(Triangulation &triangulation, const bool joined)
{
  make_section(triangulation, 0., 2., 4,
               {{level(0.), level(1.), even_rows(2), 1, false},
                {level(1.), level(2.), even_rows(2), 0, joined},
                {level(2.), level(3.), even_rows(2), 1, joined}});
}

/// The stack shortened along x by 1e-3; free above.
Surroundings shortened(const ElasticSolid &solid, const bool slides)
{
  const auto zero = [](const Point<2> &) { return 0.; };
  Surroundings result;
  prescribe(solid, boundary::bottom, 1, zero, result.displacements);
  prescribe(solid, boundary::left, 0, zero, result.displacements);
  prescribe(
      solid, boundary::right, 0, [](const Point<2> &) { return -2e-3; },
      result.displacements);
  result.slides = slides;
  return result;
}
} // namespace

TEST(ErrorIndicator, IsZeroWhereStressesAreInEquilibrium)
{
  // Each strip under its own uniform stress along x, whether they stick or slide; cells
  // of two sizes.
  for (const bool slides : {false, true})
    for (const unsigned int degree : {1u, 2u})
    {
      Triangulation triangulation(MPI_COMM_WORLD);
      make_stack(triangulation, !slides);
      refine_where(triangulation, [](const Point<2> &p) { return p[0] < 0.6; });
      const ElasticSolid solid(triangulation, {rock, weak}, degree);
      const Surroundings surroundings = shortened(solid, slides);
      const Vector u = solve_reduced(
          solid,
          DofReduction(solid, surroundings.displacements,
                       slides ? sliding_interfaces(solid) : std::vector<Tie>()),
          solid.make_vector());
      const double energy = 2. * solid.strain_energy(u);
      EXPECT_GT(energy, 0.);
      // Squares of round-off times the contrast of 1e3.
      EXPECT_LT(sum_of(error_indicators(solid, u, surroundings)), 1e-20 * energy);
      if (slides) // without its partner the pressure of a side would be missed
        continue;
      // Without the supports their reactions are loads that nothing carries.
      Surroundings unheld = surroundings;
      unheld.displacements.clear();
      EXPECT_GT(sum_of(error_indicators(solid, u, unheld)), 1e-2 * energy);
    }
}

TEST(ErrorIndicator, WeightAndSpringsAreLoads)
{
  // A block of rock that stands on springs under its weight: stress is linear in y, in
  // Q2 cells exactly.
  constexpr double g = 9.81, k = 1e9;
  Triangulation triangulation(MPI_COMM_WORLD);
  make_rectangle(triangulation, 2., 1., 3, 2);
  refine_where(triangulation, [](const Point<2> &p) { return p[0] < 0.7; });
  ElasticSolid solid(triangulation, {rock}, 2);
  solid.add_to_stiffness(winkler_foundation(solid, {boundary::bottom}, k));
  Surroundings surroundings;
  surroundings.acceleration = Tensor<1, 2>({0., -g});
  surroundings.sprung = {boundary::bottom};
  surroundings.spring_stiffness = k;
  for (const unsigned int side : {boundary::left, boundary::right})
    prescribe(
        solid, side, 0, [](const Point<2> &) { return 0.; }, surroundings.displacements);
  const Vector u = solve_direct(solid, solid.stiffness(), surroundings.displacements,
                                gravity(solid, surroundings.acceleration));
  const double energy = 2. * solid.strain_energy(u);
  EXPECT_LT(sum_of(error_indicators(solid, u, surroundings)), 1e-18 * energy);
  for (const bool springs : {false, true})
  {
    Surroundings lacking = surroundings;
    if (springs)
      lacking.sprung.clear();
    else
      lacking.acceleration = Tensor<1, 2>();
    EXPECT_GT(sum_of(error_indicators(solid, u, lacking)), 1e-3 * energy) << springs;
  }
}

TEST(ErrorIndicator, OfAKinkIsItsJump)
{
  // u_x = e |x - 1| across two cells, all nodes held: tractions -+ C11 e meet.
  constexpr double e = 1e-3, height = 0.5;
  for (const unsigned int degree : {1u, 2u})
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 2., height, 2, 1);
    const ElasticSolid solid(triangulation, {rock}, degree);
    const auto kink = [](const Point<2> &p, const unsigned int c)
    { return c == 0 ? e * std::abs(p[0] - 1.) : 0.; };
    Surroundings surroundings;
    surroundings.displacements = prescribe_all_sides(solid, kink);
    const Vector u = interpolate(solid, kink);
    const double jump = 2. * e * rock.stiffness[0][0],
                 least = 2. * rock.stiffness[2][2]; // 2 mu
    // Cells are 1 long across the face of 0.5; each has half of it.
    const double expected = jump * jump * height * 1. / (degree * 2. * least);
    for (const double square : error_indicators(solid, u, surroundings))
      EXPECT_NEAR(square, expected, 1e-12 * expected);
  }
}

TEST(Refinement, HalvesTheFewestCellsThatHoldTheBulk)
{
  Triangulation triangulation(MPI_COMM_SELF);
  make_rectangle(triangulation, 4., 1., 4, 1);
  // 16 of 31 is above half.
  EXPECT_TRUE(refine(triangulation, {1., 2., 16., 12.}, {0.5}));
  EXPECT_EQ(triangulation.n_global_active_cells(), 7u);
}

TEST(Refinement, TreatsAlikeWhatIsAlike)
{
  // One of three equal cells would do.
  Triangulation triangulation(MPI_COMM_SELF);
  make_rectangle(triangulation, 4., 1., 4, 1);
  EXPECT_TRUE(refine(triangulation, {5., 5. * (1. - 1e-9), 0., 5. * (1. + 1e-9)}, {0.2}));
  EXPECT_EQ(triangulation.n_global_active_cells(), 13u);
}

TEST(Refinement, StopsAtTheLimitOfCells)
{
  Triangulation triangulation(MPI_COMM_SELF);
  make_rectangle(triangulation, 4., 1., 4, 1);
  // 4 cells, each halved one adds 3; the two that are alike do not fit.
  EXPECT_FALSE(refine(triangulation, {1., 5., 5., 1.}, {0.9, 9.}));
  EXPECT_EQ(triangulation.n_global_active_cells(), 4u);
  EXPECT_TRUE(refine(triangulation, {1., 5., 5., 1.}, {0.9, 10.}));
  EXPECT_EQ(triangulation.n_global_active_cells(), 10u);
  EXPECT_FALSE(refine(triangulation, std::vector<double>(10, 0.), {}));
}

TEST(Refinement, KeepsInterfacesInMatch)
{
  // Only cells of the strong strip are asked for, up to its two faces, twice.
  Triangulation triangulation(MPI_COMM_WORLD);
  make_stack(triangulation, false);
  for (unsigned int round = 0; round < 2; ++round)
  {
    std::vector<double> indicators;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        indicators.push_back(cell->material_id() == 0 && cell->center()[0] < 0.5 ? 1.
                                                                                 : 0.);
    EXPECT_TRUE(refine(triangulation, indicators, {1.}));
  }
  const ElasticSolid solid(triangulation, {rock, weak}, 2);
  EXPECT_NE(solid.hanging_nodes(), nullptr);
  // Throws where a node has no partner. Of four columns the first is in four parts, and
  // with neighbours within a level the second in two: 8 faces of two nodes on either
  // interface, and one at the end.
  const std::size_t n_ties =
      dealii::Utilities::MPI::sum(sliding_interfaces(solid).size(), MPI_COMM_WORLD);
  EXPECT_EQ(n_ties, 2u * (2u * (4u + 2u + 1u + 1u) + 1u));
}

TEST(Refinement, RefusesWhatItCannotUse)
{
  Triangulation triangulation(MPI_COMM_SELF);
  make_rectangle(triangulation, 2., 1., 2, 1);
  const double nan = std::nan("");
  EXPECT_THROW(refine(triangulation, {1.}, {}), std::invalid_argument);
  EXPECT_THROW(refine(triangulation, {1., -1.}, {}), std::invalid_argument);
  EXPECT_THROW(refine(triangulation, {1., nan}, {}), std::invalid_argument);
  EXPECT_THROW(refine(triangulation, {1., 1.}, {0.}), std::invalid_argument);
  EXPECT_THROW(refine(triangulation, {1., 1.}, {1.1}), std::invalid_argument);
}
} // namespace error_indicator_tests

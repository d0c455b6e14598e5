// Linear fields and rigid rotations on distorted cells.
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace patch_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
const auto rock = ElasticMaterial::isotropic(20e9, 0.25, 2500.);

/// A displacement with all four gradients and a translation [m].
double linear_field(const Point<2> &p, const unsigned int component)
{
  return component == 0 ? 1e-3 + 2e-3 * p[0] - 1e-3 * p[1]
                        : -2e-3 + 5e-4 * p[0] + 3e-3 * p[1];
}

void expect_linear_field_is_solved(const unsigned int degree)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 5);
  ElasticSolid solid(triangulation, {rock}, degree);
  const auto exact = interpolate(solid, linear_field);
  auto u = solve_direct(solid, solid.stiffness(),
                        prescribe_all_sides(solid, linear_field), solid.make_vector());
  const auto states = solid.cell_states(u);
  u -= exact;
  // Round-off times the condition of 36 nodes (some 1e2).
  EXPECT_LT(largest(u), 1e-12 * largest(exact));

  const std::array<double, 3> strain{{2e-3, 3e-3, -1e-3 + 5e-4}};
  const double size = rock.stiffness[0][0] * 3e-3;
  for (const auto &state : states)
    for (unsigned int i = 0; i < 3; ++i)
    {
      double stress = 0.;
      for (unsigned int j = 0; j < 3; ++j)
        stress += rock.stiffness[i][j] * strain[j];
      EXPECT_NEAR(state.stress[i], stress, 1e-12 * size);
      EXPECT_NEAR(state.strain[i], strain[i], 1e-12 * 3e-3);
    }
}

void expect_rotation_is_free_of_stress(const unsigned int degree)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 5);
  ElasticSolid solid(triangulation, {rock}, degree);
  const double angle = 0.1;
  const auto u = interpolate(solid, [&](const Point<2> &p, const unsigned int c)
                             { return c == 0 ? -angle * p[1] : angle * p[0]; });
  auto force = solid.make_vector();
  solid.add_internal_force(u, force);
  // Round-off of sums whose terms are as large as |K| |u|.
  EXPECT_LT(largest(force), 1e-12 * largest(solid.absolute_row_sums()) * largest(u));
  for (const auto &state : solid.cell_states(u))
  {
    for (const double stress : state.stress)
      EXPECT_NEAR(stress, 0., 1e-12 * angle * rock.stiffness[0][0]);
    EXPECT_NEAR(state.rotation, angle, 1e-12 * angle);
  }
}
} // namespace

TEST(PatchTest, LinearFieldIsSolvedExactlyByQ1)
{
  expect_linear_field_is_solved(1);
}
TEST(PatchTest, LinearFieldIsSolvedExactlyByQ2)
{
  expect_linear_field_is_solved(2);
}
TEST(PatchTest, RotationIsFreeOfStressInQ1)
{
  expect_rotation_is_free_of_stress(1);
}
TEST(PatchTest, RotationIsFreeOfStressInQ2)
{
  expect_rotation_is_free_of_stress(2);
}
} // namespace patch_tests

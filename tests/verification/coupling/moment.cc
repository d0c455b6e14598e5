// A beam of grains, overlap and mesh that is bent at its free end: the constraint holds
// no rotations of grains, and yet the section of grains carries the whole couple and
// bends as a beam of grains alone.
#include "support/column_fixture.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace antiform::coupling::test::moment_tests
{
namespace
{
/// Force and moment about the axis that joints carry across a section.
struct Section
{
  double shear = 0., moment = 0.;
};
Section across(const GrainState &state, const double x, const double y_axis)
{
  const discrete::Grains &g = state.grains;
  Section sum;
  for (std::size_t j = 0; j < state.joints.size(); ++j)
  {
    const auto a = static_cast<std::size_t>(state.joints.first[j]),
               b = static_cast<std::size_t>(state.joints.second[j]);
    if ((g.reference_x[a] < x) == (g.reference_x[b] < x))
      continue;
    // What the left part does to the grain on the right.
    const bool second_is_right = g.reference_x[b] > x;
    const discrete::JointForce &f = state.joints.force[j];
    const Vec2 force = (second_is_right ? 1. : -1.) * Vec2{f.x, f.y};
    const Vec2 arm = g.reference(second_is_right ? b : a) - Vec2{x, y_axis};
    sum.shear += force.y;
    sum.moment += cross(arm, force) + (second_is_right ? f.torque2 : f.torque1);
  }
  return sum;
}

/// Second derivative of the deflection between two places, by a parabola through all
/// grains there.
double curvature(const GrainState &state, const double from, const double to)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const discrete::Grains &g = state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.reference_x[i] > from && g.reference_x[i] < to)
    {
      const double x = g.reference_x[i];
      const Eigen::Vector3d row(1., x, 0.5 * x * x);
      normal += row * row.transpose();
      right += g.displacement_y[i] * row;
    }
  return normal.ldlt().solve(right)[2];
}

void set_and_compute(GrainState &state, const StaticSolution &u)
{
  state.grains.displacement_x = u.ux;
  state.grains.displacement_y = u.uy;
  state.grains.rotation = u.rotation;
  discrete::compute_joint_forces(state.grains, state.joints, {}, nullptr);
}

constexpr double first = -30., size = 1e-9;

/// Nodal forces of a couple @p size, or of a transverse force @p size, on the end.
void load_end(StaticSystem &system, const Column &column, const bool couple)
{
  const Bridged &model = column.model;
  const double middle = 0.5 * column.height;
  double square = 0., n = 0.;
  for (const unsigned int dof : column.end_dofs)
  {
    square += std::pow(model.mesh_place(dof).y - middle, 2);
    n += 1.;
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (x.x < column.end - 1e-9)
      continue;
    if (couple && model.solid->component(dof) == 0) // anticlockwise
      system.add_mesh_force(dof, -size * (x.y - middle) / square);
    if (!couple && model.solid->component(dof) == 1)
      system.add_mesh_force(dof, size / n);
  }
}

/// Curvature of the same rows of grains without a mesh under the same couple, far from
/// both ends.
double curvature_of_grains_alone(const double height)
{
  GrainState state;
  constexpr double length = 60.;
  state.grains = hexagonal_lattice({0., length, 0., height}, {0., 0.},
                                   [](const Vec2 &) { return true; });
  const discrete::Grains &g = state.grains;
  state.joints.begin_group(elastic_law(), 0, "grains");
  for (const auto &[i, j] : discrete::pairs_within(g, 1e-6, 0, 0))
    state.joints.add(g, i, j, 1., 1.);
  state.joints.finish(g.size());
  StaticSystem system(g, state.joints, nullptr, nullptr);
  double square = 0.;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.reference_x[i] > length - 0.25)
      square += std::pow(g.reference_y[i] - 0.5 * height, 2);
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.reference_x[i] < 0.6)
      for (const unsigned int c : {0u, 1u, 2u})
        system.fix_grain(i, c, 0.);
    else if (g.reference_x[i] > length - 0.25)
      system.add_grain_force(i, 0, -size * (g.reference_y[i] - 0.5 * height) / square);
  set_and_compute(state, system.solve());
  return curvature(state, 24., 36.);
}
} // namespace

TEST(BentBeam, GrainsCarryTheWholeCouple)
{
  Column column(first);
  column.support(0., true);
  StaticSystem system = column.static_system(true, 0.);
  load_end(system, column, true);
  set_and_compute(column.model.state, system.solve());
  const double alone = curvature_of_grains_alone(column.height);
  double worst = 0.;
  for (const double x : {-20.2, -12.2, -6.2, -1.2})
  {
    const Section found = across(column.model.state, x, 0.5 * column.height);
    // The right part is in balance: the left one does the opposite of the load to it.
    worst = std::max({worst, std::abs(found.moment / -size - 1.),
                      std::abs(found.shear) * column.height / size});
  }
  const double bent = curvature(column.model.state, -12., 0.) / alone;
  std::printf(
      "  couple: largest error of moment %.1e; curvature beside the overlap %.5f of "
      "that of grains alone\n",
      worst, bent);
  EXPECT_LE(worst,
            1e-9); // balance, to the residual of the solve and the square of rotations
  EXPECT_NEAR(bent, 1., 0.01);
}

TEST(BentBeam, GrainsCarryTheMomentOfATransverseForce)
{
  Column column(first);
  column.support(0., true);
  StaticSystem system = column.static_system(true, 0.);
  load_end(system, column, false);
  set_and_compute(column.model.state, system.solve());
  double worst = 0.;
  for (const double x : {-20.2, -12.2, -6.2, -1.2})
  {
    const Section found = across(column.model.state, x, 0.5 * column.height);
    const double wanted = -size * (column.end - x);
    worst = std::max({worst, std::abs(found.moment / wanted - 1.),
                      std::abs(found.shear / -size - 1.)});
  }
  std::printf("  transverse force: largest error of moment and shear %.1e\n", worst);
  EXPECT_LE(worst, 1e-9);
}
} // namespace antiform::coupling::test::moment_tests

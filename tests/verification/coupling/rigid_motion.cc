// Rigid motions of grains and mesh together: no force, no displacement gap.
#include "support/coupling_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::rigid_motion_tests
{
namespace
{
/// Displace all of the model rigidly, by linear kinematics.
void move_rigidly(Bridged &model, const Vec2 &shift, const double angle)
{
  discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 u = shift + angle * perpendicular(g.reference(i));
    g.displacement_x[i] = u.x;
    g.displacement_y[i] = u.y;
    g.rotation[i] = angle;
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 u = shift + angle * perpendicular(model.mesh_place(dof));
    model.mesh->displacement(dof) = model.solid->component(dof) == 0 ? u.x : u.y;
  }
  model.mesh->displacement.update_ghost_values();
}

struct Disturbance
{
  double force; ///< largest on a grain or node over stiffness (1) times motion
  double gap;   ///< displacement gap over motion
};
Disturbance disturbance(Bridged &model)
{
  discrete::Grains &g = model.state.grains;
  discrete::compute_joint_forces(g, model.state.joints, {}, nullptr);
  model.mesh->force = 0.;
  model.solid->add_internal_force(model.mesh->displacement, model.mesh->force);
  double force = model.mesh->force.linfty_norm();
  for (std::size_t i = 0; i < g.size(); ++i)
    force = std::max(
        {force, std::abs(g.force_x[i]), std::abs(g.force_y[i]), std::abs(g.torque[i])});
  const double motion = largest_displacement(model);
  return {force / motion,
          model.domain->displacement_gap(g, model.mesh->displacement) / motion};
}
} // namespace

TEST(RigidMotion, LeavesNoForceAndNoGap)
{
  for (const bool cubic : {false, true})
  {
    BlockShape shape;
    shape.cubic = cubic;
    Bridged model;
    make_lattice_block(model, shape);
    move_rigidly(model, {0.3, -1.7}, 0.);
    const Disturbance shifted = disturbance(model);
    // The joints' kinematics are exact: a linear rotation by a strains them by a^2 / 2.
    move_rigidly(model, {0., 0.}, 1e-13);
    const Disturbance turned = disturbance(model);
    std::printf("  translation: force %.1e, gap %.1e; rotation: force %.1e, gap %.1e\n",
                shifted.force, shifted.gap, turned.force, turned.gap);
    for (const Disturbance &d : {shifted, turned})
    {
      EXPECT_LE(d.force, 1e-12);
      EXPECT_LE(d.gap, 1e-12);
    }
  }
}

TEST(RigidMotion, ForceIsSeenWhenTheMotionIsNotRigid)
{
  Bridged model;
  make_lattice_block(model, {});
  move_rigidly(model, {0., 0.}, 1e-13);
  model.state.grains.displacement_x[model.state.grains.size() / 2] *= 1.01;
  EXPECT_GT(disturbance(model).force, 1e-4);
}

TEST(RigidMotion, GrainsTurnExactlyByAnyAngle)
{
  Bridged model;
  make_lattice_block(model, {});
  discrete::Grains &g = model.state.grains;
  for (const double angle : {0.3, 1.6, -3.})
  {
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const Vec2 u = rotated(g.reference(i), angle) - g.reference(i);
      g.displacement_x[i] = u.x;
      g.displacement_y[i] = u.y;
      g.rotation[i] = angle;
    }
    EXPECT_LE(disturbance(model).force, 1e-12) << angle;
  }
}

TEST(RigidMotion, MovesTheModelStatically)
{
  // Turned at the outer boundary of the mesh, all grains and nodes follow, rotations too.
  const BlockShape shape;
  Bridged model;
  make_lattice_block(model, shape);
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                      model.domain.get());
  const auto field = [](const Vec2 &x) { return Vec2{0.2, -0.1} + perpendicular(x); };
  const double out = shape.w + shape.rim - 1e-9;
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (x.x < -out || x.x > shape.core_x + out || x.y < -out || x.y > shape.core_y + out)
      system.fix_mesh(dof, model.solid->component(dof) == 0 ? field(x).x : field(x).y);
  }
  const StaticSolution u = system.solve();
  double worst = 0.;
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 wanted = field(g.reference(i));
    worst = std::max({worst, std::abs(u.ux[i] - wanted.x), std::abs(u.uy[i] - wanted.y),
                      std::abs(u.rotation[i] - 1.)});
  }
  // Condition (1e6, with the weights' floor of 1e-3) times round-off times motion 30.
  EXPECT_LE(worst, 1e-8);
}
} // namespace antiform::coupling::test::rigid_motion_tests

// Layer and mesh joined at the surface by multipliers: what the joining itself keeps.
#include "support/surface_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_tie_tests
{
namespace
{
using Kind = SurfaceTie::Kind;

/// Momentum of grains and mesh by their inertia and velocities, at reference places.
Momenta momentum(const Bridged &model)
{
  const discrete::Grains &g = model.state.grains;
  return momenta(
      model, false,
      [&](const std::size_t i)
      { return std::pair(g.mass[i] * g.velocity(i), g.inertia[i] * g.spin[i]); },
      [&](const unsigned int dof)
      { return model.mesh->mass(dof) * model.mesh->velocity(dof); });
}

Momenta resultant(const Bridged &model)
{
  const discrete::Grains &g = model.state.grains;
  return momenta(
      model, false,
      [&](const std::size_t i) {
        return std::pair(Vec2{g.force_x[i], g.force_y[i]}, g.torque[i]);
      },
      [&](const unsigned int dof) { return model.mesh->force(dof); });
}

void expect_same(const Momenta &a, const Momenta &b)
{
  const double round_off = 1e-12 * a.magnitude;
  EXPECT_NEAR(a.x, b.x, round_off);
  EXPECT_NEAR(a.y, b.y, round_off);
  EXPECT_NEAR(a.angular, b.angular, round_off);
}
} // namespace

TEST(SurfaceTie, KeepsMomentumAndAngularMomentum)
{
  for (const Kind kind : {Kind::cemented, Kind::sliding})
    for (const unsigned int degree : {1u, 2u})
    {
      LayeredShape shape;
      shape.degree = degree;
      Bridged model;
      make_layered_lattice(model, shape);
      SurfaceTie tie = make_tie(model, kind, true);
      tie.factorise(model.state.grains, model.mesh->inverse_mass);
      stir(model, 1., 3);
      const Momenta before = momentum(model);
      const double was = model.mesh->velocity.l2_norm();
      tie.project(model.state.grains, model.mesh->velocity);
      EXPECT_GT(std::abs(model.mesh->velocity.l2_norm() - was), 1e-3 * was);
      expect_same(before, momentum(model));

      discrete::Grains &g = model.state.grains;
      g.force_x = g.velocity_x;
      g.force_y = g.velocity_y;
      g.torque = g.velocity_x;
      model.mesh->force = model.mesh->velocity;
      const Momenta forces = resultant(model);
      tie.constrain_forces(g, model.mesh->force);
      expect_same(forces, resultant(model));
    }
}

TEST(SurfaceTie, LetsRigidMotionsPass)
{
  for (const Kind kind : {Kind::cemented, Kind::sliding})
  {
    Bridged model;
    make_layered_lattice(model, {});
    SurfaceTie tie = make_tie(model, kind, true);
    tie.factorise(model.state.grains, model.mesh->inverse_mass);
    discrete::Grains &g = model.state.grains;
    for (const double angle : {0., 1e-3})
    {
      move_rigidly(model, {0.3, -1.7}, angle, false);
      // Round-off of displacements.
      EXPECT_LT(tie.displacement_gap(g, model.mesh->displacement),
                1e-14 * largest_displacement(model));
      // The same as velocities: the projection has nothing to do.
      g.velocity_x = g.displacement_x;
      g.velocity_y = g.displacement_y;
      g.spin = g.rotation;
      model.mesh->velocity = model.mesh->displacement;
      tie.project(g, model.mesh->velocity);
      continuum::Vector change = model.mesh->velocity;
      change -= model.mesh->displacement;
      EXPECT_LT(change.linfty_norm(), 1e-13 * largest_displacement(model));
      for (std::size_t i = 0; i < g.size(); ++i)
        ASSERT_NEAR(g.spin[i], angle, 1e-13 * largest_displacement(model));
    }
  }
}

/// After follow() a finite rotation is a motion like any other: velocities of a body that
/// turns about the origin obey the constraint, and its normals have turned.
TEST(SurfaceTie, FollowsAFiniteRotation)
{
  for (const Kind kind : {Kind::cemented, Kind::sliding})
  {
    Bridged model;
    make_layered_lattice(model, {});
    SurfaceTie tie = make_tie(model, kind, true);
    const double angle = 0.7;
    move_rigidly(model, {0.3, -1.7}, angle, true);
    discrete::Grains &g = model.state.grains;
    tie.follow(g, model.mesh->displacement);
    tie.factorise(g, model.mesh->inverse_mass);
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const Vec2 v = perpendicular(g.position(i));
      g.velocity_x[i] = v.x;
      g.velocity_y[i] = v.y;
      g.spin[i] = 1.;
    }
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); dof += 2)
    {
      const Vec2 at = model.mesh_place(dof) + Vec2{model.mesh->displacement(dof),
                                                   model.mesh->displacement(dof + 1)};
      model.mesh->velocity(dof) = -at.y;
      model.mesh->velocity(dof + 1) = at.x;
    }
    const continuum::Vector before = model.mesh->velocity;
    tie.project(g, model.mesh->velocity);
    continuum::Vector change = model.mesh->velocity;
    change -= before;
    EXPECT_LT(change.linfty_norm(), 1e-12 * before.linfty_norm());
    if (kind == Kind::cemented)
      continue;
    // The normal is (-sin, cos): components of one node are in that ratio.
    for (const LinearForm &row : tie.rows())
      for (std::size_t k = 0; k + 1 < row.mesh.size(); k += 2)
      {
        ASSERT_EQ(row.mesh[k].dof + 1, row.mesh[k + 1].dof);
        ASSERT_NEAR(row.mesh[k].value / row.mesh[k + 1].value, -std::tan(angle), 1e-12);
      }
  }
}

/// Masses that have changed since are noticed, of the tied grains alone.
TEST(SurfaceTie, KnowsTheMassesOfItsFactor)
{
  Bridged model;
  make_layered_lattice(model, {});
  SurfaceTie tie = make_tie(model, Kind::cemented, true);
  discrete::Grains &g = model.state.grains;
  EXPECT_FALSE(tie.is_factorised_for(g));
  tie.factorise(g, model.mesh->inverse_mass);
  EXPECT_TRUE(tie.is_factorised_for(g));
  const std::int32_t outer = tie.interfaces()[1].points()[3].grain;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (std::abs(g.reference_y[i] - 0.5 * LayeredShape().thickness()) < 1.)
      g.inverse_mass[i] *= 2.; // not tied
  EXPECT_TRUE(tie.is_factorised_for(g));
  g.inverse_inertia[outer] *= 2.;
  EXPECT_FALSE(tie.is_factorised_for(g));
}

/// Cells half as large as grains: vertices between two grains follow the line from one to
/// the other, and the constraint is not singular.
TEST(SurfaceTie, BearsCellsSmallerThanGrains)
{
  LayeredShape shape;
  shape.h = 0.5;
  shape.height = 2.;
  Bridged model;
  make_layered_lattice(model, shape);
  SurfaceTie tie = make_tie(model, Kind::cemented, false);
  EXPECT_EQ(tie.n_multipliers(), 2u * 49u); // 24 d / 0.5 d + 1 vertices
  tie.factorise(model.state.grains, model.mesh->inverse_mass);
  stir(model, 1., 3);
  tie.project(model.state.grains, model.mesh->velocity);
  discrete::Grains &g = model.state.grains;
  g.displacement_x = g.velocity_x;
  g.displacement_y = g.velocity_y;
  g.rotation = g.spin;
  EXPECT_LT(tie.displacement_gap(g, model.mesh->velocity), 1e-13);
}

/// An edge in several pieces, or without a face, is the user's error.
TEST(SurfaceTie, RefusesAnEdgeThatIsNotThere)
{
  Bridged model;
  make_layered_lattice(model, {});
  const discrete::Grains &g = model.state.grains;
  EXPECT_THROW(SurfaceInterface(g, outer_side(g, {}, 1., {0., -1.}), *model.solid, 9),
               std::invalid_argument);
}

/// The outer grains of the lattice's lower side are its first row, in order, and stand
/// for the whole edge.
TEST(SurfaceTie, FindsTheOuterGrains)
{
  Bridged model;
  const LayeredShape shape;
  make_layered_lattice(model, shape);
  const discrete::Grains &g = model.state.grains;
  const SurfaceInterface below = interface_below(model);
  ASSERT_EQ(below.points().size(), 24u); // 0.137 + i <= 24
  double sum = 0.;
  for (const SurfacePoint &point : below.points())
  {
    EXPECT_DOUBLE_EQ(g.reference_y[point.grain], 0.5);
    EXPECT_NEAR(point.distance, 0.5, 1e-15);
    sum += point.length;
  }
  EXPECT_NEAR(sum, shape.length, 1e-12);
  EXPECT_NEAR(below.edge().outward().y, 1., 1e-15);
  EXPECT_NEAR(interface_above(model).edge().outward().y, -1., 1e-15);
}
} // namespace antiform::coupling::test::surface_tie_tests

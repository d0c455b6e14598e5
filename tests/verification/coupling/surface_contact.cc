// Layer and mesh in contact at the surface: Coulomb friction, opening, momentum, energy
// and the stable step.
#include "support/surface_fixtures.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_contact_tests
{
namespace
{
using continuum::ContactPhase;
using continuum::FrictionalContact;
using continuum::FrictionlessContact;
using continuum::SlidingContact;

/// A short layer on one mesh of its modulus.
LayeredShape block_on_mesh()
{
  LayeredShape shape;
  shape.above = false;
  shape.length = 12.;
  shape.rows = 3;
  shape.height = 4.;
  return shape;
}

FrictionalContact rough(const Bridged &model, const double tan_friction, const double c)
{
  const auto k =
      surface_stiffness(interface_below(model), model.state.joints, *model.solid);
  return {k.normal, k.shear, tan_friction, c};
}

Momenta resultant(const Bridged &model)
{
  const discrete::Grains &g = model.state.grains;
  return momenta(
      model, true,
      [&](const std::size_t i) {
        return std::pair(Vec2{g.force_x[i], g.force_y[i]}, g.torque[i]);
      },
      [&](const unsigned int dof) { return model.mesh->force(dof); });
}

void clear_forces(Bridged &model)
{
  discrete::Grains &g = model.state.grains;
  for (auto *f : {&g.force_x, &g.force_y, &g.torque})
    f->assign(g.size(), 0.);
  model.mesh->force = 0.;
}

/// Random displacements of all, so large that places, normals and arms change.
void shake(Bridged &model, const double size)
{
  stir(model, size, 11);
  discrete::Grains &g = model.state.grains;
  g.displacement_x = g.velocity_x;
  g.displacement_y = g.velocity_y;
  g.rotation = g.spin;
  model.mesh->displacement = model.mesh->velocity;
}
} // namespace

/// Internal forces of a bent, torn, slipped interface have no resultant and no moment
/// where they act.
TEST(SurfaceContact, KeepsMomentumAndAngularMomentum)
{
  for (const unsigned int degree : {1u, 2u})
  {
    LayeredShape shape = block_on_mesh();
    shape.degree = degree;
    Bridged model;
    make_layered_lattice(model, shape);
    SurfaceContact contact(interface_below(model), rough(model, 0.5, 1e-3), {});
    shake(model, 0.05);
    stir(model, 0.01, 5);
    clear_forces(model);
    contact.add_forces(model.state.grains, model.mesh->displacement, model.mesh->velocity,
                       1., model.mesh->force);
    int n_open = 0, n_slides = 0, n_sticks = 0;
    for (const SurfaceContact::State &state : contact.states())
    {
      n_open += state.phase == ContactPhase::open;
      n_slides += state.phase == ContactPhase::slides;
      n_sticks += state.phase == ContactPhase::sticks;
    }
    EXPECT_GT(n_open, 0);
    EXPECT_GT(n_slides + n_sticks, 0);
    const Momenta sum = resultant(model);
    ASSERT_GT(sum.magnitude, 1e-3);
    EXPECT_LT(std::abs(sum.x), 1e-12 * sum.magnitude);
    EXPECT_LT(std::abs(sum.y), 1e-12 * sum.magnitude);
    EXPECT_LT(std::abs(sum.angular), 1e-12 * sum.magnitude);
  }
}

/// Turned by a radian in 1000 steps, each of them finite: the arms and edges of a rigid
/// body keep their places on each other. A step errs in slip by r angle^3 / 24, r
/// (angle - 2 sin(angle / 2)).
TEST(SurfaceContact, LetsFiniteRotationsPass)
{
  Bridged model;
  make_layered_lattice(model, block_on_mesh());
  SurfaceContact contact(interface_below(model), rough(model, 0.5, 1.), {});
  discrete::Grains &g = model.state.grains;
  const int n = 1000;
  for (int step = 1; step <= n; ++step)
  {
    const discrete::Grains before = g;
    const continuum::Vector mesh_before = model.mesh->displacement;
    move_rigidly(model, {0.01 * step, -0.02 * step}, static_cast<double>(step) / n, true);
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      g.velocity_x[i] = g.displacement_x[i] - before.displacement_x[i];
      g.velocity_y[i] = g.displacement_y[i] - before.displacement_y[i];
      g.spin[i] = g.rotation[i] - before.rotation[i];
    }
    model.mesh->velocity = model.mesh->displacement;
    model.mesh->velocity -= mesh_before;
    contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, 1.,
                       model.mesh->force);
  }
  const double of_step = 0.5 * std::pow(1. / n, 3) / 24.;
  for (const SurfaceContact::State &state : contact.states())
  {
    EXPECT_LT(std::abs(state.gap.opening), 1e-13);
    EXPECT_NEAR(std::abs(state.gap.slip), n * of_step, 0.05 * n * of_step);
    EXPECT_NEAR(state.normal.x, -std::sin(1.), 1e-12);
  }
}

/// The normal force derives from its energy, at kinks of the edge too: central
/// differences of 1e-6 err by their square over the bend, some 1e-9.
TEST(SurfaceContact, NormalForceIsTheGradientOfTheEnergy)
{
  for (const unsigned int degree : {1u, 2u})
  {
    LayeredShape shape = block_on_mesh();
    shape.degree = degree;
    Bridged model;
    make_layered_lattice(model, shape);
    SurfaceContact contact(interface_below(model), SlidingContact{1.}, {});
    shake(model, 0.05);
    discrete::Grains &g = model.state.grains;
    MeshState &m = *model.mesh;
    const auto energy = [&]
    {
      clear_forces(model);
      contact.add_forces(g, m.displacement, m.velocity, 0., m.force);
      return contact.elastic_energy();
    };
    ASSERT_GT(energy(), 1e-4);
    const discrete::Grains at = g;
    const continuum::Vector force = m.force;
    const double small = 1e-6;
    const auto slope = [&](double &u)
    {
      const double here = u;
      u = here + small;
      const double up = energy();
      u = here - small;
      const double down = energy();
      u = here;
      return (up - down) / (2. * small);
    };
    for (const SurfacePoint &point : contact.interface().points())
    {
      EXPECT_NEAR(slope(g.displacement_x[point.grain]), -at.force_x[point.grain], 1e-8);
      EXPECT_NEAR(slope(g.displacement_y[point.grain]), -at.force_y[point.grain], 1e-8);
    }
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
      EXPECT_NEAR(slope(m.displacement.begin()[dof]), -force(dof), 1e-8);
  }
}

/// Pressed by p and pushed aside at a steady speed, the layer drags the mesh with mu p +
/// c over its length; the work of slip is force times slip.
TEST(SurfaceContact, SlipsAtTheFrictionOfItsPressure)
{
  Bridged model;
  LayeredShape shape = block_on_mesh();
  shape.length = 24.;
  make_layered_lattice(model, shape);
  discrete::Grains &g = model.state.grains;
  MeshState &m = *model.mesh;
  // A rigid layer of one row over the middle of the mesh: held grains that move as told.
  std::vector<std::int32_t> outer;
  for (const std::int32_t i : outer_side(g, {}, 1., {0., -1.}))
    if (g.reference_x[i] > 6. && g.reference_x[i] < 18.)
      outer.push_back(i);
  const double mu = 0.6, c = 2e-4;
  const auto k =
      surface_stiffness(interface_below(model), model.state.joints, *model.solid);
  SurfaceContact contact(SurfaceInterface(g, outer, *model.solid, lower_edge),
                         FrictionalContact{k.normal, k.shear, mu, c}, {});
  double length = 0.;
  for (const SurfacePoint &point : contact.interface().points())
    length += point.length;
  ASSERT_NEAR(length, outer.size(), 1e-12); // spacing 1, half of it beyond the ends

  const double p = 1e-3, slip = 5., step = 1e-3;
  double drag = 0., work = 0., at_work = 0.;
  for (int n = 0; n * step < slip; ++n)
  {
    for (const std::int32_t i : outer)
    {
      g.displacement_x[i] = n * step;
      g.velocity_x[i] = n > 0 ? step : 0.;
      g.displacement_y[i] = -p / k.normal; // the mesh does not give way: it is held
    }
    clear_forces(model);
    contact.add_forces(g, m.displacement, m.velocity, n > 0 ? 1. : 0., m.force);
    const double before = drag;
    drag = 0.;
    double pressing = 0.;
    for (const std::int32_t i : outer)
    {
      drag -= g.force_x[i];
      pressing += g.force_y[i];
    }
    EXPECT_NEAR(pressing, p * length, 1e-12);
    work += n > 0 ? 0.5 * (before + drag) * step : 0.;
    at_work = n * step;
  }
  EXPECT_NEAR(drag, (mu * p + c) * length, 1e-12);
  for (const SurfaceContact::State &state : contact.states())
    EXPECT_EQ(state.phase, ContactPhase::slides);
  // Less what is elastic: slip begins at (mu p + c) / k_t, within a step, in which the
  // force is taken to be even.
  const double elastic = (mu * p + c) / k.shear;
  EXPECT_NEAR(contact.slip_energy(), (mu * p + c) * length * (at_work - elastic),
              0.5 * k.shear * step * step * length);
  EXPECT_NEAR(contact.slip_energy() + contact.elastic_energy(),
              work + 0.5 * p * p / k.normal * length, 1e-12);
  // The torque: drag at the arm of each grain, which is pressed in by p / k_n.
  EXPECT_NEAR(g.torque[outer[3]], -(mu * p + c) * (0.5 - p / k.normal), 1e-12);
}

/// Pulled off, a frictionless or frictional layer opens: no force, all energy back.
TEST(SurfaceContact, OpensWithoutTension)
{
  for (const bool frictional : {false, true})
  {
    Bridged model;
    make_layered_lattice(model, block_on_mesh());
    const FrictionalContact law = rough(model, 0.5, 1e-3);
    SurfaceContact contact =
        frictional ? SurfaceContact(interface_below(model), law, {})
                   : SurfaceContact(interface_below(model),
                                    FrictionlessContact{law.normal_stiffness}, {});
    discrete::Grains &g = model.state.grains;
    for (const double y : {-1e-3, -5e-4, 1e-12, 1e-3, 0.5})
    {
      std::fill(g.displacement_y.begin(), g.displacement_y.end(), y);
      clear_forces(model);
      contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, 0.,
                         model.mesh->force);
      double pull = 0.;
      for (std::size_t i = 0; i < g.size(); ++i)
        pull -= g.force_y[i];
      EXPECT_NEAR(pull, y < 0. ? law.normal_stiffness * y * 12. : 0., 1e-12);
    }
    EXPECT_EQ(contact.elastic_energy(), 0.);
    EXPECT_EQ(model.mesh->force.linfty_norm(), 0.);
  }
}

/// Laid down under a pressure the layer presses from the start, and opens when that is
/// taken off; a law that cannot carry the traction is refused.
TEST(SurfaceContact, StartsUnderItsInitialTraction)
{
  Bridged model;
  make_layered_lattice(model, block_on_mesh());
  const double p = 2e-3;
  const auto pressed = [&](const Vec2 &, const Vec2 &normal) { return -p * normal; };
  const FrictionalContact law = rough(model, 0.5, 0.);
  SurfaceContact contact(interface_below(model), law, pressed);
  discrete::Grains &g = model.state.grains;
  const double lift = p / law.normal_stiffness;
  for (const double share : {0., 0.5, 1.001})
  {
    std::fill(g.displacement_y.begin(), g.displacement_y.end(), share * lift);
    clear_forces(model);
    contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, 0.,
                       model.mesh->force);
    double push = 0.;
    for (std::size_t i = 0; i < g.size(); ++i)
      push += g.force_y[i];
    EXPECT_NEAR(push, share < 1. ? (1. - share) * p * 12. : 0., 1e-14);
  }
  EXPECT_THROW(SurfaceContact(interface_below(model), law,
                              [&](const Vec2 &, const Vec2 &n)
                              { return -p * n + 0.51 * p * perpendicular(n); }),
               std::invalid_argument);
  EXPECT_THROW(SurfaceContact(interface_below(model), FrictionlessContact{0.}, {}),
               std::invalid_argument);
}

/// Masses scaled to a step with the contact's stiffness are stable at it, also under
/// contacts that are much stiffer than either side; without its stiffness they are not.
TEST(SurfaceContact, MassesScaledWithItsStiffnessAreStable)
{
  for (const double stiffness : {1., 100.})
    for (const bool counted : {true, false})
    {
      Bridged model;
      make_layered_lattice(model, block_on_mesh());
      discrete::Grains &g = model.state.grains;
      const SurfaceContact contact(
          interface_below(model), FrictionalContact{stiffness, 0.5 * stiffness, 0.5, 0.});
      discrete::StiffnessSums sums =
          discrete::stiffness_sums(g, model.state.joints, false);
      std::vector<double> rows(model.n_mesh_dofs(), 0.);
      if (counted)
        contact.add_stiffness(sums, rows);
      const double dt0 = 10.; // far above the step of the real masses
      discrete::scale_density(g, sums, {}, dt0);
      model.mesh->scale_density(model.solid->lumped_mass(), rows, dt0);
      const double step = surface_stable_step(g, model.state.joints, *model.solid,
                                              model.mesh->inverse_mass, {&contact});
      if (counted)
      {
        EXPECT_GE(step, dt0 * (1. - 1e-12));
        EXPECT_LT(step, 1.5 * dt0); // by mass, not by the bound's slack
      }
      else if (stiffness > 1.)
      {
        EXPECT_LT(step, 0.5 * dt0);
      }
    }
}

/// A centre behind the edge has no side to be pushed to.
TEST(SurfaceContact, RefusesGrainsBehindTheEdge)
{
  Bridged model;
  make_layered_lattice(model, block_on_mesh());
  discrete::Grains &g = model.state.grains;
  SurfaceContact contact(interface_below(model), FrictionlessContact{1.}, {});
  std::fill(g.displacement_y.begin(), g.displacement_y.end(), -0.6);
  EXPECT_THROW(contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, 0.,
                                  model.mesh->force),
               NumericalError);
  for (double &y : g.reference_y)
    y -= 0.6;
  EXPECT_THROW(SurfaceContact(interface_below(model), FrictionlessContact{1.}, {}),
               std::invalid_argument);
}

/// Two disks of radius 1/2 and modulus 1 have k_n = 1; a soft mesh gives ten times its
/// own stiffness per row of cells.
TEST(SurfaceContact, IsAsStiffAsTheSofterSide)
{
  for (const double ratio : {1., 1e-3})
  {
    LayeredShape shape = block_on_mesh();
    shape.modulus_ratio = ratio;
    Bridged model;
    make_layered_lattice(model, shape);
    const auto C = lattice_material(elastic_law()).stiffness;
    const auto k =
        surface_stiffness(interface_below(model), model.state.joints, *model.solid);
    EXPECT_NEAR(k.normal, ratio == 1. ? 1. : 10. * ratio * C[1][1] / 2., 1e-12);
    EXPECT_NEAR(k.shear, ratio == 1. ? 1. / 2.2 : 10. * ratio * C[2][2] / 2., 1e-12);
  }
}

/// A grain that moves by cells follows the edge; one that has left it is free: past
/// the corner by more than sqrt(0.5^2 - 0.49^2) = 0.0995.
TEST(SurfaceContact, FollowsAlongTheEdge)
{
  Bridged model;
  make_layered_lattice(model, block_on_mesh());
  discrete::Grains &g = model.state.grains;
  SurfaceContact contact(interface_below(model), FrictionlessContact{1.}, {});
  const std::int32_t grain = contact.interface().points().back().grain; // the leftmost
  const double start = g.reference_x[grain];
  g.displacement_y[grain] = -0.01;
  for (double x = 0.; x < 13.; x += 0.05)
  {
    g.displacement_x[grain] = x;
    clear_forces(model);
    contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, 0.,
                       model.mesh->force);
    const SurfaceContact::State &state = contact.states().back();
    if (start + x <= 12.)
    {
      EXPECT_NEAR(contact.interface().edge().distance_along(state.place), 12. - start - x,
                  1e-12);
      EXPECT_GT(g.force_y[grain], 0.);
    }
    else if (start + x > 12.0995)
    {
      EXPECT_EQ(g.force_y[grain], 0.);
    }
  }
}
} // namespace antiform::coupling::test::surface_contact_tests

// Grains of the overlap that nothing holds: found, and tied to the mesh in all.
#include "support/coupling_loop.h"
#include "support/lattice_patch.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace antiform::coupling::test::grain_ties_tests
{
namespace
{
/// A row of grains along x from the core (x <= 0) into the overlap.
struct Row
{
  discrete::Grains grains;
  discrete::Joints joints;
  OverlapWeight weight;

  Row(const std::vector<Vec2> &places, const discrete::JointLaw &law)
  {
    weight.distance_to_core = [](const Vec2 &x) { return std::max(0., x.x); };
    weight.width = 8.;
    for (const Vec2 &x : places)
      grains.add(x, 0.5, 1., 0);
    joints.begin_group(law, 0, "grains");
    for (const auto &[i, j] : discrete::pairs_within(grains, 1e-6, 0, 0))
      joints.add(grains, i, j, 1., 1.);
    joints.finish(grains.size());
    joints.weight = joint_weights(grains, joints, weight);
  }
  std::vector<std::int32_t> unsupported() const
  {
    return unsupported_grains(grains, joints, weight);
  }
};

/// A lattice block whose rim has a grain without joints, and two that only hold each
/// other: their neighbours are left out.
void make_block_with_loose_grains(Bridged &model,
                                  const BlockShape &shape,
                                  const bool with_loose = true)
{
  make_block_mesh(model, shape);
  const Rectangle box{-shape.w, shape.core_x + shape.w, -shape.w, shape.core_y + shape.w};
  const discrete::Grains all = hexagonal_lattice(
      box, {0.137, 0.271}, [&](const Vec2 &x) { return model.weight.holds_grains(x); });
  const auto nearest = [&](const Vec2 &to)
  {
    std::size_t best = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (norm(all.reference(i) - to) < norm(all.reference(best) - to))
        best = i;
    return all.reference(best);
  };
  const Vec2 alone = nearest({shape.core_x + shape.w - 0.5, 8.}),
             one = nearest({-shape.w + 0.5, 8.}),
             two = nearest(one + Vec2{0.5, 0.5 * std::sqrt(3.)});
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const Vec2 x = all.reference(i);
    const bool is_loose =
        norm(x - alone) < 0.1 || norm(x - one) < 0.1 || norm(x - two) < 0.1;
    const bool is_beside =
        norm(x - alone) < 1.1 || norm(x - one) < 1.1 || norm(x - two) < 1.1;
    if (is_loose ? with_loose : !is_beside)
      model.state.grains.add(x, 0.5, 1., 0);
  }
  const FlatJoint law = elastic_law();
  model.join(law, 1e-6, lattice_material(law), shape.h * shape.h);
}

Vec2 mesh_displacement(const Bridged &model, const StaticSolution &u, const Vec2 &x)
{
  const continuum::PointEvaluation shape = model.solid->shape_values({x.x, x.y});
  Vec2 sum;
  for (std::size_t k = 0; k < shape.value.size(); ++k)
    sum += shape.value[k] * Vec2{u.mesh(shape.dof_x[k]), u.mesh(shape.dof_y[k])};
  return sum;
}
/// Half the curl, by central differences.
double mesh_rotation(const Bridged &model, const StaticSolution &u, const Vec2 &x)
{
  constexpr double step = 1e-4;
  const auto difference = [&](const Vec2 &d)
  { return mesh_displacement(model, u, x + d) - mesh_displacement(model, u, x - d); };
  return 0.25 / step * (difference({step, 0.}).y - difference({0., step}).x);
}

bool is_outer(const BlockShape &shape, const Vec2 &x)
{
  const double out = shape.w + shape.rim - 1e-9;
  return x.x < -out || x.x > shape.core_x + out || x.y < -out || x.y > shape.core_y + out;
}
} // namespace

TEST(UnsupportedGrains, AreThoseWithoutAPathToTheCore)
{
  // 0, 1: core; 2, 3: a row hanging on one joint; 4: alone; 5, 6: a pair on its own.
  const Row row({{-1., 0.}, {0., 0.}, {1., 0.}, {2., 0.}, {4., 0.}, {6., 0.}, {6., 1.}},
                elastic_law());
  EXPECT_EQ(row.unsupported(), (std::vector<std::int32_t>{4, 5, 6}));
}

TEST(UnsupportedGrains, AreThoseThatRollOnAJointWithoutMoment)
{
  discrete::ContactBond bond;
  bond.effective_modulus = 1.;
  bond.stiffness_ratio = 2.2;
  // A row: the last rolls on the one before it, and once it is out so does that one.
  const Row row({{-1., 0.}, {0., 0.}, {1., 0.}, {2., 0.}}, bond);
  EXPECT_EQ(row.unsupported(), (std::vector<std::int32_t>{2, 3}));
  // Two joints at an angle hold it.
  const Row held({{0., 0.}, {0., 1.}, {0.5 * std::sqrt(3.), 0.5}}, bond);
  EXPECT_EQ(held.unsupported(), (std::vector<std::int32_t>{}));
}

TEST(UnsupportedGrains, AreNoneOfALattice)
{
  Bridged model;
  make_lattice_block(model, {});
  EXPECT_TRUE(
      unsupported_grains(model.state.grains, model.state.joints, model.weight).empty());
}

TEST(TiedGrains, MakeTheSystemRegularAndKeepUniformStrain)
{
  BlockShape shape;
  Bridged loose;
  make_block_with_loose_grains(loose, shape);
  EXPECT_THROW(solve_patch(loose, shape, unit_strains[0], loose.domain.get()),
               NumericalError);

  Bridged model;
  model.tie_unsupported = true;
  make_block_with_loose_grains(model, shape);
  ASSERT_EQ(model.options.tied_grains.size(), 3u);
  // The same holes without the loose grains: what the missing grains do to the patch.
  Bridged empty;
  make_block_with_loose_grains(empty, shape, false);
  PatchError worst, of_holes;
  for (const Strain &strain : unit_strains)
  {
    of_holes.enlarge(
        error_of(empty, strain, solve_patch(empty, shape, strain, empty.domain.get())));
    const StaticSolution u = solve_patch(model, shape, strain, model.domain.get());
    worst.enlarge(error_of(model, strain, u));
    for (const std::int32_t i : model.options.tied_grains)
    {
      const Vec2 wanted = mesh_displacement(model, u, model.state.grains.reference(i));
      EXPECT_NEAR(u.ux[i], wanted.x, 1e-9);
      EXPECT_NEAR(u.uy[i], wanted.y, 1e-9);
      EXPECT_NEAR(u.rotation[i], mesh_rotation(model, u, model.state.grains.reference(i)),
                  1e-6); // differences over 1e-4
    }
  }
  std::printf("  tied: core strain %.2e, joint force %.2e, mesh %.2e; holes alone %.2e, "
              "%.2e, %.2e\n",
              worst.strain, worst.force, worst.mesh, of_holes.strain, of_holes.force,
              of_holes.mesh);
  EXPECT_LE(worst.strain, 1.1 * of_holes.strain);
  EXPECT_LE(worst.force, 1.1 * of_holes.force);
  EXPECT_LE(worst.mesh, 1.1 * of_holes.mesh);
  // Demands of a random packing, since the rim has holes.
  EXPECT_LE(worst.strain, 2.5e-2);
  EXPECT_LE(worst.force, 3e-2);
  EXPECT_LE(worst.mesh, 0.10);
}

TEST(TiedGrains, MoveAndTurnWithTheMesh)
{
  BlockShape shape;
  Bridged model;
  model.tie_unsupported = true;
  make_block_with_loose_grains(model, shape);
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                      model.domain.get());
  const auto field = [](const Vec2 &x) { return Vec2{0.2, -0.1} + perpendicular(x); };
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (is_outer(shape, x))
      system.fix_mesh(dof, model.solid->component(dof) == 0 ? field(x).x : field(x).y);
  }
  const StaticSolution u = system.solve();
  const discrete::Grains &g = model.state.grains;
  double worst = 0.;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 wanted = field(g.reference(i));
    worst = std::max({worst, std::abs(u.ux[i] - wanted.x), std::abs(u.uy[i] - wanted.y),
                      std::abs(u.rotation[i] - 1.)});
  }
  EXPECT_LE(worst, 1e-8); // as without ties (rigid_motion.cc)
}

TEST(TiedGrains, ForcesHaveTheSameWorkOnGrainsAndNodes)
{
  Bridged model;
  model.tie_unsupported = true;
  make_block_with_loose_grains(model, {});
  discrete::Grains &g = model.state.grains;
  discrete::Random random(5, 0);
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    model.mesh->velocity(dof) = random.uniform();
  model.domain->ties().follow(g, model.mesh->velocity);
  double wanted = 0.;
  for (const std::int32_t i : model.options.tied_grains)
  {
    g.force_x[i] = random.uniform();
    g.force_y[i] = random.uniform();
    g.torque[i] = random.uniform();
    wanted += g.force_x[i] * g.velocity_x[i] + g.force_y[i] * g.velocity_y[i] +
              g.torque[i] * g.spin[i];
  }
  model.mesh->force = 0.;
  model.domain->ties().move_forces(g, model.mesh->force);
  EXPECT_NEAR(model.mesh->force * model.mesh->velocity, wanted, 1e-13 * wanted);
  for (const std::int32_t i : model.options.tied_grains)
    EXPECT_EQ(g.force_x[i], 0.);
}

TEST(TiedGrains, KeepEnergyMomentumAndTheStepOfTheLoop)
{
  Bridged model;
  model.tie_unsupported = true;
  const BlockShape shape;
  make_block_with_loose_grains(model, shape);
  // Free body: momentum of all that moves, the tied grains' in the nodes' masses.
  const auto momentum = [&]
  {
    Vec2 sum;
    const discrete::Grains &g = model.state.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (g.inverse_mass[i] > 0.)
        sum += (1. / g.inverse_mass[i]) * g.velocity(i);
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const double p = model.mesh->mass(dof) * model.mesh->velocity(dof);
      model.solid->component(dof) == 0 ? sum.x += p : sum.y += p;
    }
    return sum;
  };
  model.factorise();
  white_noise(model, 1e-9, 4);
  // What the tied pair adds to the mesh's rows hardly shows beside the rows themselves.
  const std::vector<double> extra = model.domain->ties().absolute_row_sums(
      model.state.grains, model.state.joints, model.n_mesh_dofs());
  const continuum::Vector rows = model.solid->absolute_row_sums();
  double bound = model.grain_step();
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    bound = std::min(
        bound, 2. / std::sqrt((rows(dof) + extra[dof]) * model.mesh->inverse_mass(dof)));
  EXPECT_GT(*std::max_element(extra.begin(), extra.end()), 0.);
  const Vec2 before = momentum();
  Loop run(model, 0.99 * bound, {});
  double first = 0., drift = 0.;
  run.probe(100,
            [&](const Clock &clock)
            {
              const Energies e = run.simulation.energies();
              const double energy = e.kinetic + e.strain_grains + e.strain_continuum;
              if (clock.step == 0)
                first = energy;
              drift = std::max(drift, std::abs(energy / first - 1.));
            });
  run.advance(5001);
  const Vec2 after = momentum();
  EXPECT_GT(first, 0.);
  EXPECT_LE(drift, 1e-8); // exact for linear forces; joints turn by 1e-9
  EXPECT_NEAR(after.x, before.x, 1e-10 * norm(before));
  EXPECT_NEAR(after.y, before.y, 1e-10 * norm(before));
}
} // namespace antiform::coupling::test::grain_ties_tests

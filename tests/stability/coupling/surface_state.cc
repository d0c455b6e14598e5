// Surface interface: what its springs are in a static system, what it keeps from step to
// step, and how its constraint follows grains that slide.
#include "support/coupling_loop.h"
#include "support/files.h"
#include "support/surface_fixtures.h"

#include "coupling/state_file.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_state_tests
{
namespace
{
using continuum::FrictionalContact;
using Kind = SurfaceTie::Kind;

LayeredShape block_on_mesh()
{
  LayeredShape shape;
  shape.above = false;
  shape.length = 12.;
  shape.rows = 4;
  shape.height = 4.;
  return shape;
}

/// A layer in contact or tied, stirred, in a loop of its own.
struct Stirred
{
  Bridged model;
  std::optional<SurfaceContact> contact;
  std::optional<SurfaceTie> tie;
  std::optional<Loop> loop;

  explicit Stirred(const bool tied)
  {
    make_layered_lattice(model, block_on_mesh());
    Loop::Options options;
    options.bridged = false;
    if (tied)
    {
      tie.emplace(make_tie(model, Kind::sliding, false));
      tie->factorise(model.state.grains, model.mesh->inverse_mass);
      stir(model, 1e-3, 5);
      tie->project(model.state.grains, model.mesh->velocity);
    }
    else
    {
      const auto k =
          surface_stiffness(interface_below(model), model.state.joints, *model.solid);
      contact.emplace(interface_below(model),
                      FrictionalContact{k.normal, k.shear, 0.3, 1e-4},
                      [](const Vec2 &, const Vec2 &n) { return -1e-4 * n; });
      stir(model, 1e-3, 5);
    }
    loop.emplace(model, 0.2, options);
    if (tied)
      loop->add(std::make_unique<TiedSurface>(*tie, model.state, *model.mesh, true, 7),
                {Stage::forces, Stage::damp, Stage::constrain}, 94, "tie");
    else
      loop->add(
          std::make_unique<SurfaceContactForces>(*contact, model.state, *model.mesh),
          {Stage::forces}, 30, "contact");
  }
};
} // namespace

/// Resumed between two turns of the rows, a run gives the same bits.
TEST(SurfaceState, ResumesWithTheSameBits)
{
  for (const bool tied : {false, true})
  {
    antiform::test::TemporaryFolder folder;
    const std::string path = folder.path("state.h5");
    Stirred whole(tied), resumed(tied);
    whole.loop->advance(53);
    {
      StateWriter writer;
      whole.loop->simulation.visit_state(writer);
      writer.commit(path);
    }
    whole.loop->advance(40);
    StateReader reader(path);
    resumed.loop->simulation.visit_state(reader);
    resumed.loop->advance(40);
    const discrete::Grains &a = whole.model.state.grains, &b = resumed.model.state.grains;
    EXPECT_EQ(a.displacement_x, b.displacement_x);
    EXPECT_EQ(a.velocity_y, b.velocity_y);
    EXPECT_EQ(a.spin, b.spin);
    for (unsigned int dof = 0; dof < whole.model.n_mesh_dofs(); ++dof)
      ASSERT_EQ(whole.model.mesh->velocity(dof), resumed.model.mesh->velocity(dof));
    if (!tied)
    {
      EXPECT_GT(whole.contact->slip_energy(), 0.);
      EXPECT_EQ(whole.contact->slip_energy(), resumed.contact->slip_energy());
    }
  }
}

/// Slid along by 3.3 d, a grain is bound to the vertices that are beside it now.
TEST(SurfaceState, SlidingTieFindsNewVertices)
{
  Bridged model;
  make_layered_lattice(model, block_on_mesh());
  SurfaceTie tie = make_tie(model, Kind::sliding, false);
  discrete::Grains &g = model.state.grains;
  std::fill(g.displacement_x.begin(), g.displacement_x.end(), -3.3);
  tie.follow(g, model.mesh->displacement);
  ASSERT_GT(tie.n_multipliers(), 4u);
  for (const LinearForm &row : tie.rows())
  {
    double from = 12., to = 0.;
    for (const LinearForm::MeshTerm &term : row.mesh)
    {
      from = std::min(from, model.mesh_place(term.dof).x);
      to = std::max(to, model.mesh_place(term.dof).x);
    }
    // A grain more on either side, that shares the last stretch.
    for (const LinearForm::GrainTerm &term : row.grains)
      if (from > 0.) // at the edge's end grains have slid beyond it
      {
        EXPECT_GT(g.position(term.grain).x, from - 1.);
        EXPECT_LT(g.position(term.grain).x, to + 1.);
      }
  }
  tie.factorise(g, model.mesh->inverse_mass);
}

/// Springs of the static system are the linearised forces: at the static solution grains
/// and mesh are in equilibrium with the contact's own forces.
TEST(SurfaceState, StaticSpringsAreTheLinearisedContact)
{
  Bridged model;
  const LayeredShape shape = block_on_mesh();
  make_layered_lattice(model, shape);
  const auto k =
      surface_stiffness(interface_below(model), model.state.joints, *model.solid);
  const double initial = 1e-7, load = 1e-9; // closed for certain, linear to 1e-7
  SurfaceContact contact(interface_below(model),
                         FrictionalContact{k.normal, k.shear, 0., 1.},
                         [&](const Vec2 &, const Vec2 &n) { return -initial * n; });
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(), nullptr);
  contact.add_to(system);
  std::vector<bool> is_held(model.n_mesh_dofs(), false);
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    if (model.mesh_place(dof).y < 1e-9 - shape.height)
    {
      system.fix_mesh(dof, 0.);
      is_held[dof] = true;
    }
  discrete::Grains &g = model.state.grains;
  std::vector<Vec2> external(g.size());
  for (const std::int32_t i : outer_side(g, {}, 1., {0., 1.}))
  {
    external[i] = {0.3 * load, -load};
    system.add_grain_force(i, 0, external[i].x);
    system.add_grain_force(i, 1, external[i].y);
  }
  const StaticSolution solution = system.solve();

  const auto forces = [&](const double dt)
  {
    compute_forces(model);
    contact.add_forces(g, model.mesh->displacement, model.mesh->velocity, dt,
                       model.mesh->force);
  };
  forces(0.);
  const discrete::Grains at_rest = g;
  const continuum::Vector mesh_at_rest = model.mesh->force;
  set_displacement(model, solution);
  g.velocity_x = g.displacement_x; // a step of 1 s led here
  g.velocity_y = g.displacement_y;
  g.spin = g.rotation;
  model.mesh->velocity = model.mesh->displacement;
  forces(1.);
  const double tolerance = 1e-5 * load; // initial traction times rotation, 12 d of them
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    EXPECT_NEAR(g.force_x[i] - at_rest.force_x[i] + external[i].x, 0., tolerance);
    EXPECT_NEAR(g.force_y[i] - at_rest.force_y[i] + external[i].y, 0., tolerance);
    EXPECT_NEAR(g.torque[i] - at_rest.torque[i], 0., tolerance);
  }
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const double unbalanced = model.mesh->force(dof) - mesh_at_rest(dof);
    EXPECT_LT(is_held[dof] ? 0. : std::abs(unbalanced), tolerance);
  }
  double pressed = 0., dragged = 0.;
  for (std::size_t p = 0; p < contact.states().size(); ++p)
  {
    const double length = contact.interface().points()[p].length;
    pressed -= length * (contact.states()[p].traction.normal + initial);
    dragged += length * contact.states()[p].traction.shear;
  }
  EXPECT_NEAR(pressed, 12. * load, 1e-4 * load);
  EXPECT_NEAR(dragged, 0.3 * 12. * load, 1e-4 * load); // along +x: the normal turned
}
} // namespace antiform::coupling::test::surface_state_tests

// Surface interface in the loop: rest, energy, stable step.
#include "support/coupling_loop.h"
#include "support/surface_fixtures.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_tests
{
namespace
{
using Kind = SurfaceTie::Kind;
using continuum::FrictionalContact;
using continuum::FrictionlessContact;
using continuum::SlidingContact;

LayeredShape block_on_mesh()
{
  LayeredShape shape;
  shape.above = false;
  shape.length = 12.;
  shape.rows = 4;
  shape.height = 4.;
  return shape;
}

/// The lower rim of the mesh held.
void hold_below(Bridged &model, const LayeredShape &shape)
{
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    if (model.mesh_place(dof).y < 1e-9 - shape.height)
      model.mesh->prescribe(dof, -1);
}

/// A tie in the loop.
void add_tie(Loop &loop, Bridged &model, SurfaceTie &tie, const bool at_samples_only)
{
  loop.add(std::make_unique<TiedSurface>(tie, model.state, *model.mesh, at_samples_only),
           {Stage::damp, Stage::constrain}, 94, "surface interface");
}
SurfaceContactForces &add_contact(Loop &loop, Bridged &model, SurfaceContact &contact)
{
  return loop.add(
      std::make_unique<SurfaceContactForces>(contact, model.state, *model.mesh),
      {Stage::forces}, 30, "surface contact");
}

/// Largest departure of the ledger from its first sample, over the energy at start.
struct Ledger
{
  double start = 0., drift = 0., slip = 0.;
  int n_open = 0; ///< contacts, of all samples
  void sample(const Loop &loop)
  {
    const Energies e = loop.simulation.energies();
    const double total = e.stored_and_spent() - e.boundary_work;
    if (start == 0.)
      start = total;
    drift = std::max(drift, std::abs(total - start) / start);
    slip = e.slip;
  }
};

/// Of grains, mesh and what @p add_forces adds, on velocities that @p project projects.
double largest_frequency(Bridged &model,
                         const std::function<void()> &add_forces,
                         const std::function<void()> &project)
{
  stir(model, 1., 17);
  return frequency_by_power_iteration(model, add_forces, project, 800);
}
} // namespace

/// The static solution of tied grains and mesh is at rest in the loop, with any damping:
/// forces are constrained before they are damped; and the supports carry the load.
TEST(Surface, TiedLayerAtRestStaysAtRest)
{
  for (const double alpha : {0., 0.7})
  {
    Bridged model;
    const LayeredShape shape = block_on_mesh();
    make_layered_lattice(model, shape);
    hold_below(model, shape);
    SurfaceTie tie = make_tie(model, Kind::cemented, false);
    tie.factorise(model.state.grains, model.mesh->inverse_mass);
    StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                        nullptr);
    tie.add_to(system);
    for (const PrescribedDof &entry : model.mesh->prescribed)
      system.fix_mesh(entry.dof, 0.);
    std::vector<GrainLoad> loads; // 1e-9: the joints' kinematics are linear to 1e-9
    Vec2 load;
    for (const std::int32_t i : outer_side(model.state.grains, {}, 1., {0., 1.}))
    {
      loads.push_back({i, {3e-10, -1e-9}, 0.});
      load += loads.back().force;
      system.add_grain_force(i, 0, loads.back().force.x);
      system.add_grain_force(i, 1, loads.back().force.y);
    }
    set_displacement(model, system.solve());
    const double settled = model.mesh->displacement.linfty_norm();
    const continuum::Vector at_rest = model.mesh->displacement;

    Loop::Options options;
    options.damping = alpha;
    options.bridged = false;
    options.wall_speed = [](double) { return 0.; };
    Loop loop(model, 0.9 * model.stable_step(), options);
    add_tie(loop, model, tie, alpha == 0.);
    loop.add(std::make_unique<GrainLoads>(model.state, loads), {Stage::forces}, 30,
             "load");
    double ratio = 0.;
    loop.probe(1,
               [&](const Clock &) { ratio = std::max(ratio, loop.unbalanced_ratio()); });
    loop.advance(500);
    EXPECT_LT(ratio, 1e-8);
    continuum::Vector change = model.mesh->displacement;
    change -= at_rest;
    EXPECT_LT(change.linfty_norm(), 1e-7 * settled);
    Vec2 reaction;
    for (const PrescribedDof &entry : model.mesh->prescribed)
      (model.solid->component(entry.dof) == 0 ? reaction.x : reaction.y) +=
          entry.reaction;
    EXPECT_NEAR(reaction.x, -load.x, 1e-7 * norm(load));
    EXPECT_NEAR(reaction.y, -load.y, 1e-7 * norm(load));
  }
}

/// Held at the edge itself a support carries what the tie brings: the grains hang on
/// prescribed dofs.
TEST(Surface, SupportOnTheTieCarriesTheLoad)
{
  Bridged model;
  const LayeredShape shape = block_on_mesh();
  make_layered_lattice(model, shape);
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    model.mesh->prescribe(dof, -1);
  SurfaceTie tie = make_tie(model, Kind::cemented, false);
  tie.factorise(model.state.grains, model.mesh->inverse_mass);
  std::vector<GrainLoad> loads;
  Vec2 load;
  for (const std::int32_t i : outer_side(model.state.grains, {}, 1., {0., 1.}))
  {
    loads.push_back({i, {3e-10, -1e-9}, 0.});
    load += loads.back().force;
  }
  Loop::Options options;
  options.damping = 0.7;
  options.bridged = false;
  options.wall_speed = [](double) { return 0.; };
  Loop loop(model, 0.9 * model.grain_step(), options);
  add_tie(loop, model, tie, false);
  loop.add(std::make_unique<GrainLoads>(model.state, loads), {Stage::forces}, 30, "load");
  loop.probe(1, [](const Clock &) {});
  loop.advance(4000);
  EXPECT_LT(loop.unbalanced_ratio(), 1e-6);
  Vec2 reaction;
  for (const PrescribedDof &entry : model.mesh->prescribed)
    (model.solid->component(entry.dof) == 0 ? reaction.x : reaction.y) += entry.reaction;
  EXPECT_NEAR(reaction.x, -load.x, 1e-5 * norm(load));
  EXPECT_NEAR(reaction.y, -load.y, 1e-5 * norm(load));
}

/// Projection never raises the largest frequency; here it leaves it within 2 %.
TEST(Surface, TieDoesNotReduceTheStableStep)
{
  for (const Kind kind : {Kind::cemented, Kind::sliding})
    for (const double ratio : {1., 20.})
    {
      LayeredShape shape = block_on_mesh();
      shape.modulus_ratio = ratio;
      Bridged model;
      make_layered_lattice(model, shape);
      SurfaceTie tie = make_tie(model, kind, false);
      tie.factorise(model.state.grains, model.mesh->inverse_mass);
      const double apart = largest_frequency(
          model, [] {}, [] {});
      const double tied = largest_frequency(
          model, [] {}, [&] { tie.project(model.state.grains, model.mesh->velocity); });
      EXPECT_LT(tied, apart * (1. + 1e-6)); // the iteration's error, from below
      EXPECT_GT(tied, 0.9 * apart);
      EXPECT_LT(model.stable_step(), 2. / tied);
      std::printf("%s, modulus ratio %g: frequency tied over apart %.4f\n",
                  kind == Kind::cemented ? "cemented" : "sliding", ratio, tied / apart);
    }
}

/// 1e4 steps at 0.9 of the stable step from white noise.
TEST(Surface, TieKeepsEnergyAndGap)
{
  for (const Kind kind : {Kind::cemented, Kind::sliding})
  {
    Bridged model;
    make_layered_lattice(model, block_on_mesh());
    SurfaceTie tie = make_tie(model, kind, false);
    tie.factorise(model.state.grains, model.mesh->inverse_mass);
    stir(model, 1e-6, 23); // linear kinematics
    tie.project(model.state.grains, model.mesh->velocity);
    Loop::Options options;
    options.bridged = false;
    Loop loop(model, 0.9 * model.stable_step(), options);
    add_tie(loop, model, tie, true);
    Ledger ledger;
    double gap = 0., size = 0.;
    loop.probe(50,
               [&](const Clock &)
               {
                 ledger.sample(loop);
                 gap = std::max(gap, tie.displacement_gap(model.state.grains,
                                                          model.mesh->displacement));
                 size = std::max(size, largest_displacement(model));
               });
    loop.advance(10000);
    EXPECT_LT(ledger.drift, 1e-4);
    EXPECT_LT(gap, 1e-10 * size);
    std::printf("%s: drift %.1e, gap %.1e\n",
                kind == Kind::cemented ? "cemented" : "sliding", ledger.drift,
                gap / size);
  }
}

namespace
{
/// A layer laid down on a mesh under a pressure, thrown along the edge or off it.
Ledger thrown_layer(
    const std::function<continuum::ContactLaw(const continuum::ContactStiffness &)> &law,
    const Vec2 &velocity,
    const double share_of_step,
    const int n_steps)
{
  Bridged model;
  const LayeredShape shape = block_on_mesh();
  make_layered_lattice(model, shape);
  hold_below(model, shape);
  const double p = 1e-4;
  SurfaceContact contact(
      interface_below(model),
      law(surface_stiffness(interface_below(model), model.state.joints, *model.solid)),
      [p](const Vec2 &, const Vec2 &n) { return -p * n; });
  // What presses on the layer's other side and in the mesh: loads that do not change.
  std::vector<GrainLoad> on_grains;
  continuum::Vector on_mesh = model.solid->make_vector();
  for (const SurfacePoint &point : contact.interface().points())
  {
    on_grains.push_back({point.grain, {0., -p * point.length}, 0.});
    const EdgeCurve::Shape at = contact.interface().edge().shape(point.place);
    for (unsigned int n = 0; n < at.n; ++n)
      on_mesh(at.dofs[n][1]) += p * point.length * at.value[n];
  }
  discrete::Grains &g = model.state.grains;
  g.velocity_x.assign(g.size(), velocity.x);
  g.velocity_y.assign(g.size(), velocity.y);
  Loop::Options options;
  options.bridged = false;
  const double dt =
      share_of_step * surface_stable_step(g, model.state.joints, *model.solid,
                                          model.mesh->inverse_mass, {&contact});
  Loop loop(model, dt, options);
  add_contact(loop, model, contact);
  loop.add(std::make_unique<GrainLoads>(model.state, on_grains), {Stage::forces}, 31,
           "pressure on the layer");
  loop.add(std::make_unique<MeshLoads>(*model.mesh, on_mesh), {Stage::forces}, 32,
           "pressure on the mesh");
  Ledger ledger;
  loop.probe(20,
             [&](const Clock &)
             {
               ledger.sample(loop);
               for (const SurfaceContact::State &state : contact.states())
                 ledger.n_open += state.phase == continuum::ContactPhase::open;
             });
  loop.advance(n_steps);
  return ledger;
}
} // namespace

/// 1e4 steps at half the stable step, thrown along the edge: what is stored and what
/// slips is what was there. Frictional contact turns all of it but vibrations into slip.
TEST(Surface, ContactKeepsTheLedger)
{
  const Ledger slips = thrown_layer(
      [](const continuum::ContactStiffness &k) {
        return FrictionalContact{k.normal, k.shear, 0.3, 0.};
      },
      {1e-3, 0.}, 0.5, 10000);
  EXPECT_LT(slips.drift, 1e-4);
  EXPECT_GT(slips.slip, 0.95 * slips.start);
  EXPECT_LT(slips.slip, slips.start);
  const Ledger bilateral = thrown_layer([](const continuum::ContactStiffness &k)
                                        { return SlidingContact{k.normal}; },
                                        {0., 2e-4}, 0.5, 10000);
  EXPECT_LT(bilateral.drift, 1e-4);
  EXPECT_EQ(bilateral.n_open, 0);
  std::printf("friction: drift %.1e, slip %.4f of the energy; bilateral: drift %.1e\n",
              slips.drift, slips.slip / slips.start, bilateral.drift);
}

/// Thrown off the edge a frictionless layer hammers on it. Leapfrog errs wherever a
/// contact opens or closes within a step; the error of the ledger falls with the step.
TEST(Surface, LedgerOfHammeringConverges)
{
  double before = 1.;
  for (const double share : {0.5, 0.25, 0.125})
  {
    const Ledger ledger = thrown_layer([](const continuum::ContactStiffness &k)
                                       { return FrictionlessContact{k.normal}; },
                                       {0., 2e-4}, share, static_cast<int>(5000 / share));
    EXPECT_GT(ledger.n_open, 100);
    EXPECT_LT(ledger.drift, before);
    std::printf("step %.3f of the bound: drift %.1e\n", share, ledger.drift);
    before = ledger.drift;
  }
  EXPECT_LT(before, 2e-3);
}

/// Bounded at 0.99 of the bound, growing at 1.02 of the true limit; the bound gives away
/// less than half of the step.
TEST(Surface, StableStepWithContactIsABoundAndNotFarFromTheLimit)
{
  for (const double stiff : {1., 30.}) // over the default stiffness
  {
    Bridged model;
    make_layered_lattice(model, block_on_mesh());
    const auto k =
        surface_stiffness(interface_below(model), model.state.joints, *model.solid);
    const auto make = [&]
    {
      return SurfaceContact(
          interface_below(model),
          FrictionalContact{stiff * k.normal, stiff * k.shear, 1., 1e9}, // sticks
          [](const Vec2 &, const Vec2 &n) { return -1e-5 * n; });        // closed
    };
    discrete::Grains &g = model.state.grains;
    MeshState &m = *model.mesh;
    SurfaceContact contact = make();
    const double bound = surface_stable_step(g, model.state.joints, *model.solid,
                                             m.inverse_mass, {&contact});
    // The pressure at rest, which its contact adds to what it answers.
    compute_forces(model);
    contact.add_forces(g, m.displacement, m.velocity, 0., m.force);
    const discrete::Grains at_rest = g;
    const continuum::Vector mesh_at_rest = m.force;
    const auto add_contact_forces = [&]
    {
      contact = make();
      contact.add_forces(g, m.displacement, m.velocity, 1., m.force);
      for (std::size_t i = 0; i < g.size(); ++i)
      {
        g.force_x[i] -= at_rest.force_x[i];
        g.force_y[i] -= at_rest.force_y[i];
        g.torque[i] -= at_rest.torque[i];
      }
      m.force -= mesh_at_rest;
    };
    const double limit = 2. / largest_frequency(model, add_contact_forces, [] {});
    const auto growth = [&](const double dt) -> double
    {
      SurfaceContact fresh = make();
      for (auto *field : {&g.displacement_x, &g.displacement_y, &g.rotation})
        field->assign(g.size(), 0.);
      m.displacement = 0.;
      stir(model, 1e-12, 29);
      Loop::Options options;
      options.bridged = false;
      Loop loop(model, dt, options);
      add_contact(loop, model, fresh);
      std::vector<GrainLoad> balance;
      for (std::size_t i = 0; i < g.size(); ++i)
        balance.push_back({static_cast<std::int32_t>(i),
                           {-at_rest.force_x[i], -at_rest.force_y[i]},
                           -at_rest.torque[i]});
      continuum::Vector on_mesh = mesh_at_rest;
      on_mesh *= -1.;
      loop.add(std::make_unique<GrainLoads>(model.state, balance), {Stage::forces}, 31,
               "balance of the layer");
      loop.add(std::make_unique<MeshLoads>(m, on_mesh), {Stage::forces}, 32,
               "balance of the mesh");
      try
      {
        loop.advance(1500);
      }
      catch (const NumericalError &) // it has torn the layer through the edge
      {
        return std::numeric_limits<double>::infinity();
      }
      return m.velocity.linfty_norm() / 1e-12;
    };
    const double below = growth(0.99 * bound), above = growth(1.02 * limit);
    EXPECT_LT(below, 10.);
    EXPECT_GT(above, 1e4);
    EXPECT_LT(bound, limit * (1. + 1e-3)); // the iteration comes from below
    EXPECT_GT(bound, 0.5 * limit);
    std::printf("contact %g times the default: bound over limit %.3f, over the step "
                "without contact %.3f; growth %.1f, %.1e; grains alone %.3f\n",
                stiff, bound / limit, bound / model.stable_step(), below, above,
                model.stable_step() *
                    largest_frequency(
                        model, [] {}, [] {}) /
                    2.);
  }
}

/// An elastic layer under pressure p on an elastic mesh, drawn along by forces on its
/// first row: it sticks under 0.99 mu p of them and slides off under 1.01.
TEST(Surface, LayerSlidesFromItsFrictionOn)
{
  const double mu = 0.5, p = 1e-5;
  for (const double share : {0.99, 1.01})
  {
    Bridged model;
    LayeredShape shape = block_on_mesh();
    shape.length = 24.;
    make_layered_lattice(model, shape);
    hold_below(model, shape);
    discrete::Grains &g = model.state.grains;
    std::vector<std::int32_t> outer;
    for (const std::int32_t i : outer_side(g, {}, 1., {0., -1.}))
      outer.push_back(i);
    const auto k =
        surface_stiffness(interface_below(model), model.state.joints, *model.solid);
    SurfaceContact contact(SurfaceInterface(g, outer, *model.solid, lower_edge),
                           FrictionalContact{k.normal, k.shear, mu, 0.}, {});
    Loop::Options options;
    options.damping = 0.7;
    options.bridged = false;
    const double dt = 0.8 * surface_stable_step(g, model.state.joints, *model.solid,
                                                model.mesh->inverse_mass, {&contact});
    Loop loop(model, dt, options);
    add_contact(loop, model, contact);
    const auto forces = [&](const Vec2 &force)
    {
      std::vector<GrainLoad> loads;
      for (const SurfacePoint &point : contact.interface().points())
        loads.push_back({point.grain, point.length * force, 0.});
      return loads;
    };
    loop.add(std::make_unique<GrainLoads>(model.state, forces({0., -p})), {Stage::forces},
             31, "pressure");
    loop.advance(4000);
    loop.add(std::make_unique<GrainLoads>(model.state, forces({share * mu * p, 0.})),
             {Stage::forces}, 31, "drag");
    loop.advance(8000);
    const double there = g.displacement_x[outer[10]];
    loop.advance(4000);
    const double way = std::abs(g.displacement_x[outer[10]] - there);
    std::printf("drag %.2f mu p: way %.2e of what is elastic\n", share,
                way / (mu * p / k.shear));
    if (share < 1.)
    {
      EXPECT_LT(way, 1e-2 * mu * p / k.shear);
    }
    else
    {
      EXPECT_GT(way, 10. * mu * p / k.shear);
    }
  }
}
} // namespace antiform::coupling::test::surface_tests

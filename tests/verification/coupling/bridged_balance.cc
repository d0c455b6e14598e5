// Grains with a mesh as a body that the event driver balances.
#include "support/coupled_layer.h"
#include "support/coupling_loop.h"

#include "continuum/errors.h"
#include "coupling/bridged_balance.h"
#include "coupling/event_driver.h"
#include "coupling/static_system.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::coupling::test::bridged_balance_tests
{
namespace
{
using discrete::Bond;

/// The linear state at a shortening of 1, walls as springs that move in: Trilinos' saddle
/// point.
StaticSolution unit_shortening(const CoupledLayer &layer)
{
  const Bridged &model = layer.model;
  const discrete::Grains &grains = model.state.grains;
  StaticSystem system(grains, model.state.joints, model.solid.get(), model.domain.get());
  const double way = 0.5 * layer.shape.length;
  for (const discrete::Wall &wall : model.walls)
    for (const discrete::WallContact &contact : wall.contacts)
      if (wall_gap(wall, contact, grains) <= 0.)
      {
        const double stiffness = contact.weight * contact.stiffness;
        system.add_grain_spring(contact.grain, 0, stiffness);
        system.add_grain_force(contact.grain, 0, stiffness * way * wall.normal.x);
      }
  for (const PrescribedDof &entry : model.mesh->prescribed)
    system.fix_mesh(entry.dof,
                    entry.wall < 0 ? 0. : way * model.walls[entry.wall].normal.x);
  return system.solve();
}

FlatJoint unbreakable()
{
  FlatJoint law;
  law.breakable = false;
  return law;
}

/// Largest difference of two vectors of displacements over the largest of the second.
double difference(const Eigen::VectorXd &one, const Eigen::VectorXd &other)
{
  return (one - other).cwiseAbs().maxCoeff() / other.cwiseAbs().maxCoeff();
}

Eigen::VectorXd noise(const Eigen::Index n, const std::uint64_t seed)
{
  discrete::Random random(seed, 3);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i)
    values[i] = 2. * random.uniform() - 1.;
  return values;
}
} // namespace

namespace
{
/// Of the tangent, from Trilinos' saddle point.
double error_of_tangent(const CoupledShape &shape)
{
  CoupledLayer layer{shape};
  EXPECT_EQ(layer.model.domain->ties().empty(), shape.tied_every == 0);
  const StaticSolution linear = unit_shortening(layer);
  const BridgedBalance body = body_of(layer);
  const auto n = static_cast<Eigen::Index>(layer.n_grains());
  Eigen::VectorXd wanted(body.n_unknowns());
  for (Eigen::Index i = 0; i < n; ++i)
    wanted.segment<3>(3 * i) << linear.ux[i], linear.uy[i], linear.rotation[i];
  wanted.segment<2>(3 * n).setConstant(0.5 * layer.shape.length); // walls
  for (Eigen::Index k = 3 * n + 2; k < wanted.size(); ++k)
    wanted[k] = linear.mesh.begin()[k - 3 * n - 2];
  const double error = difference(body.tangent().cwiseProduct(body.levers()),
                                  wanted.cwiseProduct(body.levers()));
  std::printf("  difference %.1e\n", error);
  return error;
}
} // namespace

TEST(BridgedBalance, TangentIsTheSaddlePointsSolution)
{
  EXPECT_LT(error_of_tangent(CoupledShape()), 1e-9);
  CoupledShape tied;
  tied.tied_every = 40;
  EXPECT_LT(error_of_tangent(tied), 1e-9);
  CoupledShape soft;
  soft.contrast = 1e4; // whose pins have all but nothing beside them
  EXPECT_LT(error_of_tangent(soft), 1e-9);
}

TEST(BridgedBalance, OperatorIsSymmetricAndKeepsTheConstraint)
{
  CoupledLayer layer{CoupledShape()};
  BridgedBalance body = body_of(layer);
  const Eigen::VectorXd a = noise(body.n_unknowns(), 1), b = noise(body.n_unknowns(), 2);
  const Eigen::VectorXd from_a = body.correction(a), from_b = body.correction(b);
  EXPECT_NEAR(b.dot(from_a) / std::sqrt(a.dot(from_a) * b.dot(from_b)),
              a.dot(from_b) / std::sqrt(a.dot(from_a) * b.dot(from_b)), 1e-10);
  EXPECT_GT(a.dot(from_a), 0.);
  body.move(1e-9 / from_a.cwiseAbs().maxCoeff() * from_a);
  EXPECT_LT(body.gap(), 1e-12 * 1e-9);
  for (const PrescribedDof &entry : layer.model.mesh->prescribed)
    EXPECT_EQ(layer.model.mesh->displacement(entry.dof), 0.);
}

namespace
{
/// The element of the layer that breaks first in linear theory, and the force conjugate
/// to the shortening then.
struct FirstBreak
{
  std::size_t joint = 0;
  int element = 0;
  Bond mode = Bond::bonded;
  double strain = HUGE_VAL, force = 0.;
};

/// By hand, from stresses k_n (g - theta s_e) and k_s u_s of the saddle point's solution.
FirstBreak predict(const CoupledLayer &layer, const FlatJoint &law)
{
  const StaticSolution unit = unit_shortening(layer);
  const discrete::Joints &joints = layer.model.state.joints;
  FirstBreak first;
  double energy = layer.model.solid->strain_energy(unit.mesh);
  for (const discrete::Wall &wall : layer.model.walls)
    for (const discrete::WallContact &contact : wall.contacts)
      if (wall_gap(wall, contact, layer.model.state.grains) <= 0.)
        energy +=
            0.5 * contact.weight * contact.stiffness *
            std::pow(wall.normal.x * unit.ux[contact.grain] - 0.5 * layer.shape.length,
                     2);
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    const double u[6] = {unit.ux[one], unit.uy[one], unit.rotation[one],
                         unit.ux[two], unit.uy[two], unit.rotation[two]};
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    double d[3] = {0., 0., 0.};
    for (int r = 0; r < 3; ++r)
    {
      for (int a = 0; a < 6; ++a)
        d[r] += rows[r][a] * u[a];
      energy += 0.5 * stiffness[r] * d[r] * d[r];
    }
    if (j >= joints.groups[0].end) // the matrix does not break
      continue;
    const double k = joints.stiffness[j], R = joints.half_length[j];
    for (int e = 0; e < law.n_elements; ++e)
    {
      const double s = -R + (e + 0.5) * 2. * R / law.n_elements;
      const double sigma = k * (d[0] - d[2] * s);
      const double excess =
          std::abs(k / law.stiffness_ratio * d[1]) + sigma * law.tan_friction;
      const double in_tension = sigma > 0. ? law.tensile_strength / sigma : HUGE_VAL,
                   in_shear = excess > 0. ? law.cohesion / excess : HUGE_VAL;
      if (std::min(in_tension, in_shear) < first.strain)
        first = {j, e,
                 in_tension < in_shear ? Bond::broken_in_tension : Bond::broken_in_shear,
                 std::min(in_tension, in_shear), 0.};
    }
  }
  first.force = 2. * energy * first.strain;
  return first;
}
} // namespace

// The operator is the derivative of the unbalanced force in the directions that keep the
// constraint.
TEST(BridgedBalance, OperatorIsThatOfTheResidual)
{
  CoupledLayer layer{CoupledShape(), unbreakable()};
  DriverSettings settings;
  settings.limits = {1e-10, 1e-8, 1e-8};
  Driven run(layer, settings);
  run.driver.run_to(1e-6); // contacts of the walls press
  BridgedBalance &body = run.body;
  Eigen::VectorXd step = body.correction(noise(body.n_unknowns(), 3));
  step *= 1e-9 / step.cwiseProduct(body.levers()).cwiseAbs().maxCoeff();
  const Eigen::VectorXd before = body.residual();
  body.move(step);
  const Eigen::VectorXd back = body.correction(before - body.residual());
  // Loaded to strains of 1e-6, whose share the geometric terms have.
  EXPECT_LT(difference(back, step), 1e-4);
}

// Strengths a millionth of a rock's: what geometry changes is far below the tolerance.
TEST(BridgedBalance, FirstBreakIsThatOfLinearTheory)
{
  FlatJoint law;
  law.tensile_strength = 15.;
  law.cohesion = 60.;
  CoupledLayer layer{CoupledShape(), law};
  const FirstBreak predicted = predict(layer, law);
  DriverSettings settings;
  settings.largest_step = 10. * predicted.strain;
  settings.events_per_step = 1;
  settings.limits = {1e-9, 1e-8, 1e-8};
  Driven run(layer, settings);
  run.driver.run_to(0.999999 * predicted.strain);
  EXPECT_TRUE(layer.model.state.cracks.empty());
  EXPECT_NEAR(run.driver.largest_force() / predicted.force, 0.999999, 1e-6);
  run.driver.run_to(1.00001 * predicted.strain);
  ASSERT_GE(layer.model.state.cracks.size(), 1u);
  const discrete::Crack &crack = layer.model.state.cracks.front();
  EXPECT_EQ(crack.joint, predicted.joint);
  EXPECT_EQ(crack.element, predicted.element);
  EXPECT_EQ(crack.mode, predicted.mode);
  EXPECT_NEAR(crack.time / predicted.strain, 1., 1e-6); // the load at which it broke
}

namespace
{
/// Displacements and turns of all, as the unknowns have them, in metres.
Eigen::VectorXd place_of(const BridgedBalance &body, const CoupledLayer &layer)
{
  const discrete::Grains &g = layer.model.state.grains;
  const auto n = static_cast<Eigen::Index>(g.size());
  Eigen::VectorXd u = Eigen::VectorXd::Zero(body.n_unknowns());
  for (Eigen::Index i = 0; i < n; ++i)
    u.segment<3>(3 * i) << g.displacement_x[i], g.displacement_y[i],
        g.rotation[i] * g.radius[i];
  for (Eigen::Index k = 3 * n + 2; k < u.size(); ++k)
    u[k] = layer.model.mesh->displacement.begin()[k - 3 * n - 2];
  return u;
}

/// Shorten in time by the program's loop, then hold the walls until all is at rest.
/// \return force of the walls on the section
double shorten_in_time(CoupledLayer &layer, const double shortening)
{
  Bridged &model = layer.model;
  model.state.breaking = false;
  scale_for_motion(model);
  const double dt = 0.5 * model.stable_step();
  const std::int64_t n = 2000;
  const double way = 0.5 * shortening * layer.shape.length,
               end = static_cast<double>(n) * dt;
  Loop::Options options;
  options.damping = 0.7;
  options.wall_speed = [=](const double t) { return t < end ? way / end : 0.; };
  Loop loop(model, dt, options);
  loop.probe(n, [](const Clock &) {});
  loop.advance(n + 1);
  for (int k = 0; k < 20 && loop.unbalanced_ratio() > 1e-9; ++k)
    loop.advance(n);
  EXPECT_LT(loop.unbalanced_ratio(), 1e-8);
  EXPECT_NEAR(loop.walls().closure(), shortening * layer.shape.length,
              1e-9 * shortening * layer.shape.length);
  return loop.walls().grain_reaction(0) + loop.walls().grain_reaction(1) +
         loop.walls().mesh_reaction();
}
} // namespace

// Without breaks there is one equilibrium, finite rotations included.
TEST(BridgedBalance, ElasticPathIsThatOfMotionInTime)
{
  constexpr double shortening = 3e-3;
  CoupledLayer implicit{CoupledShape(), unbreakable()},
      in_time{CoupledShape(), unbreakable()};
  DriverSettings settings;
  settings.limits = {1e-9, 1e-7, 1e-7};
  Driven run(implicit, settings);
  run.driver.run_to(shortening);
  const double force = shorten_in_time(in_time, shortening);
  const double error =
      difference(place_of(run.body, implicit), place_of(run.body, in_time));
  std::printf("  difference %.1e, of the force %.1e, gap %.1e m\n", error,
              run.body.conjugate_force() / (force * implicit.shape.length) - 1.,
              run.body.gap());
  EXPECT_LT(error, 1e-6);
  EXPECT_NEAR(run.body.conjugate_force() / (force * implicit.shape.length), 1., 1e-6);
  EXPECT_LT(run.body.gap(), 1e-14);
}

TEST(BridgedBalance, EveryRecordIsInBalanceKeepsTheConstraintAndClosesTheBooks)
{
  CoupledLayer layer{CoupledShape()};
  DriverSettings settings;
  settings.stop_drop = 0.;
  Driven run(layer, settings);
  double open = 0., gap = 0.;
  for (int k = 1; k <= 30; ++k)
  {
    run.driver.run_to(1e-4 * k);
    open = std::max(open, open_share(books_of(run, layer)));
    gap = std::max(gap, run.body.gap() / largest_displacement(layer.model));
  }
  std::printf("  books open by %.1e, gap %.1e of the displacement, %zu cracks\n", open,
              gap, layer.model.state.cracks.size());
  EXPECT_LT(open, 1e-3); // as of grains alone
  EXPECT_LT(gap, 1e-13);
  for (const LoadRecord &record : run.driver.report().records)
    EXPECT_TRUE(record.ratios.within(settings.limits)) << record.load;
  EXPECT_GT(layer.model.state.cracks.size(), 50u);
  const Energies books = books_of(run, layer);
  for (const double term : {books.strain_grains, books.strain_continuum, books.fracture})
    EXPECT_GT(term, 1e-2 * books.magnitude()); // none could be left out
  EXPECT_GE(run.driver.report().least_held, 0.);
  // At rest the plain forces are not in balance where there are multipliers.
  compute_forces(layer.model);
  double plain = 0.;
  for (const std::int32_t i : layer.model.domain->overlap_grains())
    plain = std::max(plain, std::abs(layer.model.state.grains.force_x[i]));
  EXPECT_GT(run.body.grains().over_joint_forces(0., plain).largest,
            3. * settings.limits.largest);
}

TEST(BridgedBalance, HandsOverToMotionThatKeepsTheConstraint)
{
  CoupledLayer layer{CoupledShape()};
  DriverSettings settings;
  settings.most_breaks = 0.; // at every break
  settings.stop_drop = 0.;
  Driven run(layer, settings);
  for (int k = 1; k <= 15; ++k)
  {
    run.driver.run_to(1e-4 * k);
    EXPECT_LT(open_share(books_of(run, layer)), 1e-3) << k;
    EXPECT_LT(run.body.gap(), 1e-12 * largest_displacement(layer.model)) << k;
  }
  const DriverReport &report = run.driver.report();
  EXPECT_GT(report.hand_overs, 5);
  EXPECT_GT(report.explicit_steps, 100 * report.hand_overs);
  for (const LoadRecord &record : report.records)
    EXPECT_TRUE(record.ratios.within(settings.limits)) << record.load;
}

namespace
{
// From a push away from balance motion comes back to it, and what it has lost is booked.
void expect_settles(const CoupledShape &shape)
{
  CoupledLayer layer{shape, unbreakable()};
  DriverSettings settings;
  settings.limits = {1e-10, 1e-8, 1e-8};
  Driven run(layer, settings);
  run.driver.run_to(1e-3);
  BridgedBalance &body = run.body;
  const auto stored = [&]
  {
    Energies books;
    body.add_energies(books);
    const GrainState &state = layer.model.state;
    books.strain_grains = joint_energies(state.grains, state.joints).strain;
    for (const discrete::Wall &wall : layer.model.walls)
      books.strain_grains += wall_energy(state.grains, wall);
    return books.stored_and_spent();
  };
  const Eigen::VectorXd balance = place_of(body, layer);
  Eigen::VectorXd push = body.correction(noise(body.n_unknowns(), 4));
  push *= 1e-3 / push.cwiseProduct(body.levers()).cwiseAbs().maxCoeff();
  body.move(push);
  const double before = stored();
  const HeldResult result = body.settle({}, BalanceRatios{1e-8, 1e-6, 1e-6});
  EXPECT_GT(result.steps, 100);
  EXPECT_LT(difference(place_of(body, layer), balance), 1e-5);
  EXPECT_NEAR(result.dissipated / (before - stored()), 1., 1e-3);
}
} // namespace

TEST(BridgedBalance, SettlesWhereItBalances)
{
  expect_settles(CoupledShape());
  CoupledShape tied;
  tied.tied_every = 40;
  expect_settles(tied);
}

// A grain of the overlap on a support could not follow the mesh.
TEST(BridgedBalance, RefusesWhatCannotFollow)
{
  CoupledLayer layer{CoupledShape()};
  const std::int32_t grain = layer.model.domain->overlap_grains().front();
  EXPECT_THROW(BridgedBalance(layer.model.state, layer.bearing(), {{grain, 0, 0.}},
                              *layer.model.mesh, *layer.model.domain),
               std::invalid_argument);
  std::vector<BearingWall> free = layer.bearing();
  free.back().is_loaded = true;
  EXPECT_THROW(
      BridgedBalance(layer.model.state, free, {}, *layer.model.mesh, *layer.model.domain),
      std::invalid_argument);
  // Nothing holds the section in y.
  std::vector<PrescribedDof> &supports = layer.model.mesh->prescribed;
  supports.erase(std::remove_if(supports.begin(), supports.end(),
                                [](const PrescribedDof &entry)
                                { return entry.wall < 0; }),
                 supports.end());
  EXPECT_THROW(body_of(layer), NumericalError);
}
} // namespace antiform::coupling::test::bridged_balance_tests

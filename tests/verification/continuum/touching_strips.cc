// Two strips that touch under load: uniform stress across the interface, what a penalty
// costs, friction, and the state in which they are laid down.
#include "support/two_strips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace touching_strips_tests
{
using namespace antiform;
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double E = 1e9, nu = 0.25;
const auto rock = LameConstants::from_young_poisson(E, nu);

ContactStiffness default_stiffness(const TwoStrips &form, const double ratio = 100.)
{
  const ContactSide side{rock, form.height / form.n_rows};
  return contact_stiffness(side, side, ratio);
}

FrictionalContact friction_of(const TwoStrips &form, const double tan, const double c)
{
  const ContactStiffness k = default_stiffness(form);
  return {k.normal, k.shear, tan, c};
}

double zero(const Point<2> &)
{
  return 0.;
}

/// Largest difference of the stress from a uniform one, over @p scale, on all ranks.
double stress_error(const NonlinearSolid &solid,
                    const Vector &u,
                    const PointStress &uniform,
                    const double scale)
{
  double error = 0.;
  for (const auto &state : solid.point_states(u))
    for (const double difference :
         {state.stress.xx - uniform.xx, state.stress.yy - uniform.yy,
          state.stress.xy - uniform.xy})
      error = std::max(error, std::abs(difference) / scale);
  return dealii::Utilities::MPI::max(error, MPI_COMM_WORLD);
}

/// Sum of the reactions of one component on both strips' nodes at height y [N/m].
double reaction_at(const LoadedSolid &body,
                   const DisplacementSpace &space,
                   const double y,
                   const unsigned int component)
{
  return body.reactions() *
         interpolate(space, [=](const Point<2> &p, const unsigned int c)
                     { return c == component && std::abs(p[1] - y) < 1e-9 ? 1. : 0.; });
}
} // namespace

TEST(TouchingStrips, StressIsUniformAcrossAnInclinedInterface)
{
  // Under the same pressure from all sides the strips shrink evenly, and the upper one
  // comes nearer by p / k_n along the normal.
  constexpr double p = 1e6, dip = 0.3;
  for (const unsigned int degree : {1u, 2u})
  {
    TwoStrips form;
    form.degree = degree;
    form.dip = dip;
    const FrictionlessContact law{default_stiffness(form).normal};
    TwoStripBody body(form, law);
    const double nearer = p / law.normal_stiffness, slope = std::atan(dip);
    Loads growing;
    growing.dead = pressure(body.solid(), {0, 1, 2, 3}, p);
    hold_node(body.solid(), {0., -1.}, 0, growing.displacements);
    hold_node(body.solid(), {0., -1.}, 1, growing.displacements);
    hold_node(body.solid(), {1., -1.}, 1, growing.displacements);
    DirichletValues above; // so that the strips do not slip
    hold_node(body.solid(), {0., 1.}, 0, above);
    for (const auto &[dof, value] : above)
      growing.displacements[dof] = value + nearer * std::sin(slope);
    LoadedSolid loaded(body.solid(), {}, growing);
    NewtonSolver newton(loaded, NewtonSolver::Options());
    auto u = body.solid().make_vector();
    newton.advance(0., 1., 1, u);
    EXPECT_LT(stress_error(body.solid(), u, {-p, -p, 0., 0.}, p), 1e-8); // Newton's
    for (const auto &state : body.contact().point_states(u))
    {
      EXPECT_NEAR(state.gap.opening, -nearer, 1e-8 * nearer);
      EXPECT_NEAR(state.gap.slip, 0., 1e-8 * nearer);
      EXPECT_NEAR(state.traction.normal, -p, 1e-8 * p);
    }
  }
}

TEST(TouchingStrips, StressIsUniformAtLargeStrain)
{
  // A neo-Hookean column that gets thicker: its nominal stress is the dead pressure.
  constexpr double p = 0.15 * E;
  for (const unsigned int degree : {1u, 2u})
  {
    TwoStrips form;
    form.degree = degree;
    form.law = make_law<NeoHookean>(E, nu);
    const FrictionlessContact law{default_stiffness(form).normal};
    TwoStripBody body(form, law);
    Loads growing;
    growing.dead = pressure(body.solid(), {boundary::top}, p);
    prescribe(body.solid(), boundary::bottom, 1, zero, growing.displacements);
    prescribe(body.solid(), boundary::left, 0, zero, growing.displacements);
    LoadedSolid loaded(body.solid(), {}, growing);
    NewtonSolver newton(loaded, NewtonSolver::Options());
    auto u = body.solid().make_vector();
    newton.advance(0., 1., 2, u);
    // Cauchy's stress is -p over the stretch across, that of the whole upper face.
    const double stretch = 1. + at_node(body.solid(), u, {1., 1.}, 0);
    EXPECT_GT(stretch, 1.02);
    EXPECT_LT(stress_error(body.solid(), u, {0., -p / stretch, 0., 0.}, p), 1e-8);
    for (const auto &state : body.contact().point_states(u))
      EXPECT_NEAR(state.gap.opening, -p / law.normal_stiffness,
                  1e-8 * p / law.normal_stiffness);
  }
}

TEST(TouchingStrips, PenaltyMakesAColumnTooSoftByItsShare)
{
  // A column between smooth walls of 2 n rows gives way by p (2 H / M + 1 / k_n): too
  // soft by 2 / (ratio 2 n).
  constexpr double p = 1e6;
  const double modulus = rock.lambda + 2. * rock.mu;
  for (const double ratio : {25., 50., 100., 200.})
  {
    TwoStrips form;
    form.n_columns = 1;
    TwoStripBody body(form, FrictionlessContact{default_stiffness(form, ratio).normal});
    Loads growing;
    growing.dead = pressure(body.solid(), {boundary::top}, p);
    prescribe(body.solid(), boundary::bottom, 1, zero, growing.displacements);
    for (const auto side : {boundary::left, boundary::right})
      prescribe(body.solid(), side, 0, zero, growing.displacements);
    LoadedSolid loaded(body.solid(), {}, growing);
    NewtonSolver newton(loaded, NewtonSolver::Options());
    auto u = body.solid().make_vector();
    newton.advance(0., 1., 1, u);
    const double joined = p * 2. * form.height / modulus;
    const double error = -at_node(body.solid(), u, {0., 1.}, 1) / joined - 1.;
    // Newton's tolerance of 1e-8 of the whole displacement.
    EXPECT_NEAR(error, 2. / (ratio * 2. * form.n_rows), 1e-8) << ratio;
  }
}

namespace
{
/// A flat strip pressed on another one and dragged along at its top.
struct Dragged
{
  double normal, shear; ///< total forces on the base [N/m], as drag ends
  double closed;        ///< length of the interface then [m]
  double shear_back;    ///< after the same way back and further
  double closed_back;
  double slip_norm, move_norm; ///< of the history, and of the displacement
};

constexpr double press = 1e4, mu = 0.6, c = 2e3;

TwoStrips flat_strips(const unsigned int degree)
{
  TwoStrips form;
  form.length = 2.;
  form.height = 0.15; // so flat that it does not topple: 6 mu H < length
  form.n_columns = 8;
  form.n_rows = 1;
  form.degree = degree;
  return form;
}

double
closed_length(const StripContact &contact, const Vector &u, const MPI_Comm communicator)
{
  double length = 0.;
  for (const auto &state : contact.point_states(u))
    length += state.phase == ContactPhase::open ? 0. : state.length;
  return dealii::Utilities::MPI::sum(length, communicator);
}

Dragged drag(const MPI_Comm communicator, const unsigned int degree)
{
  const TwoStrips form = flat_strips(degree);
  TwoStripBody body(form, friction_of(form, mu, c), communicator);
  NonlinearSolid &solid = body.solid();
  Loads constant, growing;
  constant.dead = pressure(solid, {boundary::top}, press);
  for (unsigned int component = 0; component < 2; ++component)
    prescribe(solid, boundary::bottom, component, zero, constant.displacements);
  // Elastic slip ends at some 1e-7 m; a shear strain of 2e-5 adds 6e-6 m.
  prescribe(
      solid, boundary::top, 0, [](const Point<2> &) { return 2e-5; },
      growing.displacements);
  LoadedSolid loaded(solid, constant, growing);
  NewtonSolver newton(loaded, NewtonSolver::Options());
  auto u = solid.make_vector();
  newton.solve(0., 0., u);
  newton.advance(0., 1., 3, u);
  Dragged result{};
  result.normal = reaction_at(loaded, solid, -form.height, 1);
  result.shear = -reaction_at(loaded, solid, -form.height, 0);
  result.closed = closed_length(body.contact(), u, communicator);
  newton.advance(1., -0.5, 3, u);
  result.shear_back = -reaction_at(loaded, solid, -form.height, 0);
  result.closed_back = closed_length(body.contact(), u, communicator);
  double sum = 0.;
  for (const double slip : *body.contact().history())
    sum += slip * slip;
  result.slip_norm = std::sqrt(dealii::Utilities::MPI::sum(sum, communicator));
  result.move_norm = u.l2_norm();
  return result;
}
} // namespace

TEST(TouchingStrips, DraggedStripSlidesAtCohesionAndFriction)
{
  for (const unsigned int degree : {1u, 2u})
  {
    const Dragged found = drag(MPI_COMM_WORLD, degree);
    const double weight = press * 2.;
    // Drag lifts one edge by some eighth of a face: no cohesion there.
    EXPECT_GT(std::min(found.closed, found.closed_back), 2. - 0.05);
    const double limit = c * found.closed + mu * weight,
                 limit_back = c * found.closed_back + mu * weight;
    // Newton's tolerance is 1e-8. The interface turns by some strain, 1e-5, and so does
    // its traction.
    EXPECT_NEAR(found.normal, weight, 1e-8 * weight);
    EXPECT_NEAR(found.shear, limit, 3e-5 * limit);
    EXPECT_NEAR(found.shear_back, -limit_back, 3e-5 * limit);
  }
}

TEST(TouchingStrips, RanksDoNotChangeTheResult)
{
  for (const unsigned int degree : {1u, 2u})
  {
    const Dragged one = drag(MPI_COMM_SELF, degree), all = drag(MPI_COMM_WORLD, degree);
    EXPECT_NEAR(all.normal, one.normal, 1e-8 * one.normal);
    EXPECT_NEAR(all.shear, one.shear, 1e-8 * one.shear);
    EXPECT_NEAR(all.shear_back, one.shear_back, 1e-8 * one.shear);
    EXPECT_GT(one.slip_norm, 0.);
    EXPECT_NEAR(all.slip_norm, one.slip_norm, 1e-8 * one.slip_norm);
    EXPECT_NEAR(all.move_norm, one.move_norm, 1e-8 * one.move_norm);
  }
}

TEST(TouchingStrips, LooseStripHoldsUpToCohesionAndFriction)
{
  // Pressed by its own weight of 10 kPa and drawn sideways by its mass: as on an incline.
  const TwoStrips form = flat_strips(2);
  TwoStripBody body(form, friction_of(form, mu, c));
  NonlinearSolid &solid = body.solid();
  Loads constant, growing;
  const double limit = c + mu * press;
  const auto pull = [&](const unsigned int component, const double stress)
  {
    return body_force(solid,
                      [=, &form](const Point<2> &p)
                      {
                        dealii::Tensor<1, 2> force;
                        force[component] = p[1] > 0. ? stress / form.height : 0.;
                        return force;
                      });
  };
  constant.dead = pull(1, -press);
  growing.dead = pull(0, limit);
  for (unsigned int component = 0; component < 2; ++component)
    prescribe(solid, boundary::bottom, component, zero, constant.displacements);
  LoadedSolid loaded(solid, constant, growing);
  NewtonSolver newton(loaded, NewtonSolver::Options());
  auto u = solid.make_vector();
  newton.solve(0., 0., u);
  newton.advance(0., 0.98, 4, u);
  EXPECT_NEAR(-reaction_at(loaded, solid, -form.height, 0), 0.98 * limit * form.length,
              1e-8 * limit * form.length);
  unsigned int n_sliding = 0;
  for (const auto &state : body.contact().point_states(u))
    n_sliding += state.phase == ContactPhase::slides ? 1 : 0;
  EXPECT_GT(dealii::Utilities::MPI::sum(n_sliding, MPI_COMM_WORLD), 0u);

  const auto history = *body.contact().history();
  const auto before = u;
  EXPECT_THROW(newton.solve(1.02, 0., u), NumericalError);
  EXPECT_EQ(*body.contact().history(), history);
  auto change = u;
  change -= before;
  EXPECT_EQ(change.l2_norm(), 0.);
}

TEST(TouchingStrips, LieStillUnderTheStressTheyAreLaidDownIn)
{
  // Weight, and a side pressure of 0.7 of it: a dipping interface bears shear too.
  for (const unsigned int degree : {1u, 2u})
  {
    const auto stress = [](const Point<2> &p)
    {
      const double yy = -1e6 * (2. - p[1]);
      return PointStress{0.7 * yy, yy, 0.7 * yy, 0.};
    };
    const auto traction = [=](const Point<2> &p, const dealii::Tensor<1, 2> &n)
    {
      const PointStress s = stress(p);
      return dealii::Tensor<1, 2>({s.xx * n[0], s.yy * n[1]});
    };
    TwoStrips form;
    form.degree = degree;
    form.dip = 0.3;
    form.initial_stress = stress;
    form.contact.initial_traction = traction;
    TwoStripBody body(form, friction_of(form, mu, 0.));
    Loads constant;
    constant.dead = boundary_traction(body.solid(), {0, 1, 2, 3}, traction);
    constant.dead->add(1., body_force(body.solid(),
                                      [](const Point<2> &) {
                                        return dealii::Tensor<1, 2>({0., -1e6});
                                      }));
    LoadedSolid loaded(body.solid(), constant, {});
    const auto u = body.solid().make_vector();
    loaded.assemble(u, 1., 0., nullptr);
    EXPECT_LT(loaded.residual().l2_norm(), 1e-12 * loaded.force_scale());
    EXPECT_GT(loaded.force_scale(), 1e5);
    for (const auto &state : body.contact().point_states(u))
    {
      EXPECT_EQ(state.phase, ContactPhase::sticks);
      EXPECT_LT(state.traction.normal, -1e6);
      EXPECT_LT(std::abs(state.traction.shear), 0.2 * std::abs(state.traction.normal));
    }
    // Without what the interface bears they would not.
    TwoStrips loose = form;
    loose.contact.initial_traction = {};
    TwoStripBody other(loose, friction_of(form, mu, 0.));
    LoadedSolid falling(other.solid(), constant, {});
    falling.assemble(other.solid().make_vector(), 1., 0., nullptr);
    EXPECT_GT(falling.residual().l2_norm(), 0.1 * falling.force_scale());
  }
}

TEST(TouchingStrips, RefusesWhatItCannotCarry)
{
  const auto refuses = [](const ContactLaw &law, const TwoStrips &form = TwoStrips())
  { EXPECT_THROW(TwoStripBody(form, law), std::invalid_argument); };
  refuses(FrictionlessContact{0.});
  refuses(FrictionalContact{1., 0., 0.5, 0.});
  refuses(FrictionalContact{1., 1., -0.5, 0.});
  refuses(FrictionalContact{1., 1., 0.5, -1.});
  TwoStrips pulled, sheared, none;
  pulled.contact.initial_traction = [](const Point<2> &, const dealii::Tensor<1, 2> &n)
  { return 1e3 * n; };
  refuses(FrictionlessContact{1e9}, pulled);
  EXPECT_NO_THROW(TwoStripBody(pulled, SlidingContact{1e9}));
  sheared.contact.initial_traction = [](const Point<2> &, const dealii::Tensor<1, 2> &n) {
    return -1e3 * n + dealii::Tensor<1, 2>({700., 0.});
  };
  refuses(FrictionlessContact{1e9}, sheared);
  refuses(SlidingContact{1e9}, sheared);
  refuses(FrictionalContact{1e9, 1e9, 0.6, 0.}, sheared);
  EXPECT_NO_THROW(TwoStripBody(sheared, FrictionalContact{1e9, 1e9, 0.8, 0.}));
  none.contact.is_included = [](const Point<2> &) { return false; };
  refuses(FrictionlessContact{1e9}, none);
  none.contact.is_included = [](const Point<2> &p) { return p[0] < 0.5; };
  EXPECT_NO_THROW(TwoStripBody(none, FrictionlessContact{1e9}));
  EXPECT_THROW(contact_stiffness({rock, 0.}, {rock, 1.}), std::invalid_argument);
  EXPECT_THROW(contact_stiffness({rock, 1.}, {rock, 1.}, 0.), std::invalid_argument);
}

TEST(TouchingStrips, RefusesADisplacementThatDoesNotKnowWhatTouches)
{
  TwoStripBody body(TwoStrips(), SlidingContact{1e9});
  NonlinearSolid &solid = body.solid();
  const DisplacementSpace before(
      dynamic_cast<const Triangulation &>(solid.dof_handler().get_triangulation()), 1);
  const auto u = before.make_vector();
  auto force = solid.make_vector();
  const bool knows = solid.partitioner().is_globally_compatible(before.partitioner());
  if (knows) // all faces in touch are of one rank
    EXPECT_NO_THROW(solid.assemble(u, 0., force, nullptr));
  else
    EXPECT_THROW(solid.assemble(u, 0., force, nullptr), std::invalid_argument);
  EXPECT_EQ(knows, dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1);
}
} // namespace touching_strips_tests

// Strips that touch without being joined: what their interface carries, whatever the
// rotation, and how the body around it answers.
#include "continuum/foundation.h"
#include "support/two_strips.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace strip_contact_tests
{
using namespace antiform;
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
constexpr double k_n = 200., k_t = 50., friction = 0.6, cohesion = 1.5;
const FrictionalContact frictional{k_n, k_t, friction, cohesion};

/// What the contact alone asks of the nodes at a displacement [N/m].
Vector contact_force(TwoStripBody &body, const Vector &u, Matrix *tangent = nullptr)
{
  auto force = body.solid().make_vector();
  if (tangent)
    *tangent = 0.;
  body.contact().add(u, force, tangent);
  force.compress(dealii::VectorOperation::add);
  if (tangent)
    tangent->compress(dealii::VectorOperation::add);
  return force;
}

/// The upper strip as it is, moved.
Vector moved_upper(const TwoStripBody &body, const double slip, const double opening)
{
  return body.interpolate([=](const Point<2> &, const unsigned int c, const bool up)
                          { return up ? (c == 0 ? slip : opening) : 0.; });
}

/// Both strips bent, the upper one moved, and all turned by @p angle.
Vector bent_and_turned(const TwoStripBody &body,
                       const double slip,
                       const double opening,
                       const double angle)
{
  return body.interpolate(
      [=](const Point<2> &p, const unsigned int c, const bool up)
      {
        const dealii::Tensor<1, 2> x(
            {p[0] + 0.04 * std::sin(2. * p[0] + p[1]) + (up ? slip : 0.),
             p[1] + 0.05 * std::cos(3. * p[0]) + (up ? opening + 0.002 * p[0] : 0.)});
        const double turned = c == 0 ? std::cos(angle) * x[0] - std::sin(angle) * x[1]
                                     : std::sin(angle) * x[0] + std::cos(angle) * x[1];
        return turned - p[c];
      });
}

/// Whether all points, and some, are in this phase.
void expect_all(const StripContact &contact, const Vector &u, const ContactPhase phase)
{
  unsigned int n_other = 0, n = 0;
  for (const auto &state : contact.point_states(u))
    ++(state.phase == phase ? n : n_other);
  EXPECT_EQ(dealii::Utilities::MPI::sum(n_other, MPI_COMM_WORLD), 0u);
  EXPECT_GT(dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD), 0u);
}
} // namespace

TEST(StripContact, SticksSlidesAndOpens)
{
  for (const unsigned int degree : {1u, 2u})
  {
    TwoStrips form;
    form.length = 2.;
    form.degree = degree;
    TwoStripBody body(form, frictional);
    const double press = 0.03, limit = cohesion + friction * k_n * press; // 5.1 Pa
    const auto expect_tractions = [&](const double slip, const double opening,
                                      const double normal, const double shear)
    {
      const auto f = contact_force(body, moved_upper(body, slip, opening));
      EXPECT_NEAR(body.on_upper(f, 1), normal * form.length, 1e-12); // of some 12 N/m
      EXPECT_NEAR(body.on_upper(f, 0), shear * form.length, 1e-12);
    };
    expect_tractions(0.01, -press, -k_n * press, k_t * 0.01);
    expect_tractions(-0.1, -press, -k_n * press, -k_t * 0.1);
    expect_tractions(0.12, -press, -k_n * press, limit);
    expect_tractions(-0.12, -press, -k_n * press, -limit);
    // None of them was accepted: the interface remembers nothing.
    expect_tractions(0., -press, -k_n * press, 0.);

    // It slides to 0.15, so that slip is at rest at 0.15 - limit / k_t = 0.048.
    expect_tractions(0.15, -press, -k_n * press, limit);
    body.solid().accept();
    expect_tractions(0.1, -press, -k_n * press, k_t * 0.1 - (k_t * 0.15 - limit));
    expect_tractions(0.2, -press, -k_n * press, limit);
    expect_tractions(0.1, -0.001, -0.2, cohesion + friction * 0.2);
    // Once open it carries nothing, and closes free of shear.
    expect_tractions(0.1, 1e-6, 0., 0.);
    body.solid().accept();
    expect_tractions(0.1, -press, -k_n * press, 0.);
    expect_tractions(0.11, -press, -k_n * press, k_t * 0.01);
  }
}

TEST(StripContact, CarriesTheSameHoweverTheBodyIsTurned)
{
  for (const ContactLaw &law :
       {ContactLaw(frictional), ContactLaw(FrictionlessContact{k_n}),
        ContactLaw(SlidingContact{k_n})})
  {
    TwoStrips form;
    form.degree = 2;
    form.dip = 0.2;
    form.contact.initial_traction =
        [](const Point<2> &p, const dealii::Tensor<1, 2> &normal)
    { return -(1. + p[0]) * normal; };
    TwoStripBody body(form, law);
    const auto straight = contact_force(body, bent_and_turned(body, 0.05, -0.02, 0.));
    EXPECT_GT(straight.l2_norm(), 1.);
    for (const double degrees : {30., 90., 200.})
    {
      const double angle = degrees * M_PI / 180.;
      const auto u = bent_and_turned(body, 0.05, -0.02, angle);
      const auto turned = contact_force(body, u);
      // Along two directions that turn with it, weighted by place: every node counts.
      const auto along = [&](const double a, const Vector &f)
      {
        return f * body.interpolate(
                       [=](const Point<2> &p, const unsigned int c, const bool up)
                       {
                         return (1. + p[0] * p[0] + (up ? 2. * p[0] : 0.)) *
                                (c == 0 ? std::cos(a) : std::sin(a));
                       });
      };
      for (const double a : {0., 0.5 * M_PI})
        EXPECT_NEAR(along(a + angle, turned), along(a, straight),
                    1e-12 * straight.l1_norm())
            << degrees;
      EXPECT_NEAR(turned.l2_norm(), straight.l2_norm(), 1e-12 * straight.l2_norm());

      // Forces balance, and moments about the origin at the places of now.
      const auto moment = body.interpolate(
          [=](const Point<2> &p, const unsigned int c, bool) { return p[c]; });
      auto place = moment;
      place.add(1., u);
      place.update_ghost_values();
      double torque = 0.;
      std::array<double, 2> sum{};
      for (const auto dof : body.solid().locally_owned())
      {
        const unsigned int c = body.solid().component(dof);
        sum[c] += turned(dof);
        // The other component of a node is numbered beside it.
        torque += (c == 0 ? -place(dof + 1) : place(dof - 1)) * turned(dof);
      }
      torque = dealii::Utilities::MPI::sum(torque, MPI_COMM_WORLD);
      EXPECT_NEAR(torque, 0., 1e-12 * straight.l1_norm());
      for (const double s : sum)
        EXPECT_NEAR(dealii::Utilities::MPI::sum(s, MPI_COMM_WORLD), 0.,
                    1e-12 * straight.l1_norm());
    }
  }
}

TEST(StripContact, TangentIsTheDerivativeOfTheForces)
{
  struct State
  {
    const char *name;
    ContactLaw law;
    double slip, opening;
    ContactPhase phase;
  };
  for (const State &state :
       {State{"sticks", frictional, 0.02, -0.04, ContactPhase::sticks},
        State{"slides", frictional, 0.4, -0.04, ContactPhase::slides},
        State{"slides back", frictional, -0.8, -0.15, ContactPhase::slides},
        State{"open", frictional, 0.1, 0.2, ContactPhase::open},
        State{"frictionless", FrictionlessContact{k_n}, 0.2, -0.04, ContactPhase::slides},
        State{"pulled", SlidingContact{k_n}, 0.2, 0.1, ContactPhase::slides}})
    for (const unsigned int degree : {1u, 2u})
    {
      SCOPED_TRACE(state.name);
      TwoStrips form;
      form.degree = degree;
      form.dip = 0.2;
      TwoStripBody body(form, state.law);
      const auto u = bent_and_turned(body, state.slip, state.opening, 0.7);
      expect_all(body.contact(), u, state.phase);
      const auto d = body.interpolate(
          [](const Point<2> &p, const unsigned int c, const bool up)
          {
            return (c == 0 ? std::cos(4. * p[1]) : std::sin(3. * p[0] - p[1])) +
                   (up ? std::sin(5. * p[0]) : 0.);
          });
      Matrix tangent = body.solid().make_matrix();
      contact_force(body, u, &tangent);
      auto Kd = body.solid().make_vector();
      tangent.vmult(Kd, d);

      // Central differences err by h^2 / 6 of the third derivative (1e-10) and by
      // round-off over h.
      const double h = 1e-5;
      auto difference = body.solid().make_vector();
      for (const double side : {1., -1.})
      {
        auto moved = u;
        moved.add(side * h, d);
        moved.update_ghost_values();
        difference.add(side / (2. * h), contact_force(body, moved));
      }
      difference.add(-1., Kd);
      if (state.phase == ContactPhase::open)
        EXPECT_EQ(Kd.l2_norm() + difference.l2_norm(), 0.);
      else
      {
        EXPECT_GT(Kd.l2_norm(), 1.);
        EXPECT_LT(difference.l2_norm(), 1e-8 * Kd.l2_norm());
      }

      const auto e = wavy_field(body.solid(), 1.);
      auto Ke = body.solid().make_vector();
      tangent.vmult(Ke, e);
      const double asymmetry = std::abs(e * Kd - d * Ke);
      const bool slides = state.phase == ContactPhase::slides &&
                          std::holds_alternative<FrictionalContact>(state.law);
      EXPECT_EQ(asymmetry > 1e-10 * Kd.l2_norm(), slides) << asymmetry;
      EXPECT_EQ(body.solid().has_symmetric_tangent(),
                !std::holds_alternative<FrictionalContact>(state.law));
    }
}

TEST(StripContact, OfTwoHalvesAndOnSpringsIsThatOfTheWhole)
{
  // Parts of an interface may have their own laws; springs may have been made before the
  // interface was known, with fewer entries.
  TwoStrips form;
  form.degree = 2;
  form.law = make_law<LinearElastic>(1e3, 0.25);
  form.dip = 0.2;
  TwoStripBody whole(form, frictional);
  TwoStrips left = form;
  left.contact.is_included = [](const Point<2> &p) { return p[0] < 0.5; };
  TwoStripBody halves(left, frictional);
  StripContact::Options right;
  right.is_included = [](const Point<2> &p) { return p[0] >= 0.5; };
  halves.solid().add(
      std::make_shared<StripContact>(halves.solid(), ContactLaw(frictional), right));
  const auto &mesh = dynamic_cast<const Triangulation &>(
      halves.solid().dof_handler().get_triangulation());
  const DisplacementSpace untouched(mesh, form.degree);
  halves.solid().add_springs(winkler_foundation(untouched, {boundary::bottom}, 1e3));
  whole.solid().add_springs(winkler_foundation(whole.solid(), {boundary::bottom}, 1e3));

  std::vector<Vector> results;
  for (TwoStripBody *body : {&whole, &halves})
  {
    const auto u = bent_and_turned(*body, 0.05, -0.02, 0.3);
    auto force = body->solid().make_vector(), Kf = force;
    Matrix tangent = body->solid().make_matrix();
    body->solid().assemble(u, 0., force, &tangent);
    tangent.vmult(Kf, wavy_field(body->solid(), 1.));
    results.push_back(force);
    results.push_back(Kf);
  }
  for (const std::size_t i : {0, 1})
  {
    const double norm = results[i].l2_norm();
    auto difference = results[i + 2];
    difference -= results[i];
    EXPECT_GT(norm, 1.);
    EXPECT_LT(difference.l2_norm(), 1e-12 * norm);
  }
}
} // namespace strip_contact_tests

#include "coupling/local_moves.h"

#include "coupling/walled_grains.h"
#include "discrete/joint_events.h"
#include "support/grain_fixtures.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::coupling::test::local_moves_tests
{
TEST(BandFactor, SolvesAsADenseOne)
{
  const int n = 23, band = 4;
  BandFactor factor;
  factor.reset(n, band);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int column = 0; column < n; ++column)
    for (int row = column; row <= std::min(n - 1, column + band); ++row)
    {
      const double value = row == column ? 3. + 0.1 * row : std::sin(1. + row * column);
      factor.entry(row, column) = value;
      dense(row, column) = dense(column, row) = value;
    }
  dense.diagonal().array() += 5.;
  for (int i = 0; i < n; ++i)
    factor.entry(i, i) += 5.; // rows then outweigh what is beside the diagonal
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n, -1., 2.);
  ASSERT_TRUE(factor.factorise());
  EXPECT_LT((factor.solve(right) - dense.llt().solve(right)).norm(), 1e-14);

  factor.reset(n, band);
  for (int i = 0; i < n; ++i)
    factor.entry(i, i) = i == 7 ? -1. : 1.;
  EXPECT_FALSE(factor.factorise());
}

namespace
{
using discrete::LoadedElement;

/// A lattice between its lowest row, held, and its highest, pulled up by the load; the
/// joint of number @p weak has half the strength of the others.
struct Lattice
{
  GrainState state;
  std::vector<PrescribedMotion> ends;
  std::size_t weak = 0;

  explicit Lattice(const int columns = 14, const int rows = 14)
  {
    discrete::test::Sample sample;
    sample.grains = discrete::test::lattice(columns, rows);
    discrete::FlatJoint law = discrete::test::strong_law();
    law.tensile_strength = 1.;
    law.cohesion = 4.;
    discrete::test::bond_all(sample, law);
    state.grains = sample.grains;
    state.joints = sample.joints;
    const auto [low, high] = std::minmax_element(state.grains.reference_y.begin(),
                                                 state.grains.reference_y.end());
    const double middle_y = 0.5 * (*low + *high);
    for (std::size_t i = 0; i < state.grains.size(); ++i)
    {
      const double y = state.grains.reference_y[i];
      if (y == *low || y == *high)
        for (const unsigned int c : {0U, 1U})
          ends.push_back(
              {static_cast<std::int32_t>(i), c, y == *high && c == 1 ? 1. : 0.});
    }
    const std::size_t n = state.joints.size();
    state.joints.tension_factor.assign(n, 1.);
    state.joints.cohesion_factor.assign(n, 1.);
    double nearest = HUGE_VAL;
    for (std::size_t j = 0; j < n; ++j)
    {
      const Vec2 place = 0.5 * (state.grains.reference(state.joints.first[j]) +
                                state.grains.reference(state.joints.second[j]));
      const double away = norm(place - Vec2{0.5 * columns, middle_y});
      if (away < nearest && std::abs(state.joints.normal_y[j]) > 0.5)
      {
        nearest = away;
        weak = j;
      }
    }
    state.joints.tension_factor[weak] = 0.5;
  }
  Lattice(const Lattice &) = delete;
};

/// Correct with the operator of the whole body until nothing moves any more. \return what
/// holding it took [J]
double balance(GrainBalance &body)
{
  double held = 0.;
  Eigen::VectorXd r = body.residual();
  for (int k = 0; k < 400 && r.cwiseAbs().maxCoeff() > 1e-13; ++k)
  {
    const Eigen::VectorXd step = body.solve(r);
    body.move(step);
    const Eigen::VectorXd before = r;
    r = body.residual();
    held += 0.5 * (before + r).dot(step);
  }
  return held;
}

/// Pull until a bond is over its strength, in balance. \return the bonds
std::vector<LoadedElement> pull(Lattice &lattice, GrainBalance &body)
{
  std::vector<LoadedElement> over;
  while (over.empty())
  {
    body.move(1e-4 * body.tangent());
    balance(body);
    over = discrete::overstressed_elements(lattice.state.grains, lattice.state.joints);
  }
  return over;
}

LocalSettings wide()
{
  LocalSettings settings;
  settings.radius = settings.core = 100.;
  settings.most_corrections = 1000;
  return settings;
}
} // namespace

TEST(LocalMoves, OfTheWholeBodyAreItsBalance)
{
  Lattice one, other;
  GrainBalance apart(one.state, one.ends), whole(other.state, other.ends);
  std::vector<LoadedElement> over = pull(one, apart);
  pull(other, whole);
  ASSERT_EQ(over.front().joint, one.weak);
  const double scale = apart.tangent().cwiseAbs().maxCoeff() * 1e-4;

  LocalMoves moves(apart, wide(), 1.);
  // The second bond of the weak joint may go with the first: all that follow, in order.
  const LocalResult result = moves.relax(over.front(), {}, 1e-13);
  double held = 0.;
  std::int64_t breaks = 0;
  for (over = {over.front()}; !over.empty(); ++breaks)
  {
    const LoadedElement next =
        *std::max_element(over.begin(), over.end(),
                          [](const LoadedElement &a, const LoadedElement &b)
                          { return a.factor.value < b.factor.value; });
    discrete::break_elements(other.state.grains, other.state.joints, {next}, {},
                             other.state.cracks);
    held += balance(whole);
    over = discrete::overstressed_elements(other.state.grains, other.state.joints);
  }
  EXPECT_EQ(result.breaks, breaks);
  ASSERT_EQ(one.state.cracks.size(), other.state.cracks.size());
  for (std::size_t k = 0; k < one.state.cracks.size(); ++k)
  {
    EXPECT_EQ(one.state.cracks[k].joint, other.state.cracks[k].joint);
    EXPECT_EQ(one.state.cracks[k].element, other.state.cracks[k].element);
    EXPECT_EQ(one.state.cracks[k].grain, other.state.cracks[k].grain);
  }
  for (std::size_t i = 0; i < one.state.grains.size(); ++i)
  {
    EXPECT_NEAR(one.state.grains.displacement_x[i], other.state.grains.displacement_x[i],
                1e-8 * scale);
    EXPECT_NEAR(one.state.grains.rotation[i], other.state.grains.rotation[i],
                1e-8 * scale);
  }
  // Both are sums of the trapezoidal rule along ways that differ, of one potential.
  EXPECT_GT(held, 0.);
  EXPECT_NEAR(result.held / held, 1., 1e-3);
  EXPECT_EQ(one.state.joints.damage, other.state.joints.damage);
}

TEST(LocalMoves, BalanceThePatchAndLeaveTheRest)
{
  Lattice lattice;
  GrainBalance body(lattice.state, lattice.ends);
  const std::vector<LoadedElement> over = pull(lattice, body);
  const GrainState before = lattice.state;
  const auto energy = [&]
  {
    const discrete::JointEnergies e =
        discrete::joint_energies(lattice.state.grains, lattice.state.joints);
    return e.strain + e.slip + e.fracture;
  };
  const double stored = energy();

  LocalSettings settings;
  settings.radius = 4.;
  settings.most_breaks = 1;
  LocalMoves moves(body, settings, 1.);
  const double allowed = 0.05 * body.allowed_force({1., 1., 1.});
  const LocalResult result = moves.relax(over.front(), {}, allowed);
  EXPECT_EQ(result.breaks, 1);
  EXPECT_GT(result.corrections, 0);
  // Supports stood still: holding took what is missing, to the trapezoidal rule.
  EXPECT_GT(result.held, 0.);
  EXPECT_NEAR((stored - energy()) / result.held, 1., 1e-2);

  const Eigen::VectorXd r = body.residual();
  const Vec2 centre = 0.5 * (before.grains.reference(before.joints.first[lattice.weak]) +
                             before.grains.reference(before.joints.second[lattice.weak]));
  double beyond = 0.;
  std::size_t n_moved = 0;
  for (std::size_t i = 0; i < before.grains.size(); ++i)
  {
    const auto first = static_cast<Eigen::Index>(3 * i);
    const double worst = r.segment<3>(first)
                             .cwiseQuotient(body.levers().segment<3>(first))
                             .cwiseAbs()
                             .maxCoeff();
    const bool has_moved =
        lattice.state.grains.displacement_y[i] != before.grains.displacement_y[i];
    n_moved += has_moved ? 1 : 0;
    if (norm(before.grains.reference(i) - centre) <= settings.radius)
    {
      EXPECT_LE(worst, settings.share * allowed) << i;
    }
    else
    {
      EXPECT_FALSE(has_moved) << i;
      beyond = std::max(beyond, worst);
    }
  }
  EXPECT_GT(n_moved, 30U); // pi 4^2 of them, less what is held
  EXPECT_GT(beyond, 0.);   // the ring's share is left to the whole body
}

TEST(LocalMoves, AreTheSameEachTime)
{
  Lattice one, other;
  for (Lattice *lattice : {&one, &other})
  {
    GrainBalance body(lattice->state, lattice->ends);
    const std::vector<LoadedElement> over = pull(*lattice, body);
    LocalMoves moves(body, {}, 1.);
    moves.relax(over.front(), {}, body.allowed_force({1., 0.1, 0.15}));
    moves.relax(over.back(), {}, body.allowed_force({1., 0.1, 0.15}));
  }
  EXPECT_EQ(one.state.grains.displacement_y, other.state.grains.displacement_y);
  EXPECT_EQ(one.state.grains.rotation, other.state.grains.rotation);
  EXPECT_EQ(one.state.joints.damaged.slip_energy, other.state.joints.damaged.slip_energy);
}

// Between walls a patch feels them as the body does.
TEST(LocalMoves, FeelTheWallsThatStandAtThePatch)
{
  Lattice lattice(10, 10);
  discrete::Wall left;
  left.point = {-0.5, 0.};
  left.normal = {1., 0.};
  install_wall_contacts(lattice.state.grains, left, 0.7, 0.7,
                        std::vector<double>(1, 1e3));
  ASSERT_GE(left.contacts.size(), 5U);
  left.displacement = 1e-4; // it presses
  WalledGrains body(lattice.state, {{&left, 0., false, 0.}}, lattice.ends);
  const std::vector<LoadedElement> over = pull(lattice, body);
  LocalMoves moves(body, wide(), 1.);
  moves.relax(over.front(), {}, 1e-12);
  // Balanced apart, with the walls' pushes: nothing is left in the body.
  EXPECT_LT(body.residual().cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(left.reaction, 0.);
}
} // namespace antiform::coupling::test::local_moves_tests

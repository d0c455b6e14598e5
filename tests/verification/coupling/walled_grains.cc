// Grains between rigid walls, as a body that the event driver balances.
#include "support/specimen_fixture.h"

#include "coupling/event_driver.h"
#include "coupling/static_system.h"
#include "coupling/walled_grains.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace antiform::coupling::test::walled_grains_tests
{
namespace
{
using discrete::Wall;

/// The packed specimen between two ends (along y) and two sides, wall contacts installed
/// stress-free within a third of a diameter, as decks have them.
struct Walled
{
  Specimen specimen;
  std::vector<Wall> walls; ///< bottom, top, left, right

  explicit Walled(const double size = 9.)
      : specimen(size, 3)
      , walls(4)
  {
    const double top = 2. * size;
    const std::array<Vec2, 4> points{{{0., 0.}, {0., top}, {0., 0.}, {size, 0.}}};
    const std::array<Vec2, 4> normals{{{0., 1.}, {0., -1.}, {1., 0.}, {-1., 0.}}};
    for (std::size_t w = 0; w < 4; ++w)
    {
      walls[w].point = points[w];
      walls[w].normal = normals[w];
      install_wall_contacts(specimen.state.grains, walls[w], 1., 0.3,
                            {rock_law().effective_modulus});
    }
  }

  double height() const { return walls[1].point.y; }
  /// Ends go with the load parameter, a shortening; sides press where asked to.
  std::vector<BearingWall> bearing(const bool has_sides, const double load)
  {
    std::vector<BearingWall> all{{&walls[0], 0.5 * height(), false, 0.},
                                 {&walls[1], 0.5 * height(), false, 0.}};
    if (has_sides)
      for (const int w : {2, 3})
        all.push_back({&walls[w], 0., true, load});
    return all;
  }
  /// One grain of the bottom is kept from sliding along it.
  std::vector<PrescribedMotion> held() const
  {
    return {{walls[0].contacts.front().grain, 0, 0.}};
  }
};

DriverSettings tight()
{
  DriverSettings settings;
  settings.limits = {1e-10, 1e-8, 1e-8};
  return settings;
}
} // namespace

TEST(WalledGrains, ShortenAsInLinearTheory)
{
  Walled walled;
  discrete::Grains &grains = walled.specimen.state.grains;
  constexpr double shortening = 1e-8; // of which nothing but the linear part is left
  const double way = 0.5 * shortening * walled.height();
  StaticSystem system(grains, walled.specimen.state.joints, nullptr, nullptr);
  for (const int w : {0, 1})
    for (const discrete::WallContact &contact : walled.walls[w].contacts)
      if (wall_gap(walled.walls[w], contact, grains) <= 0.)
      {
        // A spring to a wall that has gone inward: one to the ground, and its push.
        system.add_grain_spring(contact.grain, 1, contact.stiffness);
        system.add_grain_force(contact.grain, 1,
                               contact.stiffness * way * walled.walls[w].normal.y);
      }
  const PrescribedMotion held = walled.held().front();
  system.fix_grain(held.grain, held.component, 0.);
  const StaticSolution linear = system.solve();

  WalledGrains body(walled.specimen.state, walled.bearing(false, 0.), walled.held());
  EventDriver driver(body.state(), body, nullptr, tight());
  driver.run_to(shortening);
  double scale = 0.;
  for (const double u : linear.uy)
    scale = std::max(scale, std::abs(u));
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    // The residual is balanced to 1e-8 of a joint's force; geometry counts 1e-8.
    EXPECT_NEAR(grains.displacement_y[i], linear.uy[i], 1e-6 * scale);
    EXPECT_NEAR(grains.displacement_x[i], linear.ux[i], 1e-6 * scale);
  }
  // The conjugate force is that of both ends over their ways, and they agree.
  EXPECT_NEAR(walled.walls[0].reaction / walled.walls[1].reaction, 1., 1e-6);
  EXPECT_NEAR(body.conjugate_force() / (walled.walls[0].reaction * walled.height()), 1.,
              1e-6);
}

// The operator is the derivative of the residual, places of the walls included.
TEST(WalledGrains, OperatorIsThatOfTheResidual)
{
  Walled walled;
  constexpr double load = 1e5;
  WalledGrains body(walled.specimen.state, walled.bearing(true, load), walled.held());
  EventDriver driver(body.state(), body, nullptr, tight());
  driver.run_to(2e-7);
  for (const BearingWall &bearing : body.walls())
    for (const discrete::WallContact &contact : bearing.wall->contacts)
      if (contact.reference_gap != 0.) // installed where it stood: in the operator
      {
        ASSERT_LT(wall_gap(*bearing.wall, contact, body.state().grains), 0.);
      }
  const Eigen::VectorXd before = body.residual();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(body.n_unknowns());
  for (Eigen::Index k = 0; k < step.size(); ++k)
    step[k] = 1e-10 * std::sin(0.7 * static_cast<double>(k)) / body.levers()[k];
  const PrescribedMotion held = walled.held().front();
  step[3 * held.grain + held.component] = 0.;
  for (std::size_t i = 0; i < body.state().grains.size(); ++i)
    if (body.state().joints.grain_begin[i] == body.state().joints.grain_begin[i + 1])
      step.segment<3>(static_cast<Eigen::Index>(3 * i)).setZero();
  step.segment<2>(step.size() - 4).setZero(); // the ends are prescribed
  body.move(step);
  const Eigen::VectorXd back = body.solve(before - body.residual());
  // Loaded to strains of 1e-6, whose share the geometric terms have.
  EXPECT_LT((back - step).norm(), 1e-4 * step.norm());
  EXPECT_GT(step.tail<2>().norm(), 0.);
}

TEST(WalledGrains, FreeWallsComeToCarryTheirLoad)
{
  Walled walled;
  constexpr double load = 1e6; // 0.06 MPa: nothing breaks
  WalledGrains body(walled.specimen.state, walled.bearing(true, load), walled.held());
  EventDriver driver(body.state(), body, nullptr, tight());
  driver.run_to(0.);
  for (const int w : {2, 3})
    EXPECT_NEAR(walled.walls[w].reaction / load, 1., 1e-6);
  const Energies &books = driver.report().records.back().energies;
  double strain = books.strain_grains;
  for (const Wall &wall : walled.walls)
    strain += wall_energy(body.state().grains, wall);
  // Put on at once, a load does twice the work that is stored.
  EXPECT_NEAR(books.boundary_work / strain, 2., 1e-4);
  EXPECT_NEAR(books.damping / strain, 1., 1e-4);
}

// Explicit motion with walls without mass ends where the implicit balance is.
TEST(WalledGrains, SettleWhereTheyBalance)
{
  constexpr double load = 1e6;
  Walled implicit, settling;
  WalledGrains one(implicit.specimen.state, implicit.bearing(true, load),
                   implicit.held());
  EventDriver driver(one.state(), one, nullptr, tight());
  driver.run_to(0.);

  WalledGrains other(settling.specimen.state, settling.bearing(true, load),
                     settling.held());
  const HeldResult result = other.settle({}, BalanceRatios{1e-7, 1e-5, 1e-5});
  EXPECT_GT(result.steps, 100);
  double scale = 0.;
  for (const double u : one.state().grains.displacement_x)
    scale = std::max(scale, std::abs(u));
  for (std::size_t i = 0; i < one.state().grains.size(); ++i)
    EXPECT_NEAR(other.state().grains.displacement_x[i],
                one.state().grains.displacement_x[i], 1e-4 * scale);
  for (const int w : {2, 3})
  {
    EXPECT_NEAR(settling.walls[w].displacement / implicit.walls[w].displacement, 1.,
                1e-4);
    EXPECT_NEAR(settling.walls[w].reaction / load, 1., 1e-9);
  }
  double strain = joint_energies(other.state().grains, other.state().joints).strain;
  for (const Wall &wall : settling.walls)
    strain += wall_energy(other.state().grains, wall);
  // What the load has done is stored or has been damped; a wall without mass takes none.
  EXPECT_NEAR((strain + result.dissipated) / result.load_work, 1., 1e-3);
}

// A free wall from which all grains have drawn back comes after them.
TEST(WalledGrains, FreeWallsFollowGrainsThatHaveDrawnBack)
{
  Walled walled;
  constexpr double load = 1e6;
  WalledGrains body(walled.specimen.state, walled.bearing(true, load), walled.held());
  for (const int w : {2, 3})
    walled.walls[w].displacement = -0.3; // out of reach
  body.settle({}, BalanceRatios{1e-6, 1e-4, 1e-4});
  for (const int w : {2, 3})
    EXPECT_NEAR(walled.walls[w].reaction / load, 1., 1e-9);
}
} // namespace antiform::coupling::test::walled_grains_tests

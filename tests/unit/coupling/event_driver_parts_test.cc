#include "coupling/anderson.h"
#include "coupling/elastic_factor.h"

#include "continuum/errors.h"
#include "discrete/joint_events.h"
#include "support/grain_fixtures.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

namespace antiform::coupling::test::event_driver_parts_tests
{
namespace
{
/// Chain of springs between two walls.
Eigen::SparseMatrix<double> chain(const int n, const bool is_held)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i)
  {
    const bool is_end = i == 0 || i == n - 1;
    entries.emplace_back(i, i, is_end && !is_held ? 1. : 2.);
    if (i > 0)
      entries.emplace_back(i, i - 1, -1.);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}
} // namespace

TEST(ElasticFactor, SolvesAChainOfSprings)
{
  const int n = 50;
  const ElasticFactor factor(chain(n, true));
  const Eigen::VectorXd u = factor.solve(Eigen::VectorXd::Ones(n));
  for (int i = 0; i < n; ++i) // u'' = -1 between fixed ends, exact at the nodes
    EXPECT_NEAR(u[i], 0.5 * (i + 1) * (n - i), 1e-10 * n * n);
}

TEST(ElasticFactor, RoundsForCorrectionsWhatLeavesLittleOfAnError)
{
  const int n = 300; // condition 4e4, of which single precision keeps enough
  const Eigen::SparseMatrix<double> matrix = chain(n, true);
  ElasticFactor factor(matrix);
  const Eigen::VectorXd force = Eigen::VectorXd::LinSpaced(n, 1., 2.);
  const Eigen::VectorXd exact = factor.solve(force);
  EXPECT_EQ(factor.correction(force), exact); // not asked for
  factor.round_for_corrections(matrix, 0.01);
  const double left = (factor.correction(force) - exact).norm() / exact.norm();
  EXPECT_LT(left, 0.01);
  EXPECT_GT(left, 1e-9); // in single precision it is
  // Forces beyond its range, as those of a millimetre's grains near balance.
  const Eigen::VectorXd tiny = factor.correction(1e-60 * force);
  EXPECT_LT((1e60 * tiny - exact).norm(), 0.01 * exact.norm());
  EXPECT_EQ(factor.correction(0. * force), 0. * force);
}

TEST(ElasticFactor, IsNotRoundedForABodyThatBendsEasily)
{
  // A beam: second differences twice over, condition 1e13. In single precision its
  // softest motions are lost.
  const int n = 3000;
  const Eigen::SparseMatrix<double> whole =
      chain(n, true).selfadjointView<Eigen::Lower>();
  const Eigen::SparseMatrix<double> matrix = whole * whole;
  ElasticFactor factor(matrix);
  factor.round_for_corrections(matrix, 0.01);
  const Eigen::VectorXd force = Eigen::VectorXd::LinSpaced(n, -1., 2.);
  EXPECT_EQ(factor.correction(force), factor.solve(force));
}

TEST(ElasticFactor, RefusesABodyThatHangsOnNothing)
{
  Eigen::SparseMatrix<double> matrix = chain(50, true);
  matrix.coeffRef(20, 20) = -1.;
  EXPECT_THROW(ElasticFactor{matrix}, NumericalError);
}

TEST(Anderson, SolvesALinearProblemInAsManyStepsAsItHasEigenvalues)
{
  // g(u) = K^-1 (f - A u) with three different eigenvalues of K^-1 A: a fourth step,
  // with three differences, is exact; the plain iteration contracts by 0.9.
  const Eigen::Vector4d slope(0.1, 0.5, 1., 0.5), wanted(1., -2., 3., 4.);
  const auto g = [&](const Eigen::VectorXd &u)
  { return Eigen::VectorXd(slope.cwiseProduct(wanted - u)); };
  Anderson anderson(5);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(4), plain = u;
  for (int step = 0; step < 4; ++step)
  {
    u += anderson.increment(g(u));
    plain += g(plain);
  }
  EXPECT_LT((u - wanted).norm(), 1e-10);
  EXPECT_GT((plain - wanted).norm(), 0.5);

  anderson.reset();
  const Eigen::VectorXd first = g(plain);
  EXPECT_EQ((anderson.increment(first) - first).norm(), 0.);
}

namespace
{
using discrete::Bond;
using discrete::test::bonded_pair;
using discrete::test::Sample;
using discrete::test::set_deformation;

discrete::FlatJoint brittle_law()
{
  discrete::FlatJoint law = discrete::test::strong_law();
  law.tensile_strength = 1.;
  law.cohesion = 4.;
  law.tan_friction = 0.5;
  return law; // k_n = 1e3, k_s = 1e3 / 2.2 for two grains of diameter 1
}
} // namespace

TEST(LoadFactor, IsThatOfTheCriterionNearestToItsLimit)
{
  const discrete::BondedElement pulled{0.5, 0.3, 1., 4., 0.5, 0., 0.};
  EXPECT_DOUBLE_EQ(discrete::load_factor(pulled).value, 0.5);
  EXPECT_EQ(discrete::load_factor(pulled).mode, Bond::broken_in_tension);
  const discrete::BondedElement sheared{-2., -6., 1., 4., 0.5, 0., 0.};
  EXPECT_DOUBLE_EQ(discrete::load_factor(sheared).value, 6. / (4. + 1.));
  EXPECT_EQ(discrete::load_factor(sheared).mode, Bond::broken_in_shear);
}

TEST(OverstressedElements, AreThoseThatTheKernelBreaks)
{
  // Bent and pulled: one outer element is over, the others are not.
  const discrete::JointDeformation d{0.8e-3, 0., 1e-3};
  Sample listed = bonded_pair(brittle_law()), stepped = bonded_pair(brittle_law());
  set_deformation(listed, d);
  const auto over = discrete::overstressed_elements(listed.grains, listed.joints);
  ASSERT_EQ(over.size(), 1u);
  discrete::test::load(stepped, d);
  ASSERT_EQ(stepped.cracks.size(), 1u);
  EXPECT_EQ(stepped.cracks[0].element, over[0].element);
  // Mean gap of the outer element, 1/3 of the diameter from the centre.
  EXPECT_NEAR(over[0].factor.value, 0.8 + 1. / 3., 1e-6); // squares of the strains

  discrete::break_elements(listed.grains, listed.joints, over, {}, listed.cracks);
  discrete::compute_joint_forces(listed.grains, listed.joints, {}, nullptr);
  ASSERT_EQ(listed.cracks.size(), 1u);
  EXPECT_NEAR(listed.cracks[0].place.x, stepped.cracks[0].place.x, 1e-12);
  EXPECT_NEAR(listed.cracks[0].place.y, stepped.cracks[0].place.y, 1e-12);
  EXPECT_NEAR(listed.grains.force_x[0], stepped.grains.force_x[0], 1e-12);
  EXPECT_NEAR(listed.grains.torque[0], stepped.grains.torque[0], 1e-12);
  EXPECT_TRUE(discrete::overstressed_elements(listed.grains, listed.joints).empty());
}

// The kernel's search against the law, a joint at a time.
TEST(OverstressedElements, AreAllThatTheLawFinds)
{
  Sample rock;
  rock.grains = discrete::test::lattice(13, 13); // joints beyond a whole number of lanes
  discrete::test::bond_all(rock, brittle_law());
  for (std::size_t i = 0; i < rock.grains.size(); ++i)
  {
    const auto number = static_cast<double>(i);
    rock.grains.displacement_x[i] = 0.6e-3 * std::sin(7. * number);
    rock.grains.displacement_y[i] = 0.6e-3 * std::sin(11. * number + 1.);
    rock.grains.rotation[i] = 0.6e-3 * std::sin(5. * number + 2.);
  }
  discrete::break_element(rock.grains, rock.joints, 17, 1, Bond::broken_in_tension);
  const auto over = discrete::overstressed_elements(rock.grains, rock.joints);
  std::size_t next = 0;
  for (std::size_t j = 0; j < rock.joints.size(); ++j)
    for (int e = 0; e < 3; ++e)
    {
      const double factor =
          discrete::load_factor(
              discrete::bonded_element(
                  rock.joints, j, e, discrete::deformation(rock.grains, rock.joints, j)))
              .value;
      if (factor < 1. || (j == 17 && e == 1))
        continue;
      ASSERT_LT(next, over.size());
      EXPECT_EQ(over[next].joint, j);
      EXPECT_EQ(over[next].element, e);
      EXPECT_EQ(over[next].factor.value, factor);
      ++next;
    }
  EXPECT_EQ(next, over.size());
  EXPECT_GT(next, 20U);
  EXPECT_LT(next, 2 * rock.joints.size()); // neither all nor none of them
}

TEST(BreakElements, BookTheLostEnergyOnceWhereTheFacesRubAtOnce)
{
  // Pressed and sheared beyond Coulomb's limit: what is closed slips back to friction.
  Sample pair = bonded_pair(brittle_law());
  set_deformation(pair, {-1e-3, 12e-3, 0.});
  discrete::compute_joint_forces(pair.grains, pair.joints, {}, nullptr);
  const double before = discrete::joint_energies(pair.grains, pair.joints).strain;
  const auto over = discrete::overstressed_elements(pair.grains, pair.joints);
  ASSERT_EQ(over.size(), 3u);
  EXPECT_EQ(over[0].factor.mode, Bond::broken_in_shear);
  discrete::break_elements(pair.grains, pair.joints, over, {}, pair.cracks);
  const discrete::JointEnergies after =
      discrete::joint_energies(pair.grains, pair.joints);
  EXPECT_GT(after.fracture, 0.1 * before);
  EXPECT_NEAR(after.strain + after.slip + after.fracture, before, 1e-12 * before);
}

TEST(StepsToBreak, ReachTheStrengthForEitherSignOfTheLoad)
{
  Sample pair = bonded_pair(brittle_law());
  pair.grains.velocity_x[1] = 1.; // opens by 1 per unit of load
  set_deformation(pair, {0.2e-3, 0., 0.});
  const auto pulled = discrete::steps_to_break(pair.grains, pair.joints, 1e-4);
  ASSERT_EQ(pulled.size(), 3u);
  for (const double step : pulled)
    EXPECT_NEAR(step, 0.8e-3, 1e-12);
  // Pressed, it never breaks: Coulomb's strength grows faster than nothing.
  EXPECT_TRUE(discrete::steps_to_break(pair.grains, pair.joints, -1e-4).empty());

  // Sheared under pressure -0.5: |tau| = 4 + 0.25 = k_s u_s.
  Sample sheared = bonded_pair(brittle_law());
  sheared.grains.velocity_y[1] = 1.;
  set_deformation(sheared, {-0.5e-3, 0., 0.});
  for (const double probe : {1e-4, -1e-4})
    for (const double step :
         discrete::steps_to_break(sheared.grains, sheared.joints, probe))
      EXPECT_NEAR(step, 4.25 / (1e3 / 2.2), 1e-9);
}

TEST(LocalMaxima, LeaveOutWhatIsNearAMoreLoadedOne)
{
  const auto element = [](const double x, const double factor)
  {
    discrete::LoadedElement e;
    e.factor.value = factor;
    e.place = {x, 0.};
    return e;
  };
  const auto taken = discrete::local_maxima(
      {element(0., 1.1), element(3., 1.3), element(6., 1.2), element(9., 1.01)}, 4.);
  ASSERT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[0].place.x, 3.);
  EXPECT_EQ(taken[1].place.x, 9.); // its nearer neighbour was left out itself
}
} // namespace antiform::coupling::test::event_driver_parts_tests

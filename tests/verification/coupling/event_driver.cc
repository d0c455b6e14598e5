#include "support/driver_books.h"
#include "support/specimen_fixture.h"

#include "coupling/static_system.h"
#include "discrete/joint_events.h"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::coupling::test::event_driver_tests
{
namespace
{
using discrete::Bond;

/// Linear solution of a unit shortening: Trilinos' direct solver, platens as the
/// specimen has them.
StaticSolution unit_shortening(const Specimen &specimen)
{
  StaticSystem system(specimen.state.grains, specimen.state.joints, nullptr, nullptr);
  for (const PrescribedMotion &platen : specimen.platens)
    system.fix_grain(platen.grain, platen.component, platen.rate);
  return system.solve();
}

/// The element that breaks first in linear theory, and the stress then [Pa].
struct FirstBreak
{
  std::size_t joint = 0;
  int element = 0;
  Bond mode = Bond::bonded;
  double strain = std::numeric_limits<double>::infinity();
  double stress = 0.;
};

/// By hand: stresses k_n (g - theta s_e) and k_s u_s of the linear solution, criteria
/// sigma = sigma_b and |tau| + sigma tan(phi) = c.
FirstBreak predict(const Specimen &specimen, const discrete::FlatJoint &law)
{
  const StaticSolution unit = unit_shortening(specimen);
  const discrete::Joints &joints = specimen.state.joints;
  FirstBreak first;
  double energy = 0.; // of the unit shortening: half its conjugate force
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
    const double k = joints.stiffness[j], R = joints.half_length[j];
    for (int e = 0; e < law.n_elements; ++e)
    {
      const double s = -R + (e + 0.5) * 2. * R / law.n_elements;
      const double sigma = k * (d[0] - d[2] * s);
      const double tau = std::abs(k / law.stiffness_ratio * d[1]);
      const double excess = tau + sigma * law.tan_friction;
      const double in_tension = sigma > 0. ? law.tensile_strength / sigma : HUGE_VAL;
      const double in_shear = excess > 0. ? law.cohesion / excess : HUGE_VAL;
      const double strain = std::min(in_tension, in_shear);
      if (strain < first.strain)
        first = {j, e,
                 in_tension < in_shear ? Bond::broken_in_tension : Bond::broken_in_shear,
                 strain, 0.};
    }
  }
  first.stress = specimen.stress(2. * energy * first.strain);
  return first;
}

/// Relative changes of the law's geometry are of the order of its strain: strengths a
/// thousandth of a rock's keep them far below 1e-6.
discrete::FlatJoint soft_law(const double cohesion_over_tension)
{
  discrete::FlatJoint law = rock_law();
  law.tensile_strength = 15.;
  law.cohesion = cohesion_over_tension * law.tensile_strength;
  return law;
}

void expect_first_break_as_predicted(const discrete::FlatJoint &law, const Bond mode)
{
  Specimen specimen(9., 3, law);
  const FirstBreak predicted = predict(specimen, law);
  ASSERT_EQ(predicted.mode, mode);

  GrainBalance body(specimen.state, specimen.platens);
  DriverSettings settings;
  settings.largest_step = 10. * predicted.strain;
  settings.events_per_step = 1;
  settings.limits = {1e-9, 1e-8, 1e-8}; // of the geometry's order, as far as it shows
  EventDriver driver(body, settings);
  driver.run_to(0.999999 * predicted.strain);
  EXPECT_TRUE(specimen.state.cracks.empty());
  // Rounding, strains and the shortfall of the load are below a millionth.
  EXPECT_NEAR(specimen.stress(driver.largest_force()) / predicted.stress, 0.999999, 1e-6);
  driver.run_to(1.00001 * predicted.strain);
  ASSERT_GE(specimen.state.cracks.size(), 1u);
  const discrete::Crack &crack = specimen.state.cracks.front();
  EXPECT_EQ(crack.joint, predicted.joint);
  EXPECT_EQ(crack.element, predicted.element);
  EXPECT_EQ(crack.mode, predicted.mode);
  EXPECT_NEAR(crack.time / predicted.strain, 1., 1e-6); // the load at which it broke
}
} // namespace

TEST(EventDriver, FirstBreakIsThatOfLinearTheoryInTension)
{
  expect_first_break_as_predicted(soft_law(4.), Bond::broken_in_tension);
}

TEST(EventDriver, FirstBreakIsThatOfLinearTheoryInShear)
{
  expect_first_break_as_predicted(soft_law(0.4), Bond::broken_in_shear);
}

namespace
{
DriverSettings scaled(const double share)
{
  DriverSettings settings;
  settings.limits.mean *= share;
  settings.limits.largest *= share;
  settings.limits.of_strength *= share;
  return settings;
}

struct Ascent
{
  double peak = 0.; ///< [Pa]
  DriverReport report;
};

Ascent climb(Specimen &specimen, const DriverSettings &settings)
{
  GrainBalance body(specimen.state, specimen.platens);
  EventDriver driver(body, settings);
  EXPECT_FALSE(driver.run_to(0.02)) << "the specimen did not fail";
  return {specimen.stress(driver.largest_force()), driver.report()};
}
} // namespace

TEST(EventDriver, EveryRecordIsInBalanceAndTheBooksClose)
{
  Specimen specimen(12., 1);
  ASSERT_GT(specimen.n_grains(), 280u);
  const DriverSettings settings;
  const DriverReport report = climb(specimen, settings).report;
  ASSERT_GT(report.records.size(), 50u);
  for (const LoadRecord &record : report.records)
    if (&record != &report.records.back()) // it may be the collapse at its stop
    {
      EXPECT_TRUE(record.ratios.within(settings.limits)) << record.load;
    }
  EXPECT_GT(specimen.state.cracks.size(), 300u);
  EXPECT_GE(report.hand_overs, 1);

  // The limit of runs with breaks: what is left is the trapezoidal rule across a kink
  // of the law, and breaks within explicit steps.
  EXPECT_LT(open_share(report), 1e-3);
  const Energies &last = report.records.back().energies;
  for (const double term : {last.strain_grains, last.slip, last.fracture, last.damping})
    EXPECT_GT(term, 1e-2 * last.magnitude()); // none could be left out
  // Corrections with an operator that is no softer than the body take energy out of it.
  EXPECT_GE(report.least_held, 0.);
}

TEST(EventDriver, OverstressedBondsAreNeverLeftAtARecord)
{
  Specimen specimen(9., 2);
  GrainBalance body(specimen.state, specimen.platens);
  EventDriver driver(body, {});
  for (const double load : {6e-4, 8e-4, 1e-3, 1.2e-3})
  {
    driver.run_to(load);
    EXPECT_TRUE(
        discrete::overstressed_elements(specimen.state.grains, specimen.state.joints)
            .empty());
    EXPECT_EQ(driver.load(), load);
  }
  EXPECT_GT(specimen.state.cracks.size(), 5u);
}

namespace
{
/// Cracks up to the record with the largest force, in their order.
std::vector<discrete::Crack> cracks_to_peak(const Specimen &specimen,
                                            const DriverReport &report)
{
  const auto peak = std::max_element(report.records.begin(), report.records.end(),
                                     [](const LoadRecord &a, const LoadRecord &b)
                                     { return a.force < b.force; });
  const auto &cracks = specimen.state.cracks;
  return {cracks.begin(), cracks.begin() + static_cast<std::ptrdiff_t>(peak->cracks)};
}

struct Closer
{
  double ratio = 0.; ///< of the peaks
  double same = 0.;  ///< share of the cracks to the peak that are in both runs
};

/// Half the tolerances against the usual ones.
Closer closer_peak(const std::uint64_t seed)
{
  Specimen one(12., seed), other(12., seed);
  const Ascent usual = climb(one, {}), closer = climb(other, scaled(0.5));
  const auto a = cracks_to_peak(one, usual.report),
             b = cracks_to_peak(other, closer.report);
  const auto is_same = [](const discrete::Crack &c, const discrete::Crack &d)
  { return c.joint == d.joint && c.element == d.element; };
  const auto n_same = std::count_if(a.begin(), a.end(),
                                    [&](const discrete::Crack &c)
                                    {
                                      return std::any_of(b.begin(), b.end(),
                                                         [&](const discrete::Crack &d)
                                                         { return is_same(c, d); });
                                    });
  const Closer found{closer.peak / usual.peak,
                     static_cast<double>(n_same) /
                         static_cast<double>(std::max(a.size(), b.size()))};
  std::printf("  seed %d: peaks %.2f and %.2f MPa, %+.2f %%; %zu and %zu cracks, the "
              "same %.3f\n",
              static_cast<int>(seed), 1e-6 * usual.peak, 1e-6 * closer.peak,
              100. * (found.ratio - 1.), a.size(), b.size(), found.same);
  return found;
}
} // namespace

// Half a percent holds where the very same bonds are broken at the peak. Elsewhere a break
// that came first by a hair has led another way, and peaks differ as those of drivers do:
// 8 % are allowed one.
TEST(EventDriver, HalfTheTolerancesLeaveThePeakInTheMean)
{
  constexpr int n = 10;
  double mean = 0.;
  int n_same = 0;
  for (std::uint64_t seed = 1; seed <= n; ++seed)
  {
    const Closer found = closer_peak(seed);
    EXPECT_NEAR(found.ratio, 1., found.same == 1. ? 5e-3 : 0.08) << seed;
    n_same += found.same == 1. ? 1 : 0;
    mean += found.ratio / n;
  }
  EXPECT_GE(n_same, 2);
  // Twice the standard error of ten that scatter by 1 %.
  EXPECT_NEAR(mean, 1., 0.006);
}

TEST(EventDriver, HandsOverWhereACascadeGoesOn)
{
  Specimen specimen(9., 2);
  GrainBalance body(specimen.state, specimen.platens);
  DriverSettings settings;
  settings.most_breaks = 0.;  // at every break,
  settings.local.radius = 0.; // with nothing of it balanced before
  EventDriver driver(body, settings);
  driver.run_to(1.5e-3);
  const DriverReport &report = driver.report();
  EXPECT_GT(report.hand_overs, 5);
  EXPECT_GT(report.explicit_steps, 100 * report.hand_overs);
  EXPECT_LT(open_share(report), 1e-3);
  for (const LoadRecord &record : report.records)
    EXPECT_TRUE(record.ratios.within(settings.limits)) << record.load;
  const discrete::Grains &grains = specimen.state.grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    EXPECT_EQ(grains.velocity_y[i], 0.);
    EXPECT_DOUBLE_EQ(grains.inverse_mass[i] * grains.mass[i], 1.);
  }
}

TEST(EventDriver, ConstantLoadsComeUpAsInLinearTheory)
{
  Specimen specimen(9., 2);
  const std::vector<GrainLoad> loads = side_loads(specimen, 1e3); // strains of 1e-8
  StaticSystem system(specimen.state.grains, specimen.state.joints, nullptr, nullptr);
  for (const PrescribedMotion &platen : specimen.platens)
    system.fix_grain(platen.grain, platen.component, 0.);
  for (const GrainLoad &load : loads)
    system.add_grain_force(load.grain, 0, load.force.x);
  const StaticSolution linear = system.solve();

  GrainBalance body(specimen.state, specimen.platens, loads);
  DriverSettings settings;
  settings.limits = {1e-9, 1e-7, 1e-7};
  EventDriver driver(body, settings);
  driver.run_to(0.);
  double scale = 0.;
  for (const double u : linear.ux)
    scale = std::max(scale, std::abs(u));
  for (std::size_t i = 0; i < specimen.n_grains(); ++i)
    EXPECT_NEAR(specimen.state.grains.displacement_x[i], linear.ux[i], 1e-6 * scale);
  const Energies &books = driver.report().records.back().energies;
  // Loads put on at once do twice the work that is stored; holding takes the other
  // half.
  EXPECT_NEAR(books.damping / books.strain_grains, 1., 1e-6);
  EXPECT_NEAR(books.boundary_work / books.strain_grains, 2., 1e-6);
}

TEST(EventDriver, ConfinementRaisesTheStrength)
{
  Specimen bare(12., 6), confined(12., 6);
  const double peak = climb(bare, {}).peak;
  // 10 MPa on a mean diameter of side, about.
  GrainBalance body(confined.state, confined.platens, side_loads(confined, 10e6));
  EventDriver driver(body, {});
  driver.run_to(0.02);
  const DriverReport &report = driver.report();
  EXPECT_LT(open_share(report), 1e-3);
  EXPECT_GT(confined.stress(driver.largest_force()), peak + 10e6); // as any rock
}

namespace
{
/// The elements' share in the stiffness of joint @p j as it is deformed, over gap,
/// shear and rotation: bonded ones whole, broken ones by their closed length, sticking.
Eigen::Matrix3d damaged_stiffness(const Specimen &specimen, const std::size_t j)
{
  const discrete::Joints &joints = specimen.state.joints;
  const discrete::FlatJoint &law = joints.groups[0].flat();
  const discrete::JointDeformation d =
      discrete::deformation(specimen.state.grains, joints, j);
  const double k = joints.stiffness[j], R = joints.half_length[j];
  const std::int32_t record = joints.damage[j];
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int e = 0; e < law.n_elements; ++e)
  {
    double a = -R + 2. * R * e / law.n_elements, b = a + 2. * R / law.n_elements;
    const bool is_whole =
        record < 0 || joints.damaged.bond(record, e) == discrete::Bond::bonded;
    const double at_a = d.gap - d.rotation * a, at_b = d.gap - d.rotation * b;
    if (!is_whole && at_a >= 0. && at_b >= 0.)
      continue;
    if (!is_whole && at_a > 0.)
      a = d.gap / d.rotation;
    if (!is_whole && at_b > 0.)
      b = d.gap / d.rotation;
    const double l = b - a, s = 0.5 * (a + b);
    sum(0, 0) += k * l;
    sum(0, 2) -= k * l * s;
    sum(2, 0) -= k * l * s;
    sum(2, 2) += k * l * (s * s + l * l / 12.);
    sum(1, 1) += k * l / law.stiffness_ratio;
  }
  return sum;
}

/// Stiffness of the specimen as it stands [Pa], assembled and solved apart from the
/// driver. Grains that hang on nothing are kept by a spring of 1e-9 of the others'.
double damaged_modulus(const Specimen &specimen)
{
  const discrete::Joints &joints = specimen.state.joints;
  const auto n = static_cast<Eigen::Index>(3 * specimen.n_grains());
  Eigen::VectorXd is_held = Eigen::VectorXd::Zero(n), u = is_held;
  for (const PrescribedMotion &platen : specimen.platens)
  {
    is_held[3 * platen.grain + platen.component] = 1.;
    u[3 * platen.grain + platen.component] = platen.rate;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    Eigen::Matrix<double, 3, 6> rows;
    const auto of_joint = joint_rows(joints, j);
    for (int r = 0; r < 3; ++r)
      for (int a = 0; a < 6; ++a)
        rows(r, a) = of_joint[r][a];
    const Eigen::Matrix<double, 6, 6> stiffness =
        rows.transpose() * damaged_stiffness(specimen, j) * rows;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
        entries.emplace_back(3 * (a < 3 ? joints.first[j] : joints.second[j]) + a % 3,
                             3 * (b < 3 ? joints.first[j] : joints.second[j]) + b % 3,
                             stiffness(a, b));
  }
  Eigen::SparseMatrix<double> whole(n, n);
  whole.setFromTriplets(entries.begin(), entries.end());
  const double spring = 1e-9 * whole.diagonal().maxCoeff();
  Eigen::SparseMatrix<double> free = whole;
  for (Eigen::Index column = 0; column < n; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(free, column); it; ++it)
      if (is_held[it.row()] + is_held[column] > 0.)
        it.valueRef() = it.row() == column ? 1. : 0.;
      else if (it.row() == column)
        it.valueRef() += spring;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(free);
  const Eigen::VectorXd right = -(whole * u);
  u += factor.solve((is_held.array() > 0.).select(0., right));
  return specimen.stress(u.dot(whole * u));
}

struct Reversal
{
  double damaged = 0.;                      ///< modulus by damaged_modulus() [Pa]
  double measured = 0.;                     ///< secant of a small step back [Pa]
  double intact = 0.;                       ///< of the first record [Pa]
  double before = 0., low = 0., again = 0.; ///< stress at the turn, low, and back [Pa]
  std::size_t cracks = 0, new_cracks = 0;
};

/// Load to @p load, a thousandth of it back, then to half of it, and up again.
Reversal reverse(const double load)
{
  Specimen specimen(12., 6);
  GrainBalance body(specimen.state, specimen.platens);
  DriverSettings settings = {};
  settings.limits = {1e-7, 1e-5, 1e-5}; // of the stress; the step back changes 1e-3 of it
  settings.most_corrections = 5000;
  EventDriver driver(body, settings);
  const auto stress = [&] { return specimen.stress(body.conjugate_force()); };
  Reversal r;
  EXPECT_TRUE(driver.run_to(load));
  const LoadRecord &early = driver.report().records[1];
  r.intact = specimen.stress(early.force) / early.load;
  r.before = stress();
  r.cracks = specimen.state.cracks.size();
  r.damaged = damaged_modulus(specimen);
  EXPECT_TRUE(driver.run_to(0.999 * load));
  r.measured = (r.before - stress()) / (0.001 * load);
  settings.stop_drop = 0.;
  EventDriver back(body, settings); // counts loads from here
  EXPECT_TRUE(back.run_to(-0.499 * load));
  r.low = stress();
  EXPECT_TRUE(back.run_to(0.001 * load));
  r.again = stress();
  r.new_cracks = specimen.state.cracks.size() - r.cracks;
  return r;
}
} // namespace

TEST(EventDriver, UnloadsAlongTheDamagedTangentAndComesBack)
{
  const Reversal r = reverse(1.5e-3);
  ASSERT_GT(r.cracks, 100u);
  EXPECT_LT(r.damaged, 0.97 * r.intact);
  // Closed lengths change a little within the step back.
  EXPECT_NEAR(r.measured / r.damaged, 1., 5e-3);
  EXPECT_EQ(r.new_cracks, 0u);
  EXPECT_NEAR(r.low / r.before, 0.5, 0.01);
  // What little rubs on the way is the only difference: slip is a percent of the strain
  // energy at the peak, and most of it is no reversal's.
  EXPECT_NEAR(r.again / r.before, 1., 1e-3);
}
} // namespace antiform::coupling::test::event_driver_tests

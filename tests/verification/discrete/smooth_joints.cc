// Pre-existing fractures: the law of a smooth joint against its closed forms, and blocks
// that slide along a plane (case 16).
#include "support/grain_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::discrete::test::smooth_joints_tests
{
namespace
{
constexpr double degree = M_PI / 180.;

/// A pair whose branch is turned by @p branch, with a fracture through its middle at
/// @p angle; k_n = 1000, k_s = 400, width 1.
SmoothJoints joint_of_pair(Grains &grains,
                           const double branch,
                           const double angle,
                           SmoothJoint law)
{
  grains = {};
  grains.add({0., 0.}, 0.5, 1., 0);
  grains.add(rotated({1., 0.}, branch), 0.5, 1., 0);
  const Vec2 middle = 0.5 * grains.reference(1);
  const Vec2 half = rotated({0.5, 0.}, angle);
  law.normal_stiffness = 1000.;
  law.shear_stiffness = 400.;
  return make_smooth_joints(grains, {{middle + -1. * half, middle + half, law}},
                            {{0, 1, 1., 1.}});
}

/// Forces of the joint alone, with the second grain displaced by @p u (n, t) of the plane.
Vec2 force_on_upper(Grains &grains,
                    SmoothJoints &joints,
                    const Vec2 &u,
                    std::vector<Crack> *cracks = nullptr)
{
  const SmoothContact &c = joints.contacts[0];
  const Vec2 n{c.normal_x, c.normal_y}, t = perpendicular(n);
  const Vec2 d = u.x * n + u.y * t;
  grains.displacement_x[c.second] = d.x;
  grains.displacement_y[c.second] = d.y;
  for (std::vector<double> *v : {&grains.force_x, &grains.force_y, &grains.torque})
    std::fill(v->begin(), v->end(), 0.);
  add_smooth_joint_forces(grains, joints, {}, cracks);
  const Vec2 f{grains.force_x[c.second], grains.force_y[c.second]};
  return {dot(f, n), dot(f, t)};
}
} // namespace

TEST(SmoothJoint, CarriesPressureNormalToThePlaneWhateverTheBranch)
{
  for (const double branch : {0.6, 1.3, 2.2}) // the plane is along x
  {
    Grains grains;
    SmoothJoint law;
    law.friction = 0.5;
    SmoothJoints joints = joint_of_pair(grains, branch, 0., law);
    ASSERT_EQ(joints.contacts.size(), 1u);
    EXPECT_DOUBLE_EQ(joints.contacts[0].area, 1.); // the fracture's length
    const Vec2 closed = force_on_upper(grains, joints, {-0.01, 0.});
    EXPECT_NEAR(closed.x, 10., 1e-12);
    EXPECT_NEAR(closed.y, 0., 1e-12);
    const Vec2 stuck = force_on_upper(grains, joints, {-0.01, 0.01});
    EXPECT_NEAR(stuck.y, -4., 1e-12); // k_s u, below mu N = 5
    const Vec2 slid = force_on_upper(grains, joints, {-0.01, 0.05});
    EXPECT_NEAR(slid.y, -5., 1e-12);
    const Vec2 open = force_on_upper(grains, joints, {0.001, 0.05});
    EXPECT_EQ(open.x, 0.);
    EXPECT_EQ(open.y, 0.);
  }
}

TEST(SmoothJoint, DilationAtConstantVolumeRaisesThePressureBySlipTimesItsTangent)
{
  Grains grains;
  SmoothJoint law;
  law.friction = 0.5;
  law.tan_dilation = std::tan(10. * degree);
  SmoothJoints joints = joint_of_pair(grains, 1.2, 0., law);
  force_on_upper(grains, joints, {-0.01, 0.});
  double shear = 0.;
  for (int n = 1; n <= 2000; ++n)
    force_on_upper(grains, joints, {-0.01, shear = 1e-5 * n});
  const SmoothContact &c = joints.contacts[0];
  EXPECT_GT(c.slip, 0.005);
  EXPECT_NEAR(c.dilation, c.slip * std::tan(10. * degree), 1e-15);
  EXPECT_NEAR(-c.normal_stress, 10. + 1000. * c.slip * std::tan(10. * degree), 1e-10);
  // Rate form of sliding under the growing pressure: k_s (u - p) = mu (N0 + k_n tan psi p)
  const double slip =
      (400. * shear - 0.5 * 10.) / (400. + 0.5 * 1000. * std::tan(10. * degree));
  EXPECT_NEAR(c.slip, slip, 1e-3 * slip); // friction follows pressure a step behind
}

TEST(SmoothJoint, BondedBreaksAtItsStrengthsAndThenRubs)
{
  SmoothJoint law;
  law.friction = 0.4;
  law.bonded = true;
  law.tensile_strength = 2.;
  law.cohesion = 6.;
  law.tan_friction = 0.5;
  Grains grains;
  std::vector<Crack> cracks;
  SmoothJoints joints = joint_of_pair(grains, 1.2, 0.3, law);
  force_on_upper(grains, joints, {0.00199, 0.}, &cracks);
  EXPECT_TRUE(cracks.empty());
  EXPECT_EQ(force_on_upper(grains, joints, {0.00201, 0.}, &cracks).x, 0.);
  ASSERT_EQ(cracks.size(), 1u);
  EXPECT_EQ(cracks[0].mode, Bond::broken_in_tension);
  EXPECT_NEAR(cracks[0].orientation, 0.3, 1e-12);

  cracks.clear();
  joints = joint_of_pair(grains, 1.2, 0.3, law);
  const double limit = (6. + 0.5 * 4.) / 400.; // c + |sigma| tan(phi)
  force_on_upper(grains, joints, {-0.004, 0.999 * limit}, &cracks);
  EXPECT_TRUE(cracks.empty());
  const Vec2 after = force_on_upper(grains, joints, {-0.004, 1.001 * limit}, &cracks);
  ASSERT_EQ(cracks.size(), 1u);
  EXPECT_EQ(cracks[0].mode, Bond::broken_in_shear);
  EXPECT_NEAR(after.y, -0.4 * 4., 1e-12);
}

TEST(SmoothJoint, IsFreeOfForceUnderRigidMotionAndKeepsMomentum)
{
  Grains grains;
  SmoothJoint law;
  law.bonded = true;
  law.tensile_strength = law.cohesion = 1e9;
  SmoothJoints joints = joint_of_pair(grains, 1.1, 0.3, law);
  for (const double angle : {0.4, 2., 6.})
  {
    for (const int i : {0, 1})
    {
      const Vec2 at = rotated(grains.reference(i), angle) + Vec2{3., -2.};
      grains.displacement_x[i] = at.x - grains.reference(i).x;
      grains.displacement_y[i] = at.y - grains.reference(i).y;
      grains.rotation[i] = angle;
      grains.force_x[i] = grains.force_y[i] = grains.torque[i] = 0.;
    }
    add_smooth_joint_forces(grains, joints, {}, nullptr);
    EXPECT_NEAR(grains.force_x[1], 0., 1e-11);
    EXPECT_NEAR(grains.torque[1], 0., 1e-11);
  }
  grains.displacement_x[1] += 0.03;
  grains.rotation[0] -= 0.05;
  grains.force_x = grains.force_y = grains.torque = {0., 0.};
  add_smooth_joint_forces(grains, joints, {}, nullptr);
  EXPECT_GT(std::abs(grains.force_x[1]), 1.);
  EXPECT_DOUBLE_EQ(grains.force_x[0], -grains.force_x[1]);
  const Vec2 branch = grains.position(1) - grains.position(0);
  EXPECT_NEAR(grains.torque[0] + grains.torque[1] +
                  cross(branch, {grains.force_x[1], grains.force_y[1]}),
              0., 1e-12);
}

TEST(SmoothJoint, ForcesAreTheGradientOfItsEnergy)
{
  Grains grains;
  SmoothJoint law;
  law.bonded = true;
  law.tensile_strength = law.cohesion = 1e9;
  SmoothJoints joints = joint_of_pair(grains, 1.1, 0.3, law);
  grains.displacement_x = {0.01, -0.02};
  grains.displacement_y = {0.015, 0.005};
  grains.rotation = {0.1, -0.3};
  const auto energy = [&]
  {
    grains.force_x = grains.force_y = grains.torque = {0., 0.};
    add_smooth_joint_forces(grains, joints, {}, nullptr);
    return smooth_joint_energies(joints).strain;
  };
  constexpr double h = 1e-6;
  for (const int i : {0, 1})
    for (const auto &[x, f] : {std::pair{&grains.displacement_x, &grains.force_x},
                               std::pair{&grains.displacement_y, &grains.force_y},
                               std::pair{&grains.rotation, &grains.torque}})
    {
      const double at = (*x)[i];
      (*x)[i] = at + h;
      const double above = energy();
      (*x)[i] = at - h;
      const double below = energy();
      (*x)[i] = at;
      energy();
      EXPECT_NEAR((*f)[i], -(above - below) / (2. * h), 1e-6);
    }
}

namespace
{
/// Downslope displacement of the block above a fracture at 30 degrees, cut through a
/// random pack, under gravity: the lower one is held.
double slide_of_block(const std::uint64_t seed, const double friction)
{
  Sample sample;
  sample.grains = random_pack(12, 13, seed);
  const Vec2 middle{5.75, 5.2}, half = rotated({20., 0.}, 30. * degree);
  SmoothJoint law;
  law.friction = friction;
  const std::vector<Fracture> fractures = {{middle + -1. * half, middle + half, law}};
  const FlatJoint rock = strong_law();
  sample.joints.begin_group(rock, 0, "rock");
  std::vector<CrossedPair> crossed;
  for (const auto &[i, j] : pairs_within(sample.grains, 0.15, 0, 0))
    if (crossed_by(fractures, sample.grains.reference(i), sample.grains.reference(j)) < 0)
      sample.joints.add(sample.grains, i, j, 1e3, 1e3);
    else
      crossed.push_back(
          {i, j, 1e3 / (sample.grains.radius[i] + sample.grains.radius[j]), 2.2});
  sample.joints.finish(sample.grains.size());
  ExplicitRun run(std::move(sample));
  Grains &grains = run.sample.grains;
  run.smooth = make_smooth_joints(grains, fractures, crossed);
  std::vector<std::size_t> upper;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (cross(half, grains.reference(i) - middle) > 0.)
      upper.push_back(i);
    else
      hold(grains, i);
  const double dt =
      0.8 * stable_step(grains, run.sample.joints, {}, {}, pair_stiffness(grains, *run.smooth));
  run.damping.coefficient = 0.7;
  run.damping.combined = true; // local damping would hold the drift of the block back
  run.damping.start(grains.size());
  const auto slid = [&]
  {
    double sum = 0.;
    for (const std::size_t i : upper)
      sum -= dot({grains.displacement_x[i], grains.displacement_y[i]},
                 rotated({1., 0.}, 30. * degree));
    return sum / static_cast<double>(upper.size());
  };
  constexpr int n_steps = 15000;
  for (int n = 0; n < n_steps; ++n)
  {
    run.gravity.y = -0.05 * std::min(1., n / 1000.);
    run.advance(dt);
  }
  return slid();
}
} // namespace

TEST(SmoothJoint, BlockSlidesAtTheAngleOfFrictionWhateverTheGrains)
{
  for (const std::uint64_t seed : {1u, 2u, 3u})
  {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    // 30 degrees to 0.2: it stays where friction is that of 30.2 and goes at 29.8.
    const double stays = slide_of_block(seed, std::tan(30.2 * degree));
    const double goes = slide_of_block(seed, std::tan(29.8 * degree));
    EXPECT_LT(std::abs(stays), 5e-3); // what it takes to build up stress
    EXPECT_GT(goes, 10. * std::abs(stays));
  }
}

// Two grains that come to meet across a plane are springs in series, each of its own
// region: k_n = 1 / (R_1/E_1 + R_2/E_2).
TEST(SmoothJoint, OfGrainsThatMeetLaterHasTheModuliOfTheirRegions)
{
  Grains grains;
  grains.add({0., 0.}, 0.5, 1., 0);
  grains.add({0.2, 1.4}, 0.4, 1., 2);
  const std::vector<Fracture> plane = {{{-2., 0.7}, {2., 0.7}, {}}};
  SmoothJoints joints = make_smooth_joints(grains, plane, {});
  joints.modulus = {1e3, 0., 50.};
  joints.stiffness_ratio = 2.;
  grains.displacement_y[1] = -0.6; // they overlap now
  SmoothJointSearch search(grains, joints, 0.1);
  EXPECT_TRUE(search.takes(0, 1));
  search.finish();
  ASSERT_EQ(joints.contacts.size(), 1u);
  const double k = 1. / (0.5 / 1e3 + 0.4 / 50.);
  EXPECT_NEAR(joints.contacts[0].normal_stiffness / k, 1., 1e-14);
  EXPECT_NEAR(joints.contacts[0].shear_stiffness / k, 0.5, 1e-14);
}

TEST(SmoothJoint, EnergyClosesWhileFracturesSlideAndPairsChange)
{
  Sample sample;
  sample.grains = random_pack(12, 12, 5);
  SmoothJoint law;
  law.friction = 0.3;
  law.tan_dilation = 0.1;
  const std::vector<Fracture> fractures = {{{-2., 4.9}, {14., 5.6}, law}};
  sample.joints.begin_group(strong_law(), 0, "rock");
  std::vector<CrossedPair> crossed;
  for (const auto &[i, j] : pairs_within(sample.grains, 0.15, 0, 0))
    if (crossed_by(fractures, sample.grains.reference(i), sample.grains.reference(j)) < 0)
      sample.joints.add(sample.grains, i, j, 1e3, 1e3);
    else
      crossed.push_back({i, j, 1e3, 2.2});
  sample.joints.finish(sample.grains.size());
  ExplicitRun run(std::move(sample));
  Grains &grains = run.sample.grains;
  run.smooth = make_smooth_joints(grains, fractures, crossed);
  run.smooth->modulus = {1e3};
  run.smooth->stiffness_ratio = 2.2;
  run.has_contacts = true;
  run.contacts.margin = 0.1;
  LinearContact contact;
  contact.effective_modulus = 1e3;
  contact.friction = 0.3;
  run.contacts.groups.push_back({0, 0, contact});
  // The upper block is thrown along the fracture and onto it.
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (crosses({{-20., 4.113}, {32., 6.388}, {}}, grains.reference(i), {0., -50.}))
    {
      grains.velocity_x[i] = 0.6;
      grains.velocity_y[i] = -0.2;
    }
  run.search();
  const double dt = 0.1 * stable_step(grains, run.sample.joints, run.contacts, {},
                                      pair_stiffness(grains, *run.smooth));
  double origin = 0., error = 0., slip = 0., error_without_slip = 0.;
  std::vector<std::pair<int, int>> pairs_before;
  for (const SmoothContact &c : run.smooth->contacts)
    pairs_before.emplace_back(c.first, c.second);
  for (int n = 0; n < 6000; ++n)
  {
    run.first_half(dt);
    const EnergyTerms e = run.energies();
    const double all = e.kinetic + e.strain + e.slip + e.fracture;
    if (n == 0)
      origin = all;
    error = std::max(error, std::abs(all / origin - 1.));
    error_without_slip =
        std::max(error_without_slip, std::abs((all - e.slip) / origin - 1.));
    slip = e.slip / origin;
    run.second_half(dt);
  }
  std::vector<std::pair<int, int>> pairs_after;
  for (const SmoothContact &c : run.smooth->contacts)
    pairs_after.emplace_back(c.first, c.second);
  SCOPED_TRACE(testing::Message() << "slip " << slip << ", error " << error);
  EXPECT_NE(pairs_before, pairs_after);
  EXPECT_GT(slip, 0.05);
  EXPECT_LT(error, 1e-3); // limit of the ledger
  EXPECT_GT(error_without_slip, 1e-2);
}
} // namespace antiform::discrete::test::smooth_joints_tests

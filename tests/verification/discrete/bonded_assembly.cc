// Elastic assemblies with closed forms: the cantilever of bonded disks and the moduli of
// the triangular lattice, by a static solve and by damped relaxation.
#include "support/grain_fixtures.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace antiform::discrete::test::bonded_assembly_tests
{
namespace
{
constexpr double E = 1e3, kappa = 2., P = 1e-6, d = 1.;

Sample chain(const int n_bonds)
{
  Sample sample;
  for (int i = 0; i <= n_bonds; ++i)
    sample.grains.add({d * i, 0.}, 0.5 * d, 1., 0);
  FlatJoint law = strong_law();
  law.effective_modulus = E;
  law.stiffness_ratio = kappa;
  bond_all(sample, law, 1e-9);
  hold(sample.grains, 0);
  return sample;
}

/// Deflection of the last disk under a transverse force on it: bending and shear.
double exact_deflection(const int n)
{
  const double bending = E / d * d * d * d / 12., shear = E / kappa;
  return P * d * d / bending * n * (4. * n * n - 1.) / 12. + n * P / shear;
}

/// Minus the derivative of all forces with respect to all motions of free grains, by
/// central differences about the reference.
Eigen::MatrixXd stiffness(Sample sample, const std::vector<std::size_t> &free_grains)
{
  const double h = 1e-6; // truncation h^2 = 1e-12, rounding 1e-16 / h = 1e-10
  Grains &g = sample.grains;
  const auto n = static_cast<Eigen::Index>(3 * free_grains.size());
  Eigen::MatrixXd K(n, n);
  const auto forces = [&]
  {
    compute_joint_forces(g, sample.joints, {}, nullptr);
    Eigen::VectorXd f(n);
    for (Eigen::Index i = 0; i < n / 3; ++i)
      f.segment<3>(3 * i) << g.force_x[free_grains[i]], g.force_y[free_grains[i]],
          g.torque[free_grains[i]];
    return f;
  };
  for (Eigen::Index i = 0; i < n; ++i)
  {
    std::vector<double> &motion =
        i % 3 == 0 ? g.displacement_x : (i % 3 == 1 ? g.displacement_y : g.rotation);
    double &freedom = motion[free_grains[i / 3]];
    freedom = h;
    K.col(i) = -forces();
    freedom = -h;
    K.col(i) += forces();
    K.col(i) /= 2. * h;
    freedom = 0.;
  }
  return K;
}

/// Steps with local damping, @p load added to the forces, until velocities are nil.
void relax(ExplicitRun &run,
           const double dt,
           const int most_steps,
           const std::function<void(Grains &)> &load)
{
  for (int step = 0; step < most_steps; ++step)
  {
    Grains &g = run.sample.grains;
    run.add_forces(dt);
    load(g);
    damped_kick(g, dt, run.damping);
    drift(g, dt);
  }
}
} // namespace

TEST(Cantilever, StaticSolveGivesTheClosedForm)
{
  for (const int n : {1, 5, 20})
  {
    const Sample sample = chain(n);
    std::vector<std::size_t> free_grains;
    for (std::size_t i = 1; i < sample.grains.size(); ++i)
      free_grains.push_back(i);
    const Eigen::MatrixXd K = stiffness(sample, free_grains);
    EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm()); // there is a potential
    Eigen::VectorXd f = Eigen::VectorXd::Zero(K.rows());
    f[K.rows() - 2] = P;
    const Eigen::VectorXd u = K.ldlt().solve(f);
    // Rounding of the differences, 1e-10 an entry, averaged over the chain.
    EXPECT_NEAR(u[K.rows() - 2] / exact_deflection(n), 1., 1e-8) << n;
  }
  EXPECT_NEAR(exact_deflection(5), 5.05e-7, 0.0005e-7); // printed digits
  EXPECT_NEAR(exact_deflection(20), 3.202e-5, 0.0005e-5);
}

TEST(Cantilever, RelaxesToTheClosedForm)
{
  for (const int n : {5, 20})
  {
    ExplicitRun run(chain(n));
    run.damping.coefficient = 0.7;
    const double dt = 0.8 * stable_step(run.sample.grains, run.sample.joints);
    relax(run, dt, n == 5 ? 20000 : 400000, [](Grains &g) { g.force_y.back() += P; });
    // Local damping leaves less than the printed tolerance of the policy.
    EXPECT_NEAR(run.sample.grains.displacement_y.back() / exact_deflection(n), 1., 1e-4)
        << n;
  }
}

namespace
{
/// Mean stress of the joints of the grains marked @p inside over the area they own.
struct Stress
{
  double xx = 0., yy = 0., xy = 0.;
};
Stress mean_stress(const Sample &sample, const std::vector<bool> &inside)
{
  Stress sum;
  double area = 0.;
  for (const bool in : inside)
    area += in ? 0.5 * std::sqrt(3.) * d * d : 0.;
  const Joints &joints = sample.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    // Each grain owns half of its joints.
    const double share = 0.5 * ((inside[joints.first[j]] ? 1. : 0.) +
                                (inside[joints.second[j]] ? 1. : 0.));
    const Vec2 branch = sample.grains.reference(joints.second[j]) -
                        sample.grains.reference(joints.first[j]);
    const double weight = -share / area; // the force on the second grain pulls it back
    sum.xx += weight * branch.x * joints.force[j].x;
    sum.yy += weight * branch.y * joints.force[j].y;
    sum.xy +=
        0.5 * weight * (branch.x * joints.force[j].y + branch.y * joints.force[j].x);
  }
  return sum;
}

/// Stress in the middle of a square lattice sample whose outer grains follow the strain;
/// the inner ones start at rest and relax. @p turned: rows along y.
Stress relaxed_patch(const Vec2 &strain, const double shear_strain, const bool turned)
{
  Sample sample;
  const Grains rows = lattice(15, 17);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const Vec2 p = rows.reference(i);
    sample.grains.add(turned ? Vec2{-p.y, p.x} : p, 0.5, 1., 0);
  }
  FlatJoint law = strong_law();
  law.stiffness_ratio = 2.2;
  bond_all(sample, law, 1e-9);
  std::vector<bool> inside(rows.size(), false);
  const Vec2 middle = turned ? Vec2{-7., 7.5} : Vec2{7.5, 7.};
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const std::int32_t joints =
        sample.joints.grain_begin[i + 1] - sample.joints.grain_begin[i];
    const Vec2 p = sample.grains.reference(i);
    inside[i] = norm(p - middle) < 4.;
    if (joints == 6)
      continue;
    hold(sample.grains, i);
    sample.grains.displacement_x[i] = strain.x * p.x + 0.5 * shear_strain * p.y;
    sample.grains.displacement_y[i] = strain.y * p.y + 0.5 * shear_strain * p.x;
  }
  ExplicitRun run(sample);
  run.damping.coefficient = 0.7;
  const double dt = 0.8 * stable_step(run.sample.grains, run.sample.joints);
  relax(run, dt, 3000, [](Grains &) {});
  return mean_stress(run.sample, inside);
}
} // namespace

TEST(TriangularLattice, RelaxedPatchHasTheLatticesModuli)
{
  const double k = 2.2;
  const double young = 2. * std::sqrt(3.) * E * (k + 1.) / (3. * k + 1.);
  const double poisson = (k - 1.) / (3. * k + 1.);
  EXPECT_NEAR(young, 1458.6, 0.05); // printed digits of the closed form
  EXPECT_NEAR(poisson, 0.15789, 5e-6);
  const double e = 1e-5;
  for (const bool turned : {false, true})
  {
    const Stress x = relaxed_patch({e, 0.}, 0., turned);
    const Stress y = relaxed_patch({0., e}, 0., turned);
    const Stress shear = relaxed_patch({0., 0.}, e, turned);
    const double nu = x.yy / x.xx; // of the plane: sigma_yy = nu sigma_xx at e_yy = 0
    // What relaxation leaves; a perfect lattice has no other error but the strain.
    EXPECT_NEAR(nu / poisson, 1., 0.01) << turned;
    EXPECT_NEAR(x.xx * (1. - nu * nu) / e / young, 1., 0.01) << turned;
    EXPECT_NEAR(y.yy / x.xx, 1., 0.01) << turned;
    EXPECT_NEAR(shear.xy / e * 2. * (1. + poisson) / young, 1., 0.01) << turned;
    EXPECT_NEAR(shear.xx / shear.xy, 0., 0.01) << turned;
  }
}
} // namespace antiform::discrete::test::bonded_assembly_tests

// Pinned column of bonded grains under axial load: critical load from the growth of its
// deflection (Southwell 1932), by static solutions with the joints' exact kinematics,
// against pi^2 D / L^2 with D measured in pure bending of the same column.
#include "support/grain_fixtures.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace antiform::discrete::test::euler_column_tests
{
namespace
{
constexpr int n_rows = 5, length = 100; // slenderness 25; shear lowers the load by 0.4 %

class BondedColumn
{
public:
  BondedColumn()
      : pair_(bonded_pair(strong_law()))
  {
    // Odd rows have one grain less, so that both ends are alike.
    for (int r = 0; r < n_rows; ++r)
      for (int c = 0; c < length + 1 - r % 2; ++c)
        sample_.grains.add({c + 0.5 * (r % 2), 0.5 * std::sqrt(3.) * (r - n_rows / 2)},
                           0.5, 1., 0);
    bond_all(sample_, strong_law(), 1e-6);
    load_.assign(3 * sample_.grains.size(), 0.);
    fixed_.assign(load_.size(), false);
    fixed_[3 * at({0., 0.})] = fixed_[3 * at({0., 0.}) + 1] = true;
    fixed_[3 * at({length, 0.}) + 1] = true;
  }

  const Grains &grains() const { return sample_.grains; }
  void add_force(const std::size_t i, const Vec2 &force)
  {
    load_[3 * i] += force.x;
    load_[3 * i + 1] += force.y;
  }
  /// Dead axial load, evenly on the end grains of the even rows; no moment.
  void compress(const double P)
  {
    for (int r = 0; r < n_rows; r += 2)
    {
      const double y = 0.5 * std::sqrt(3.) * (r - n_rows / 2);
      add_force(at({0., y}), {P / 3., 0.});
      add_force(at({length, y}), {-P / 3., 0.});
    }
  }
  /// Couples on both ends that bend the column [N m].
  void bend(const double M)
  {
    const double arm = 0.5 * std::sqrt(3.) * (n_rows - 1);
    for (const double side : {-1., 1.})
    {
      add_force(at({0., 0.5 * side * arm}), {side * M / arm, 0.});
      add_force(at({length, 0.5 * side * arm}), {-side * M / arm, 0.});
    }
  }
  void push_sideways(const double amplitude)
  {
    for (std::size_t i = 0; i < grains().size(); ++i)
      add_force(i, {0., amplitude * std::sin(M_PI * grains().reference_x[i] / length)});
  }

  /// Newton's method on the exact forces; returns the last residual over the largest
  /// load.
  double solve()
  {
    double largest = 0.;
    for (const double f : load_)
      largest = std::max(largest, std::abs(f));
    double residual = 0.;
    for (int iteration = 0; iteration < 8; ++iteration)
    {
      const Eigen::VectorXd r = residual_forces();
      residual = r.cwiseAbs().maxCoeff() / largest;
      if (residual < 1e-11)
        break;
      const Eigen::VectorXd du =
          Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(tangent()).solve(r);
      Grains &g = sample_.grains;
      for (std::size_t i = 0; i < g.size(); ++i)
      {
        const auto row = static_cast<Eigen::Index>(3 * i);
        g.displacement_x[i] += du[row];
        g.displacement_y[i] += du[row + 1];
        g.rotation[i] += du[row + 2];
      }
    }
    return residual;
  }

  /// Number of directions in which the present equilibrium is unstable.
  int n_unstable()
  {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(tangent());
    return static_cast<int>((factor.vectorD().array() < 0.).count());
  }

  double deflection() const { return grains().displacement_y[at({0.5 * length, 0.})]; }
  /// Of the axis in the middle half, from a fit of a parabola.
  double curvature() const
  {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int c = length / 4; c <= 3 * length / 4; ++c)
    {
      const double x = c - 0.5 * length;
      const Eigen::Vector3d row(1., x, 0.5 * x * x);
      normal += row * row.transpose();
      right += grains().displacement_y[at({static_cast<double>(c), 0.})] * row;
    }
    return (normal.inverse() * right)[2];
  }

private:
  std::size_t at(const Vec2 &place) const
  {
    for (std::size_t i = 0; i < grains().size(); ++i)
      if (norm(grains().reference(i) - place) < 1e-9)
        return i;
    throw std::logic_error("no grain there");
  }

  Eigen::VectorXd residual_forces()
  {
    Grains &g = sample_.grains;
    compute_joint_forces(g, sample_.joints, {}, nullptr);
    Eigen::VectorXd r(static_cast<Eigen::Index>(load_.size()));
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const std::array<double, 3> force{{g.force_x[i], g.force_y[i], g.torque[i]}};
      for (std::size_t c = 0; c < 3; ++c)
        r[static_cast<Eigen::Index>(3 * i + c)] =
            fixed_[3 * i + c] ? 0. : force[c] + load_[3 * i + c];
    }
    return r;
  }

  /// Forces on the two grains of joint @p j for their displacements @p q.
  std::array<double, 6> joint_forces(const std::size_t j, const std::array<double, 6> &q)
  {
    Grains &g = pair_.grains;
    pair_.joints.normal_x[0] = sample_.joints.normal_x[j];
    pair_.joints.normal_y[0] = sample_.joints.normal_y[j];
    g.displacement_x = {q[0], q[3]};
    g.displacement_y = {q[1], q[4]};
    g.rotation = {q[2], q[5]};
    compute_joint_forces(g, pair_.joints, {}, nullptr);
    return {{g.force_x[0], g.force_y[0], g.torque[0], g.force_x[1], g.force_y[1],
             g.torque[1]}};
  }

  /// Tangent stiffness by central differences, joint by joint.
  Eigen::SparseMatrix<double> tangent()
  {
    std::vector<Eigen::Triplet<double>> entries;
    const Grains &g = sample_.grains;
    const double step = 1e-5; // error step^2 relative, round-off 1e-16 / step
    for (std::size_t j = 0; j < sample_.joints.size(); ++j)
    {
      const std::array<std::int32_t, 2> ends{
          {sample_.joints.first[j], sample_.joints.second[j]}};
      std::array<double, 6> q{};
      for (int k = 0; k < 6; ++k)
      {
        const std::int32_t i = ends[k / 3];
        q[k] = k % 3 == 0   ? g.displacement_x[i]
               : k % 3 == 1 ? g.displacement_y[i]
                            : g.rotation[i];
      }
      for (int c = 0; c < 6; ++c)
      {
        std::array<double, 6> forward = q, backward = q;
        forward[c] += step;
        backward[c] -= step;
        const auto f = joint_forces(j, forward), b = joint_forces(j, backward);
        const int column = 3 * ends[c / 3] + c % 3;
        for (int r = 0; r < 6; ++r)
        {
          const int row = 3 * ends[r / 3] + r % 3;
          if (!fixed_[row] && !fixed_[column])
            entries.emplace_back(row, column, -(f[r] - b[r]) / (2. * step));
        }
      }
    }
    for (std::size_t k = 0; k < fixed_.size(); ++k)
      if (fixed_[k])
        entries.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.);
    const auto n = static_cast<Eigen::Index>(load_.size());
    Eigen::SparseMatrix<double> K(n, n);
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
  }

  Sample sample_, pair_;
  std::vector<double> load_;
  std::vector<bool> fixed_;
};

double measured_bending_stiffness()
{
  BondedColumn column;
  constexpr double M = 1e-4; // end rotation 1e-5
  column.bend(M);
  EXPECT_LT(column.solve(), 1e-9);
  return M / std::abs(column.curvature());
}

/// Deflection under the axial load @p P and a faint sideways load.
double deflection(const double P)
{
  BondedColumn column;
  column.compress(P);
  column.push_sideways(1e-9);
  EXPECT_LT(column.solve(), 1e-9);
  return column.deflection();
}
} // namespace

TEST(BondedColumn, BucklesAtTheEulerLoad)
{
  const double D = measured_bending_stiffness();
  const double euler = M_PI * M_PI * D / (length * length);
  // delta = delta_0 / (1 - P / P_cr) under a sideways load of the mode's shape: slope of
  // (delta - delta_0) / P over delta is 1 / P_cr.
  const double start = deflection(0.);
  std::vector<double> slope;
  for (const double fraction : {0.3, 0.6, 0.9})
  {
    const double P = fraction * euler, now = deflection(P);
    slope.push_back((now - start) / (P * now));
  }
  std::printf("  D = %.4g N m^2, P_cr / P_Euler = %.4f, %.4f, %.4f\n", D,
              1. / (slope[0] * euler), 1. / (slope[1] * euler), 1. / (slope[2] * euler));
  for (const double s : slope)
    EXPECT_NEAR(1. / (s * euler), 1., 0.03);
  // The plot is straight: higher modes and shortening bend it by less.
  EXPECT_NEAR(slope.back() / slope.front(), 1., 0.01);

  // The straight state is stable below that load and unstable above it.
  const double critical = 1. / slope.back();
  for (const double fraction : {0.99, 1.01})
  {
    BondedColumn column;
    column.compress(fraction * critical);
    EXPECT_LT(column.solve(), 1e-9);
    EXPECT_EQ(column.n_unstable(), fraction < 1. ? 0 : 1) << fraction;
  }
}
} // namespace antiform::discrete::test::euler_column_tests

#include "discrete/homogenise.h"

#include "discrete/disk_pairs.h"

#include <Eigen/Sparse>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
namespace
{
using Triple = std::array<double, 3>; ///< gap, shear, rotation of a joint

/// Linearised kinematics and stiffness of one joint (docs/theory/packing.md):
///   gap = n.(u2 - u1),  shear = t.(u2 - u1) - r1 theta1 - r2 theta2,
///   rotation = theta2 - theta1.
struct LinearJoint
{
  Vec2 branch, normal, tangent;
  double lever_1, lever_2; ///< centre to face [m]
  Triple stiffness;        ///< force, force, moment per deformation

  LinearJoint(const PeriodicTile &tile, const DiskPair &pair, const FlatJoint &law)
      : branch(discrete::branch(tile.disks, pair))
  {
    const double r1 = tile.disks[pair.first].radius, r2 = tile.disks[pair.second].radius;
    const double distance = norm(branch);
    normal = (1. / distance) * branch;
    tangent = perpendicular(normal);
    const double gap = distance - r1 - r2;
    lever_1 = r1 + 0.5 * gap;
    lever_2 = r2 + 0.5 * gap;

    const double k_n = law.effective_modulus / (r1 + r2);
    const double length = 2. * law.radius_multiplier * std::min(r1, r2);
    // Elements of constant stress lack their own share of the moment.
    const double n = law.n_elements;
    const double share = law.element_moment ? 1. : 1. - 1. / (n * n);
    stiffness = {k_n * length, k_n / law.stiffness_ratio * length,
                 k_n * length * length * length / 12. * share};
  }

  Triple of_relative_displacement(const Vec2 &d) const
  {
    return {dot(normal, d), dot(tangent, d), 0.};
  }
};

/// u2 - u1 of a joint in the unit strains xx, yy and (engineering) xy.
std::array<Vec2, 3> affine(const Vec2 &branch)
{
  return {Vec2{branch.x, 0.}, Vec2{0., branch.y}, Vec2{0.5 * branch.y, 0.5 * branch.x}};
}

/// Unknowns: per grain u_x, u_y and rotation times the mean radius; the translation of
/// grain 0 is pinned. Entry -1 or -2 of a dof index: pinned.
class FluctuationProblem
{
public:
  FluctuationProblem(const PeriodicTile &tile,
                     const std::vector<DiskPair> &pairs,
                     const FlatJoint &law)
      : pairs_(pairs)
  {
    for (const Disk &d : tile.disks)
      length_ += d.radius / static_cast<double>(tile.disks.size());
    for (const DiskPair &p : pairs)
      joints_.emplace_back(tile, p, law);
    assemble(3 * static_cast<int>(tile.disks.size()) - 2);
  }

  const std::vector<LinearJoint> &joints() const { return joints_; }

  /// Deformation of every joint at equilibrium, per unit strain.
  std::vector<std::array<Triple, 3>> solve() const
  {
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix_);
    const bool factored = factor.info() == Eigen::Success;
    const double largest = factored ? factor.vectorD().cwiseAbs().maxCoeff() : 0.;
    if (!factored || factor.vectorD().minCoeff() < 1e-10 * largest)
      throw std::runtime_error(
          "Homogenisation: the periodic tile has a mechanism: grains without joints, or "
          "joints without moment. Give a larger installation gap or more elements.");
    std::vector<std::array<Triple, 3>> result(pairs_.size());
    for (int k = 0; k < 3; ++k)
    {
      Eigen::VectorXd u = factor.solve(load_.col(k));
      const Eigen::VectorXd residual = load_.col(k) - matrix_ * u;
      u += factor.solve(residual); // one refinement: residual at round-off
      for (std::size_t j = 0; j < pairs_.size(); ++j)
        result[j][k] = deformation(j, k, u);
    }
    return result;
  }

private:
  /// Gradient of the deformation of joint @p j: rows gap, shear, rotation; columns the
  /// three dofs of the first grain, then of the second.
  std::array<std::array<double, 6>, 3> gradient(const std::size_t j) const
  {
    const Vec2 n = joints_[j].normal, t = joints_[j].tangent;
    const double r1 = joints_[j].lever_1 / length_, r2 = joints_[j].lever_2 / length_;
    return {{{-n.x, -n.y, 0., n.x, n.y, 0.},
             {-t.x, -t.y, -r1, t.x, t.y, -r2},
             {0., 0., -1. / length_, 0., 0., 1. / length_}}};
  }

  std::array<int, 6> dofs(const std::size_t j) const
  {
    const int a = 3 * pairs_[j].first - 2, b = 3 * pairs_[j].second - 2;
    return {a, a + 1, a + 2, b, b + 1, b + 2};
  }

  void assemble(const int n)
  {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(36 * pairs_.size());
    load_ = Eigen::MatrixXd::Zero(n, 3);
    for (std::size_t j = 0; j < pairs_.size(); ++j)
    {
      const auto b = gradient(j);
      const auto dof = dofs(j);
      const Triple &stiffness = joints_[j].stiffness;
      const auto strains = affine(joints_[j].branch);
      for (int row = 0; row < 6; ++row)
      {
        if (dof[row] < 0)
          continue;
        for (int column = 0; column < 6; ++column)
        {
          double sum = 0.;
          for (int d = 0; d < 3; ++d)
            sum += b[d][row] * stiffness[d] * b[d][column];
          if (dof[column] >= 0)
            entries.emplace_back(dof[row], dof[column], sum);
        }
        for (int k = 0; k < 3; ++k)
        {
          const Triple a = joints_[j].of_relative_displacement(strains[k]);
          for (int d = 0; d < 3; ++d)
            load_(dof[row], k) -= b[d][row] * stiffness[d] * a[d];
        }
      }
    }
    matrix_.resize(n, n);
    matrix_.setFromTriplets(entries.begin(), entries.end());
  }

  Triple deformation(const std::size_t j, const int k, const Eigen::VectorXd &u) const
  {
    Triple result = joints_[j].of_relative_displacement(affine(joints_[j].branch)[k]);
    const auto b = gradient(j);
    const auto dof = dofs(j);
    for (int d = 0; d < 3; ++d)
      for (int c = 0; c < 6; ++c)
        if (dof[c] >= 0)
          result[d] += b[d][c] * u[dof[c]];
    return result;
  }

  const std::vector<DiskPair> &pairs_;
  double length_ = 0.; ///< mean radius: makes rotations displacements [m]
  std::vector<LinearJoint> joints_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::MatrixXd load_;
};

/// Compact text of a number for messages.
std::string number(const double x)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}
} // namespace

TileResponse
homogenise(const PeriodicTile &tile, const double installation_gap, const FlatJoint &law)
{
  if (tile.disks.empty())
    throw std::invalid_argument("Homogenisation: the periodic tile has no grains.");
  const std::vector<DiskPair> pairs = disk_pairs(tile.disks, tile.size, installation_gap);
  const FluctuationProblem problem(tile, pairs, law);

  TileResponse response;
  response.deformation = problem.solve();
  const double tile_area = tile.size.x * tile.size.y;
  // Energy: at equilibrium the mixed product of two states is the stiffness itself.
  for (std::size_t j = 0; j < pairs.size(); ++j)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        for (int d = 0; d < 3; ++d)
          response.stiffness[k][l] += response.deformation[j][k][d] *
                                      problem.joints()[j].stiffness[d] *
                                      response.deformation[j][l][d] / tile_area;
  for (const DiskPair &p : pairs)
    response.joints.push_back({p.first, p.second, p.shift});
  for (const Disk &d : tile.disks)
    response.density_factor += M_PI * d.radius * d.radius / tile_area;

  const double c11 = 0.5 * (response.stiffness[0][0] + response.stiffness[1][1]);
  const double c12 = response.stiffness[0][1];
  response.poisson_ratio = c12 / (c11 + c12);
  response.young_modulus = (c11 - c12) * (1. + response.poisson_ratio);
  return response;
}

FlatJoint match_moduli(const PeriodicTile &tile,
                       const double installation_gap,
                       FlatJoint law,
                       const double young_modulus,
                       const double poisson_ratio)
{
  constexpr double smallest_kappa = 1., largest_kappa = 50.;
  if (!(young_modulus > 0.))
    throw std::invalid_argument("Matching of moduli: Young's modulus is " +
                                number(young_modulus) + " Pa; give one > 0.");
  const auto excess = [&](const double log_kappa)
  {
    law.stiffness_ratio = std::exp(log_kappa);
    return homogenise(tile, installation_gap, law).poisson_ratio - poisson_ratio;
  };
  const double from = std::log(smallest_kappa), to = std::log(largest_kappa);
  const double low = excess(from), high = excess(to);
  if (!(low <= 0. && high >= 0.))
    throw std::invalid_argument(
        "Matching of moduli: Poisson's ratio (plane strain) is " + number(poisson_ratio) +
        ", but this packing of disks reaches " + number(low + poisson_ratio) +
        " (k_n/k_s = " + number(smallest_kappa) + ") to " + number(high + poisson_ratio) +
        " (k_n/k_s = " + number(largest_kappa) +
        ") only. Give one within, or end the grains at the surface of the layer.");

  std::uintmax_t evaluations = 60;
  const auto bracket = boost::math::tools::toms748_solve(
      excess, from, to, low, high,
      [](const double a, const double b) { return std::abs(b - a) < 1e-8; }, evaluations);
  law.stiffness_ratio = std::exp(0.5 * (bracket.first + bracket.second));
  // The response is proportional to E*.
  law.effective_modulus *=
      young_modulus / homogenise(tile, installation_gap, law).young_modulus;
  return law;
}
} // namespace antiform::discrete

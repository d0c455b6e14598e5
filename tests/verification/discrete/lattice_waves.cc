// Plane waves along the rows of a bonded triangular lattice: their frequencies are the
// eigenvalues of a 3 x 3 matrix, and their speeds, when they are long, those of the
// continuum.
#include "support/grain_fixtures.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace antiform::discrete::test::lattice_waves_tests
{
namespace
{
using Matrix = Eigen::Matrix3cd;
constexpr double E_c = 1e3, kappa = 2.2, d = 1.; // of strong_law and lattice
constexpr double mass = M_PI * 0.25 * d * d, inertia = 0.125 * mass * d * d;

/// Frequencies and polarisations (u, v, theta) e^(i k x) of a wave along x.
struct Branch
{
  double omega;
  Eigen::Vector3cd polarisation;
};
enum
{
  pressure,
  shear,
  rotation
};
std::array<Branch, 3> branches(const double k)
{
  Matrix D = Matrix::Zero();
  const double K_n = E_c, K_s = K_n / kappa, K_r = K_n * d * d / 12.;
  const Eigen::Vector3d stiffness(K_n, K_s, K_r);
  for (const double angle : {0., M_PI / 3., 2. * M_PI / 3.}) // each bond once
  {
    const double nx = std::cos(angle), ny = std::sin(angle);
    const std::complex<double> there = std::polar(1., k * d * nx), step = there - 1.;
    Matrix B; // gap, shear, rotation of the bond
    B << step * nx, step * ny, 0., -step * ny, step * nx, -0.5 * d * (1. + there), 0., 0.,
        step;
    D += B.adjoint() * stiffness.asDiagonal() * B;
  }
  const Eigen::Vector3d scale(1. / std::sqrt(mass), 1. / std::sqrt(mass),
                              1. / std::sqrt(inertia));
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(scale.asDiagonal() * D *
                                                     scale.asDiagonal());
  std::array<Branch, 3> result;
  int next = shear; // ascending: the acoustic branch before the optical one
  for (int i = 0; i < 3; ++i)
  {
    const Eigen::Vector3cd v = scale.asDiagonal() * solver.eigenvectors().col(i);
    // By symmetry u is alone.
    const bool is_pressure = std::norm(v[0]) > 0.5 * v.squaredNorm();
    result[is_pressure ? pressure : next] = {std::sqrt(solver.eigenvalues()[i]), v};
    next += is_pressure ? 0 : 1;
  }
  return result;
}

/// A lattice that repeats after @p columns along x and after two rows along y: the grains
/// around the cell copy those that they are images of.
class PeriodicLattice
{
public:
  explicit PeriodicLattice(const int columns)
      : run_(sample(columns))
  {
    int next = 0;
    for (int r = -1; r <= 2; ++r)
      for (int c = -1; c <= columns; ++c, ++next)
        if (r == 0 || r == 1)
        {
          if (c >= 0 && c < columns)
            cell_.push_back(next);
        }
    next = 0;
    for (int r = -1; r <= 2; ++r)
      for (int c = -1; c <= columns; ++c, ++next)
        source_.push_back(cell_[((r + 2) % 2) * columns + (c + columns) % columns]);
  }

  double stable() const { return stable_step(run_.sample.grains, run_.sample.joints); }

  /// Frequency of the standing wave, from the time between crossings of zero.
  double frequency(const double k, const Branch &branch, const double dt)
  {
    Grains &g = run_.sample.grains;
    const double amplitude = 1e-7; // linear to as many digits
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const std::complex<double> there = std::polar(amplitude, k * g.reference_x[i]);
      g.displacement_x[i] = (branch.polarisation[0] * there).real();
      g.displacement_y[i] = (branch.polarisation[1] * there).real();
      g.rotation[i] = (branch.polarisation[2] * there).real();
    }
    std::vector<double> crossing;
    double last = projection(k, branch);
    while (crossing.size() < 5)
    {
      run_.advance(dt);
      copy_images();
      const double now = projection(k, branch);
      if (last * now < 0.)
        crossing.push_back(run_.time - dt * now / (now - last));
      last = now;
    }
    return 4. * M_PI / (crossing[4] - crossing[0]);
  }

private:
  static Sample sample(const int columns)
  {
    Sample sample;
    for (int r = -1; r <= 2; ++r)
      for (int c = -1; c <= columns; ++c)
        sample.grains.add({d * (c + 0.5 * ((r + 2) % 2)), 0.5 * std::sqrt(3.) * d * r},
                          0.5 * d, 1., 0);
    bond_all(sample, strong_law(), 1e-9);
    return sample;
  }

  void copy_images()
  {
    Grains &g = run_.sample.grains;
    for (std::vector<double> *v : {&g.displacement_x, &g.displacement_y, &g.rotation,
                                   &g.velocity_x, &g.velocity_y, &g.spin})
      for (std::size_t i = 0; i < g.size(); ++i)
        (*v)[i] = (*v)[source_[i]];
  }

  /// Of the motion on the wave, in the scalar product of the masses.
  double projection(const double k, const Branch &branch) const
  {
    const Grains &g = run_.sample.grains;
    double sum = 0.;
    for (const int i : cell_)
    {
      const std::complex<double> there = std::polar(1., k * g.reference_x[i]);
      sum += mass * (branch.polarisation[0] * there).real() * g.displacement_x[i] +
             mass * (branch.polarisation[1] * there).real() * g.displacement_y[i] +
             inertia * (branch.polarisation[2] * there).real() * g.rotation[i];
    }
    return sum;
  }

  ExplicitRun run_;
  std::vector<int> cell_;   ///< grains of the cell, row by row
  std::vector<int> source_; ///< per grain, the one of the cell that it is an image of
};

/// Measured on a lattice of @p columns with @p waves waves in it.
double measured(const int columns, const int waves, const int branch)
{
  const double k = 2. * M_PI * waves / (columns * d);
  PeriodicLattice lattice(columns);
  const double dt = 0.1 * lattice.stable();
  const double omega = lattice.frequency(k, branches(k)[branch], dt);
  return 2. / dt * std::sin(0.5 * omega * dt); // free of leapfrog's own dispersion
}

/// Speeds of the continuum: C11 = sqrt(3)/4 (3 k_n + k_s), C66 = sqrt(3)/4 (k_n + k_s).
double continuum_speed(const int branch)
{
  const double k_n = E_c, k_s = k_n / kappa;
  const double density = mass / (0.5 * std::sqrt(3.) * d * d);
  const double modulus = branch == pressure ? 3. * k_n + k_s : k_n + k_s;
  return std::sqrt(0.25 * std::sqrt(3.) * modulus / density);
}
} // namespace

TEST(LatticeWaves, LongOnesHaveTheSpeedsOfTheContinuum)
{
  const Threads threads(1);
  for (const int branch : {pressure, shear})
  {
    std::array<double, 3> error{};
    for (const int i : {0, 1, 2})
    {
      const int waves = 1 << i;
      const double k = 2. * M_PI * waves / 64.;
      error[i] = measured(64, waves, branch) / k / continuum_speed(branch) - 1.;
    }
    // Dispersion is of the order of (k d)^2 / 24: 4e-4 for 64 grains a wave.
    EXPECT_LT(std::abs(error[0]), 5e-3 / 4.) << branch;
    EXPECT_NEAR(std::log2(error[1] / error[0]), 2., 0.1) << branch;
    EXPECT_NEAR(std::log2(error[2] / error[1]), 2., 0.1) << branch;
  }
}

TEST(LatticeWaves, DispersionOfEveryBranchIsThatOfTheBlochMatrix)
{
  const Threads threads(1);
  for (const int waves : {1, 4, 8, 16, 24, 32}) // up to k d = pi
  {
    const double k = 2. * M_PI * waves / (64. * d);
    for (const int branch : {pressure, shear, rotation})
      // Interpolating a crossing is good to (omega dt)^2 / 24 of a step.
      EXPECT_NEAR(measured(64, waves, branch) / branches(k)[branch].omega, 1., 1e-4)
          << waves << ' ' << branch;
  }
}

TEST(LatticeWaves, PressureBranchIsItsClosedForm)
{
  // K_n, K_s: u alone moves. One bond along the row, two at 60 degrees.
  const double K_n = E_c, K_s = K_n / kappa;
  for (const double k : {0.1, 1., 2., 3.})
  {
    const double row = 4. * std::pow(std::sin(0.5 * k * d), 2);
    const double oblique = 4. * std::pow(std::sin(0.25 * k * d), 2);
    const double exact =
        std::sqrt((K_n * row + 2. * (0.25 * K_n + 0.75 * K_s) * oblique) / mass);
    EXPECT_NEAR(branches(k)[pressure].omega / exact, 1., 1e-12) << k;
  }
}
} // namespace antiform::discrete::test::lattice_waves_tests

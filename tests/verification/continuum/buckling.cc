// Buckling forces from static deflections under a sine load at forces below the critical
// one (Southwell): W = q / (D k^4 + k_w - N k^2), so 1/W falls linearly and is 0 at N(k).
#include "continuum/foundation.h"
#include "continuum/layer_theory.h"
#include "continuum/loads.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

namespace buckling_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
enum class Ends
{
  pinned, ///< may turn and slide along x
  free    ///< may move across too
};

/// A strip of Q2 cells on springs at its lower face.
class SpringStrip
{
public:
  SpringStrip(const theory::Layer &layer,
        const double length,
        const unsigned int n_columns,
        const double foundation,
        const Ends ends = Ends::pinned,
        const double shear_layer = 0.)
      : layer_(layer)
      , length_(length)
      , triangulation_(MPI_COMM_WORLD)
      , solid_(mesh(n_columns),
               {ElasticMaterial::isotropic(layer.young_modulus, layer.poisson_ratio, 1.)},
               2)
  {
    if (foundation > 0.)
      solid_.add_to_stiffness(winkler_foundation(solid_, {boundary::bottom}, foundation));
    if (shear_layer > 0.)
      solid_.add_to_stiffness(
          pasternak_foundation(solid_, {boundary::bottom}, shear_layer));
    dealii::SymmetricTensor<2, 2> unit;
    unit[0][0] = -1. / layer.thickness; // one newton a metre of compression
    geometric_.reinit(solid_.stiffness());
    geometric_.add(1., solid_.geometric_stiffness(unit));

    const auto zero = [](const Point<2> &) { return 0.; };
    if (ends == Ends::pinned)
    {
      prescribe(solid_, boundary::left, 1, zero, values_);
      prescribe(solid_, boundary::right, 1, zero, values_);
    }
    hold_node(solid_, Point<2>(0., 0.), 0, values_);
  }

  /// Amplitude of the axis under sin(m pi x / L) on the upper face and axial force N [m].
  double deflection(const double N, const unsigned int m) const
  {
    const double k = m * M_PI / length_;
    const auto load =
        boundary_traction(solid_, {boundary::top},
                          [&](const Point<2> &p, const auto &) {
                            return dealii::Tensor<1, 2>({0., std::sin(k * p[0])});
                          });
    return axis_deflection(N, load, 0.5 * length_ / m);
  }

  /// Of the left end under a unit force across it and axial force N [m].
  double end_deflection(const double N) const
  {
    const auto load = boundary_traction(
        solid_, {boundary::left}, [&](const Point<2> &, const auto &) {
          return dealii::Tensor<1, 2>({0., 1. / layer_.thickness});
        });
    return axis_deflection(N, load, 0.);
  }

  /// Where the line through 1/W at two forces meets 0 [N/m].
  double buckling_force(const unsigned int m, const double N1, const double N2) const
  {
    const double y1 = 1. / deflection(N1, m), y2 = 1. / deflection(N2, m);
    return N1 + y1 * (N2 - N1) / (y1 - y2);
  }

private:
  template <class Load>
  double axis_deflection(const double N, const Load &load, const double x) const
  {
    dealii::TrilinosWrappers::SparseMatrix matrix;
    matrix.copy_from(solid_.stiffness());
    matrix.add(N, geometric_);
    const auto u = solve_direct(solid_, matrix, values_, load);
    double amplitude = 0.;
    for (const auto dof : solid_.locally_owned())
    {
      const auto p = solid_.support_point(dof);
      if (solid_.component(dof) == 1 && std::abs(p[1]) < 1e-9 &&
          std::abs(p[0] - x) < 1e-9)
        amplitude = u(dof);
    }
    return dealii::Utilities::MPI::sum(amplitude, MPI_COMM_WORLD);
  }

  const Triangulation &mesh(const unsigned int n_columns)
  {
    make_rectangle(triangulation_, length_, layer_.thickness, n_columns, 2);
    return triangulation_;
  }

  theory::Layer layer_;
  double length_;
  Triangulation triangulation_;
  ElasticSolid solid_;
  dealii::TrilinosWrappers::SparseMatrix geometric_;
  DirichletValues values_;
};

/// A layer with D = 1 N m.
theory::Layer unit_layer(const double thickness)
{
  return {12. / (thickness * thickness * thickness), 0., thickness};
}

void expect_winkler_mode(const double length,
                         const double foundation,
                         const unsigned int mode,
                         const double force)
{
  // Half as many columns make the second mode 1e-3 too stiff (cells 20 times longer than
  // high); these leave 2e-4. Crests are nodes for every mode tested.
  const unsigned int n_columns = mode == 2 ? 96 : 240;
  // Shear lowers D k^2 by 0.2 (k h)^2, the turning sections by (k h)^2 / 12 (nu = 0):
  // together 3e-4 for this thickness and the fifth mode.
  const double thickness = length / 500.;
  const SpringStrip strip(unit_layer(thickness), length, n_columns, foundation);
  const double N = strip.buckling_force(mode, 0.3 * force, 0.6 * force);
  EXPECT_NEAR(N, force, 1e-3 * force);
  for (const unsigned int other : {mode - 1, mode + 1})
    EXPECT_GT(strip.buckling_force(other, 0.3 * force, 0.6 * force), N);
}
} // namespace

TEST(Buckling, PinnedColumnReachesEulersForce)
{
  const double length = 20.;
  const theory::Layer layer{20e9, 0.25, 1.};
  const SpringStrip column(layer, length, 20, 0.);
  const double k = M_PI / length;
  const double euler = layer.bending_stiffness() * k * k;

  const double N = column.buckling_force(1, 0.3 * euler, 0.6 * euler);
  EXPECT_NEAR(N, euler, 0.01 * euler); // plane-strain D; shear takes 0.9 %
  // With shear and the turning of sections: what is left is of order (k h)^4, 6e-4, and
  // the discretisation.
  EXPECT_NEAR(N, layer.thick_bending_force(k), 1e-3 * euler);

  // 1/W is linear: a third force lies on the line. The deviation is from the turning of
  // sections, (k h)^2 / 12 of that of the shear.
  const double predicted = 1. / column.deflection(0., 1) * (1. - 0.8 * euler / N);
  EXPECT_NEAR(1. / column.deflection(0.8 * euler, 1), predicted, 1e-4 * predicted);
}

TEST(Buckling, StripOnSpringsOfUnitLengthTakesTheSecondMode)
{
  expect_winkler_mode(1., 500., 2, 52.1436);
}

TEST(Buckling, StripOnStiffSpringsTakesTheFifthMode)
{
  expect_winkler_mode(1., 5e4, 5, 449.3825);
}

TEST(Buckling, LongStripOnSpringsTakesTheFifthMode)
{
  expect_winkler_mode(3., 1e3, 5, 63.8912);
}

namespace
{
/// Least force of a layer of D = 1 with m half waves in its length, on springs k_w = 4
/// and a shear layer G_p = 3, for k = sqrt(2) = (k_w / D)^(1/4): 2 sqrt(k_w D) + G_p = 7.
/// \param slenderness k h
double force_on_a_shear_layer(const double slenderness,
                              const unsigned int m,
                              const unsigned int columns_per_half_wave)
{
  const double k = std::sqrt(2.);
  const SpringStrip strip(unit_layer(slenderness / k), m * M_PI / k,
                          m * columns_per_half_wave, 4., Ends::pinned, 3.);
  return strip.buckling_force(m, 0.3 * 7., 0.6 * 7.);
}
} // namespace

TEST(Buckling, StripOnAShearLayerBucklesAtTheWinklerForceAndItsStiffness)
{
  const double found = force_on_a_shear_layer(0.0125, 4, 48);
  // Pinned modes D k^2 + k_w / k^2 + G_p; the shear layer adds its stiffness, 43 % here,
  // whatever the wave. Shear and turning sections take 2e-5.
  EXPECT_NEAR(found, 2. * std::sqrt(4.) + 3., 1e-3 * 7.);
  const SpringStrip longer(unit_layer(0.0125), 10., 240, 4., Ends::pinned, 3.);
  for (const unsigned int m : {2u, 5u, 8u})
  {
    const double k = m * M_PI / 10., mode = k * k + 4. / (k * k) + 3.;
    EXPECT_NEAR(longer.buckling_force(m, 0.3 * mode, 0.6 * mode), mode, 1e-3 * mode);
  }
}

TEST(Buckling, ForcesOnAShearLayerConvergeAtFourthOrder)
{
  std::vector<double> forces;
  for (const unsigned int n : {8, 16, 32, 64})
    forces.push_back(force_on_a_shear_layer(0.2, 1, n));
  // Q2 in bending, from above. Cells of 1.4 to 0.2 times their height: the order rises to
  // 4 as they become short.
  const auto order = [&](const unsigned int k)
  { return std::log2((forces[k] - forces[k + 1]) / (forces[k + 1] - forces[k + 2])); };
  EXPECT_NEAR(order(0), 3.7, 0.2);
  EXPECT_NEAR(order(1), 3.9, 0.15);
  // With x = (k h)^2 shear lowers the bending force 2 by 0.2 x and the turning of the
  // sections under N all of it by x / 12; what is left is of order x^2, 2e-3 of 2.
  const double x = 0.04, expected = (2. / (1. + 0.2 * x) + 2. + 3.) / (1. + x / 12.);
  EXPECT_NEAR(forces[3], expected, 5e-4);
}

TEST(Buckling, LongStripWithFreeEndsBucklesAtHalfTheForce)
{
  // D = 1, k_w = 4: a half-infinite beam under a force P at its free end deflects there by
  //   W = (P / k_w) 4 l^2 b / (3 b^2 - a^2),  l^4 = k_w / 4 D,
  //   a^2 = l^2 + N / 4 D,  b^2 = l^2 - N / 4 D
  // (Hetenyi 1946): b / W falls linearly with N and is 0 at N = sqrt(k_w D).
  const double foundation = 4., critical = 2., thickness = 0.02, length = 14.;
  const SpringStrip strip(unit_layer(thickness), length, 280, foundation, Ends::free);
  const auto b = [](const double N) { return std::sqrt(1. - 0.25 * N); };
  const auto ordinate = [&](const double N) { return b(N) / strip.end_deflection(N); };
  const double N1 = 0.3 * critical, N2 = 0.6 * critical;
  const double y1 = ordinate(N1), y2 = ordinate(N2);
  const double N = N1 + y1 * (N2 - N1) / (y1 - y2);
  EXPECT_NEAR(N, critical, 1e-3 * critical);
  EXPECT_NEAR(N, 0.5 * theory::winkler_critical_force(1., foundation), 1e-3 * critical);
  // What the beam does before: 4 l^2 b / (k_w (2 - N)) = b / (2 - N).
  EXPECT_NEAR(strip.end_deflection(N1), b(N1) / (2. - N1), 2e-3 * b(N1) / (2. - N1));
}

TEST(Buckling, ClosedFormGivesTheModesOnSprings)
{
  // D (m pi / L)^2 + k_w (L / m pi)^2 worked out by hand. The third is tabulated
  // elsewhere as 63.8919, which has lost a digit: 27.415568 + 36.475626.
  struct Case
  {
    double length, foundation;
    theory::Mode expected;
  };
  for (const Case &c : {Case{1., 500., {2, 52.143566}}, Case{1., 5e4, {5, 449.38248}},
                        Case{3., 1e3, {5, 63.891194}}})
  {
    const auto mode = theory::winkler_critical_mode(1., c.foundation, c.length);
    EXPECT_EQ(mode.half_waves, c.expected.half_waves);
    EXPECT_NEAR(mode.force, c.expected.force,
                1e-6 * c.expected.force); // of the digits given
  }
}
} // namespace buckling_tests

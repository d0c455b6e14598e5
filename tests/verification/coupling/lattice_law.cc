// The law of the mesh beside grains against the grains: a regular lattice of bonded
// grains is a semi-linear solid at any uniform deformation.
#include "continuum/semi_linear_law.h"
#include "support/coupling_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::lattice_law_tests
{
namespace
{
struct Deformation
{
  double xx, xy, yx, yy; ///< F
  double turn() const { return std::atan2(yx - xy, xx + yy); }
  Vec2 operator()(const Vec2 &x) const
  {
    return {xx * x.x + xy * x.y, yx * x.x + yy * x.y};
  }
  continuum::PlaneVector strain() const
  {
    return {0.5 * (xx * xx + yx * yx - 1.), 0.5 * (xy * xy + yy * yy - 1.),
            xx * xy + yx * yy};
  }
};

/// A grain of the lattice, its six neighbours and their twelve joints.
GrainState hexagon()
{
  GrainState state;
  state.grains.add({0., 0.}, 0.5, 1., 0);
  for (int k = 0; k < 6; ++k)
    state.grains.add({std::cos(k * M_PI / 3.), std::sin(k * M_PI / 3.)}, 0.5, 1., 0);
  state.joints.begin_group(elastic_law(), 0, "lattice");
  for (const auto &[i, j] : discrete::pairs_within(state.grains, 1e-6, 0, 0))
    state.joints.add(state.grains, i, j, 1., 1.);
  state.joints.finish(state.grains.size());
  state.breaking = false;
  return state;
}

void deform(GrainState &state, const Deformation &F, const double turn)
{
  discrete::Grains &g = state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    const Vec2 u = F(g.reference(i)) - g.reference(i);
    g.displacement_x[i] = u.x;
    g.displacement_y[i] = u.y;
    g.rotation[i] = turn;
  }
  discrete::compute_joint_forces(g, state.joints, {}, nullptr);
}
} // namespace

TEST(LatticeLaw, IsSemiLinear)
{
  const continuum::ElasticMaterial material = lattice_material(elastic_law());
  const double mu = material.stiffness[2][2], lambda = material.stiffness[0][1];
  const continuum::SemiLinear law({lambda, mu});
  const continuum::NeoHookean other({lambda, mu});
  GrainState state = hexagon();
  ASSERT_EQ(state.joints.size(), 12u); // four in each direction: of four grains' areas
  const double area = 4. * 0.5 * std::sqrt(3.);
  Bonds bonds(state);
  Clock clock;
  for (const Deformation &F :
       {Deformation{0.85, 0., 0., 1.}, Deformation{1., 0.3, -0.1, 1.1},
        Deformation{0.1, -1.2, 0.9, 0.2}})
  {
    deform(state, F, F.turn());
    Energies e;
    clock.sample_due = true;
    bonds.run(Stage::forces, clock);
    bonds.add_energies(e);
    EXPECT_NEAR(e.strain_grains / area / law.energy(F.strain()), 1., 1e-12);
    EXPECT_GT(std::abs(other.energy(F.strain()) / law.energy(F.strain()) - 1.), 0.02);
    // The rotation of the grains is their own: no torque is left on the middle one.
    EXPECT_NEAR(state.grains.torque[0], 0., 1e-14);
  }
}
} // namespace antiform::coupling::test::lattice_law_tests

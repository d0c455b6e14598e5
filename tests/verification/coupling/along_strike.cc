// An overlap inside the competent layer, across its strike: grains in the middle, mesh to
// both sides, the distance to the core a function of x alone. And layers of very
// different stiffness, and overlaps narrower than a cell.
#include "support/lattice_patch.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace antiform::coupling::test::along_strike_tests
{
namespace
{
struct Strip
{
  Bridged model;
  double core = 8., w = 8., rim = 8., height = 0.;

  Strip(const bool cubic, const double modulus_ratio = 1.)
  {
    constexpr int n_rows = 24;
    height = n_rows * 0.5 * std::sqrt(3.);
    model.weight.distance_to_core = [this](const Vec2 &x) {
      return std::max({0., -x.x, x.x - core});
    };
    model.weight.width = w;
    model.weight.cubic = cubic;
    const double out = w + rim;
    make_cells(model.triangulation, lines(-out, core + out, 20), lines(0., height, 10),
               [this](const Vec2 &x) { return x.x < 0. || x.x > core; });
    model.state.grains = hexagonal_lattice({-w, core + w, 0., height}, {0.137, 0.},
                                           [](const Vec2 &) { return true; });
    const FlatJoint law = elastic_law();
    continuum::ElasticMaterial material = lattice_material(law);
    for (auto &row : material.stiffness)
      for (double &c : row)
        c *= modulus_ratio;
    model.join(law, 1e-6, material, 2. * height / 10.);
  }

  bool on_side(const Vec2 &x) const { return x.y < 1e-6 || x.y > height - 1e-6; }

  /// Sides and ends follow the uniform strain; the sides are lines of symmetry of the
  /// lattice, so its field is affine between them.
  StaticSolution solve(const Strain &strain) const
  {
    StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                        model.domain.get());
    const double out = w + rim - 1e-9;
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const Vec2 x = model.mesh_place(dof), u = affine(strain, x);
      if (on_side(x) || x.x < -out || x.x > core + out)
        system.fix_mesh(dof, model.solid->component(dof) == 0 ? u.x : u.y);
    }
    const discrete::Grains &g = model.state.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (on_side(g.reference(i)))
      {
        const Vec2 u = affine(strain, g.reference(i));
        system.fix_grain(i, 0, u.x);
        system.fix_grain(i, 1, u.y);
        system.fix_grain(i, 2, 0.);
      }
    return system.solve();
  }
};

PatchError strip_error(const bool cubic, const double modulus_ratio = 1.)
{
  const Strip strip(cubic, modulus_ratio);
  PatchError worst;
  for (const Strain &strain : {Strain{{1., 0., 0.}}, Strain{{0., 0., 1.}}})
  {
    const PatchError e = error_of(strip.model, strain, strip.solve(strain));
    std::printf("  %s, %s: core strain %.2e, joint force beside the overlap %.2e, mesh "
                "%.2e\n",
                cubic ? "cubic" : "linear", strain[0] != 0. ? "stretch" : "shear",
                e.strain, e.force, e.mesh);
    worst.enlarge(e);
  }
  return worst;
}
} // namespace

// The core is 8 d wide: all of its joints lie within 4 d of an overlap.
TEST(AlongStrike, JointForcesBesideTheOverlapAreUniform)
{
  // The demands of the patch test of a block.
  const PatchError linear = strip_error(false), cubic = strip_error(true);
  EXPECT_LE(linear.strain, 1.5e-3);
  EXPECT_LE(linear.force, 4e-3);
  EXPECT_LE(linear.mesh, 1.5e-2);
  EXPECT_LE(cubic.strain, 5e-4);
  EXPECT_LE(cubic.force, 1.5e-3);
  EXPECT_LE(cubic.mesh, 1e-2);
  EXPECT_GT(linear.force, 1e-5);
  EXPECT_GT(cubic.force, 1e-5);
}

TEST(AlongStrike, FailsWithASofterMesh)
{
  EXPECT_GT(strip_error(false, 0.5).force, 10. * 4e-3);
}

TEST(ThinOverlap, RunsOrIsRefused)
{
  // One cell of two diameters runs; a single grain's width gives vertices fewer grains
  // than they need or runs too. Nothing in between: no wrong numbers.
  for (const double w : {2., 1., 0.5})
  {
    BlockShape shape;
    shape.w = w;
    shape.rim = 10. - w; // whole cells
    Bridged model;
    bool runs = true;
    try
    {
      make_lattice_block(model, shape);
      model.factorise();
      PatchError worst;
      for (const Strain &strain : unit_strains)
        worst.enlarge(error_of(model, strain,
                               solve_patch(model, shape, strain, model.domain.get())));
      std::printf("  w = %g d runs: core strain %.2e, joint force %.2e\n", w,
                  worst.strain, worst.force);
      EXPECT_LE(worst.strain, 0.03);
      EXPECT_LE(worst.force, 0.10); // that of an edge tie
    }
    catch (const NumericalError &error)
    {
      runs = false;
      std::printf("  w = %g d: %s\n", w, error.what());
      EXPECT_NE(std::string(error.what()).find("multiplier space too rich at vertex ("),
                std::string::npos);
    }
    if (w == 2.)
    {
      EXPECT_TRUE(runs);
    }
  }
}

TEST(StiffnessContrast, OfTenThousandIsSolved)
{
  // A stiff half of the core, in series with the rest and the mesh along x: sides slide,
  // so the axial stress is that of springs in series.
  constexpr double ratio = 1e4;
  Strip strip(false);
  Bridged &model = strip.model;
  discrete::Joints &joints = model.state.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const double x = 0.5 * (model.state.grains.reference_x[joints.first[j]] +
                            model.state.grains.reference_x[joints.second[j]]);
    if (x > 2. && x < 6.)
      joints.stiffness[j] *= ratio;
  }
  StaticSystem system(model.state.grains, joints, model.solid.get(), model.domain.get());
  const double out = strip.w + strip.rim, length = strip.core + 2. * out;
  for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    const bool is_x = model.solid->component(dof) == 0;
    if (is_x && x.x < -out + 1e-9)
      system.fix_mesh(dof, 0.);
    else if (is_x && x.x > strip.core + out - 1e-9)
      system.fix_mesh(dof, 1.);
    else if (!is_x && strip.on_side(x))
      system.fix_mesh(dof, 0.);
  }
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (strip.on_side(g.reference(i)))
    {
      system.fix_grain(i, 1, 0.);
      system.fix_grain(i, 2, 0.);
    }
  const StaticSolution u = system.solve();
  EXPECT_LT(u.residual, 1e-8);
  set_displacement(model, u);
  const double gap = model.domain->displacement_gap(g, model.mesh->displacement);
  double mean = 0., n = 0.;
  for (const auto &cell : model.solid->cell_states(u.mesh))
    if (cell.weight == 1.)
    {
      mean += cell.strain[0];
      n += 1.;
    }
  // Everything but 4 d is deformable; the stiff part's boundary is uncertain by half a
  // joint on each side, and the half joints on the sides are whole here.
  const double strain = mean / n, wanted = 1. / (length - 4.);
  std::printf("  contrast %g: residual %.1e, gap %.1e, strain %.5f, in series %.5f\n",
              ratio, u.residual, gap, strain, wanted);
  EXPECT_LE(gap, 1e-8); // over an end displacement of 1
  EXPECT_NEAR(strain / wanted, 1., 1. / (length - 4.));
}
} // namespace antiform::coupling::test::along_strike_tests

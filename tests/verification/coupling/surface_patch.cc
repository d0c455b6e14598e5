// Patch test of the surface interface: a layer of the hexagonal lattice between two
// meshes, shortened or stretched evenly along the layer under an even pressure across it.
// Strains are then uniform in each material, and the lattice's affine field is its
// equilibrium up to its outer grains: on each of them lies one diameter of pressure.
#include "support/surface_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_patch_tests
{
namespace
{
using Kind = SurfaceTie::Kind;

/// The exact solution.
struct Patch
{
  LayeredShape shape;
  double along = 1e-10, pressure = 1e-10;     // linear kinematics of the joints
  double across_mesh = 0., across_layer = 0.; ///< strains

  Patch(const LayeredShape &s, const continuum::ElasticMaterial &lattice)
      : shape(s)
  {
    const auto &C = lattice.stiffness;
    across_layer = (-pressure - C[1][0] * along) / C[1][1];
    across_mesh = (-pressure / s.modulus_ratio - C[1][0] * along) / C[1][1];
  }
  Vec2 mesh(const Vec2 &x) const
  {
    const double T = shape.thickness();
    if (x.y <= 0.)
      return {along * x.x, across_mesh * (x.y + shape.height)};
    return {along * x.x,
            across_mesh * (x.y - T + shape.height) + across_layer * (T - 1.)};
  }
  /// Half a diameter at either side is a rigid arm.
  Vec2 grain(const Vec2 &x) const
  {
    return {along * x.x, across_mesh * shape.height + across_layer * (x.y - 0.5)};
  }
};

struct PatchError
{
  double strain = 0.; ///< of the cells, largest, over the strain
  double force = 0.;  ///< of the joints of outer grains, RMS over RMS
  double shear = 0.;  ///< force on outer grains along the edge, largest, over pressure d
  double normal = 0.; ///< error of that across it, over pressure d
};

bool is_end(const Vec2 &x, const LayeredShape &shape)
{
  return x.x < 1. || x.x > shape.length - 1.;
}

StaticSolution solve(const Bridged &model, const Patch &patch, const SurfaceTie &tie)
{
  const LayeredShape &shape = patch.shape;
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(), nullptr);
  tie.add_to(system);
  const double small = 1e-9;
  for (std::size_t dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof), u = patch.mesh(x);
    const bool at_end = x.x < small || x.x > shape.length - small;
    if (model.solid->component(dof) == 0)
    {
      if (at_end)
        system.fix_mesh(dof, u.x);
      continue;
    }
    if (x.y < small - shape.height)
      system.fix_mesh(dof, u.y);
    // Simpson's weights on Q2 faces, the trapezoid's on Q1.
    const bool is_middle = std::abs(std::remainder(x.x, shape.h)) > 0.1 * shape.h;
    const double share = shape.degree == 1 ? (at_end ? 0.5 : 1.)
                         : is_middle       ? 2. / 3.
                         : at_end          ? 1. / 6.
                                           : 1. / 3.;
    if (x.y > shape.thickness() + shape.height - small)
      system.add_mesh_force(dof, -patch.pressure * shape.h * share);
  }
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (is_end(g.reference(i), shape))
    {
      const Vec2 u = patch.grain(g.reference(i));
      system.fix_grain(i, 0, u.x);
      system.fix_grain(i, 1, u.y);
      system.fix_grain(i, 2, 0.);
    }
  return system.solve();
}

/// Of solution and exact field, away from the ends by @p margin.
PatchError error_of(Bridged &model,
                    const Patch &patch,
                    const SurfaceTie &tie,
                    const double margin = 0.)
{
  set_displacement(model, solve(model, patch, tie));
  const LayeredShape &shape = patch.shape;
  PatchError error;
  const auto inner = [&](const double x)
  { return x > margin && x < shape.length - margin; };

  const std::array<double, 3> exact{patch.along, patch.across_mesh, 0.};
  const double size = std::hypot(exact[0], exact[1]);
  const auto states = model.solid->cell_states(model.mesh->displacement);
  std::size_t c = 0;
  for (const auto &cell : model.triangulation.active_cell_iterators())
  {
    for (unsigned int k = 0; k < 3; ++k)
      if (inner(cell->center()[0]))
        error.strain =
            std::max(error.strain, std::abs(states[c].strain[k] - exact[k]) / size);
    ++c;
  }

  discrete::Grains &g = model.state.grains;
  discrete::Joints &joints = model.state.joints;
  discrete::compute_joint_forces(g, joints, {}, nullptr);
  std::vector<bool> outer(g.size(), false);
  for (const SurfaceInterface &interface : tie.interfaces())
    for (const SurfacePoint &point : interface.points())
      if (inner(g.reference_x[point.grain]) && !is_end(g.reference(point.grain), shape))
      {
        const double side = interface.edge().outward().y; // the edge pushes this way
        outer[point.grain] = true;
        error.shear =
            std::max(error.shear, std::abs(g.force_x[point.grain]) / patch.pressure);
        error.normal = std::max(
            error.normal, std::abs(-g.force_y[point.grain] * side / patch.pressure - 1.));
      }
  double square = 0., sum = 0.;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    if (!outer[joints.first[j]] && !outer[joints.second[j]])
      continue;
    const auto k = joint_stiffness(joints, j);
    const Vec2 n{joints.normal_x[j], joints.normal_y[j]};
    const Vec2 stretch{patch.along * n.x, patch.across_layer * n.y};
    const Vec2 t = perpendicular(n);
    const Vec2 wanted = k[0] * dot(stretch, n) * n + k[1] * dot(stretch, t) * t;
    // Force on the second grain: it is pulled back.
    const Vec2 got{-joints.force[j].x, -joints.force[j].y};
    square += dot(got - wanted, got - wanted);
    sum += dot(wanted, wanted);
  }
  error.force = std::sqrt(square / sum);
  return error;
}
} // namespace

/// Grains from end to end of the edge: the layer is all covered, and the patch is passed
/// for any cells, Q1 or Q2, in step with the grains or not, and any contrast. Round-off:
/// the solver's, times the contrast where forces come from small differences.
TEST(SurfacePatch, IsPassedByGrainsFromEndToEnd)
{
  for (const double ratio : {1., 1. / 20., 1e-4})
    for (const Kind kind : {Kind::cemented, Kind::sliding})
      for (const double h : {2., 2.4, 24. / 7.})
        for (const unsigned int degree : {1u, 2u})
        {
          LayeredShape shape;
          shape.h = h;
          shape.height = 4. * h;
          shape.first = 0.;
          shape.rows = 7; // first and last alike
          shape.modulus_ratio = ratio;
          shape.degree = degree;
          Bridged model;
          make_layered_lattice(model, shape);
          const Patch patch(shape, lattice_material(elastic_law()));
          const PatchError error = error_of(model, patch, make_tie(model, kind, true));
          const double round_off = 1e-13 + 1e-14 / ratio;
          EXPECT_LT(error.strain, 1e-12);
          EXPECT_LT(error.force, 20. * round_off);
          EXPECT_LT(error.normal, 20. * round_off);
          EXPECT_LT(error.shear, 20. * round_off);
        }
}

/// In general position the lattice ends a distance r from the end of the edge. The
/// traction there goes to the last grains, which takes r^2 / 2 d^2 of its share off the
/// last but one: the error of a soft mesh, whose traction is even whatever the layer
/// does. A mesh as stiff as the layer evens it out. It is an end effect: six diameters
/// further in it has fallen by more than three.
TEST(SurfacePatch, ErrsAtTheEndsOnly)
{
  const double rest = 24. - 23.137;
  for (const double ratio : {1., 1. / 20., 1e-4})
    for (const double h : {2., 2.4, 24. / 7.})
    {
      LayeredShape shape;
      shape.h = h;
      shape.height = 4. * h;
      shape.modulus_ratio = ratio;
      Bridged model;
      make_layered_lattice(model, shape);
      const Patch patch(shape, lattice_material(elastic_law()));
      const SurfaceTie tie = make_tie(model, Kind::cemented, true);
      const PatchError all = error_of(model, patch, tie),
                       inner = error_of(model, patch, tie, 6.);
      if (ratio == 1e-4)
      {
        EXPECT_NEAR(all.normal, 0.5 * rest * rest, 1e-3);
      }
      EXPECT_LT(all.normal, 0.5 * rest * rest + 1e-3);
      EXPECT_GT(all.force, 3. * inner.force);
      EXPECT_LT(inner.force, 0.02);
      EXPECT_LT(inner.normal, 0.02);
      EXPECT_LT(inner.strain, 0.01);
      std::printf(
          "E_mesh/E_layer %.4g, h %.3g d: strain %.1e, bond force %.1e, pressure %.1e; "
          "inner %.1e, %.1e, %.1e\n",
          ratio, h, all.strain, all.force, all.normal, inner.strain, inner.force,
          inner.normal);
    }
}

/// Sliding keeps together across the edge only: no shear on any outer grain, and an even
/// pressure on all but those at the ends, wherever the lattice ends.
TEST(SurfacePatch, SlidingCarriesNoShear)
{
  for (const double ratio : {1., 1. / 20.})
  {
    LayeredShape shape;
    shape.modulus_ratio = ratio;
    Bridged model;
    make_layered_lattice(model, shape);
    Patch patch(shape, lattice_material(elastic_law()));
    const PatchError even =
        error_of(model, patch, make_tie(model, Kind::sliding, true), 6.);
    EXPECT_LT(even.shear, 1e-12);
    EXPECT_LT(even.normal, 0.02); // as above

    // The measure sees shear where there is some.
    EXPECT_GT(error_of(model, patch, make_tie(model, Kind::cemented, true), 6.).shear,
              1e-4);
  }
}
} // namespace antiform::coupling::test::surface_patch_tests

// Patch test of the bridging domain on a hexagonal lattice: uniform strain imposed at the
// outer boundary of the mesh. The lattice's affine field is its equilibrium, so all
// errors come from the joining.
#include "support/coupling_fixtures.h"

#include "continuum/errors.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include <array>

namespace antiform::coupling::test::lattice_patch_tests
{
namespace
{
using Strain = std::array<double, 3>; // xx, yy, engineering xy
constexpr std::array<Strain, 3> unit_strains{{{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}};

Vec2 affine(const Strain &e, const Vec2 &x)
{
  return {e[0] * x.x + 0.5 * e[2] * x.y, 0.5 * e[2] * x.x + e[1] * x.y};
}

double norm_of(const Strain &e)
{
  return std::sqrt(e[0] * e[0] + e[1] * e[1] + 0.5 * e[2] * e[2]);
}

StaticSolution solve_patch(const Bridged &model,
                           const BlockShape &shape,
                           const Strain &strain,
                           const BridgingDomain *domain,
                           const double anchor = 0.)
{
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(), domain);
  const double out = shape.w + shape.rim, small = 1e-9;
  for (std::size_t dof = 0; dof < model.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = model.mesh_place(dof);
    if (x.x < -out + small || x.x > shape.core_x + out - small || x.y < -out + small ||
        x.y > shape.core_y + out - small)
    {
      const Vec2 u = affine(strain, x);
      system.fix_mesh(
          dof, model.solid->component(static_cast<unsigned int>(dof)) == 0 ? u.x : u.y);
    }
  }
  if (anchor > 0.)
    for (std::size_t i = 0; i < model.state.grains.size(); ++i)
      for (const unsigned int c : {0u, 1u})
        system.add_grain_spring(i, c, anchor);
  return system.solve();
}

struct PatchError
{
  double strain = 0.; ///< of the core: fit of a linear field to its grains
  double force = 0.;  ///< of the core's joints: RMS error over RMS force
  double mesh = 0.;   ///< largest of the cells outside of the overlap
  void enlarge(const PatchError &e)
  {
    strain = std::max(strain, e.strain);
    force = std::max(force, e.force);
    mesh = std::max(mesh, e.mesh);
  }
};

/// Mean strain of the grains in the core, from a least-squares fit of their displacement.
Strain fitted_strain(const Bridged &model, const StaticSolution &u)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (model.weight.distance_to_core(g.reference(i)) == 0.)
    {
      const Eigen::Vector3d row(1., g.reference_x[i], g.reference_y[i]);
      normal += row * row.transpose();
      right += row * Eigen::RowVector2d(u.ux[i], u.uy[i]);
    }
  const Eigen::Matrix<double, 3, 2> a = normal.ldlt().solve(right);
  return {a(1, 0), a(2, 1), a(2, 0) + a(1, 1)};
}

PatchError error_of(const Bridged &model, const Strain &strain, const StaticSolution &u)
{
  PatchError error;
  const Strain core = fitted_strain(model, u);
  error.strain =
      norm_of({core[0] - strain[0], core[1] - strain[1], core[2] - strain[2]}) /
      norm_of(strain);

  const discrete::Joints &joints = model.state.joints;
  const discrete::Grains &g = model.state.grains;
  double square = 0., reference = 0.;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    if (model.weight.distance_to_core(g.reference(one)) > 0. ||
        model.weight.distance_to_core(g.reference(two)) > 0.)
      continue;
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    const Vec2 a = affine(strain, g.reference(one)), b = affine(strain, g.reference(two));
    const std::array<double, 6> exact{a.x, a.y, 0., b.x, b.y, 0.};
    const std::array<double, 6> found{u.ux[one], u.uy[one], u.rotation[one],
                                      u.ux[two], u.uy[two], u.rotation[two]};
    for (const int r : {0, 1}) // normal and shear force
    {
      double wanted = 0., had = 0.;
      for (int c = 0; c < 6; ++c)
      {
        wanted += stiffness[r] * rows[r][c] * exact[c];
        had += stiffness[r] * rows[r][c] * found[c];
      }
      square += (had - wanted) * (had - wanted);
      reference += wanted * wanted;
    }
  }
  error.force = std::sqrt(square / reference);

  const auto cells = model.solid->cell_states(u.mesh);
  for (const auto &cell : cells)
    if (cell.weight == 1.)
    {
      const Strain &e = cell.strain;
      error.mesh = std::max(
          error.mesh, norm_of({e[0] - strain[0], e[1] - strain[1], e[2] - strain[2]}) /
                          norm_of(strain));
    }
  return error;
}

/// Worst of the three unit strains.
PatchError patch_error(const BlockShape &shape,
                       const MultiplierSpace space = MultiplierSpace::mesh)
{
  Bridged model;
  model.options.multipliers = space;
  make_lattice_block(model, shape);
  PatchError worst;
  for (const Strain &strain : unit_strains)
    worst.enlarge(
        error_of(model, strain, solve_patch(model, shape, strain, model.domain.get())));
  std::printf("  w = %g d, %s: core strain %.2e, joint force %.2e, mesh %.2e\n", shape.w,
              shape.cubic ? "cubic" : "linear", worst.strain, worst.force, worst.mesh);
  return worst;
}

BlockShape block(const double w, const bool cubic)
{
  BlockShape shape;
  shape.w = w;
  shape.cubic = cubic;
  return shape;
}
} // namespace

TEST(LatticePatch, LinearRampKeepsUniformStrain)
{
  const PatchError error = patch_error(block(8., false));
  EXPECT_LE(error.strain, 1.5e-3);
  EXPECT_LE(error.force, 4e-3);
  EXPECT_LE(error.mesh, 1.5e-2);
  EXPECT_GT(error.mesh, 1e-4);
}

TEST(LatticePatch, CubicRampKeepsUniformStrain)
{
  const PatchError error = patch_error(block(8., true));
  EXPECT_LE(error.strain, 5e-4);
  EXPECT_LE(error.force, 1.5e-3);
  EXPECT_LE(error.mesh, 1e-2);
  EXPECT_GT(error.mesh, 1e-4);
}

TEST(LatticePatch, QuadraticCellsKeepUniformStrain)
{
  // Multipliers stay on the vertices; the demand is that of bilinear cells.
  BlockShape shape = block(8., true);
  shape.degree = 2;
  const PatchError error = patch_error(shape);
  EXPECT_LE(error.strain, 5e-4);
  EXPECT_LE(error.force, 1.5e-3);
  EXPECT_LE(error.mesh, 1e-2);
}

TEST(LatticePatch, ErrorFallsWithTheWidthOfTheOverlap)
{
  const PatchError wide = patch_error(block(8., false)),
                   thin = patch_error(block(2., false));
  EXPECT_LE(wide.strain / thin.strain, 0.4);
  EXPECT_LE(wide.force / thin.force, 0.4);
}

TEST(LatticePatch, CoarsenedMultipliersTakeCellsOfOneDiameter)
{
  // h = 1 d, where the multipliers of the mesh itself are refused. 0.13 % was found when
  // the formulation was chosen; a fifth of it would mean that the measure sees nothing.
  BlockShape shape = block(8., false);
  shape.h = 1.;
  const PatchError error = patch_error(shape, MultiplierSpace::coarsened);
  EXPECT_LE(error.strain, 3e-3);
  EXPECT_LE(error.force, 8e-3);
  EXPECT_LE(error.mesh, 3e-2);
  EXPECT_GT(error.mesh, 1e-4);
}

TEST(LatticePatch, MultipliersPerGrainKeepUniformStrain)
{
  // The affine field is the lattice's equilibrium, so nothing is frozen that should move:
  // the demands are those of the mesh's multipliers.
  for (const bool cubic : {false, true})
  {
    const PatchError error = patch_error(block(8., cubic), MultiplierSpace::per_grain);
    EXPECT_LE(error.strain, 1.5e-3);
    EXPECT_LE(error.force, 4e-3);
    EXPECT_LE(error.mesh, 1.5e-2);
    EXPECT_GT(error.mesh, 1e-5);
  }
}

TEST(LatticePatch, FailsWithASofterMesh)
{
  // Negative control: half the modulus shifts half the strain to the wrong side.
  BlockShape shape = block(8., false);
  shape.mesh_modulus_ratio = 0.5;
  const PatchError error = patch_error(shape);
  EXPECT_GT(error.strain, 10. * 1.5e-3);
  EXPECT_GT(error.force, 10. * 4e-3);
  EXPECT_GT(error.mesh, 1.5e-2);
}

TEST(LatticePatch, FailsWithoutTheConstraint)
{
  // Negative control: nothing holds the grains, and with a faint anchor to the ground
  // they stay behind.
  const BlockShape shape = block(8., false);
  Bridged model;
  make_lattice_block(model, shape);
  EXPECT_THROW(solve_patch(model, shape, unit_strains[0], nullptr), NumericalError);
  const PatchError error = error_of(
      model, unit_strains[0], solve_patch(model, shape, unit_strains[0], nullptr, 1e-6));
  EXPECT_NEAR(error.strain, 1., 1e-3);
  EXPECT_NEAR(error.force, 1., 1e-3);
}

TEST(LatticePatch, AgreesWithTheExplicitConstraintAtRest)
{
  // The static solution is at rest for the loop too: unbalanced ratio at round-off, no
  // displacement gap.
  for (const MultiplierSpace space :
       {MultiplierSpace::mesh, MultiplierSpace::coarsened, MultiplierSpace::per_grain})
  {
    BlockShape shape = block(8., true);
    shape.h = space == MultiplierSpace::coarsened ? 1. : 2.;
    Bridged model;
    model.options.multipliers = space;
    make_lattice_block(model, shape);
    // Strain 1e-9: the joints' exact rotations differ from the linear ones by its square.
    set_displacement(model,
                     solve_patch(model, shape, {1e-9, 0., 0.}, model.domain.get()));
    const double out = shape.w + shape.rim, small = 1e-9;
    for (unsigned int dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const Vec2 x = model.mesh_place(dof);
      if (x.x < -out + small || x.x > shape.core_x + out - small || x.y < -out + small ||
          x.y > shape.core_y + out - small)
        model.mesh->prescribe(dof, -1);
    }
    model.factorise();
    EXPECT_LE(
        model.domain->displacement_gap(model.state.grains, model.mesh->displacement),
        1e-12 * largest_displacement(model));
    Loop run(model, model.stable_step(), {});
    run.probe(1, [](const Clock &) {});
    run.advance(1);
    EXPECT_LE(run.unbalanced_ratio(), 1e-8);
  }
}
} // namespace antiform::coupling::test::lattice_patch_tests

// Patch test of the bridging domain on a hexagonal lattice: uniform strain imposed at the
// outer boundary of the mesh. The lattice's affine field is its equilibrium, so all
// errors come from the joining.
#include "support/coupling_loop.h"
#include "support/figures.h"
#include "support/lattice_patch.h"

#include "continuum/errors.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::lattice_patch_tests
{
namespace
{
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

/// The two samplings of the weight never agree, so the error is a positive one: less than
/// a fifth of what was found when the formulation was chosen, @p chosen, would mean that
/// the measure sees nothing, or grains and mesh nothing of each other. Of the mesh a
/// tenth, since it is the largest of few cells.
void expect_no_less(const PatchError &error, const PatchError &chosen)
{
  EXPECT_GE(error.strain, 0.2 * chosen.strain);
  EXPECT_GE(error.force, 0.2 * chosen.force);
  EXPECT_GE(error.mesh, 0.1 * chosen.mesh);
}
constexpr PatchError chosen_linear{6.7e-4, 2.0e-3, 6.7e-3},
    chosen_cubic{1.4e-4, 5.6e-4, 4.6e-3};
} // namespace

TEST(LatticePatch, LinearRampKeepsUniformStrain)
{
  const PatchError error = patch_error(block(8., false));
  EXPECT_LE(error.strain, 1.5e-3);
  EXPECT_LE(error.force, 4e-3);
  EXPECT_LE(error.mesh, 1.5e-2);
  expect_no_less(error, chosen_linear);
}

TEST(LatticePatch, CubicRampKeepsUniformStrain)
{
  const PatchError error = patch_error(block(8., true));
  EXPECT_LE(error.strain, 5e-4);
  EXPECT_LE(error.force, 1.5e-3);
  EXPECT_LE(error.mesh, 1e-2);
  expect_no_less(error, chosen_cubic);
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
  expect_no_less(error, chosen_cubic);
}

TEST(LatticePatch, ErrorFallsWithTheWidthOfTheOverlap)
{
  const PatchError wide = patch_error(block(8., false)),
                   thin = patch_error(block(2., false));
  EXPECT_LE(wide.strain / thin.strain, 0.4);
  EXPECT_LE(wide.force / thin.force, 0.4);
  // By the weight's slope, 1 / w, it should be a quarter; 1 / w^2 would be of another
  // cause.
  EXPECT_GE(wide.strain / thin.strain, 1. / 16.);
  EXPECT_GE(wide.force / thin.force, 1. / 16.);
}

// Linear: all that is left over by the two samplings of the weight's slope, 1 / w, is
// spread over w; cubic from 4 cells on, where it leaves most of its rims alone.
TEST(LatticePatch, ErrorFollowsTheWidthOfTheOverlapLong)
{
  antiform::test::Figure figure(
      "patch_error", "width_over_cell,cubic,core_strain,joint_force,mesh_strain");
  for (const bool cubic : {false, true})
  {
    PatchError last;
    for (const double w : {2., 4., 6., 8., 12., 16.})
    {
      const PatchError error = patch_error(block(w, cubic));
      figure.add({0.5 * w, cubic ? 1. : 0., error.strain, error.force, error.mesh});
      if (w > 2.)
      {
        EXPECT_LT(error.strain, last.strain);
        EXPECT_LT(error.force, last.force);
      }
      last = error;
    }
    // From one cell to eight: by the inverse of the width at least.
    EXPECT_LE(last.strain, cubic ? 5e-4 : 1.5e-3);
    EXPECT_LE(last.force, cubic ? 1.5e-3 : 4e-3);
    EXPECT_GE(last.force, 1e-6);
  }
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

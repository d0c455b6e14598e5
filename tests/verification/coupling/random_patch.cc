// Patch test on random packings: the core of a block cut from a periodic tile, under the
// mesh's uniform strain, against the tile's own response to that strain.
#include "support/figures.h"
#include "support/lattice_patch.h"

#include "discrete/homogenise.h"
#include "discrete/packing.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include <array>

namespace antiform::coupling::test::random_patch_tests
{
namespace
{
constexpr double core_size = 24., tile_size = 44.; // core and overlap of 8 d on each side
constexpr double installation_gap = 0.15;

struct RandomBlock
{
  Bridged model;
  discrete::TileResponse response;
  std::vector<std::int32_t> tile_joint; ///< of each joint of the model

  RandomBlock(const std::uint64_t seed,
              const bool cubic,
              const double modulus_ratio = 1.,
              const MultiplierSpace space = MultiplierSpace::mesh)
  {
    model.options.multipliers = space;
    discrete::PackingParameters parameters;
    parameters.seed = seed;
    const discrete::PeriodicTile tile =
        discrete::pack_periodic({tile_size, tile_size}, parameters);
    const FlatJoint law = elastic_law();
    response = discrete::homogenise(tile, installation_gap, law);

    BlockShape shape;
    shape.core_x = shape.core_y = core_size;
    shape.cubic = cubic;
    make_block_mesh(model, shape);
    const double shift = 0.5 * (tile_size - core_size);
    std::vector<std::int32_t> grain(tile.disks.size(), -1);
    std::vector<int> n_joints(tile.disks.size(), 0);
    const auto inside = [&](const int i) {
      return model.weight.holds_grains(tile.disks[i].centre - Vec2{shift, shift});
    };
    for (const discrete::TileJoint &joint : response.joints)
      if (norm(joint.shift) == 0. && inside(joint.first) && inside(joint.second))
        ++n_joints[joint.first], ++n_joints[joint.second];
    discrete::Grains &g = model.state.grains;
    for (std::size_t i = 0; i < tile.disks.size(); ++i)
      if (n_joints[i] > 0) // no rattlers from the cut
      {
        grain[i] = static_cast<std::int32_t>(g.size());
        g.add(tile.disks[i].centre - Vec2{shift, shift}, tile.disks[i].radius, 1., 0);
      }
    discrete::Joints &joints = model.state.joints;
    joints.begin_group(law, 0, "grains");
    for (std::size_t j = 0; j < response.joints.size(); ++j)
    {
      const discrete::TileJoint &joint = response.joints[j];
      if (norm(joint.shift) == 0. && inside(joint.first) && inside(joint.second))
      {
        joints.add(g, grain[joint.first], grain[joint.second], 1., 1.);
        tile_joint.push_back(static_cast<std::int32_t>(j));
      }
    }
    joints.finish(g.size());
    continuum::ElasticMaterial material;
    material.stiffness = response.stiffness;
    for (auto &row : material.stiffness)
      for (double &c : row)
        c *= modulus_ratio;
    material.density = response.density_factor;
    model.join_bonded(material, 4.);
  }

  StaticSolution solve(const Strain &strain) const
  {
    StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                        model.domain.get());
    const double low = -16. + 1e-9, high = core_size + 16. - 1e-9;
    for (std::size_t dof = 0; dof < model.n_mesh_dofs(); ++dof)
    {
      const Vec2 x = model.mesh_place(dof), u = affine(strain, x);
      if (x.x < low || x.x > high || x.y < low || x.y > high)
        system.fix_mesh(
            dof, model.solid->component(static_cast<unsigned int>(dof)) == 0 ? u.x : u.y);
    }
    return system.solve();
  }
};

struct PatchError
{
  double strain = 0., stress = 0., force = 0., mesh = 0.;
  double beside = 0.; ///< of the joint forces within 4 d of the overlap
  /// Of the joint forces by depth in the core, in strips of 2 d from its rim inwards.
  std::array<double, 6> by_depth{};
  void enlarge(const PatchError &e)
  {
    strain = std::max(strain, e.strain);
    stress = std::max(stress, e.stress);
    force = std::max(force, e.force);
    mesh = std::max(mesh, e.mesh);
    beside = std::max(beside, e.beside);
    for (std::size_t k = 0; k < by_depth.size(); ++k)
      by_depth[k] = std::max(by_depth[k], e.by_depth[k]);
  }
};

PatchError error_of(const RandomBlock &block, const Strain &strain)
{
  const Bridged &model = block.model;
  const StaticSolution u = block.solve(strain);
  PatchError error;
  const Strain fit = fitted_strain(model, u);
  error.strain = norm_of({{fit[0] - strain[0], fit[1] - strain[1], fit[2] - strain[2]}}) /
                 norm_of(strain);

  const discrete::Joints &joints = model.state.joints;
  const discrete::Grains &g = model.state.grains;
  double square = 0., reference = 0., square_beside = 0., reference_beside = 0.;
  const Rectangle inner{4., core_size - 4., 4., core_size - 4.};
  Eigen::Matrix2d stress = Eigen::Matrix2d::Zero(), wanted = stress; // times area
  std::array<double, 6> square_at{}, reference_at{};
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    if (model.weight.distance_to_core(g.reference(one)) > 0. ||
        model.weight.distance_to_core(g.reference(two)) > 0.)
      continue;
    const auto rows = joint_rows(joints, j);
    const auto stiffness = joint_stiffness(joints, j);
    const std::array<double, 6> q{
        {u.ux[one], u.uy[one], u.rotation[one], u.ux[two], u.uy[two], u.rotation[two]}};
    const auto &tile = block.response.deformation[block.tile_joint[j]];
    const Eigen::Vector2d n(joints.normal_x[j], joints.normal_y[j]), t(-n[1], n[0]);
    for (const int r : {0, 1}) // normal and shear force
    {
      double found = 0., exact = 0.;
      for (int c = 0; c < 6; ++c)
        found += stiffness[r] * rows[r][c] * q[c];
      for (int e = 0; e < 3; ++e)
        exact += stiffness[r] * strain[e] * tile[e][r];
      square += (found - exact) * (found - exact);
      reference += exact * exact;
      const Vec2 x = 0.5 * (g.reference(one) + g.reference(two));
      const double depth =
          std::min({x.x, core_size - x.x, x.y, core_size - x.y, 0.499 * core_size});
      square_at[static_cast<std::size_t>(0.5 * depth)] +=
          (found - exact) * (found - exact);
      reference_at[static_cast<std::size_t>(0.5 * depth)] += exact * exact;
      if (!inner.holds(g.reference(one)) || !inner.holds(g.reference(two)))
      {
        square_beside += (found - exact) * (found - exact);
        reference_beside += exact * exact;
      }
      const Eigen::Matrix2d dyad = joints.length[j] * (r == 0 ? n : t) * n.transpose();
      stress += found * dyad;
      wanted += exact * dyad;
    }
  }
  error.force = std::sqrt(square / reference);
  error.beside = std::sqrt(square_beside / reference_beside);
  for (std::size_t k = 0; k < square_at.size(); ++k)
    error.by_depth[k] = std::sqrt(square_at[k] / reference_at[k]);
  error.stress = (stress - wanted).norm() / wanted.norm();
  for (const auto &cell : model.solid->cell_states(u.mesh))
    if (cell.weight == 1.)
    {
      const Strain &e = cell.strain;
      error.mesh = std::max(
          error.mesh, norm_of({{e[0] - strain[0], e[1] - strain[1], e[2] - strain[2]}}) /
                          norm_of(strain));
    }
  return error;
}

/// Worst of two loads: strain along x, simple shear.
PatchError patch_error(const RandomBlock &block, const char *what)
{
  PatchError worst;
  for (const Strain &strain : {Strain{{1., 0., 0.}}, Strain{{0., 0., 1.}}})
  {
    const PatchError e = error_of(block, strain);
    std::printf("  %s, %s: core strain %.2e, stress %.2e, joint force %.2e, beside "
                "the overlap %.2e, mesh %.2e\n",
                what, strain[0] != 0. ? "axial" : "shear", e.strain, e.stress, e.force,
                e.beside, e.mesh);
    worst.enlarge(e);
  }
  return worst;
}
} // namespace

// A random packing's response is not affine: its own scatter is 0.8 % of stress in a
// window of 24 d, and a tenth of that is the least that strain and stress can be off by.
// Thresholds are about 1.7 times what was measured when the formulation was chosen; less
// than a fifth of that (joint force 1.9e-2, mesh 4.8e-2) would mean that the measure sees
// nothing.
namespace
{
void expect_no_less_than_scatter(const PatchError &error)
{
  EXPECT_GE(error.strain, 8e-4);
  EXPECT_GE(error.stress, 8e-4);
  EXPECT_GE(error.force, 3.8e-3);
  EXPECT_GE(error.mesh, 9.6e-3);
}
} // namespace

TEST(RandomPatch, KeepsUniformStrainInThreePackings)
{
  for (const std::uint64_t seed : {1u, 2u, 3u})
  {
    const RandomBlock block(seed, false);
    const PatchError error =
        patch_error(block, ("packing " + std::to_string(seed)).c_str());
    EXPECT_LE(error.strain, 2.5e-2);
    EXPECT_LE(error.stress, 2.5e-2);
    EXPECT_LE(error.force, 3e-2);
    EXPECT_LE(error.mesh, 0.10);
    expect_no_less_than_scatter(error);
  }
}

TEST(RandomPatch, CubicRampDoesNoHarm)
{
  const RandomBlock block(1, true);
  const PatchError error = patch_error(block, "cubic");
  EXPECT_LE(error.strain, 2.5e-2);
  EXPECT_LE(error.stress, 2.5e-2);
  EXPECT_LE(error.force, 3e-2);
  EXPECT_LE(error.mesh, 0.10);
  expect_no_less_than_scatter(error);
}

// One multiplier a grain freezes the scatter of the grains in the overlap about the mean
// field, which the joints of the core's rim feel: 3 to 6 % of error of the joint forces
// beside the overlap were found when the formulation was chosen, against 1.4 to 2 %. The
// core is 24 d wide here, three quarters of it far from its rim, so less remains.
namespace
{
void expect_frozen_scatter(const std::uint64_t seed)
{
  const RandomBlock free(seed, false);
  const RandomBlock frozen(seed, false, 1., MultiplierSpace::per_grain);
  const PatchError one = patch_error(free, "multipliers of the mesh"),
                   two = patch_error(frozen, "multipliers per grain");
  antiform::test::Figure figure("joint_forces_" + std::to_string(seed),
                                "depth,multipliers_of_mesh,multipliers_per_grain");
  for (std::size_t k = 0; k < one.by_depth.size(); ++k)
    figure.add({2. * static_cast<double>(k) + 1., one.by_depth[k], two.by_depth[k]});
  // Beside the rim the scatter counts; in the middle of the core neither space is felt.
  EXPECT_GE(two.by_depth.front() / one.by_depth.front(), 1.5);
  EXPECT_LE(two.by_depth.front(), 0.10);
  EXPECT_LE(one.by_depth.front(), 0.05);
  EXPECT_LE(two.by_depth.back(), 0.02);
  EXPECT_GE(two.force / one.force, 1.5);
  EXPECT_GE(two.beside / one.beside, 1.5);
  EXPECT_GE(two.beside, 0.02);
  EXPECT_LE(two.beside, 0.06);
}
} // namespace

TEST(RandomPatch, MultipliersPerGrainFreezeTheScatter)
{
  expect_frozen_scatter(1);
}

TEST(RandomPatch, MultipliersPerGrainFreezeTheScatterOfTwoMoreLong)
{
  expect_frozen_scatter(2);
  expect_frozen_scatter(3);
}

TEST(RandomPatch, FailsWithASofterMesh)
{
  const RandomBlock block(1, false, 0.5);
  const PatchError error = patch_error(block, "half modulus");
  EXPECT_GT(error.strain, 5e-2);
  EXPECT_GT(error.stress, 5e-2);
  EXPECT_GT(error.force, 6e-2);
}
} // namespace antiform::coupling::test::random_patch_tests

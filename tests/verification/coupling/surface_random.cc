// A random layer between meshes joined at its surface, against the same layer between
// matrix grains of the same packing: what it costs to leave these out.
#include "support/surface_fixtures.h"

#include "discrete/homogenise.h"
#include "discrete/packing.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::surface_random_tests
{
namespace
{
constexpr double side = 44., low = 16., high = 28., installation_gap = 0.15;

/// Uniform strains of layer and matrix under a load of the section: strain along both and
/// tractions across that both carry.
struct Load
{
  double along = 0., across_layer = 0., across_matrix = 0., shear_layer = 0.,
         shear_matrix = 0.;

  static Load pressing(const std::array<std::array<double, 3>, 3> &C,
                       const double contrast)
  {
    return {0., -1. / C[1][1], -1. / (contrast * C[1][1]), 0., 0.};
  }
  static Load stretching(const std::array<std::array<double, 3>, 3> &C, double)
  {
    return {1., -C[1][0] / C[1][1], -C[1][0] / C[1][1], 0., 0.};
  }
  static Load shearing(const std::array<std::array<double, 3>, 3> &C,
                       const double contrast)
  {
    return {0., 0., 0., 1. / C[2][2], 1. / (contrast * C[2][2])};
  }
  Vec2 at(const Vec2 &x) const
  {
    const double in_layer = std::clamp(x.y, low, high) - low, in_matrix = x.y - in_layer;
    return {along * x.x + shear_layer * in_layer + shear_matrix * in_matrix,
            across_layer * in_layer + across_matrix * in_matrix};
  }
};

bool is_rim(const Vec2 &x)
{
  return x.x < 1. || x.x > side - 1. || x.y < 1. || x.y > side - 1.;
}

struct RandomLayer
{
  Bridged full;                       ///< grains only
  Bridged coupled;                    ///< layer and meshes
  std::vector<std::int32_t> grain_of; ///< coupled grain of a grain of the full model
  discrete::TileResponse response;
  double contrast;

  RandomLayer(const std::uint64_t seed, const double matrix_over_layer)
      : contrast(matrix_over_layer)
  {
    discrete::PackingParameters parameters;
    parameters.seed = seed;
    const discrete::PeriodicTile tile = discrete::pack_periodic({side, side}, parameters);
    const FlatJoint law = elastic_law();
    response = discrete::homogenise(tile, installation_gap, law);
    discrete::Grains all;
    for (const auto &disk : tile.disks)
      all.add(disk.centre, disk.radius, 1., 0);
    full.state.grains = without_rattlers(all, installation_gap);
    bond(full, law);

    const discrete::Grains &g = full.state.grains;
    discrete::Grains layer;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (is_layer(g.reference(i)))
        layer.add(g.reference(i), g.radius[i], 1., 0);
    coupled.state.grains = without_rattlers(layer, installation_gap);
    bond(coupled, law);
    grain_of.assign(g.size(), -1);
    for (std::size_t i = 0, k = 0; i < g.size() && k < coupled.state.grains.size(); ++i)
      if (norm(g.reference(i) - coupled.state.grains.reference(k)) == 0.)
        grain_of[i] = static_cast<std::int32_t>(k++);
    make_mesh();
  }

  static bool is_layer(const Vec2 &x) { return x.y > low && x.y < high; }

  void bond(Bridged &model, const FlatJoint &law) const
  {
    discrete::Joints &joints = model.state.joints;
    const discrete::Grains &g = model.state.grains;
    const auto modulus = [&](const std::int32_t i)
    { return is_layer(g.reference(i)) ? 1. : contrast; };
    joints.begin_group(law, 0, "grains");
    for (const auto &[i, j] : discrete::pairs_within(g, installation_gap, 0, 0))
      joints.add(g, i, j, modulus(i), modulus(j));
    joints.finish(g.size());
    model.state.breaking = false;
  }

  void make_mesh()
  {
    std::vector<double> y = lines(0., low, 8);
    for (const double v : lines(high, side, 8))
      y.push_back(v);
    make_cells(coupled.triangulation, lines(0., side, 22), y,
               [](const Vec2 &centre) { return !is_layer(centre); });
    for (const auto &cell : coupled.triangulation.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        for (const auto &[at, id] :
             {std::pair(low, lower_edge), std::pair(high, upper_edge)})
          if (cell->at_boundary(f) && std::abs(cell->face(f)->center()[1] - at) < 1e-9)
            cell->face(f)->set_boundary_id(id);
    continuum::ElasticMaterial material;
    material.stiffness = response.stiffness;
    material.density = response.density_factor;
    LayeredShape shape;
    shape.modulus_ratio = contrast;
    finish_layered(coupled, shape, material);
  }
};

void fix_rim(StaticSystem &system, const discrete::Grains &g, const Load &load)
{
  for (std::size_t i = 0; i < g.size(); ++i)
    if (is_rim(g.reference(i)))
    {
      const Vec2 u = load.at(g.reference(i));
      system.fix_grain(i, 0, u.x);
      system.fix_grain(i, 1, u.y);
    }
}

void small_motion(Bridged &model, StaticSolution solution)
{
  discrete::Grains &g = model.state.grains;
  g.displacement_x = solution.ux;
  g.displacement_y = solution.uy;
  g.rotation = solution.rotation;
  for (auto *field : {&g.displacement_x, &g.displacement_y, &g.rotation})
    for (double &u : *field)
      u *= 1e-8; // linear kinematics
  discrete::compute_joint_forces(g, model.state.joints, {}, nullptr);
}

/// RMS difference of joint forces over their RMS, in the middle half of the length: of
/// the outer grains' joints, and of those 3 d or more from the edges.
struct ForceError
{
  double outer = 0., middle = 0.;
};

ForceError force_error(RandomLayer &model, const SurfaceTie &tie, const Load &load)
{
  StaticSystem full(model.full.state.grains, model.full.state.joints, nullptr, nullptr);
  fix_rim(full, model.full.state.grains, load);
  small_motion(model.full, full.solve());

  Bridged &c = model.coupled;
  StaticSystem coupled(c.state.grains, c.state.joints, c.solid.get(), nullptr);
  tie.add_to(coupled);
  fix_rim(coupled, c.state.grains, load);
  for (std::size_t dof = 0; dof < c.n_mesh_dofs(); ++dof)
  {
    const Vec2 x = c.mesh_place(dof), u = load.at(x);
    if (x.x < 1e-9 || x.x > side - 1e-9 || x.y < 1e-9 || x.y > side - 1e-9)
      coupled.fix_mesh(dof, c.solid->component(dof) == 0 ? u.x : u.y);
  }
  small_motion(c, coupled.solve());

  std::vector<bool> outer(c.state.grains.size(), false);
  for (const SurfaceInterface &interface : tie.interfaces())
    for (const SurfacePoint &point : interface.points())
      outer[point.grain] = true;
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> joint_of;
  for (std::size_t j = 0; j < c.state.joints.size(); ++j)
    joint_of[{c.state.joints.first[j], c.state.joints.second[j]}] = j;
  std::array<double, 2> square{}, size{};
  const discrete::Joints &joints = model.full.state.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::int32_t a = model.grain_of[joints.first[j]],
                       b = model.grain_of[joints.second[j]];
    if (a < 0 || b < 0)
      continue;
    const Vec2 x = c.state.grains.reference(a);
    if (x.x < 11. || x.x > side - 11.)
      continue;
    const auto here = joint_of.find({a, b});
    if (here == joint_of.end())
      continue;
    const auto &was = joints.force[j], &is = c.state.joints.force[here->second];
    const bool is_outer = outer[a] || outer[b];
    if (!is_outer && std::abs(x.y - 0.5 * (low + high)) > 3.)
      continue;
    square[is_outer ? 0 : 1] += std::pow(is.x - was.x, 2) + std::pow(is.y - was.y, 2);
    size[is_outer ? 0 : 1] += was.x * was.x + was.y * was.y;
  }
  return {std::sqrt(square[0] / size[0]), std::sqrt(square[1] / size[1])};
}
} // namespace

/// Grains of a matrix press on a random layer in single points and unevenly, the mesh
/// evenly: forces near the edge differ, and the difference dies out inside. What the
/// matrix carries along the layer falls with its modulus, and with it the error.
TEST(SurfaceRandom, ErrorDiesOutFromTheEdgeInwardLong)
{
  std::array<std::array<ForceError, 3>, 3> worst{}; // by contrast, by load
  const std::array<double, 3> contrasts{1., 1. / 20., 1e-4};
  for (unsigned int c = 0; c < contrasts.size(); ++c)
    for (const std::uint64_t seed : {1, 2, 3})
    {
      RandomLayer model(seed, contrasts[c]);
      const discrete::Grains &g = model.coupled.state.grains;
      std::vector<SurfaceInterface> interfaces;
      interfaces.emplace_back(g, outer_side(g, {}, 1., {0., -1.}), *model.coupled.solid,
                              lower_edge);
      interfaces.emplace_back(g, outer_side(g, {}, 1., {0., 1.}), *model.coupled.solid,
                              upper_edge);
      // A grain a diameter, somewhat fewer where others stand before them.
      EXPECT_GT(interfaces[0].points().size(), 30u);
      EXPECT_LT(interfaces[0].points().size(), 50u);
      const SurfaceTie tie(g, interfaces, SurfaceTie::Kind::cemented);
      const auto &C = model.response.stiffness;
      const std::array<Load, 3> loads{Load::pressing(C, contrasts[c]),
                                      Load::stretching(C, contrasts[c]),
                                      Load::shearing(C, contrasts[c])};
      for (unsigned int l = 0; l < loads.size(); ++l)
      {
        const ForceError error = force_error(model, tie, loads[l]);
        worst[c][l].outer = std::max(worst[c][l].outer, error.outer);
        worst[c][l].middle = std::max(worst[c][l].middle, error.middle);
        EXPECT_LT(error.middle, 0.5 * error.outer + 0.005);
      }
    }
  for (unsigned int c = 0; c < contrasts.size(); ++c)
    std::printf("contrast %.4g: pressing %.3f %.3f, stretching %.3f %.3f, shearing %.3f "
                "%.3f (outer grains, 3 d from the edge on)\n",
                contrasts[c], worst[c][0].outer, worst[c][0].middle, worst[c][1].outer,
                worst[c][1].middle, worst[c][2].outer, worst[c][2].middle);
  for (const unsigned int c : {0u, 1u, 2u})
    for (const unsigned int l : {0u, 2u})
    {
      // The forces across come from the matrix, whatever its modulus: by the scatter of
      // the joints' forces in a packing, some 0.3 to 0.5 of their mean.
      EXPECT_GT(worst[c][l].outer, 0.15);
      EXPECT_LT(worst[c][l].outer, 0.5);
      EXPECT_LT(worst[c][l].middle, 0.16);
    }
  // Along: the layer's own force, disturbed in proportion to the matrix' modulus.
  EXPECT_LT(worst[1][1].outer, 0.4 * worst[0][1].outer);
  EXPECT_LT(worst[2][1].outer, 0.05 * worst[0][1].outer);
}
} // namespace antiform::coupling::test::surface_random_tests

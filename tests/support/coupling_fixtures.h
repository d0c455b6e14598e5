#pragma once
// Grains and mesh joined in an overlap, as the program joins them. Unit of length is the
// mean grain diameter d, of stress the grains' modulus E*, of density that of a grain.
#include "continuum/elastic_solid.h"
#include "continuum/finite_strain_solid.h"
#include "coupling/bridging_domain.h"
#include "coupling/joining_components.h"
#include "coupling/mesh_components.h"
#include "coupling/static_system.h"
#include "discrete/random.h"

#include <deal.II/distributed/tria.h>

#include <omp.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace antiform::coupling::test
{
using discrete::FlatJoint;

/// Flat joint that breaks nowhere near the deformations of these tests.
inline FlatJoint elastic_law(const double ratio = 2.2)
{
  FlatJoint law;
  law.effective_modulus = 1.;
  law.stiffness_ratio = ratio;
  law.breakable = false;
  law.tensile_strength = 0.; // not looked at
  return law;
}

struct Rectangle
{
  double x_min = 0., x_max = 0., y_min = 0., y_max = 0.;

  double distance(const Vec2 &p) const
  {
    return std::hypot(std::max({x_min - p.x, p.x - x_max, 0.}),
                      std::max({y_min - p.y, p.y - y_max, 0.}));
  }
  bool holds(const Vec2 &p) const { return distance(p) == 0.; }
};

/// n + 1 even lines from @p begin to @p end.
inline std::vector<double> lines(const double begin, const double end, const int n)
{
  std::vector<double> values;
  for (int i = 0; i <= n; ++i)
    values.push_back(begin + (end - begin) * i / n);
  return values;
}

/// Cells between grid lines, without those whose centre @p keep refuses.
inline void make_cells(dealii::parallel::distributed::Triangulation<2> &triangulation,
                       const std::vector<double> &x,
                       const std::vector<double> &y,
                       const std::function<bool(const Vec2 &)> &keep)
{
  std::map<std::pair<std::size_t, std::size_t>, unsigned int> number;
  std::vector<dealii::Point<2>> vertices;
  std::vector<dealii::CellData<2>> cells;
  for (std::size_t j = 0; j + 1 < y.size(); ++j)
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
    {
      if (!keep({0.5 * (x[i] + x[i + 1]), 0.5 * (y[j] + y[j + 1])}))
        continue;
      dealii::CellData<2> cell;
      for (unsigned int v = 0; v < 4; ++v)
      {
        const std::pair<std::size_t, std::size_t> corner{i + v % 2, j + v / 2};
        const auto [entry, is_new] =
            number.try_emplace(corner, static_cast<unsigned int>(vertices.size()));
        if (is_new)
          vertices.emplace_back(x[corner.first], y[corner.second]);
        cell.vertices[v] = entry->second;
      }
      cells.push_back(cell);
    }
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

/// Hexagonal lattice of touching disks of diameter 1 with rows along x, where @p keep
/// wants them; a grain's centre is at @p origin.
inline discrete::Grains hexagonal_lattice(const Rectangle &box,
                                          const Vec2 &origin,
                                          const std::function<bool(const Vec2 &)> &keep)
{
  discrete::Grains grains;
  const double row = 0.5 * std::sqrt(3.), small = 1e-9;
  const auto first = [small](const double from, const double step)
  { return static_cast<int>(std::ceil((from - small) / step)); };
  for (int r = first(box.y_min - origin.y, row); origin.y + row * r <= box.y_max + small;
       ++r)
  {
    const double shift = origin.x + (r % 2 != 0 ? 0.5 : 0.);
    for (int c = first(box.x_min - shift, 1.); shift + c <= box.x_max + small; ++c)
    {
      const Vec2 centre{shift + c, origin.y + row * r};
      if (keep(centre))
        grains.add(centre, 0.5, 1., 0);
    }
  }
  return grains;
}

/// Exact moduli and bulk density of that lattice: K_n = k_n A = E*, K_s = K_n / kappa.
inline continuum::ElasticMaterial lattice_material(const FlatJoint &law)
{
  const double normal = law.effective_modulus, shear = normal / law.stiffness_ratio;
  const double f = std::sqrt(3.) / 4.;
  continuum::ElasticMaterial material;
  material.stiffness = {{{f * (3. * normal + shear), f * (normal - shear), 0.},
                         {f * (normal - shear), f * (3. * normal + shear), 0.},
                         {0., 0., f * (normal + shear)}}};
  material.density = 0.25 * M_PI / (0.5 * std::sqrt(3.));
  material.name = "lattice";
  return material;
}

/// Grains without a joint would be free bodies.
inline discrete::Grains without_rattlers(const discrete::Grains &all,
                                         const double installation_gap)
{
  std::vector<int> n(all.size(), 0);
  for (const auto &[i, j] : discrete::pairs_within(all, installation_gap, 0, 0))
    ++n[i], ++n[j];
  discrete::Grains grains;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (n[i] > 0)
      grains.add(all.reference(i), all.radius[i],
                 all.mass[i] / (M_PI * all.radius[i] * all.radius[i]), 0);
  return grains;
}

/// Grains, mesh and what joins them; not movable, since its parts refer to each other.
struct Bridged
{
  GrainState state;
  OverlapWeight weight;
  dealii::parallel::distributed::Triangulation<2> triangulation;
  std::unique_ptr<continuum::ElasticSolid> solid;
  std::optional<MeshState> mesh;
  std::unique_ptr<BridgingDomain> domain;
  std::vector<discrete::Wall> walls;
  unsigned int degree = 1; ///< of the cells
  BridgingOptions options;
  bool tie_unsupported = false; ///< grains that nothing holds
  bool finite_strain = false;   ///< of the mesh
  continuum::FiniteElasticity form = continuum::FiniteElasticity::semi_linear;

  /// One thread: these models are too small to share out.
  explicit Bridged(const MPI_Comm communicator = MPI_COMM_SELF)
      : triangulation(communicator)
  {
    omp_set_num_threads(1);
  }
  Bridged(const Bridged &) = delete;

  /// Bond the grains, weigh both sides and join them; triangulation and weight are there.
  /// \param cell area of a cell, for the smallest mass of a multiplier
  void join(const FlatJoint &law,
            const double installation_gap,
            const continuum::ElasticMaterial &material,
            const double cell)
  {
    discrete::Grains &grains = state.grains;
    state.joints.begin_group(law, 0, "grains");
    for (const auto &[i, j] : discrete::pairs_within(grains, installation_gap, 0, 0))
      state.joints.add(grains, i, j, law.effective_modulus, law.effective_modulus);
    state.joints.finish(grains.size());
    join_bonded(material, cell);
  }
  void join_bonded(const continuum::ElasticMaterial &material, const double cell)
  {
    state.joints.weight = joint_weights(state.grains, state.joints, weight);
    state.breaking = false;
    if (tie_unsupported)
      options.tied_grains = unsupported_grains(state.grains, state.joints, weight);
    const std::vector<continuum::ElasticMaterial> materials{material};
    const auto of_mesh = [w = weight](const dealii::Point<2> &x) {
      return w.mesh({x[0], x[1]});
    };
    if (finite_strain)
      solid = std::make_unique<continuum::FiniteStrainSolid>(triangulation, materials,
                                                             degree, of_mesh, form);
    else
      solid = std::make_unique<continuum::ElasticSolid>(triangulation, materials, degree,
                                                        of_mesh);
    mesh.emplace(*solid);
    domain = std::make_unique<BridgingDomain>(state.grains, state.joints, *solid, weight,
                                              0.02 * material.density * cell, options);
    set_masses(0.);
  }

  /// Inertial masses for quasi-static work at @p dt0, 0: the real, weighted ones.
  void set_masses(const double dt0)
  {
    const discrete::StiffnessSums sums =
        discrete::stiffness_sums(state.grains, state.joints, false);
    discrete::scale_density(state.grains, sums, domain->grain_mass_weight(), dt0);
    mesh->scale_density(domain->mesh_mass(), {}, dt0);
    domain->ties().hold(state.grains);
  }
  /// After the last change of masses or supports.
  void factorise() { domain->factorise(state.grains, mesh->inverse_mass); }

  void hold_grain(const std::size_t i)
  {
    state.grains.inverse_mass[i] = state.grains.inverse_inertia[i] = 0.;
  }
  /// Stable steps of the weighted grains, of the same grains without mesh, of the mesh.
  double grain_step() const { return discrete::stable_step(state.grains, state.joints); }
  double mesh_step() const { return solid->stable_step(mesh->inverse_mass); }
  double uncoupled_grain_step() const
  {
    discrete::Grains grains = state.grains;
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      grains.inverse_mass[i] = 1. / grains.mass[i];
      grains.inverse_inertia[i] = 1. / grains.inertia[i];
    }
    discrete::Joints joints = state.joints;
    joints.weight.clear();
    return discrete::stable_step(grains, joints);
  }
  double stable_step() const { return std::min(grain_step(), mesh_step()); }

  Vec2 mesh_place(const std::size_t dof) const
  {
    const auto p = solid->support_point(static_cast<unsigned int>(dof));
    return {p[0], p[1]};
  }
  std::size_t n_mesh_dofs() const { return solid->dof_handler().n_dofs(); }
};

/// A block: core, overlap of width @p w around it and @p rim of plain mesh. The core
/// consists of whole cells.
struct BlockShape
{
  double core_x = 16., core_y = 16.; ///< extent of the core [d]
  double h = 2., w = 8., rim = 8.;   ///< cell, overlap, plain mesh [d]
  bool cubic = false;
  double mesh_modulus_ratio = 1.;
  unsigned int degree = 1; ///< of the cells
};

inline void make_block_mesh(Bridged &model, const BlockShape &shape)
{
  const Rectangle core{0., shape.core_x, 0., shape.core_y};
  model.weight.distance_to_core = [core](const Vec2 &x) { return core.distance(x); };
  model.weight.width = shape.w;
  model.weight.cubic = shape.cubic;
  const double out = shape.w + shape.rim;
  const auto n = [&](const double core_size)
  { return static_cast<int>(std::lround((core_size + 2. * out) / shape.h)); };
  make_cells(model.triangulation, lines(-out, shape.core_x + out, n(shape.core_x)),
             lines(-out, shape.core_y + out, n(shape.core_y)),
             [&core](const Vec2 &centre) { return !core.holds(centre); });
}

/// Block with the grains of the hexagonal lattice.
inline void make_lattice_block(Bridged &model, const BlockShape &shape)
{
  make_block_mesh(model, shape);
  const Rectangle box{-shape.w, shape.core_x + shape.w, -shape.w, shape.core_y + shape.w};
  model.state.grains =
      hexagonal_lattice(box, {0.137, 0.271}, // in general position to the cells
                        [&](const Vec2 &x) { return model.weight.holds_grains(x); });
  model.degree = shape.degree;
  const FlatJoint law = elastic_law();
  continuum::ElasticMaterial material = lattice_material(law);
  for (auto &row : material.stiffness)
    for (double &c : row)
      c *= shape.mesh_modulus_ratio;
  model.join(law, 1e-6, material, shape.h * shape.h);
}

/// Largest displacement of grains and mesh [m].
inline double largest_displacement(const Bridged &model)
{
  double largest = model.mesh->displacement.linfty_norm();
  const discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    largest =
        std::max({largest, std::abs(g.displacement_x[i]), std::abs(g.displacement_y[i])});
  return largest;
}

/// Random velocities of grains (spins too) and mesh, made to obey the constraint.
inline void white_noise(Bridged &model, const double speed, const std::uint64_t seed)
{
  discrete::Random random(seed, 7);
  discrete::Grains &g = model.state.grains;
  const auto number = [&] { return speed * (2. * random.uniform() - 1.); };
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g.inverse_mass[i] > 0.)
    {
      g.velocity_x[i] = number();
      g.velocity_y[i] = number();
      g.spin[i] = number();
    }
  MeshState &m = *model.mesh;
  for (std::size_t dof = 0; dof < model.n_mesh_dofs(); ++dof)
    m.velocity(static_cast<unsigned int>(dof)) =
        m.inverse_mass(static_cast<unsigned int>(dof)) > 0. ? number() : 0.;
  model.domain->project(g, m.velocity);
}

/// Forces of the present positions on grains and mesh, nothing else [N].
inline void compute_forces(Bridged &model)
{
  discrete::compute_joint_forces(model.state.grains, model.state.joints, {}, nullptr);
  model.mesh->force = 0.;
  model.solid->add_internal_force(model.mesh->displacement, model.mesh->force);
}

/// Largest angular frequency [rad/s] of grains, mesh and what @p add_forces adds, on
/// velocities that @p project projects, by power iteration from the velocities that are
/// there; approached from below. The model is at rest afterwards.
inline double frequency_by_power_iteration(Bridged &model,
                                           const std::function<void()> &add_forces,
                                           const std::function<void()> &project,
                                           const int n)
{
  discrete::Grains &g = model.state.grains;
  MeshState &m = *model.mesh;
  const auto for_all = [&](const auto &action) // value, velocity, force, inverse mass
  {
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      action(g.displacement_x[i], g.velocity_x[i], g.force_x[i], g.inverse_mass[i]);
      action(g.displacement_y[i], g.velocity_y[i], g.force_y[i], g.inverse_mass[i]);
      action(g.rotation[i], g.spin[i], g.torque[i], g.inverse_inertia[i]);
    }
    for (unsigned int k = 0; k < m.displacement.locally_owned_size(); ++k)
      action(m.displacement.begin()[k], m.velocity.begin()[k], m.force.begin()[k],
             m.inverse_mass.begin()[k]);
  };
  double square = 0.;
  for (int iteration = 0; iteration < n; ++iteration)
  {
    double norm = 0.;
    for_all([&](double, const double v, double, const double Mi)
            { norm += Mi > 0. ? v * v / Mi : 0.; });
    square = std::sqrt(norm);
    // Displacements of 1e-9: linear kinematics of the joints.
    for_all([&](double &u, double &v, double, double)
            { u = v = 1e-9 * v / std::sqrt(norm); });
    m.displacement.update_ghost_values();
    compute_forces(model);
    add_forces();
    for_all([&](double, double &v, const double f, const double Mi)
            { v = -1e9 * Mi * f; });
    project();
  }
  for_all([](double &u, double &v, double, double) { u = v = 0.; });
  return std::sqrt(square);
}

/// Of the model, of its projection on the constraint or of its parts side by side.
inline double largest_frequency(Bridged &model, const bool projected, const int n = 600)
{
  white_noise(model, 1., 17);
  const auto project = [&]
  {
    if (projected)
      model.domain->project(model.state.grains, model.mesh->velocity);
  };
  return frequency_by_power_iteration(
      model, [] {}, project, n);
}

/// Copy a static solution to the state.
inline void set_displacement(Bridged &model, const StaticSolution &solution)
{
  discrete::Grains &g = model.state.grains;
  g.displacement_x = solution.ux;
  g.displacement_y = solution.uy;
  g.rotation = solution.rotation;
  model.mesh->displacement = solution.mesh;
  model.mesh->displacement.update_ghost_values();
}
} // namespace antiform::coupling::test

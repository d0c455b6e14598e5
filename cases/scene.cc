#include "cases/scene.h"

#include "cases/inertia.h"
#include "cases/mesh_strips.h"
#include "cases/overlap.h"
#include "cases/scene_components.h"
#include "cases/scene_events.h"
#include "cases/section_contacts.h"
#include "cases/section_foundation.h"
#include "cases/section_materials.h"

#include "continuum/errors.h"
#include "continuum/finite_strain_solid.h"
#include "continuum/section_mesh.h"
#include "discrete/locked_in.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace antiform::cases
{
using namespace coupling;

namespace
{
OverlapWeight overlap_weight(const Parameters &p, const SectionGeometry &geometry)
{
  OverlapWeight weight;
  weight.distance_to_core = [&geometry](const Vec2 &x)
  { return geometry.distance_to_core(x); };
  weight.width = p.bridging.overlap * geometry.diameter();
  weight.floor = p.bridging.weight_floor;
  const double cells = p.bridging.overlap / p.matrix.cell_size;
  weight.cubic =
      p.bridging.ramp == "cubic" || (p.bridging.ramp == "automatic" && cells >= 4.);
  return weight;
}

/// The mesh beside matrix grains has their response.
continuum::ElasticMaterial matrix_material(const Parameters &p, const GrainSection &grains)
{
  continuum::ElasticMaterial material;
  material.stiffness = grains.matrix->response.stiffness;
  for (auto &row : material.stiffness)
    for (double &c : row)
      c *= p.matrix.mesh_modulus_ratio;
  material.density = grains.matrix->bulk_density;
  material.name = "matrix";
  return material;
}

void build_mesh(Scene &scene, const MPI_Comm communicator)
{
  const Parameters &p = scene.parameters;
  scene.triangulation = make_mesh(p, scene.geometry, communicator);
  if (p.has_surface_interface())
    label_edges(*scene.triangulation, scene.geometry);
  std::vector<continuum::ElasticMaterial> materials = mesh_materials(p);
  if (p.is_bridged())
    materials[matrix_material_id] = matrix_material(p, *scene.grains);
  std::function<double(const dealii::Point<2> &)> weight;
  if (p.is_bridged())
    weight = [w = overlap_weight(p, scene.geometry)](const dealii::Point<2> &x) {
      return w.mesh({x[0], x[1]});
    };
  if (p.run.strain == "finite") // beside grains as they strain; else as the static driver
    scene.solid = std::make_unique<continuum::FiniteStrainSolid>(
        *scene.triangulation, materials, p.matrix.element_degree, weight,
        scene.grains ? continuum::FiniteElasticity::semi_linear
                     : continuum::FiniteElasticity::neo_hookean);
  else
    scene.solid = std::make_unique<continuum::ElasticSolid>(
        *scene.triangulation, materials, p.matrix.element_degree, weight);
  scene.mesh.emplace(*scene.solid);
}

/// Sides move with the walls, the base is held as the deck says.
void support_mesh(Scene &scene)
{
  const Parameters &p = scene.parameters;
  const SectionGeometry &g = scene.geometry;
  const double small = 1e-9 * g.length();
  const auto partitioner = scene.mesh->displacement.get_partitioner();
  for (const auto dof : scene.solid->locally_owned())
  {
    const dealii::Point<2> x = scene.solid->support_point(dof);
    const auto local = partitioner->global_to_local(dof);
    const bool horizontal = scene.solid->component(dof) == 0;
    // A node on the interface reacts for half a cell of each side, by their stiffness.
    const double depth = std::min(g.layer_top(x[0]) - x[1], x[1] - g.layer_bottom(x[0]));
    const double contrast = p.matrix.stiffness_contrast;
    double layer_share = depth < -small ? 0. : 1.;
    if (p.layer.representation == "grains")
      layer_share = 0.;
    else if (p.has("matrix") && std::abs(depth) <= small)
      layer_share = contrast / (1. + contrast);
    if (p.has("walls") && horizontal && x[0] < g.x_min() + small)
      scene.mesh->prescribe(local, 0, layer_share);
    else if (p.has("walls") && horizontal && x[0] > g.x_max() - small)
      scene.mesh->prescribe(local, 1, layer_share);
    else if (p.has("matrix") && !p.has_foundation_under("base") &&
             !p.is_absorbing("base") && x[1] < g.base() + small &&
             (!horizontal || p.matrix.base == "fixed"))
      scene.mesh->prescribe(local, -1);
  }
}

/// Smooth joints have no bridging weight.
void refuse_fractures_in_overlap(const GrainSection &section, const OverlapWeight &weight)
{
  const discrete::Grains &grains = section.state.grains;
  for (const discrete::SmoothContact &c : section.smooth->contacts)
    for (const std::int32_t i : {c.first, c.second})
      if (weight.grains(grains.reference(i)) < 1.)
      {
        const discrete::Fracture &f = section.smooth->fractures[c.fracture];
        char text[320];
        std::snprintf(text, sizeof text,
                      "the fracture from (%.6g, %.6g) to (%.6g, %.6g) reaches into the "
                      "overlap of grains and mesh, where there are no smooth joints. "
                      "Shorten it, or give 'Bridging domain / Buffer width ratio' more.",
                      f.begin.x, f.begin.y, f.end.x, f.end.y);
        throw InputError({text});
      }
}
} // namespace

std::size_t Scene::n_multipliers() const
{
  if (surface)
    return surface->n_multipliers();
  return bridging ? bridging->n_multipliers() : 0;
}

double Scene::displacement_gap() const
{
  if (surface && surface->tie)
    return surface->tie->displacement_gap(grains->state.grains, mesh->displacement);
  return bridging
             ? bridging->displacement_gap(grains->state.grains, mesh->displacement)
             : 0.;
}

void Scene::factorise_constraints()
{
  if (bridging && !bridging->is_factorised_for(grains->state.grains))
    bridging->factorise(grains->state.grains, mesh->inverse_mass);
  if (surface && surface->tie && !surface->tie->is_factorised_for(grains->state.grains))
    surface->tie->factorise(grains->state.grains, mesh->inverse_mass);
}

MPI_Comm Scene::communicator() const
{
  return mesh ? mesh->communicator() : MPI_COMM_SELF;
}

double Scene::rotation() const
{
  return wall_motion->rotation();
}

double Scene::strain() const
{
  return parameters.bends() ? parameters.strain_per_radian() * rotation()
                            : loading_sign() * shortening();
}

double Scene::field_time() const
{
  return parameters.bends() ? 180. / M_PI * rotation() : shortening();
}

double Scene::shortening() const
{
  if (events != nullptr)
    return loading_sign() * events->load();
  if (grips != nullptr)
    return -grips->extension() /
           (geometry.length() - 2. * parameters.walls.grip_layers * geometry.diameter());
  return wall_motion != nullptr ? wall_motion->closure() / geometry.length() : 0.;
}

double Scene::tension() const
{
  return events != nullptr ? events->force() : grips->tension();
}

double Scene::unbalanced_ratio() const
{
  return events != nullptr ? events->ratios().mean : constrained->unbalanced_ratio();
}

void Scene::visit_state(coupling::StateArchive &archive)
{
  std::int64_t broken = breakage_components ? 1 : 0;
  archive.value("scene/breakage_components", broken);
  if (broken != 0)
    add_breakage_components();
  simulation->visit_state(archive);
  if (archive.is_loading())
    factorise_constraints();
}

std::unique_ptr<Scene>
build_bodies(const Parameters &p, const MPI_Comm communicator, const Progress &progress)
{
  auto scene = std::make_unique<Scene>(p);
  const bool grains = p.layer.representation == "grains";
  const bool bridged = p.is_bridged();
  const OverlapWeight weight = overlap_weight(p, scene->geometry);
  if (grains)
  {
    const auto holds = [&](const Vec2 &x) { return !bridged || weight.holds_grains(x); };
    scene->grains.emplace(make_grains(p, scene->geometry, holds, progress));
    if (bridged && scene->grains->smooth)
      refuse_fractures_in_overlap(*scene->grains, weight);
    if (p.has("walls") && !p.walls.pulls())
      scene->walls = make_walls(*scene->grains, scene->geometry);
    if (p.bends())
      for (discrete::Wall &wall : scene->walls)
        wall.turn.emplace();
    if (p.has("servo walls"))
      scene->side_walls = make_side_walls(*scene->grains, scene->geometry);
    if (p.layer.locked_in_stress > 0.)
      discrete::lock_in(scene->grains->state.grains, scene->geometry.layer_outline(),
                        p.layer.locked_in_stress, scene->grains->state.joints,
                        scene->walls);
    if (p.has_contacts_from_start())
    {
      scene->contacts = make_contacts(p, *scene->grains, ContactsFor::intact_scene);
      find_contacts(*scene->grains, scene->contacts);
    }
  }
  else if (p.has("walls"))
  {
    GrainSection none;
    none.mean_radius = 0.5 * p.grain_diameter();
    scene->walls = make_walls(none, scene->geometry);
  }

  if (!grains || p.joins_grains_and_mesh())
  {
    progress("building the mesh");
    build_mesh(*scene, communicator);
    support_mesh(*scene);
  }
  if (bridged)
  {
    progress("joining grains and mesh");
    coupling::GrainState &state = scene->grains->state;
    state.joints.weight = joint_weights(state.grains, state.joints, weight);
    for (discrete::Wall &wall : scene->walls)
      for (discrete::WallContact &contact : wall.contacts)
        contact.weight = weight.grains(state.grains.reference(contact.grain));
    const double cell = p.matrix.cell_size * scene->geometry.diameter();
    const BridgingOptions options = bridging_options(*scene, weight);
    if (const std::size_t n = options.tied_grains.size(); n > 0)
      progress(std::to_string(n) + (n == 1 ? " grain" : " grains") +
               " of the overlap that nothing else holds, tied to the mesh");
    // Vertices beyond the rim that fewer grains reach than there are vertices would make
    // the constraint singular.
    scene->bridging = std::make_unique<BridgingDomain>(
        state.grains, state.joints, *scene->solid, weight,
        0.1 * scene->grains->matrix->bulk_density * cell * cell, options);
    scene->mass_weight = scene->bridging->grain_mass_weight();
  }
  if (p.has_surface_interface())
  {
    progress("joining grains and mesh");
    scene->surface = make_surface_join(*scene);
  }
  return scene;
}

std::unique_ptr<Scene>
build(const Parameters &p, const MPI_Comm communicator, const Progress &progress)
{
  std::unique_ptr<Scene> scene = build_bodies(p, communicator, progress);
  if (p.follows_events())
  {
    scene->simulation = std::make_unique<Simulation>(0.); // without time
    add_event_loading(*scene);
    return scene;
  }

  const bool bridged = p.is_bridged();
  std::vector<double> foundation_rows;
  std::unique_ptr<MeshFoundation> foundation;
  if (scene->mesh && p.has("foundation"))
  {
    foundation = std::make_unique<MeshFoundation>(*scene->mesh,
                                                  section_foundation(p, *scene->solid));
    foundation_rows = foundation->absolute_row_sums();
  }
  const double dt = choose_step(*scene, foundation_rows);
  scene->factorise_constraints();
  scene->simulation = std::make_unique<Simulation>(dt);
  if (scene->grains)
    add_grain_components(*scene);
  add_loads(*scene);
  if (bridged && !p.bridging.constraint)
    scene->bridging.reset(); // weighted, but not joined: the negative control
  if (foundation)
    add_foundation(*scene, std::move(foundation));
  add_common_components(*scene);
  if (p.has_unbonded_joints())
    scene->add_breakage_components();
  return scene;
}
} // namespace antiform::cases

#include "cases/scene.h"

#include "cases/prestress.h"

#include "continuum/foundation.h"
#include "continuum/loads.h"
#include "continuum/section_mesh.h"
#include "discrete/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::cases
{
using namespace coupling;
using discrete::StiffnessSums;

namespace
{
// Order of components within a stage: forces of the mesh and of broken joints first, then
// the bonds, which set the grains' forces, then what adds to them, supports last.
enum Rank
{
  rank_mesh = 5,
  rank_broken = 10,
  rank_bonds = 20,
  rank_search = 25,
  rank_contacts = 30,
  rank_walls = 40,
  rank_loads = 60,
  rank_base = 90,
  rank_constrained = 95,
  rank_damping = 96,
  rank_motion = 50
};

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

continuum::ElasticMaterial matrix_material(const Parameters &p,
                                           const GrainSection *grains)
{
  if (grains == nullptr)
  {
    // The bulk density of a packing: solid fraction about 0.84.
    return continuum::ElasticMaterial::isotropic(p.matrix_modulus(),
                                                 p.matrix.poisson_ratio,
                                                 0.84 * p.matrix.grain_density, "matrix");
  }
  continuum::ElasticMaterial material;
  material.stiffness = grains->matrix->response.stiffness;
  for (auto &row : material.stiffness)
    for (double &c : row)
      c *= p.matrix.mesh_modulus_ratio;
  material.density = grains->matrix->bulk_density;
  material.name = "matrix";
  return material;
}

/// Strips of the mesh from the base up: matrix, layer where it is continuum, cover.
std::vector<continuum::Strip> mesh_strips(const Parameters &p,
                                          const SectionGeometry &geometry)
{
  const double d = geometry.diameter(), cell = p.matrix.cell_size * d;
  const double largest = p.matrix.largest_cell * d;
  const bool layer_is_mesh = p.layer.representation == "continuum";
  const double uniform = layer_is_mesh ? 0. : p.bridging.overlap * d;
  const auto core_top = [&geometry](const double x) { return geometry.core_top(x); };
  const auto core_bottom = [&geometry](const double x)
  { return geometry.core_bottom(x); };
  const auto surface = [&geometry](double) { return geometry.surface(); };
  const auto base = [&geometry](double) { return geometry.base(); };

  std::vector<continuum::Strip> strips;
  if (geometry.has_matrix())
  {
    const double height = geometry.core_bottom(geometry.x_min()) - geometry.base();
    strips.push_back({base, core_bottom,
                      continuum::graded_rows(height, cell, uniform, 1.3, largest, true),
                      0, false});
  }
  if (layer_is_mesh)
  {
    const int rows =
        std::max(2, static_cast<int>(std::lround(geometry.thickness() / cell)));
    continuum::Strip layer{core_bottom, core_top, {}, 1, geometry.has_matrix()};
    for (int r = 0; r <= rows; ++r)
      layer.rows.push_back(static_cast<double>(r) / rows);
    strips.push_back(layer);
  }
  if (geometry.has_matrix())
  {
    const double height = geometry.surface() - geometry.core_top(0.);
    strips.push_back({core_top, surface,
                      continuum::graded_rows(height, cell, uniform, 1.3, largest, false),
                      0, layer_is_mesh});
  }
  return strips;
}

void build_mesh(Scene &scene, const MPI_Comm communicator)
{
  const Parameters &p = scene.parameters;
  scene.triangulation =
      std::make_unique<dealii::parallel::distributed::Triangulation<2>>(communicator);
  continuum::make_section(*scene.triangulation, scene.geometry.x_min(),
                          scene.geometry.x_max(), scene.geometry.n_columns(),
                          mesh_strips(p, scene.geometry));
  const GrainSection *const grains = scene.grains ? &*scene.grains : nullptr;
  std::vector<continuum::ElasticMaterial> materials{matrix_material(p, grains)};
  materials.push_back(
      continuum::ElasticMaterial::isotropic(p.layer.young_modulus, p.layer.poisson_ratio,
                                            0.84 * p.layer.grain_density, "layer"));
  std::function<double(const dealii::Point<2> &)> weight;
  if (p.is_bridged())
    weight = [w = overlap_weight(p, scene.geometry)](const dealii::Point<2> &x) {
      return w.mesh({x[0], x[1]});
    };
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
    if (p.has("walls") && horizontal && x[0] < g.x_min() + small)
      scene.mesh->prescribe(local, 0);
    else if (p.has("walls") && horizontal && x[0] > g.x_max() - small)
      scene.mesh->prescribe(local, 1);
    else if (!p.has("foundation") && x[1] < g.base() + small &&
             (!horizontal || p.matrix.base == "fixed"))
      scene.mesh->prescribe(local, -1);
  }
}

/// Sum of stiffness on each grain, walls and base springs included.
StiffnessSums grain_stiffness(const Scene &scene, const bool weighted)
{
  const coupling::GrainState &state = scene.grains->state;
  StiffnessSums sums = discrete::stiffness_sums(state.grains, state.joints, weighted);
  for (const discrete::Wall &wall : scene.walls)
    for (const discrete::WallContact &contact : wall.contacts)
      sums.translation[contact.grain] +=
          contact.stiffness * (weighted ? contact.weight : 1.);
  for (const discrete::Contact &contact : scene.contacts.contacts)
  {
    const discrete::LinearContact &law = scene.contacts.law(state.grains, contact);
    const double normal = discrete::normal_stiffness(
        law, state.grains.radius[contact.first], state.grains.radius[contact.second]);
    const double shear = law.friction > 0. ? normal / law.stiffness_ratio : 0.;
    for (const std::int32_t i : {contact.first, contact.second})
    {
      sums.translation[i] += normal + shear;
      sums.rotation[i] += shear * state.grains.radius[i] * state.grains.radius[i];
    }
  }
  return sums;
}

/// Step of the softest region at its real masses: nothing there need be made heavier.
double softest_step(const Scene &scene, const StiffnessSums &sums)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  std::vector<double> least(scene.grains->modulus.size(),
                            std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < grains.size(); ++i)
    least[grains.region[i]] =
        std::min(least[grains.region[i]], grains.mass[i] / sums.translation[i]);
  return std::sqrt(*std::max_element(least.begin(), least.end()));
}

/// Inertial masses and the step that they allow.
double choose_step(Scene &scene, const std::vector<double> &foundation_rows)
{
  const Parameters &p = scene.parameters;
  const bool scaled = p.run.driver == "quasi-static";
  double step = std::numeric_limits<double>::infinity();
  if (scene.grains)
  {
    discrete::Grains &grains = scene.grains->state.grains;
    const StiffnessSums sums = grain_stiffness(scene, false);
    scene.dt0 = scaled ? softest_step(scene, sums) : 0.;
    discrete::scale_density(grains, sums.translation, sums.rotation, scene.mass_weight,
                            scene.dt0);
    std::vector<double> extra(grains.size(), 0.);
    for (const discrete::Wall &wall : scene.walls)
      for (const discrete::WallContact &contact : wall.contacts)
        extra[contact.grain] += contact.stiffness * contact.weight;
    step = discrete::stable_step(grains, scene.grains->state.joints, extra);
  }
  if (scene.mesh)
  {
    const continuum::Vector &real =
        scene.bridging ? scene.bridging->mesh_mass() : scene.solid->lumped_mass();
    // The mesh is made as slow as the grains are, no slower.
    scene.mesh->scale_density(real, foundation_rows, scaled && scene.grains ? step : 0.);
    double largest = 0.;
    const continuum::Vector sums = scene.solid->absolute_row_sums();
    for (std::size_t i = 0; i < scene.mesh->mass.locally_owned_size(); ++i)
      largest = std::max(largest, (sums.begin()[i] +
                                   (foundation_rows.empty() ? 0. : foundation_rows[i])) *
                                      scene.mesh->inverse_mass.begin()[i]);
    largest = dealii::Utilities::MPI::max(largest,
                                          scene.solid->dof_handler().get_communicator());
    step = std::min(step, 2. / std::sqrt(largest));
  }
  return p.run.safety * step;
}

/// Wave transit along the layer with its inertial masses.
double layer_transit(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  const double modulus =
      p.layer.young_modulus / (1. - p.layer.poisson_ratio * p.layer.poisson_ratio);
  double density = 0.84 * p.layer.grain_density;
  if (scene.grains)
  {
    const discrete::Grains &grains = scene.grains->state.grains;
    double mass = 0.;
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (grains.region[i] == layer_region)
        mass += 1. / grains.inverse_mass[i];
    density = mass / (scene.geometry.length() * scene.geometry.thickness());
  }
  return scene.geometry.length() / std::sqrt(modulus / density);
}

void add_grain_components(Scene &scene)
{
  const Parameters &p = scene.parameters;
  Simulation &simulation = *scene.simulation;
  GrainState &state = scene.grains->state;
  const auto reason = [&](const std::string &name) { return reason_for(p, name); };

  auto &bonds = simulation.add(std::make_unique<Bonds>(state), {Stage::forces},
                               rank_bonds, "bonds", reason("bonds"));
  bonds.on_first_crack = [&scene]
  { scene.simulation->later([&scene] { scene.add_breakage_components(); }); };

  if (p.has("matrix") && p.matrix.interface == "frictionless")
  {
    scene.contacts = make_contacts(p, *scene.grains, true);
    discrete::search_contacts(state.grains, state.joints, scene.contacts);
    simulation.add(std::make_unique<ContactSearch>(state, scene.contacts, [] {}),
                   {Stage::forces}, rank_search, "search", reason("search"));
    simulation.add(std::make_unique<GrainContacts>(state, scene.contacts),
                   {Stage::forces}, rank_contacts, "contacts", reason("contacts"));
  }
  if (p.has("matrix") && p.matrix.representation == "grains")
  {
    std::vector<GrainBase::Support> supports;
    const double spring = p.has("foundation") ? p.foundation.stiffness_ratio *
                                                    p.matrix_modulus() / p.layer.thickness
                                              : std::numeric_limits<double>::infinity();
    for (const auto &[grain, width] : base_grains(*scene.grains, scene.geometry))
      supports.push_back({grain, spring * width});
    const std::string name = p.has("foundation") ? "foundation" : "base";
    simulation.add(std::make_unique<GrainBase>(state, supports), {Stage::forces},
                   rank_base, name, reason(name));
  }
}

/// Gravity and surface pressure, and the prestress under which they are in equilibrium.
void add_loads(Scene &scene)
{
  const Parameters &p = scene.parameters;
  if (!p.has("gravity") && !p.has("surface pressure"))
    return;
  Simulation &simulation = *scene.simulation;
  const auto add = [&](auto component, const std::string &name)
  {
    simulation.add(std::move(component), {Stage::forces}, rank_loads, name,
                   reason_for(p, name));
  };
  continuum::Vector all;
  if (scene.mesh)
  {
    all = scene.solid->make_vector();
    const auto add_to_mesh = [&](const continuum::Vector &load, const std::string &name)
    {
      all += load;
      add(std::make_unique<MeshLoads>(*scene.mesh, load), name);
    };
    dealii::Tensor<1, 2> down;
    down[1] = -p.gravity.acceleration;
    if (p.has("gravity"))
      add_to_mesh(continuum::gravity(*scene.solid, down), "gravity");
    if (p.has("surface pressure"))
      add_to_mesh(continuum::pressure(*scene.solid, {continuum::boundary::top},
                                      p.surface_pressure.pressure),
                  "surface pressure");
  }
  const InstalledPrestress installed = install_prestress(scene, all);
  if (scene.mesh)
  {
    add(std::make_unique<MeshLoads>(*scene.mesh, installed.mesh_force, true),
        "prestress");
  }
  if (!scene.grains)
    return;
  GrainState &state = scene.grains->state;
  std::vector<double> weight;
  if (scene.bridging)
    for (std::size_t i = 0; i < state.grains.size(); ++i)
      weight.push_back(scene.bridging->weight().grains(state.grains.reference(i)));
  if (p.has("gravity"))
    add(std::make_unique<GrainGravity>(state, p.gravity.acceleration, weight), "gravity");
  if (p.has("surface pressure") && !scene.mesh)
  {
    std::vector<GrainLoad> chain;
    for (const auto &[i, width] : surface_grains(*scene.grains, scene.geometry))
      chain.push_back({i, {0., -p.surface_pressure.pressure * width}, 0.});
    add(std::make_unique<GrainLoads>(state, chain), "surface pressure");
  }
  add(std::make_unique<GrainLoads>(state, installed.grain_loads, true), "prestress");
}

/// Damping, motion, walls and constraint: what both sides share.
void add_common_components(Scene &scene)
{
  const Parameters &p = scene.parameters;
  Simulation &simulation = *scene.simulation;
  GrainState *const grains = scene.grains ? &scene.grains->state : nullptr;
  MeshState *const mesh = scene.mesh ? &*scene.mesh : nullptr;
  BridgingDomain *const domain = scene.bridging.get();

  scene.constrained = &simulation.add(
      std::make_unique<ConstrainedForces>(grains, mesh, domain, !p.has("damping")),
      {Stage::damp}, rank_constrained, "unbalanced force",
      reason_for(p, "unbalanced force"));
  const discrete::GrainDamping *grain_damping = nullptr;
  const std::vector<double> *mesh_damping = nullptr;
  if (p.has("damping"))
  {
    auto &damping = simulation.add(
        std::make_unique<LocalDamping>(grains, mesh, p.damping.coefficient),
        {Stage::damp, Stage::drift}, rank_damping, "damping", reason_for(p, "damping"));
    grain_damping = damping.grain_forces();
    mesh_damping = damping.mesh_forces();
  }
  if (p.has("walls"))
  {
    scene.transit_time = layer_transit(scene);
    scene.shortening_rate =
        1e-3 / (p.walls.transits_per_millistrain * scene.transit_time);
    const double full = 0.5 * scene.shortening_rate * scene.geometry.length();
    const double ramp = p.walls.ramp * scene.transit_time;
    const auto speed = [full, ramp](const double t)
    { return t >= ramp ? full : full * 0.5 * (1. - std::cos(M_PI * t / ramp)); };
    scene.wall_motion =
        &simulation.add(std::make_unique<Walls>(scene.walls, grains, mesh, domain, speed),
                        {Stage::forces, Stage::react, Stage::drift}, rank_walls, "walls",
                        reason_for(p, "walls"));
  }
  if (grains != nullptr)
    simulation
        .add(std::make_unique<GrainMotion>(*grains), {Stage::kick, Stage::drift},
             rank_motion, "motion of the grains", reason_for(p, "motion of the grains"))
        .damping = grain_damping;
  if (mesh != nullptr)
  {
    simulation
        .add(std::make_unique<MeshMotion>(*mesh, scene.walls),
             {Stage::forces, Stage::kick, Stage::drift}, rank_mesh, "mesh",
             reason_for(p, "mesh"))
        .damping = mesh_damping;
  }
  if (domain != nullptr)
    simulation.add(std::make_unique<Bridging>(*domain, *grains, *mesh),
                   {Stage::constrain}, 0, "bridging domain",
                   reason_for(p, "bridging domain"));
}
} // namespace

double Scene::shortening() const
{
  return wall_motion != nullptr ? wall_motion->closure() / geometry.length() : 0.;
}

void Scene::add_breakage_components()
{
  if (breakage_components)
    return;
  breakage_components = true;
  GrainState &state = grains->state;
  const bool listed =
      parameters.has("matrix") && parameters.matrix.interface == "frictionless";
  simulation->add(std::make_unique<BrokenJoints>(state), {Stage::forces}, rank_broken,
                  "friction", reason_for(parameters, "friction"));
  discrete::Contacts all = make_contacts(parameters, *grains, false);
  all.contacts = contacts.contacts;
  all.lost_energy = contacts.lost_energy;
  contacts = std::move(all);
  if (listed)
    return; // search and contacts are there; the wider groups force a search
  // Grains that come to carry contacts as well must not be too light for the step.
  const auto make_heavier = [this]
  {
    if (parameters.run.driver != "quasi-static")
      return;
    const StiffnessSums sums = grain_stiffness(*this, false);
    discrete::scale_density(grains->state.grains, sums.translation, sums.rotation,
                            mass_weight, dt0);
  };
  simulation->add(std::make_unique<ContactSearch>(state, contacts, make_heavier),
                  {Stage::forces}, rank_search, "search",
                  reason_for(parameters, "search"));
  simulation->add(std::make_unique<GrainContacts>(state, contacts), {Stage::forces},
                  rank_contacts, "contacts", reason_for(parameters, "contacts"));
}

void Scene::visit_state(coupling::StateArchive &archive)
{
  std::int64_t broken = breakage_components ? 1 : 0;
  archive.value("scene/breakage_components", broken);
  if (broken != 0)
    add_breakage_components();
  simulation->visit_state(archive);
}

std::unique_ptr<Scene>
build(const Parameters &p, const MPI_Comm communicator, const Progress &progress)
{
  auto scene = std::make_unique<Scene>(p);
  const bool grains = p.layer.representation == "grains";
  const bool bridged = p.is_bridged();
  const OverlapWeight weight = overlap_weight(p, scene->geometry);
  if (grains)
  {
    const auto holds = [&](const Vec2 &x) { return !bridged || weight.holds_grains(x); };
    scene->grains.emplace(make_grains(p, scene->geometry, holds, progress));
    if (p.has("walls"))
      scene->walls = make_walls(*scene->grains, scene->geometry);
  }
  else if (p.has("walls"))
  {
    GrainSection none;
    scene->walls = make_walls(none, scene->geometry);
  }

  std::vector<double> foundation_rows;
  std::unique_ptr<MeshFoundation> foundation;
  if (!grains || bridged)
  {
    progress("building the mesh");
    build_mesh(*scene, communicator);
    support_mesh(*scene);
    if (p.has("foundation"))
    {
      const double stiffness =
          p.foundation.stiffness_ratio * p.matrix_modulus() / p.layer.thickness;
      foundation = std::make_unique<MeshFoundation>(
          *scene->mesh, continuum::winkler_foundation(
                            *scene->solid, {continuum::boundary::bottom}, stiffness));
      foundation_rows = foundation->absolute_row_sums();
    }
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
    // Vertices beyond the rim that fewer grains reach than there are vertices would make
    // the constraint singular.
    scene->bridging = std::make_unique<BridgingDomain>(
        state.grains, state.joints, *scene->solid, weight,
        0.1 * scene->grains->matrix->bulk_density * cell * cell);
    scene->mass_weight = scene->bridging->grain_mass_weight();
  }

  const double dt = choose_step(*scene, foundation_rows);
  if (bridged)
    scene->bridging->factorise(scene->grains->state.grains, scene->mesh->inverse_mass);
  scene->simulation = std::make_unique<Simulation>(dt);
  if (scene->grains)
    add_grain_components(*scene);
  add_loads(*scene);
  if (bridged && !p.bridging.constraint)
    scene->bridging.reset(); // weighted, but not joined: the negative control
  if (foundation)
    scene->simulation->add(std::move(foundation), {Stage::forces}, rank_loads,
                           "foundation", reason_for(p, "foundation"));
  add_common_components(*scene);
  return scene;
}
} // namespace antiform::cases

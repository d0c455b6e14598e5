// The components of a scene: one for each effect that the deck calls for, no other.
#include "cases/scene_components.h"

#include "cases/inertia.h"
#include "cases/overlap.h"
#include "cases/prestress.h"
#include "cases/scene.h"
#include "cases/section_contacts.h"
#include "cases/section_foundation.h"

#include "continuum/loads.h"
#include "continuum/section_mesh.h"
#include "coupling/absorbing_component.h"
#include "coupling/mesh_step_check.h"
#include "coupling/overlap_damping.h"
#include "coupling/subcycled_mesh.h"
#include "coupling/surface_component.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::cases
{
using namespace coupling;

namespace
{
// Order of components within a stage: forces of the mesh and of broken joints first, then
// the bonds, which set the grains' forces, then what adds to them, supports last.
enum Rank
{
  rank_mesh = 5,
  rank_mesh_step = 6, // positions that the mesh has just been found sound at
  rank_broken = 10,
  rank_bonds = 20,
  rank_search = 25,
  rank_smooth_joints = 28,
  rank_contacts = 30,
  rank_surface_contacts = 35,
  rank_walls = 40,
  rank_membrane = 45, // before the grains move on
  rank_loads = 60,
  rank_base = 90,
  rank_tied_grains = 93,
  rank_overlap_damping = 94,
  rank_surface_tie = 94, // forces are constrained before anything looks at them
  rank_constrained = 95,
  rank_damping = 96,
  rank_load_steps = 98,
  rank_absorbing = 97, // after the mesh has been kicked, with or without damping
  rank_motion = 50
};

void add_contacts(Scene &scene)
{
  GrainState &state = scene.grains->state;
  const auto rescale = [&scene] { return after_search(scene); };
  // Contact bonds leave contacts behind, taken over at the end of a step.
  const bool leaves_contacts = scene.parameters.layer.bond_model == "contact bond";
  const auto search = [&scene] { find_contacts(*scene.grains, scene.contacts); };
  scene.simulation->add(
      std::make_unique<ContactSearch>(state, scene.contacts, search, rescale),
                        leaves_contacts ? std::vector<Stage>{Stage::forces, Stage::drift}
                                        : std::vector<Stage>{Stage::forces},
                        rank_search, "search", reason_for(scene.parameters, "search"));
  scene.simulation->add(std::make_unique<GrainContacts>(state, scene.contacts),
                        {Stage::forces}, rank_contacts, "contacts",
                        reason_for(scene.parameters, "contacts"));
}
} // namespace

std::vector<GrainBase::Support> base_supports(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  std::vector<GrainBase::Support> supports;
  if (!p.has("matrix") || p.matrix.representation != "grains")
    return supports;
  const double spring = p.has("foundation") ? p.foundation_stiffness()
                                            : std::numeric_limits<double>::infinity();
  for (const auto &[grain, width] : base_grains(*scene.grains, scene.geometry))
    supports.push_back({grain, spring * width});
  return supports;
}

std::array<std::vector<std::int32_t>, 2> gripped_grains(const Scene &scene)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  const SectionGeometry &g = scene.geometry;
  const double width = scene.parameters.walls.grip_layers * g.diameter();
  std::array<std::vector<std::int32_t>, 2> held;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (grains.reference_x[i] < g.x_min() + width)
      held[0].push_back(static_cast<std::int32_t>(i));
    else if (grains.reference_x[i] > g.x_max() - width)
      held[1].push_back(static_cast<std::int32_t>(i));
  return held;
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

  if (scene.grains->smooth)
    simulation
        .add(std::make_unique<SmoothJointForces>(state, *scene.grains->smooth),
             {Stage::forces}, rank_smooth_joints, "smooth joints",
             reason("smooth joints"))
        .on_first_crack = bonds.on_first_crack;
  if (p.has_contacts_from_start())
    add_contacts(scene);
  if (const std::vector<GrainBase::Support> supports = base_supports(scene);
      !supports.empty())
  {
    const std::string name = p.has("foundation") ? "foundation" : "base";
    const bool fixed = !p.has("foundation") && p.matrix.base == "fixed";
    simulation.add(std::make_unique<GrainBase>(state, supports, fixed), {Stage::forces},
                   rank_base, name, reason(name));
  }
}

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
    if (p.has("surface pressure") && !p.has_grain_cover())
      add_to_mesh(continuum::pressure(*scene.solid, {continuum::boundary::top},
                                      p.pressure_on_top()),
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
  if (p.has("surface pressure") && (!scene.mesh || p.has_grain_cover()))
  {
    std::vector<GrainLoad> chain;
    for (const auto &[i, width] : surface_grains(*scene.grains, scene.geometry))
      chain.push_back({i, {0., -p.pressure_on_top() * width}, 0.});
    add(std::make_unique<GrainLoads>(state, chain), "surface pressure");
  }
  add(std::make_unique<GrainLoads>(state, installed.grain_loads, true), "prestress");
}

namespace
{
/// Transits after which forces that do not come to balance are given up.
constexpr double longest_relaxation = 2000.;
/// Transits after which a relaxation counts as a collapse.
constexpr double patience = 100.;

/// 0 to 1 within @p ramp, without a jump of the acceleration.
double ramp_up(const double t, const double ramp)
{
  return t >= ramp ? 1. : 0.5 * (1. - std::cos(M_PI * t / ramp));
}

/// Does a platen bear on this grain?
bool is_at_platen(const Scene &scene, const std::int32_t grain)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  const double near = grains.radius[grain] + 0.3 * scene.geometry.diameter();
  return std::any_of(scene.walls.begin(), scene.walls.end(),
                     [&](const discrete::Wall &wall)
                     {
                       const Vec2 from = grains.position(grain) - wall.point;
                       return dot(from, wall.normal) - wall.displacement < near;
                     });
}

/// Side walls or membrane, and until the pressure is on the platens too, these follow it.
void add_confinement(Scene &scene, const double fastest)
{
  const ConfinementParameters servo = *scene.parameters.confinement();
  const double ramp = servo.ramp * scene.transit_time;
  const auto speed_on = [servo, ramp, fastest](const double area)
  {
    return [servo, ramp, fastest, area](const discrete::Wall &wall, const Clock &clock)
    {
      return servo_speed(wall, area, servo.pressure * ramp_up(clock.time, ramp),
                         servo.gain, fastest, clock.dt);
    };
  };
  scene.wall_motion->preload({2. * ramp, speed_on(scene.geometry.thickness())});
  if (scene.parameters.has("membrane"))
  {
    scene.membrane = &scene.simulation->add(
        std::make_unique<MembraneLoad>(
            scene.grains->state,
            scene.parameters.membrane.reach * scene.geometry.diameter(),
            [servo, ramp](const double t) { return servo.pressure * ramp_up(t, ramp); },
            [&scene](const std::int32_t grain) { return is_at_platen(scene, grain); }),
        {Stage::forces, Stage::drift}, rank_membrane, "membrane",
        reason_for(scene.parameters, "membrane"));
    return;
  }
  scene.simulation->add(std::make_unique<ServoWalls>(scene.side_walls,
                                                     scene.grains->state,
                                                     speed_on(scene.geometry.length())),
                        {Stage::forces, Stage::drift}, rank_walls, "servo walls",
                        reason_for(scene.parameters, "servo walls"));
}

/// Each wall advances in one transit, so that the wave it sends is no steeper than the
/// load step.
void add_load_steps(Scene &scene)
{
  const Parameters &p = scene.parameters;
  const double transit = scene.transit_time / scene.simulation->clock().dt;
  StepAndRelax::Options options;
  options.advance = std::max<std::int64_t>(1, std::llround(transit));
  options.speed = 0.5 * p.walls.load_step * scene.geometry.length() /
                  (static_cast<double>(options.advance) * scene.simulation->clock().dt);
  options.tolerance = p.walls.relaxation_tolerance;
  options.patience = std::llround(patience * transit);
  options.longest = std::llround(longest_relaxation * transit);
  if (const ConfinementParameters *const confinement = p.confinement())
    options.begin = 2. * confinement->ramp * scene.transit_time;
  scene.load_steps = &scene.simulation->add(
      std::make_unique<StepAndRelax>(*scene.constrained, options), {Stage::damp},
      rank_load_steps, "load steps", reason_for(p, "load steps"));
}

/// Speeds of walls that turn, at a time since the start.
struct TurningSpeeds
{
  std::function<double(double)> inward; ///< until the section is pressed [m/s]
  std::function<double(double)> spin;   ///< from then on [rad/s]
};

TurningSpeeds turning_speeds(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  const double ramp = p.walls.ramp * scene.transit_time;
  const double way = 0.5 * p.walls.shortening_before * scene.geometry.length();
  const double pressed =
      way > 0. ? p.walls.shortening_before / scene.shortening_rate + ramp : 0.;
  const double full = scene.shortening_rate / p.strain_per_radian();
  return {[way, pressed](const double t) {
            return t < pressed
                       ? way * 0.5 * M_PI / pressed * std::sin(M_PI * t / pressed)
                       : 0.;
          },
          [full, ramp, pressed](const double t)
          { return t < pressed ? 0. : full * ramp_up(t - pressed, ramp); }};
}

void add_walls(Scene &scene)
{
  const Parameters &p = scene.parameters;
  scene.transit_time = layer_transit(scene);
  scene.shortening_rate = 1e-3 / (p.walls.transits_per_millistrain * scene.transit_time);
  const bool pulls = p.walls.pulls();
  const double length =
      scene.geometry.length() -
      (pulls ? 2. * p.walls.grip_layers * scene.geometry.diameter() : 0.);
  const double full = 0.5 * scene.shortening_rate * length;
  const double ramp = p.walls.ramp * scene.transit_time;
  const auto speed = [full, ramp](const double t) { return full * ramp_up(t, ramp); };
  const auto wall_speed = [speed, &scene](const double t)
  { return scene.load_steps != nullptr ? scene.load_steps->speed() : speed(t); };
  const std::string reason = reason_for(p, "walls");
  GrainState *const grains = scene.grains ? &scene.grains->state : nullptr;
  if (pulls)
  {
    scene.grips = &scene.simulation->add(
        std::make_unique<Grips>(*grains, gripped_grains(scene), speed),
        {Stage::forces, Stage::drift}, rank_base, "walls", reason);
    return;
  }
  const TurningSpeeds turning =
      p.bends() ? turning_speeds(scene) : TurningSpeeds{wall_speed, {}};
  scene.wall_motion = &scene.simulation->add(
      std::make_unique<Walls>(scene.walls, grains, scene.mesh ? &*scene.mesh : nullptr,
                              scene.bridging.get(), turning.inward),
      {Stage::forces, Stage::react, Stage::drift}, rank_walls, "walls", reason);
  scene.wall_motion->turn(turning.spin);
  if (p.walls.steps_and_relaxes())
    add_load_steps(scene);
  if (const ConfinementParameters *const confinement = p.confinement())
  {
    // Ten times what the pressure's own strain needs in its ramp: room to follow breaks.
    const double strain = confinement->pressure / p.young_modulus();
    add_confinement(scene,
                    std::max(20. * full, 10. * strain * scene.geometry.length() /
                                             (confinement->ramp * scene.transit_time)));
  }
}

/// The constraint of the overlap and what the deck asks for beside it.
void add_bridging(Scene &scene)
{
  const Parameters &p = scene.parameters;
  Simulation &simulation = *scene.simulation;
  BridgingDomain &domain = *scene.bridging;
  GrainState &grains = scene.grains->state;
  MeshState &mesh = *scene.mesh;
  const std::string name = "bridging domain", reason = reason_for(p, name);
  simulation.add(std::make_unique<Bridging>(domain, grains, mesh), {Stage::constrain}, 0,
                 name, reason);
  if (!domain.ties().empty())
    simulation.add(std::make_unique<TiedGrains>(domain.ties(), grains, mesh),
                   {Stage::damp}, rank_tied_grains, name, reason);
  if (const double rate = overlap_damping_rate(scene); rate > 0.)
    simulation.add(
        std::make_unique<OverlapDamping>(domain, *scene.solid, grains, mesh, rate),
        {Stage::damp, Stage::drift}, rank_overlap_damping, "overlap damping",
        reason_for(p, "overlap damping"));
  if (p.bridging.sub_cycles == 1)
    return;
  // Resonance grows without end; a ledger that is open by this much has begun to.
  simulation.add(std::make_unique<EnergyWatch>(simulation, 0.05), {Stage::sample}, 0,
                 "sub-cycling", reason_for(p, "sub-cycling"));
  scene.wall_motion->average_over(p.bridging.sub_cycles);
}

/// The layer on the edges of the mesh.
void add_surface_interface(Scene &scene)
{
  const Parameters &p = scene.parameters;
  GrainState &grains = scene.grains->state;
  const std::string name = "surface interface", reason = reason_for(p, name);
  if (scene.surface->tie)
    scene.simulation->add(std::make_unique<TiedSurface>(*scene.surface->tie, grains,
                                                        *scene.mesh, !p.has("damping")),
                          {Stage::damp, Stage::constrain}, rank_surface_tie, name,
                          reason);
  std::size_t number = 0;
  for (const auto &contact : scene.surface->contacts)
    scene.simulation->add(
        std::make_unique<SurfaceContactForces>(*contact, grains, *scene.mesh,
                                               number++ == 0 ? "surface/below"
                                                             : "surface/above"),
        {Stage::forces}, rank_surface_contacts, name, reason);
}
} // namespace

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
  const std::vector<double> *mesh_damping = nullptr;
  if (p.has("damping"))
  {
    auto &damping =
        simulation.add(std::make_unique<LocalDamping>(grains, mesh, p.damping.coefficient,
                                                      p.damping.form == "combined"),
                       {Stage::damp, Stage::kick}, rank_damping, "damping",
                       reason_for(p, "damping"));
    mesh_damping = damping.mesh_forces();
  }
  if (p.has("walls"))
    add_walls(scene);
  if (grains != nullptr)
    simulation
        .add(std::make_unique<GrainMotion>(*grains), {Stage::kick, Stage::drift},
             rank_motion, "motion of the grains", reason_for(p, "motion of the grains"))
        .damped = p.has("damping");
  if (mesh != nullptr)
  {
    const bool sub_cycles = domain != nullptr && p.bridging.sub_cycles > 1;
    simulation
        .add(make_mesh_motion(scene),
             sub_cycles ? std::vector<Stage>{Stage::forces, Stage::damp, Stage::kick,
                                             Stage::drift}
                        : std::vector<Stage>{Stage::forces, Stage::kick, Stage::drift},
             rank_mesh, "mesh", reason_for(p, "mesh"))
        .damping = mesh_damping;
  }
  if (const auto *const finite =
          dynamic_cast<const continuum::FiniteStrainSolid *>(scene.solid.get()))
  {
    std::vector<double> springs;
    if (p.has("foundation"))
      springs = MeshFoundation(*mesh, section_foundation(p, *scene.solid))
                    .absolute_row_sums();
    simulation.add(
        std::make_unique<MeshStepCheck>(*mesh, *finite, damping_factor(p), springs),
        {Stage::forces}, rank_mesh_step, "finite strain", reason_for(p, "finite strain"));
  }
  if (p.has("absorbing boundary"))
    simulation.add(
        std::make_unique<AbsorbingBoundary>(
            *mesh, continuum::absorbing_dashpots(*scene.solid, absorbing_faces(p)),
            domain),
        {Stage::damp, Stage::kick, Stage::drift}, rank_absorbing, "absorbing boundary",
        reason_for(p, "absorbing boundary"));
  if (domain != nullptr)
    add_bridging(scene);
  if (scene.surface)
    add_surface_interface(scene);
}

void add_foundation(Scene &scene, std::unique_ptr<MeshFoundation> foundation)
{
  scene.simulation->add(std::move(foundation), {Stage::forces}, rank_loads, "foundation",
                        reason_for(scene.parameters, "foundation"));
}

void Scene::add_breakage_components()
{
  if (breakage_components)
    return;
  breakage_components = true;
  GrainState &state = grains->state;
  const bool listed = parameters.has_contacts_from_start();
  const bool flat_joints_break =
      std::any_of(state.joints.groups.begin(), state.joints.groups.end(),
                  [](const discrete::JointGroup &group)
                  {
                    return !discrete::is_brittle(group.law) &&
                           (group.flat().breakable || is_layer(group.layer));
                  });
  if (flat_joints_break)
    simulation->add(std::make_unique<BrokenJoints>(state), {Stage::forces}, rank_broken,
                    "friction", reason_for(parameters, "friction"));
  discrete::Contacts all = make_contacts(parameters, *grains, ContactsFor::broken_scene);
  all.contacts = contacts.contacts;
  all.lost_energy = contacts.lost_energy;
  all.installed = contacts.installed; // with the prestress that is in them
  contacts = std::move(all);
  discrete::take_released(state.joints, contacts);
  if (!listed) // else search and contacts are there; the wider groups force a search
    add_contacts(*this);
}
} // namespace antiform::cases

#include "coupling/joining_components.h"

#include "coupling/specimen_components.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace antiform::coupling
{
using namespace discrete;

void ConstrainedForces::run(const Stage, const Clock &clock)
{
  if (at_samples_only_ && !clock.sample_due)
    return;
  if (domain_ != nullptr)
    domain_->constrain_forces(grains_->grains, mesh_->inverse_mass,
                              grains_->grains.force_x, grains_->grains.force_y,
                              mesh_->force);
  if (clock.sample_due)
    ratio_ = measure().mean;
}

UnbalancedRatio ConstrainedForces::measure() const
{
  double free = 0., largest = 0., carried = 0.;
  if (grains_ != nullptr)
  {
    const Grains &g = grains_->grains;
    double n_free = 0.;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (g.inverse_mass[i] > 0.)
      {
        const double force = std::hypot(g.force_x[i], g.force_y[i]);
        free += force;
        largest = std::max(largest, force);
        n_free += 1.;
      }
    free /= std::max(1., n_free);
    for (const JointForce &force : grains_->joints.force)
      carried += std::hypot(force.x, force.y);
    carried /= static_cast<double>(grains_->joints.size());
  }
  else
  {
    const MeshState &s = *mesh_;
    for (std::size_t i = 0; i < s.mass.locally_owned_size(); ++i)
      (s.inverse_mass.begin()[i] > 0. ? free : carried) +=
          s.force.begin()[i] * s.force.begin()[i];
    free = std::sqrt(dealii::Utilities::MPI::sum(free, s.communicator()));
    carried = std::sqrt(dealii::Utilities::MPI::sum(carried, s.communicator()));
    largest = free;
  }
  return carried > 0. ? UnbalancedRatio{free / carried, largest / carried}
                      : UnbalancedRatio{};
}

LocalDamping::LocalDamping(GrainState *grains,
                           MeshState *mesh,
                           const double coefficient,
                           const bool combined)
    : grains_(grains)
    , mesh_(mesh)
    , coefficient_(coefficient)
{
  grain_damping_.coefficient = coefficient;
  grain_damping_.combined = combined;
  if (grains != nullptr)
    grain_damping_.start(grains->grains.size());
  if (mesh != nullptr)
  {
    mesh_force_.assign(mesh->mass.locally_owned_size(), 0.);
    mesh_before_.assign(combined ? mesh_force_.size() : 0, 0.);
  }
}

void LocalDamping::run(const Stage stage, const Clock &clock)
{
  if (stage == Stage::damp && mesh_ != nullptr)
    damp_mesh(clock.dt);
  if (stage == Stage::kick && grains_ != nullptr)
    damped_kick(grains_->grains, clock.dt, grain_damping_);
}

void LocalDamping::damp_mesh(const double dt)
{
  const double power =
      damp(static_cast<std::int64_t>(mesh_force_.size()), coefficient_,
           mesh_->force.begin(), mesh_before_.empty() ? nullptr : mesh_before_.data(),
           mesh_->velocity.begin(), mesh_->inverse_mass.begin(), mesh_force_.data());
  mesh_energy_ -= 0.5 * dt * power;
}

void LocalDamping::add_energies(Energies &energies) const
{
  if (grains_ == nullptr || grains_->tells_energies)
    for (const double e : grain_damping_.energy)
      energies.damping += e;
  energies.damping += mesh_energy_;
}

void LocalDamping::visit_state(StateArchive &archive)
{
  archive.array("damping/grain_energy", grain_damping_.energy);
  archive.array("damping/grain_force_x", grain_damping_.force_x);
  archive.array("damping/grain_force_y", grain_damping_.force_y);
  archive.array("damping/grain_torque", grain_damping_.torque);
  archive.array("damping/grain_before_x", grain_damping_.before_x);
  archive.array("damping/grain_before_y", grain_damping_.before_y);
  archive.array("damping/grain_before_torque", grain_damping_.before_torque);
  archive.owned_array("damping/mesh_force", mesh_force_);
  archive.owned_array("damping/mesh_before", mesh_before_);
  archive.owned_value("damping/mesh_energy", mesh_energy_);
}

namespace
{
/// Of @p wall on the grains in a time @p dt at its present speeds.
void add_wall_work(Wall &wall, const double dt)
{
  wall.work += dt * wall.reaction * wall.velocity;
  if (wall.turn)
    wall.work += dt * wall.turn->moment * wall.turn->spin;
}
} // namespace

Walls::Walls(std::vector<Wall> &walls,
             GrainState *grains,
             MeshState *mesh,
             const BridgingDomain *domain,
             std::function<double(double)> speed)
    : walls_(walls)
    , grains_(grains)
    , mesh_(mesh)
    , domain_(domain)
    , speed_(std::move(speed))
{
}

void Walls::run(const Stage stage, const Clock &clock)
{
  switch (stage)
  {
  case Stage::forces:
    if (grains_ != nullptr)
      for (Wall &wall : walls_)
      {
        add_wall_forces(grains_->grains, wall);
        add_wall_work(wall, 0.5 * clock.dt);
      }
    set_speeds(clock);
    break;
  case Stage::react:
    if (mesh_ != nullptr)
      react(clock);
    break;
  case Stage::drift:
    for (Wall &wall : walls_)
    {
      wall.displacement += clock.dt * wall.velocity;
      if (wall.turn)
        wall.turn->rotation += clock.dt * wall.turn->spin;
      if (grains_ != nullptr)
        add_wall_work(wall, 0.5 * clock.dt);
    }
    if (mesh_ != nullptr)
      for (const PrescribedDof &entry : mesh_->prescribed)
        support_work_ +=
            0.5 * clock.dt * entry.reaction * mesh_->velocity.begin()[entry.dof];
    break;
  default:
    throw std::logic_error("the walls do nothing at this stage");
  }
}

/// Of the half step to come.
void Walls::set_speeds(const Clock &clock)
{
  if (clock.time < preload_.until)
  {
    for (Wall &wall : walls_)
      wall.velocity = preload_.speed(wall, clock);
    closure_before_ = way();
    return;
  }
  const double time = clock.time + 0.5 * clock.dt - preload_.until;
  for (Wall &wall : walls_)
  {
    wall.velocity = speed_(time);
    if (wall.turn)
      wall.turn->spin = pressing_sense(wall) * spin_(time);
  }
}

void Walls::react(const Clock &clock)
{
  for (PrescribedDof &entry : mesh_->prescribed)
  {
    const double after = mesh_->velocity.begin()[entry.dof];
    entry.reaction =
        mesh_->mass.begin()[entry.dof] * (after - entry.before) / clock.dt -
        mesh_->force.begin()[entry.dof] +
        (domain_ != nullptr ? domain_->mesh_impulse(entry.dof) / clock.dt : 0.);
    support_work_ += 0.5 * clock.dt * entry.reaction * entry.before;
    if (averaged_ == 1)
      continue;
    entry.sum += entry.reaction;
    if ((clock.step + 1) % averaged_ != 0)
      continue;
    entry.mean = entry.sum / static_cast<double>(averaged_);
    entry.sum = 0.;
  }
}

double Walls::grain_reaction(const int region) const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    sum += region_reaction(grains_->grains, wall, region);
  return sum / static_cast<double>(walls_.size());
}

double Walls::mesh_reaction(const bool of_layer) const
{
  if (mesh_ == nullptr)
    return 0.;
  double sum = 0.;
  for (const PrescribedDof &entry : mesh_->prescribed)
    if (entry.wall >= 0)
      sum += (of_layer ? entry.layer_share : 1.) *
             (averaged_ == 1 ? entry.reaction : entry.mean) *
             walls_[entry.wall].normal.x;
  return dealii::Utilities::MPI::sum(sum, mesh_->communicator()) /
         static_cast<double>(walls_.size());
}

double Walls::rotation() const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    if (wall.turn)
      sum += pressing_sense(wall) * wall.turn->rotation;
  return sum / static_cast<double>(walls_.size());
}

double Walls::moment() const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    if (wall.turn)
      sum += pressing_sense(wall) * wall.turn->moment;
  return sum / static_cast<double>(walls_.size());
}

double Walls::closure() const
{
  return way() - closure_before_;
}

double Walls::way() const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    sum += wall.displacement;
  return sum;
}

void Walls::add_energies(Energies &energies) const
{
  for (const Wall &wall : walls_)
    if (grains_ != nullptr && grains_->tells_energies)
    {
      energies.boundary_work += wall.work;
      energies.strain_grains += wall_energy(grains_->grains, wall);
    }
  energies.boundary_work += support_work_;
}

void Walls::visit_state(StateArchive &archive)
{
  visit_walls(archive, "walls", walls_);
  archive.value("walls/closure_before", closure_before_);
  archive.owned_value("walls/support_work", support_work_);
  if (averaged_ == 1)
    return;
  for (const auto &[name, member] : {std::pair{"walls/mean", &PrescribedDof::mean},
                                     std::pair{"walls/sum", &PrescribedDof::sum}})
  {
    std::vector<double> values;
    for (const PrescribedDof &entry : mesh_->prescribed)
      values.push_back(entry.*member);
    archive.owned_array(name, values);
    for (std::size_t k = 0; k < values.size(); ++k)
      mesh_->prescribed[k].*member = values[k];
  }
}
} // namespace antiform::coupling

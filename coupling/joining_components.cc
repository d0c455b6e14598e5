#include "coupling/joining_components.h"

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
    measure();
}

void ConstrainedForces::measure()
{
  double free = 0., carried = 0.;
  if (grains_ != nullptr)
  {
    const Grains &g = grains_->grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (g.inverse_mass[i] > 0.)
        free += std::hypot(g.force_x[i], g.force_y[i]);
    free /= static_cast<double>(g.size());
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
    const MPI_Comm comm = s.solid.dof_handler().get_communicator();
    free = std::sqrt(dealii::Utilities::MPI::sum(free, comm));
    carried = std::sqrt(dealii::Utilities::MPI::sum(carried, comm));
  }
  ratio_ = carried > 0. ? free / carried : 0.;
}

LocalDamping::LocalDamping(GrainState *grains, MeshState *mesh, const double coefficient)
    : grains_(grains)
    , mesh_(mesh)
    , coefficient_(coefficient)
{
  grain_damping_.coefficient = coefficient;
  if (grains != nullptr)
    for (std::vector<double> *v : {&grain_damping_.force_x, &grain_damping_.force_y,
                                   &grain_damping_.torque, &grain_damping_.energy})
      v->assign(grains->grains.size(), 0.);
  if (mesh != nullptr)
  {
    mesh_force_.assign(mesh->mass.locally_owned_size(), 0.);
    mesh_energy_ = mesh_force_;
  }
}

void LocalDamping::run(const Stage stage, const Clock &clock)
{
  if (stage == Stage::damp)
  {
    if (grains_ != nullptr)
      compute_damping(grains_->grains, grains_->grains.force_x, grains_->grains.force_y,
                      grains_->grains.torque, clock.dt, grain_damping_);
    if (mesh_ != nullptr)
      for (std::size_t i = 0; i < mesh_force_.size(); ++i)
      {
        const double v = mesh_->velocity.begin()[i];
        const bool free = mesh_->inverse_mass.begin()[i] > 0.;
        const double size = coefficient_ * std::abs(mesh_->force.begin()[i]);
        mesh_force_[i] = v == 0. || !free ? 0. : -std::copysign(size, v);
        mesh_energy_[i] -= 0.5 * clock.dt * mesh_force_[i] * v;
      }
    return;
  }
  if (grains_ != nullptr)
    book_damping(grains_->grains, clock.dt, grain_damping_);
  if (mesh_ != nullptr)
    for (std::size_t i = 0; i < mesh_force_.size(); ++i)
      mesh_energy_[i] -= 0.5 * clock.dt * mesh_force_[i] * mesh_->velocity.begin()[i];
}

void LocalDamping::add_energies(Energies &energies) const
{
  for (const double e : grain_damping_.energy)
    energies.damping += e;
  for (const double e : mesh_energy_)
    energies.damping += e;
}

void LocalDamping::visit_state(StateArchive &archive)
{
  archive.array("damping/grain_energy", grain_damping_.energy);
  archive.array("damping/mesh_energy", mesh_energy_);
}

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
        wall.work += 0.5 * clock.dt * wall.reaction * wall.velocity;
      }
    for (Wall &wall : walls_) // of the half step to come
      wall.velocity = speed_(clock.time + 0.5 * clock.dt);
    break;
  case Stage::react:
    if (mesh_ != nullptr)
      react(clock);
    break;
  case Stage::drift:
    for (Wall &wall : walls_)
    {
      wall.displacement += clock.dt * wall.velocity;
      if (grains_ != nullptr)
        wall.work += 0.5 * clock.dt * wall.reaction * wall.velocity;
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
  }
}

double Walls::grain_reaction(const int region) const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    sum += region_reaction(grains_->grains, wall, region);
  return sum / static_cast<double>(walls_.size());
}

double Walls::mesh_reaction() const
{
  double sum = 0.;
  if (mesh_ != nullptr)
    for (const PrescribedDof &entry : mesh_->prescribed)
      if (entry.wall >= 0)
        sum += entry.reaction * walls_[entry.wall].normal.x;
  return sum / static_cast<double>(walls_.size());
}

double Walls::closure() const
{
  double sum = 0.;
  for (const Wall &wall : walls_)
    sum += wall.displacement;
  return sum;
}

void Walls::add_energies(Energies &energies) const
{
  for (const Wall &wall : walls_)
  {
    energies.boundary_work += wall.work;
    if (grains_ != nullptr)
      energies.strain_grains += wall_energy(grains_->grains, wall);
  }
  energies.boundary_work += support_work_;
}

void Walls::visit_state(StateArchive &archive)
{
  for (std::size_t w = 0; w < walls_.size(); ++w)
  {
    const std::string name = "walls/" + std::to_string(w);
    archive.value(name + "/displacement", walls_[w].displacement);
    archive.value(name + "/velocity", walls_[w].velocity);
    archive.value(name + "/work", walls_[w].work);
  }
  archive.value("walls/support_work", support_work_);
}
} // namespace antiform::coupling

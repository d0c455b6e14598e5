#include "coupling/specimen_components.h"

#include <stdexcept>

namespace antiform::coupling
{
void ServoWalls::run(const Stage stage, const Clock &clock)
{
  const double half = 0.5 * clock.dt;
  if (stage == Stage::forces)
    for (discrete::Wall &wall : walls_)
    {
      add_wall_forces(grains_.grains, wall);
      wall.work += half * wall.reaction * wall.velocity;
      wall.velocity = speed_(wall, clock); // of the half step to come
    }
  else
    for (discrete::Wall &wall : walls_)
    {
      wall.displacement += clock.dt * wall.velocity;
      wall.work += half * wall.reaction * wall.velocity;
    }
}

void ServoWalls::add_energies(Energies &energies) const
{
  for (const discrete::Wall &wall : walls_)
  {
    energies.boundary_work += wall.work;
    energies.strain_grains += wall_energy(grains_.grains, wall);
  }
}

void ServoWalls::visit_state(StateArchive &archive)
{
  visit_walls(archive, "servo walls", walls_);
}

namespace
{
/// Contacts found in the course of the run; the others are made with the scene.
void visit_late_contacts(StateArchive &archive,
                         const std::string &name,
                         discrete::Wall &wall)
{
  std::vector<std::int64_t> grains;
  std::vector<double> values;
  if (!archive.is_loading())
    for (const discrete::WallContact &contact : wall.contacts)
      if (contact.late)
      {
        grains.push_back(contact.grain);
        values.insert(values.end(), {contact.stiffness, contact.weight});
      }
  archive.array(name + "/late_grains", grains);
  archive.array(name + "/late_values", values);
  if (!archive.is_loading())
    return;
  for (std::size_t k = 0; k < grains.size(); ++k)
  {
    discrete::WallContact contact;
    contact.grain = static_cast<std::int32_t>(grains[k]);
    contact.stiffness = values[2 * k];
    contact.weight = values[2 * k + 1];
    contact.late = true;
    insert_contact(wall, contact);
  }
}
} // namespace

void visit_walls(StateArchive &archive,
                 const std::string &group,
                 std::vector<discrete::Wall> &walls)
{
  for (std::size_t w = 0; w < walls.size(); ++w)
  {
    const std::string name = group + "/" + std::to_string(w);
    archive.value(name + "/displacement", walls[w].displacement);
    archive.value(name + "/velocity", walls[w].velocity);
    archive.value(name + "/work", walls[w].work);
    if (walls[w].turn)
    {
      archive.value(name + "/rotation", walls[w].turn->rotation);
      archive.value(name + "/spin", walls[w].turn->spin);
    }
    visit_late_contacts(archive, name, walls[w]);
  }
}

Grips::Grips(GrainState &grains,
             std::array<std::vector<std::int32_t>, 2> held,
             std::function<double(double)> speed)
    : grains_(grains)
    , held_(std::move(held))
    , speed_(std::move(speed))
{
  for (const auto &side : held_)
  {
    if (side.empty())
      throw std::invalid_argument("a grip holds no grain");
    for (const std::int32_t i : side)
      grains_.grains.inverse_mass[i] = grains_.grains.inverse_inertia[i] = 0.;
  }
}

void Grips::run(const Stage stage, const Clock &clock)
{
  discrete::Grains &grains = grains_.grains;
  const double half = 0.5 * clock.dt;
  if (stage == Stage::drift)
  {
    work_ += half * velocity_ * (pull_[0] + pull_[1]);
    extension_ += 2. * clock.dt * velocity_;
    return;
  }
  // The grip takes what its grains carry; nothing is left that could move or damp them.
  for (const int side : {0, 1})
  {
    const double outward = side == 0 ? -1. : 1.;
    pull_[side] = 0.;
    for (const std::int32_t i : held_[side])
    {
      pull_[side] -= outward * grains.force_x[i];
      grains.force_x[i] = grains.force_y[i] = grains.torque[i] = 0.;
    }
  }
  work_ += half * velocity_ * (pull_[0] + pull_[1]);
  velocity_ = speed_(clock.time + half);
  for (const int side : {0, 1})
    for (const std::int32_t i : held_[side])
      grains.velocity_x[i] = (side == 0 ? -1. : 1.) * velocity_;
}

void Grips::add_energies(Energies &energies) const
{
  energies.boundary_work += work_;
}

void Grips::visit_state(StateArchive &archive)
{
  archive.value("grips/velocity", velocity_);
  archive.value("grips/extension", extension_);
  archive.value("grips/work", work_);
}
} // namespace antiform::coupling

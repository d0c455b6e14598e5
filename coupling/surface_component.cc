#include "coupling/surface_component.h"

namespace antiform::coupling
{
void TiedSurface::run(const Stage stage, const Clock &clock)
{
  discrete::Grains &grains = grains_.grains;
  if (stage == Stage::forces)
  {
    if (follow_every_ > 0 && clock.step % follow_every_ == 0)
    {
      tie_.follow(grains, mesh_.displacement);
      tie_.factorise(grains, mesh_.inverse_mass);
    }
  }
  else if (stage == Stage::damp)
  {
    if (!at_samples_only_ || clock.sample_due)
      tie_.constrain_forces(grains, mesh_.force);
  }
  else
  {
    tie_.project(grains, mesh_.velocity);
    tie_.for_mesh_impulses(
        [&](const std::uint32_t dof, const double impulse)
        {
          if (mesh_.inverse_mass.begin()[dof] == 0.)
            mesh_.force.begin()[dof] -= impulse / clock.dt;
        });
  }
}

void TiedSurface::visit_state(StateArchive &archive)
{
  if (follow_every_ == 0)
    return; // as the scene built it
  tie_.visit_state(archive, "surface_tie");
  if (archive.is_loading())
    tie_.factorise(grains_.grains, mesh_.inverse_mass);
}

void SurfaceContactForces::run(const Stage, const Clock &clock)
{
  contact_.add_forces(grains_.grains, mesh_.displacement, mesh_.velocity,
                      clock.step > 0 ? clock.dt : 0., mesh_.force);
}

void SurfaceContactForces::add_energies(Energies &energies) const
{
  energies.strain_grains += contact_.elastic_energy();
  energies.slip += contact_.slip_energy();
}

void SurfaceContactForces::visit_state(StateArchive &archive)
{
  std::vector<SurfaceContact::State> &states = contact_.history();
  std::vector<std::int64_t> face;
  for (const SurfaceContact::State &state : states)
    face.push_back(state.place.face);
  archive.array(name_ + "/face", face);
  for (std::size_t p = 0; p < states.size(); ++p)
    states[p].place.face = static_cast<std::int32_t>(face[p]);
  const auto visit =
      [&](const std::string &entry, double &(*member)(SurfaceContact::State &))
  {
    std::vector<double> values;
    for (SurfaceContact::State &state : states)
      values.push_back(member(state));
    archive.array(name_ + "/" + entry, values);
    for (std::size_t p = 0; p < states.size(); ++p)
      member(states[p]) = values[p];
  };
  using State = SurfaceContact::State;
  visit("along_face", [](State &s) -> double & { return s.place.s; });
  visit("normal_x", [](State &s) -> double & { return s.normal.x; });
  visit("normal_y", [](State &s) -> double & { return s.normal.y; });
  visit("opening", [](State &s) -> double & { return s.gap.opening; });
  visit("slip", [](State &s) -> double & { return s.gap.slip; });
  visit("slip_at_rest", [](State &s) -> double & { return s.slip_at_rest; });
  visit("normal_traction", [](State &s) -> double & { return s.traction.normal; });
  visit("shear_traction", [](State &s) -> double & { return s.traction.shear; });
  visit("dissipated", [](State &s) -> double & { return s.dissipated; });
}
} // namespace antiform::coupling

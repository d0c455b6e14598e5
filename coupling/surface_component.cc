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
  std::vector<std::int64_t> face;
  std::vector<double> along, slip, at_rest, shear, dissipated;
  for (const SurfaceContact::State &state : contact_.states())
  {
    face.push_back(state.place.face);
    along.push_back(state.place.s);
    slip.push_back(state.gap.slip);
    at_rest.push_back(state.slip_at_rest);
    shear.push_back(state.traction.shear);
    dissipated.push_back(state.dissipated);
  }
  archive.array(name_ + "/face", face);
  archive.array(name_ + "/along_face", along);
  archive.array(name_ + "/slip", slip);
  archive.array(name_ + "/slip_at_rest", at_rest);
  archive.array(name_ + "/shear_traction", shear);
  archive.array(name_ + "/dissipated", dissipated);
  if (!archive.is_loading())
    return;
  for (std::size_t p = 0; p < contact_.states().size(); ++p)
  {
    SurfaceContact::State &state = contact_.history()[p];
    state.place = {static_cast<std::int32_t>(face[p]), along[p]};
    state.gap.slip = slip[p];
    state.slip_at_rest = at_rest[p];
    state.traction.shear = shear[p];
    state.dissipated = dissipated[p];
  }
}
} // namespace antiform::coupling

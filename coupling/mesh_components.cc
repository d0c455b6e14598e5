#include "coupling/mesh_components.h"

#include <algorithm>

namespace antiform::coupling
{
MeshState::MeshState(continuum::ElasticSolid &body)
    : solid(body)
    , displacement(body.make_vector())
    , velocity(body.make_vector())
    , force(body.make_vector())
    , mass(body.lumped_mass())
    , inverse_mass(body.make_vector())
{
  for (std::size_t i = 0; i < mass.locally_owned_size(); ++i)
    inverse_mass.begin()[i] = 1. / mass.begin()[i];
  inverse_mass.update_ghost_values();
}

void MeshState::prescribe(const std::uint32_t dof,
                          const int wall,
                          const double layer_share)
{
  PrescribedDof entry;
  entry.dof = dof;
  entry.wall = wall;
  entry.layer_share = layer_share;
  prescribed.push_back(entry);
  inverse_mass.begin()[dof] = 0.;
}

void MeshState::scale_density(const continuum::Vector &real_mass,
                              const std::vector<double> &extra,
                              const double dt0)
{
  const continuum::Vector sums = solid.absolute_row_sums();
  for (std::size_t i = 0; i < mass.locally_owned_size(); ++i)
  {
    const double sum = sums.begin()[i] + (extra.empty() ? 0. : extra[i]);
    mass.begin()[i] = std::max(real_mass.begin()[i], 0.25 * dt0 * dt0 * sum);
    inverse_mass.begin()[i] = 1. / mass.begin()[i];
  }
  for (const PrescribedDof &entry : prescribed)
    inverse_mass.begin()[entry.dof] = 0.;
}

void MeshMotion::run(const Stage stage, const Clock &clock)
{
  MeshState &s = state_;
  const auto n = static_cast<std::int64_t>(s.mass.locally_owned_size());
  if (stage == Stage::forces)
  {
    std::fill(s.force.begin(), s.force.begin() + n, 0.);
    s.solid.add_internal_force(s.displacement, s.force);
  }
  else if (stage == Stage::kick)
    kick(clock);
  else if (stage == Stage::drift)
  {
    const double dt = clock.dt, *const v = s.velocity.begin();
    double *const u = s.displacement.begin();
#pragma omp simd
    for (std::int64_t i = 0; i < n; ++i)
      u[i] += dt * v[i];
    s.displacement.update_ghost_values();
  }
}

void MeshMotion::kick(const Clock &clock)
{
  MeshState &s = state_;
  const auto n = static_cast<std::int64_t>(s.mass.locally_owned_size());
  if (clock.sample_due)
    before_.assign(s.velocity.begin(), s.velocity.begin() + n);
  const double dt = clock.dt, *const m = s.inverse_mass.begin(),
               *const f = s.force.begin();
  const double *const extra = damping != nullptr ? damping->data() : nullptr;
  double *const v = s.velocity.begin();
#pragma omp simd
  for (std::int64_t i = 0; i < n; ++i)
    v[i] += dt * m[i] * (f[i] + (extra != nullptr ? extra[i] : 0.));
  for (PrescribedDof &entry : s.prescribed)
  {
    entry.before = s.velocity.begin()[entry.dof];
    double velocity = 0.;
    if (entry.wall >= 0)
    {
      const discrete::Wall &wall = walls_[entry.wall];
      velocity = wall.velocity * wall.normal.x;
    }
    s.velocity.begin()[entry.dof] = velocity;
  }
}

void MeshMotion::add_energies(Energies &energies) const
{
  for (std::size_t i = 0; i < before_.size(); ++i)
    energies.kinetic +=
        0.5 * state_.mass.begin()[i] * before_[i] * state_.velocity.begin()[i];
  energies.strain_continuum += state_.solid.strain_energy_share(state_.displacement);
}

void MeshMotion::visit_state(StateArchive &archive)
{
  const auto visit = [&](const std::string &name, continuum::Vector &vector)
  {
    const std::size_t n = state_.mass.locally_owned_size();
    std::vector<double> values(vector.begin(), vector.begin() + n);
    archive.owned_array(name, values);
    std::copy(values.begin(), values.end(), vector.begin());
    vector.update_ghost_values();
  };
  visit("mesh/displacement", state_.displacement);
  visit("mesh/velocity", state_.velocity);
  visit("mesh/mass", state_.mass);
  visit("mesh/inverse_mass", state_.inverse_mass);
}

MeshFoundation::MeshFoundation(MeshState &state,
                               const dealii::TrilinosWrappers::SparseMatrix &matrix)
    : state_(state)
{
  const auto partitioner = state.displacement.get_partitioner();
  for (const auto row : state.solid.locally_owned())
    for (auto it = matrix.begin(row); it != matrix.end(row); ++it)
      if (it->value() != 0.)
        entries_.push_back({partitioner->global_to_local(row),
                            partitioner->global_to_local(it->column()), it->value()});
}

void MeshFoundation::run(const Stage, const Clock &)
{
  for (const Entry &entry : entries_)
    state_.force.begin()[entry.row] -=
        entry.value * state_.displacement.begin()[entry.column];
}

void MeshFoundation::add_energies(Energies &energies) const
{
  const double *const u = state_.displacement.begin();
  for (const Entry &entry : entries_)
    energies.strain_continuum += 0.5 * entry.value * u[entry.row] * u[entry.column];
}

std::vector<double> MeshFoundation::absolute_row_sums() const
{
  std::vector<double> sums(state_.mass.locally_owned_size(), 0.);
  for (const Entry &entry : entries_)
    sums[entry.row] += std::abs(entry.value);
  return sums;
}

MeshLoads::MeshLoads(MeshState &state,
                     const continuum::Vector &load,
                     const bool is_prestress)
    : state_(state)
    , is_prestress_(is_prestress)
{
  for (std::uint32_t i = 0; i < load.locally_owned_size(); ++i)
    if (load.begin()[i] != 0.)
      load_.emplace_back(i, load.begin()[i]);
}

void MeshLoads::run(const Stage, const Clock &)
{
  for (const auto &[dof, force] : load_)
    state_.force.begin()[dof] += force;
}

void MeshLoads::add_energies(Energies &energies) const
{
  double work = 0.;
  for (const auto &[dof, force] : load_)
    work += force * state_.displacement.begin()[dof];
  if (is_prestress_)
    energies.strain_continuum -= work;
  else
    energies.boundary_work += work;
}
} // namespace antiform::coupling

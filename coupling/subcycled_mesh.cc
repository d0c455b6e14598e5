#include "coupling/subcycled_mesh.h"

#include "continuum/errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::coupling
{
SubcycledMesh::SubcycledMesh(MeshState &state,
                             const std::vector<discrete::Wall> &walls,
                             const std::int64_t interval,
                             const double dt,
                             const double mesh_step)
    : MeshMotion(state, walls)
    , state_(state)
    , interval_(interval)
{
  if (interval < 1)
    throw std::invalid_argument("sub-cycling: an interval of " +
                                std::to_string(interval) + " steps; give 1 or more.");
  const double step = static_cast<double>(interval) * dt;
  if (interval == 1 || step <= largest_share * mesh_step)
    return;
  const auto possible = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(largest_share * mesh_step / dt));
  throw NumericalError(
      "sub-cycling",
      "an impulse of the mesh every " + std::to_string(interval) +
          " steps is too seldom for the mesh, whose waves would resonate with it. Take "
          "an "
          "interval of " +
          std::to_string(possible) + (possible == 1 ? " (no sub-cycling)" : " or less") +
          ", or larger cells (Matrix / Cell size ratio); interval times step over the "
          "stable step of the mesh",
      step / mesh_step, largest_share);
}

void SubcycledMesh::run(const Stage stage, const Clock &clock)
{
  MeshState &s = state_;
  double *const force = s.force.begin();
  const std::size_t n = s.mass.locally_owned_size();
  if (stage == Stage::forces && !is_due(clock))
    std::fill(force, force + n, 0.);
  else if (stage == Stage::damp)
  {
    const double factor = is_due(clock) ? static_cast<double>(interval_) : 0.;
    for (std::size_t i = 0; i < n; ++i)
      force[i] *= factor;
  }
  else
    MeshMotion::run(stage, clock);
}

void EnergyWatch::run(const Stage, const Clock &clock)
{
  if (!clock.sample_due)
    return;
  const Energies e = simulation_.energies();
  const double balance = e.stored_and_spent() - e.boundary_work;
  largest_ = std::max(largest_, e.kinetic + e.strain_grains + e.strain_continuum);
  if (has_first_ == 0.)
  {
    has_first_ = 1.;
    first_ = balance;
    return;
  }
  growth_ = largest_ > 0. ? (balance - first_) / largest_ : 0.;
  if (!(growth_ <= largest_growth_))
    throw NumericalError("energy",
                         "the model gains energy that nothing puts in: the impulses of "
                         "the sub-cycled mesh resonate. Take a smaller interval or damp "
                         "the overlap; gain over the largest energy",
                         growth_, largest_growth_, clock.step);
}

void EnergyWatch::visit_state(StateArchive &archive)
{
  archive.value("energy_watch/has_first", has_first_);
  archive.value("energy_watch/first", first_);
  archive.value("energy_watch/largest", largest_);
}
} // namespace antiform::coupling

#include "coupling/overlap_damping.h"

#include <stdexcept>

namespace antiform::coupling
{
OverlapDamping::OverlapDamping(const BridgingDomain &domain,
                               const continuum::ElasticSolid &solid,
                               GrainState &grains,
                               MeshState &mesh,
                               const double rate)
    : overlap_grains_(domain.overlap_grains())
    , grains_(grains)
    , mesh_(mesh)
    , rate_(rate)
    , force_(overlap_grains_.size())
{
  if (!(rate >= 0.))
    throw std::invalid_argument("overlap damping: its rate is " + std::to_string(rate) +
                                " 1/s and would feed waves; give 0 or more, about 0.05 "
                                "times wave speed over grain diameter.");
  for (const std::int32_t i : overlap_grains_)
  {
    const Vec2 x = grains.grains.reference(i);
    shape_.push_back(solid.shape_values({x.x, x.y}));
  }
}

Vec2 OverlapDamping::slip(const std::size_t k) const
{
  Vec2 v = grains_.grains.velocity(overlap_grains_[k]);
  const double *const V = mesh_.velocity.begin();
  const continuum::PointEvaluation &shape = shape_[k];
  for (std::size_t a = 0; a < shape.value.size(); ++a)
    v += -shape.value[a] * Vec2{V[shape.dof_x[a]], V[shape.dof_y[a]]};
  return v;
}

void OverlapDamping::run(const Stage stage, const Clock &clock)
{
  if (stage == Stage::drift)
  {
    book_half_step(clock.dt);
    return;
  }
  discrete::Grains &g = grains_.grains;
  double *const F = mesh_.force.begin();
  for (std::size_t k = 0; k < overlap_grains_.size(); ++k)
  {
    const std::int32_t i = overlap_grains_[k];
    if (!(g.inverse_mass[i] > 0.))
      continue; // its motion is prescribed
    force_[k] = -(rate_ / g.inverse_mass[i]) * slip(k);
    g.force_x[i] += force_[k].x;
    g.force_y[i] += force_[k].y;
    const continuum::PointEvaluation &shape = shape_[k];
    for (std::size_t a = 0; a < shape.value.size(); ++a)
    {
      F[shape.dof_x[a]] -= shape.value[a] * force_[k].x;
      F[shape.dof_y[a]] -= shape.value[a] * force_[k].y;
    }
  }
  book_half_step(clock.dt);
}

/// Work of the present forces over the half step that the present velocities move: before
/// the positions of the forces at stage damp, after them at the drift. At a sample the
/// energy is then that taken up to the time of the positions.
void OverlapDamping::book_half_step(const double dt)
{
  double power = 0.;
  for (std::size_t k = 0; k < force_.size(); ++k)
    power += dot(force_[k], slip(k));
  energy_ -= 0.5 * dt * power;
}

void OverlapDamping::visit_state(StateArchive &archive)
{
  archive.owned_value("overlap_damping/energy", energy_);
}
} // namespace antiform::coupling

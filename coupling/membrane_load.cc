#include "coupling/membrane_load.h"

namespace antiform::coupling
{
namespace
{
constexpr int looked_at_every = 64; // steps: a grain moves by far less than a diameter
constexpr double moved = 0.1;       // over the reach
} // namespace

MembraneLoad::MembraneLoad(GrainState &state,
                           const double reach,
                           std::function<double(double)> pressure,
                           std::function<bool(std::int32_t)> bears)
    : state_(state)
    , reach_(reach)
    , pressure_(std::move(pressure))
    , bears_(std::move(bears))
{
  find_ring();
}

void MembraneLoad::find_ring()
{
  membrane_.ring = discrete::outer_ring(state_.grains, reach_);
  const std::size_t n = membrane_.ring.size();
  membrane_.loaded.assign(n, 1);
  for (std::size_t k = 0; k < n; ++k)
    if (bears_(membrane_.ring[k]) && bears_(membrane_.ring[(k + 1) % n]))
      membrane_.loaded[k] = 0;
  place_x_ = state_.grains.displacement_x;
  place_y_ = state_.grains.displacement_y;
}

bool MembraneLoad::has_moved() const
{
  const double limit = moved * reach_ * moved * reach_;
  for (std::size_t i = 0; i < place_x_.size(); ++i)
  {
    const double x = state_.grains.displacement_x[i] - place_x_[i];
    const double y = state_.grains.displacement_y[i] - place_y_[i];
    if (x * x + y * y > limit)
      return true;
  }
  return false;
}

void MembraneLoad::run(const Stage stage, const Clock &clock)
{
  // A follower load: it works at the velocities on both sides of the step.
  if (stage == Stage::forces)
  {
    if (clock.step % looked_at_every == 0 && has_moved())
      find_ring();
    now_ = pressure_(clock.time);
    work_ += 0.5 * clock.dt * discrete::add_membrane_forces(state_.grains, membrane_, now_);
  }
  else
    work_ += 0.5 * clock.dt * discrete::membrane_power(state_.grains, membrane_, now_);
}

void MembraneLoad::visit_state(StateArchive &archive)
{
  std::vector<std::int64_t> ring(membrane_.ring.begin(), membrane_.ring.end());
  std::vector<std::int64_t> loaded(membrane_.loaded.begin(), membrane_.loaded.end());
  archive.array("membrane/ring", ring);
  archive.array("membrane/loaded", loaded);
  archive.array("membrane/place_x", place_x_);
  archive.array("membrane/place_y", place_y_);
  archive.value("membrane/pressure", now_);
  archive.value("membrane/work", work_);
  if (!archive.is_loading())
    return;
  membrane_.ring.assign(ring.begin(), ring.end());
  membrane_.loaded.assign(loaded.begin(), loaded.end());
}
} // namespace antiform::coupling

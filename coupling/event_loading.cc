#include "coupling/event_loading.h"

#include "continuum/errors.h"
#include "coupling/present_stability.h"
#include "coupling/specimen_components.h"

#include <algorithm>

namespace antiform::coupling
{
namespace
{
/// In which a pressure comes up. A load put on at once does twice the work that is
/// stored; what is held back of it then is the number's part of that.
constexpr std::int64_t n_pressure_steps = 20;
} // namespace

EventLoading::EventLoading(GrainState &state,
                           std::vector<discrete::Wall> &ends,
                           std::vector<discrete::Wall> &sides,
                           const std::vector<PrescribedMotion> &held,
                           MeshState *const mesh,
                           BridgingDomain *const domain,
                           const Options &options)
    : state_(state)
    , mesh_(mesh)
    , domain_(domain)
    , ends_(ends)
    , sides_(sides)
    , options_(options)
    , motion_(state)
    , bonds_(state)
    , walls_(ends, &state, mesh, domain, [](double) { return 0.; })
{
  if (mesh != nullptr)
  {
    bridged_.emplace(state, bearing_walls(), held, *mesh, *domain);
    mesh_motion_.emplace(*mesh, ends);
  }
  else
    alone_.emplace(state, bearing_walls(), held);
  driver_.emplace(
      state, body(),
      [this](const RestGoal &goal)
      {
        const HeldDynamics &dynamics = options_.driver.dynamics;
        return alone_ ? alone_->settle(dynamics, goal) : bridged_->settle(dynamics, goal);
      },
      options.driver);
}

BalanceOperator &EventLoading::body()
{
  return alone_ ? static_cast<BalanceOperator &>(*alone_) : *bridged_;
}
const BalanceOperator &EventLoading::body() const
{
  return alone_ ? static_cast<const BalanceOperator &>(*alone_) : *bridged_;
}

std::vector<BearingWall> EventLoading::bearing_walls()
{
  // While the pressure comes up one end stays where it is and reacts as the other, which
  // is free, presses: with both of them free the body could go anywhere.
  const bool presses = options_.pressure > 0.;
  std::vector<BearingWall> walls;
  for (discrete::Wall &wall : ends_)
    walls.push_back(
        {&wall, 0.5 * options_.length, presses && &wall == &ends_.back(), 0.});
  for (discrete::Wall &wall : sides_)
    walls.push_back({&wall, 0., true, 0.});
  return walls;
}

void EventLoading::run(const Stage, const Clock &clock)
{
  const std::size_t cracks = state_.cracks.size();
  if (has_begun_)
    load_next();
  has_begun_ = true;
  const BalanceRatios &ratios = driver_->find_balance().ratios;
  worst_.mean = std::max(worst_.mean, ratios.mean);
  worst_.largest = std::max(worst_.largest, ratios.largest);
  worst_.of_strength = std::max(worst_.of_strength, ratios.of_strength);
  for (std::size_t k = cracks; k < state_.cracks.size(); ++k)
  {
    state_.cracks[k].step = static_cast<std::uint64_t>(clock.step);
    state_.cracks[k].time = clock.time;
  }
  look_at_stability();
}

void EventLoading::look_at_stability()
{
  const std::int64_t steps = driver_->report().load_steps;
  if (options_.stability_interval == 0 || steps % options_.stability_interval != 0 ||
      unstable_from_)
    return;
  try
  {
    if (n_unstable_directions(grains(), mesh_, domain_) > 0)
      unstable_from_ = driver_->load();
  }
  catch (const NumericalError &)
  {
    // Singular to round-off: neither the one nor the other; the next look will tell.
  }
}

void EventLoading::load_next()
{
  if (alone_)
    alone_->find_contacts(options_.reach, options_.modulus);
  else
    bridged_->find_contacts(options_.reach, options_.modulus);
  if (options_.pressure > 0. && pressure_steps_ < n_pressure_steps)
    return press();
  std::vector<BearingWall> &walls = grains().walls();
  if (pressure_steps_ == n_pressure_steps) // the ends are held from now on
  {
    ++pressure_steps_;
    for (std::size_t w = 0; w < ends_.size(); ++w)
      walls[w].is_loaded = false;
    grains().assemble_walls(); // pressure is for grains alone
  }
  driver_->step_towards(options_.target);
}

void EventLoading::press()
{
  ++pressure_steps_;
  const double pressure = options_.pressure * static_cast<double>(pressure_steps_) /
                          static_cast<double>(n_pressure_steps);
  std::vector<BearingWall> &walls = grains().walls();
  for (std::size_t w = 0; w < walls.size(); ++w)
    walls[w].load = pressure * (w < ends_.size() ? options_.height : options_.length);
}

void EventLoading::add_energies(Energies &energies) const
{
  if (driver_->report().records.empty())
    return; // nothing has been balanced since a checkpoint was read
  Energies books = driver_->report().records.back().energies;
  const auto from = books.terms(), to = energies.terms();
  for (std::size_t k = 0; k < to.size(); ++k)
    *to[k] += *from[k];
  for (const std::vector<discrete::Wall> *walls : {&ends_, &sides_})
    for (const discrete::Wall &wall : *walls)
      energies.strain_grains += wall_energy(state_.grains, wall);
}

void EventLoading::visit_state(StateArchive &archive)
{
  motion_.visit_state(archive);
  if (mesh_motion_)
    mesh_motion_->visit_state(archive);
  bonds_.visit_state(archive);
  walls_.visit_state(archive);
  visit_walls(archive, "servo walls", sides_);
  std::int64_t has_begun = has_begun_ ? 1 : 0;
  archive.value("event_loading/has_begun", has_begun);
  archive.value("event_loading/pressure_steps", pressure_steps_);
  archive.value("event_loading/worst_mean", worst_.mean);
  archive.value("event_loading/worst_largest", worst_.largest);
  archive.value("event_loading/worst_of_strength", worst_.of_strength);
  has_begun_ = has_begun != 0;
  double unstable_from = unstable_from_.value_or(-1.);
  archive.value("event_loading/unstable_from", unstable_from);
  if (unstable_from >= 0.)
    unstable_from_ = unstable_from;
  if (archive.is_loading() && pressure_steps_ > 0)
  {
    const bool stands = pressure_steps_ > n_pressure_steps;
    pressure_steps_ = std::min(pressure_steps_, n_pressure_steps) - 1;
    press(); // the loads of the walls
    if (stands)
    {
      ++pressure_steps_;
      for (std::size_t w = 0; w < ends_.size(); ++w)
        grains().walls()[w].is_loaded = false;
    }
  }
  if (alone_)
    alone_->visit_state(archive);
  else
    bridged_->visit_state(archive);
  driver_->visit_state(archive);
}
} // namespace antiform::coupling

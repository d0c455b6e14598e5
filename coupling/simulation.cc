#include "coupling/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace antiform::coupling
{
double Energies::magnitude() const
{
  return std::abs(boundary_work) + std::abs(kinetic) + std::abs(strain_grains) +
         std::abs(strain_continuum) + std::abs(slip) + std::abs(damping) +
         std::abs(fracture);
}

void Simulation::insert(std::unique_ptr<Component> component,
                        const std::vector<Stage> &stages,
                        const int rank,
                        const std::string &name,
                        const std::string &reason)
{
  entries_.push_back(std::make_unique<Entry>(
      Entry{std::move(component), rank, {name, reason, 0, 0.}, stages.front()}));
  Entry *const entry = entries_.back().get();
  for (const Stage stage : stages)
  {
    entry->first_stage = std::min(entry->first_stage, stage);
    auto &list = at_stage_[static_cast<std::size_t>(stage)];
    list.insert(std::upper_bound(list.begin(), list.end(), rank,
                                 [](const int r, const Entry *e) { return r < e->rank; }),
                entry);
  }
}

void Simulation::step()
{
  using Timer = std::chrono::steady_clock;
  clock_.sample_due = due_ && due_(clock_);
  clock_.balance_due = clock_.sample_due || (balance_ && balance_());
  for (std::size_t s = 0; s < n_stages; ++s)
    for (Entry *entry : at_stage_[s])
    {
      const auto stage = static_cast<Stage>(s);
      const Timer::time_point begin = Timer::now();
      entry->component->run(stage, clock_);
      entry->count.seconds += std::chrono::duration<double>(Timer::now() - begin).count();
      if (stage == entry->first_stage && entry->component->acted())
        ++entry->count.calls;
    }
  ++clock_.step;
  clock_.time = static_cast<double>(clock_.step) * clock_.dt;
  const std::vector<std::function<void()>> actions = std::move(later_);
  later_.clear();
  for (const auto &action : actions)
    action();
}

Energies Simulation::energies() const
{
  Energies sum;
  for (const auto &entry : entries_)
    entry->component->add_energies(sum);
  return sum;
}

std::vector<EffectCount> Simulation::effects() const
{
  std::vector<EffectCount> counts;
  for (const auto &entry : entries_)
    counts.push_back(entry->count);
  return counts;
}

void Simulation::visit_state(StateArchive &archive)
{
  archive.value("clock/step", clock_.step);
  archive.value("clock/dt", clock_.dt);
  clock_.time = static_cast<double>(clock_.step) * clock_.dt;
  for (std::size_t k = 0; k < entries_.size(); ++k)
  {
    const std::string name = "effects/" + std::to_string(k);
    archive.value(name + "/calls", entries_[k]->count.calls);
    archive.value(name + "/seconds", entries_[k]->count.seconds);
    entries_[k]->component->visit_state(archive);
  }
}
} // namespace antiform::coupling

#pragma once
// The program's stepping loop over grains and mesh joined in an overlap.
#include "coupling/grain_components.h"
#include "coupling/joining_components.h"
#include "coupling/mesh_components.h"
#include "coupling/overlap_damping.h"
#include "coupling/subcycled_mesh.h"
#include "support/coupling_fixtures.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace antiform::coupling::test
{
/// Runs a function at samples, before the drift.
class Probe : public Component
{
public:
  explicit Probe(std::function<void(const Clock &)> action)
      : action_(std::move(action))
  {
  }
  void run(Stage, const Clock &clock) override
  {
    if (clock.sample_due)
      action_(clock);
  }

private:
  std::function<void(const Clock &)> action_;
};

/// Runs a function in every step.
class Every : public Component
{
public:
  explicit Every(std::function<void(const Clock &)> action)
      : action_(std::move(action))
  {
  }
  void run(Stage, const Clock &clock) override { action_(clock); }

private:
  std::function<void(const Clock &)> action_;
};

/// The program's loop over a bridged model: components in its stages and ranks.
class Loop
{
public:
  struct Options
  {
    double damping = 0.;
    bool combined = false;   ///< form of the damping
    bool constrained = true; ///< damping and ratio from the constrained forces
    bool bridged = true;     ///< project velocities on the constraint
    std::int64_t interval = 1;   ///< of sub-cycling [steps]
    double overlap_damping = 0.; ///< rate [1/s]
    std::function<double(double)> wall_speed; ///< with walls
  };

  Loop(Bridged &model, const double dt, const Options &options)
      : model_(model)
      , simulation(dt)
  {
    GrainState &grains = model.state;
    MeshState &mesh = *model.mesh;
    auto &mesh_motion = add(
        options.interval == 1
            ? std::make_unique<MeshMotion>(mesh, model.walls)
            : std::make_unique<SubcycledMesh>(mesh, model.walls, options.interval, dt,
                                              model.mesh_step()),
        options.interval == 1
            ? std::vector<Stage>{Stage::forces, Stage::kick, Stage::drift}
            : std::vector<Stage>{Stage::forces, Stage::damp, Stage::kick, Stage::drift},
        5, "mesh");
    if (options.overlap_damping > 0.)
      add(std::make_unique<OverlapDamping>(*model.domain, *model.solid, grains, mesh,
                                           options.overlap_damping),
          {Stage::damp, Stage::drift}, 94, "overlap damping");
    if (model.domain && !model.domain->ties().empty())
      add(std::make_unique<TiedGrains>(model.domain->ties(), grains, mesh), {Stage::damp},
          90, "tied grains");
    add(std::make_unique<Bonds>(grains), {Stage::forces}, 20, "bonds");
    auto &grain_motion = add(std::make_unique<GrainMotion>(grains),
                             {Stage::kick, Stage::drift}, 50, "grains");
    constrained_ =
        &add(std::make_unique<ConstrainedForces>(
                 &grains, &mesh, options.constrained ? model.domain.get() : nullptr,
                 options.damping == 0.),
             {Stage::damp}, 95, "unbalanced force");
    if (options.damping > 0.)
    {
      auto &damping = add(std::make_unique<LocalDamping>(&grains, &mesh, options.damping,
                                                         options.combined),
                          {Stage::damp, Stage::kick}, 96, "damping");
      grain_motion.damped = true;
      mesh_motion.damping = damping.mesh_forces();
    }
    if (options.wall_speed)
      walls_ =
          &add(std::make_unique<Walls>(model.walls, &grains, &mesh,
                                       options.bridged ? model.domain.get() : nullptr,
                                       options.wall_speed),
               {Stage::forces, Stage::react, Stage::drift}, 40, "walls");
    if (options.bridged)
      add(std::make_unique<Bridging>(*model.domain, grains, mesh), {Stage::constrain}, 0,
          "bridging domain");
    simulation.set_sampler([this](const Clock &clock)
                           { return every_ > 0 && clock.step % every_ == 0; });
  }

  template <class C>
  C &add(std::unique_ptr<C> component,
         const std::vector<Stage> &stages,
         const int rank,
         const std::string &name)
  {
    return simulation.add(std::move(component), stages, rank, name, "test");
  }
  void probe(const std::int64_t every, std::function<void(const Clock &)> action)
  {
    every_ = every;
    add(std::make_unique<Probe>(std::move(action)), {Stage::sample}, 0, "probe");
  }
  void advance(const std::int64_t n)
  {
    for (std::int64_t i = 0; i < n; ++i)
      simulation.step();
  }
  /// Of the last sample.
  double unbalanced_ratio() const { return constrained_->unbalanced_ratio(); }
  const Walls &walls() const { return *walls_; }

private:
  Bridged &model_;
  std::int64_t every_ = 0;
  ConstrainedForces *constrained_ = nullptr;
  Walls *walls_ = nullptr;

public:
  Simulation simulation;
};
} // namespace antiform::coupling::test

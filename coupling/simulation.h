#pragma once

#include "coupling/state_file.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Where the loop stands. Positions are at `time`, velocities half a step before it until
/// the kick and half a step after it from then on.
struct Clock
{
  std::int64_t step = 0;
  double time = 0.;        ///< [s]; inertial time when densities are scaled
  double dt = 0.;          ///< [s]
  bool sample_due = false; ///< this step is recorded: keep what a record needs
  bool balance_due = false; ///< its forces are measured: keep those of the joints
};

/// The stages of a step, in their order.
enum class Stage
{
  forces,    ///< of the present positions
  damp,      ///< constrained force, and damping from it
  kick,      ///< velocities to the next half step
  constrain, ///< bridging domain
  react,     ///< reactions of supports, first half of their work
  sample,    ///< records: positions at t, velocities on both sides of it
  drift      ///< positions to the next step, second half of the work
};
constexpr std::size_t n_stages = 7;

/// Terms of the energy ledger [J].
struct Energies
{
  double boundary_work = 0.; ///< by walls, pressure and gravity on the model
  double kinetic = 0.;
  double strain_grains = 0.;
  double strain_continuum = 0.; ///< foundation included
  double slip = 0.;
  double damping = 0.;
  double fracture = 0.;

  double stored_and_spent() const
  {
    return kinetic + strain_grains + strain_continuum + slip + damping + fracture;
  }
  double magnitude() const;
  std::array<double *, 7> terms()
  {
    return {&boundary_work, &kinetic, &strain_grains, &strain_continuum,
            &slip,          &damping, &fracture};
  }
};

/// One effect of a scene. It exists only if the scene calls for it, and it overrides only
/// the stages that it lists.
class Component
{
public:
  virtual ~Component() = default;

  virtual void run(Stage stage, const Clock &clock) = 0;
  /// Whether the last run() did anything: a search that was not needed does not count.
  virtual bool acted() const { return true; }
  /// Add this rank's share.
  virtual void add_energies(Energies &) const {}
  virtual void visit_state(StateArchive &) {}
};

/// What `summary.json` says of an effect.
struct EffectCount
{
  std::string name;
  std::string reason;
  std::int64_t calls = 0; ///< steps in which the effect acted
  double seconds = 0.;
};

/// Holds the components and steps them. The one place that calls, counts and times them.
class Simulation
{
public:
  explicit Simulation(const double dt) { clock_.dt = dt; }

  /// Add a component that acts in @p stages. Within a stage components act in the order
  /// of
  /// @p rank, then of addition. @p name and @p reason go to the list of effects.
  template <class C>
  C &add(std::unique_ptr<C> component,
         const std::vector<Stage> &stages,
         const int rank,
         const std::string &name,
         const std::string &reason)
  {
    C &reference = *component;
    insert(std::move(component), stages, rank, name, reason);
    return reference;
  }

  /// One step. Components that `later` asks for join at its end.
  void step();
  /// Do @p action after the present step (a component that the run has made necessary).
  void later(std::function<void()> action) { later_.push_back(std::move(action)); }

  const Clock &clock() const { return clock_; }
  /// \param due     whether a step is recorded
  /// \param balance whether its forces are measured though it is not; null: never
  void set_sampler(std::function<bool(const Clock &)> due,
                   std::function<bool()> balance = nullptr)
  {
    due_ = std::move(due);
    balance_ = std::move(balance);
  }
  /// This rank's share of the ledger; the sum over ranks is the model's.
  Energies energies() const;
  std::vector<EffectCount> effects() const;
  /// The clock, the counts and every component's arrays.
  void visit_state(StateArchive &archive);

private:
  struct Entry
  {
    std::unique_ptr<Component> component;
    int rank;
    EffectCount count;
    Stage first_stage; ///< a step counts once, at the first of the effect's stages
  };
  void insert(std::unique_ptr<Component> component,
              const std::vector<Stage> &stages,
              int rank,
              const std::string &name,
              const std::string &reason);

  Clock clock_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::array<std::vector<Entry *>, n_stages> at_stage_;
  std::vector<std::function<void()>> later_;
  std::function<bool(const Clock &)> due_;
  std::function<bool()> balance_;
};
} // namespace antiform::coupling

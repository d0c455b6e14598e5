#pragma once

#include "coupling/anderson.h"
#include "coupling/grain_balance.h"
#include "coupling/held_dynamics.h"
#include "coupling/local_moves.h"
#include "coupling/simulation.h"
#include "discrete/joint_events.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace antiform::coupling
{
/// How a body is loaded through its events (docs/theory/quasi_static_driver.md).
struct DriverSettings
{
  /// Of balance. The mean does not see a single break among many grains, nor the
  /// largest one where joints carry much more than their tensile strength.
  BalanceRatios limits{1e-3, 0.1, 0.15};
  double largest_step = 1e-4;  ///< of the load parameter
  /// Until the first break: at least that many, even ones, by what is foreseen of it, so
  /// that records tell the stiffness; 0: no such limit.
  int steps_to_first_break = 0;
  int events_per_step = 0;     ///< k: a load step reaches that many; 0: N / 200
  double exclusion = 4.;       ///< radius about a break without others, mean diameters
  double correction_cap = 20.; ///< of a joint's deformation, over sigma_b / k_n [-]
  /// Likewise of a part of a move: longer ones are made and booked in parts.
  double part_length = 0.5;
  double most_parts = 400.; ///< [-]; a load step that would take more has longer ones

  LocalSettings local; ///< of bodies that are grains alone
  /// While bonds of parts that were balanced apart still break, the whole may be that
  /// many times beyond the limits before it is corrected.
  double slack = 2.;

  int accelerate_after = 2; ///< corrections since the last break or load step
  int anderson_depth = 6;
  int most_corrections = 400; ///< then the body is handed over to explicit motion
  double most_breaks = 0.125; ///< at one load, per grain: likewise
  double settled_before_peak = 1e-4; ///< mean ratio that ends it
  double settled_after_peak = 1e-3;
  double past_peak = 0.05; ///< drop below the largest force that counts as after it [-]
  HeldDynamics dynamics;

  /// Stop that far below the largest force [-]; 0: never. Explicit motion that gets
  /// there ends as it is, and the last record is not in balance.
  double stop_drop = 0.1;
};

/// A state in balance without an overstressed bond.
struct LoadRecord
{
  double load = 0.;  ///< the load parameter
  double force = 0.; ///< conjugate to it [J]: over the volume, the stress
  std::size_t cracks = 0;
  BalanceRatios ratios;
  Energies energies; ///< damping: what holding the body took
};

/// What a run took.
struct DriverReport
{
  std::int64_t load_steps = 0;
  std::int64_t solves = 0;      ///< with the factor: corrections and the first tangent
  std::int64_t evaluations = 0; ///< of the forces, without those of explicit motion
  std::int64_t batches = 0;     ///< of bonds that broke together
  std::int64_t breaks = 0;      ///< in batches
  std::int64_t local_moves = 0; ///< patches about a break that were balanced apart
  std::int64_t local_corrections = 0; ///< in these
  std::int64_t hand_overs = 0;
  std::int64_t explicit_steps = 0;
  std::int64_t most_corrections = 0; ///< between two breaks or load steps
  /// Smallest energy that holding the body took from a batch to the next balance [J].
  double least_held = std::numeric_limits<double>::infinity();
  std::vector<LoadRecord> records;
};

/// Explicit motion under held supports until the goal is reached; a body that is looked
/// at for balance alone may take it as its limits.
using HandOver = std::function<HeldResult(const RestGoal &goal)>;

/// Loads bonded grains without inertia: to the next few events; then, at that load,
/// break the most loaded bond of each neighbourhood, restore balance, and again until
/// no bond is over its strength. Where that does not end, explicit motion takes over.
class EventDriver
{
public:
  /// \param state    whose joints break; @p body's grains
  /// \param body     referred to
  /// \param dynamics what to hand over to
  EventDriver(GrainState &state,
              BalanceOperator &body,
              HandOver dynamics,
              const DriverSettings &settings);
  /// Bonded grains alone.
  EventDriver(GrainBalance &body, const DriverSettings &settings);

  /// Load, or unload, to the load parameter @p target; every balanced state is
  /// recorded, the first one before the load changes. \return false when the force has
  /// fallen by the stop's share below the largest one so far, and the run ended there
  bool run_to(double target);

  /// Balance the body at the present load and record it.
  const LoadRecord &find_balance();
  /// Change the load by one step towards @p target, elastically; a balance is to follow.
  void step_towards(double target);
  /// Load, books and counts, between the two; not the records. The same path follows
  /// from a body in the same state.
  void visit_state(StateArchive &archive);

  double load() const { return load_; }
  const DriverReport &report() const { return report_; }
  /// Largest force of a record so far [J].
  double largest_force() const { return largest_force_; }

private:
  void balance();
  void break_batch(const std::vector<discrete::LoadedElement> &over);
  void correct(int corrections);
  void break_apart(const std::vector<discrete::LoadedElement> &batch,
                   const discrete::StepTime &now);
  void hand_over();
  void come_to_rest(double mean);
  double step_size(double sign);
  void move(const Eigen::VectorXd &increment, double load_step, double deformation);
  void move_a_part(const Eigen::VectorXd &increment, double load_step);
  void evaluate();
  bool is_balanced() const;
  void add_record();

  GrainState &state_;
  BalanceOperator &body_;
  HandOver dynamics_;
  DriverSettings settings_;
  Anderson anderson_;
  std::optional<LocalMoves> local_;
  bool far_field_waits_ = false; ///< parts were balanced and the whole not since
  double mean_diameter_ = 0.; ///< [m]
  double load_ = 0., largest_force_ = 0.;
  double work_ = 0., held_ = 0.; ///< [J]
  Eigen::VectorXd unbalanced_;
  DriverReport report_;
};
} // namespace antiform::coupling

#pragma once

#include "coupling/joining_components.h"
#include "coupling/simulation.h"

#include <cstdint>

namespace antiform::coupling
{
/// Loads by small steps: the walls advance, stand still until the forces balance, are
/// recorded, advance again. What breaks meanwhile breaks at walls at rest; the load never
/// runs ahead of it. Acts after ConstrainedForces, whose forces it judges.
class StepAndRelax : public Component
{
public:
  struct Options
  {
    double speed = 0.;          ///< of each wall, advancing [m/s]
    std::int64_t advance = 1;   ///< steps in which it does it
    double tolerance = 1e-4;    ///< mean unbalanced force over mean joint force [-]
    double largest = 0.1;       ///< largest unbalanced force over mean joint force [-]
    std::int64_t interval = 10; ///< steps between looks at the balance
    /// Steps after which a relaxation counts as a collapse, which ends at ten times the
    /// tolerance: loose fragments settle slowly, and joints carry little then.
    std::int64_t patience = 0;
    std::int64_t longest = 0; ///< steps after which it is given up
    double begin = 0.;        ///< no load before this time [s]
  };

  StepAndRelax(ConstrainedForces &forces, const Options &options)
      : forces_(forces)
      , options_(options)
  {
  }

  /// Throws NumericalError with the remedy when the forces do not come to balance.
  void run(Stage stage, const Clock &clock) override;
  void visit_state(StateArchive &archive) override;

  /// Of each wall in the step to come [m/s].
  double speed() const { return phase_ == advancing ? options_.speed : 0.; }
  /// The forces are balanced and the walls stand still: the step at hand is to be
  /// recorded.
  bool is_recording() const { return phase_ == recording; }
  /// The forces of the step at hand are to be measured.
  bool is_looking() const
  {
    return phase_ == relaxing && (steps_ + 1) % options_.interval == 0;
  }
  std::int64_t n_load_steps() const { return n_load_steps_; }
  std::int64_t n_collapses() const { return n_collapses_; }

private:
  enum Phase : std::int64_t
  {
    recording,
    advancing,
    relaxing
  };
  void relax(const Clock &clock);

  ConstrainedForces &forces_;
  Options options_;
  std::int64_t phase_ = recording;
  std::int64_t steps_ = 0; ///< of the present phase
  std::int64_t n_load_steps_ = 0, n_collapses_ = 0;
};
} // namespace antiform::coupling

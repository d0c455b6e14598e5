#include "coupling/step_and_relax.h"

#include "continuum/errors.h"

#include <string>

namespace antiform::coupling
{
void StepAndRelax::run(const Stage, const Clock &clock)
{
  ++steps_;
  switch (phase_)
  {
  case recording:
    if (clock.time < options_.begin)
      return;
    phase_ = advancing;
    steps_ = 0;
    ++n_load_steps_;
    return;
  case advancing:
    if (steps_ < options_.advance)
      return;
    phase_ = relaxing;
    steps_ = 0;
    return;
  default:
    relax(clock);
  }
}

void StepAndRelax::relax(const Clock &clock)
{
  if (steps_ % options_.interval != 0)
    return;
  const UnbalancedRatio ratio = forces_.measure();
  const bool collapses = steps_ > options_.patience;
  const double tolerance = (collapses ? 10. : 1.) * options_.tolerance;
  if (ratio.mean < tolerance && ratio.largest < options_.largest)
  {
    phase_ = recording;
    steps_ = 0;
    n_collapses_ += collapses ? 1 : 0;
    return;
  }
  if (steps_ < options_.longest)
    return;
  const bool by_mean = ratio.mean >= tolerance;
  throw NumericalError(
      "load steps",
      "in load step " + std::to_string(n_load_steps_) +
          " the forces are not in balance " + std::to_string(steps_) +
          " steps after the walls have stopped: the " + (by_mean ? "mean" : "largest") +
          " unbalanced force over the mean force of a joint stays too high. Raise "
          "'Walls/Relaxation tolerance' or 'Damping/Coefficient'",
      by_mean ? ratio.mean : ratio.largest, by_mean ? tolerance : options_.largest,
      static_cast<long>(clock.step));
}

void StepAndRelax::visit_state(StateArchive &archive)
{
  archive.value("step_and_relax/phase", phase_);
  archive.value("step_and_relax/steps", steps_);
  archive.value("step_and_relax/load_steps", n_load_steps_);
  archive.value("step_and_relax/collapses", n_collapses_);
}
} // namespace antiform::coupling

#include "cases/event_run.h"

#include "cases/predicted_course.h"
#include "coupling/output/tables.h"

namespace antiform::cases
{
namespace
{
/// The load step at hand is given up.
struct GivenUp
{
};
} // namespace

SteppedRun::Pause EventRun::advance()
{
  coupling::StateWriter last_record(communicator_);
  visit_state(last_record);
  Pause wish = Pause::none;
  const Timer::time_point now = Timer::now();
  scene_->events->set_watch(
      [this, &wish, now]
      {
        wish = wish_of_this_rank(now);
        // However little time there is, each start comes a record further.
        if (wish == Pause::interrupted || (wish == Pause::out_of_time && has_recorded_))
          throw GivenUp{};
        if (log_.is_due())
          report_progress();
      });
  const bool was_unstable = scene_->events->unstable_from().has_value();
  try
  {
    scene_->simulation->step();
  }
  catch (const GivenUp &)
  {
    go_back_to(last_record);
    return wish;
  }
  catch (...)
  {
    go_back_to(last_record);
    throw;
  }
  has_recorded_ = true;
  if (const auto load = scene_->events->unstable_from(); load && !was_unstable)
    log_.line("the balance has become unstable, with the walls held, by a shortening of " +
              coupling::shortest_text(*load));
  return Pause::none;
}

void EventRun::go_back_to(const coupling::StateWriter &last_record)
{
  last_record.commit(options_.output + "/state.h5");
  coupling::GrainState &state = scene_->grains->state;
  state.cracks.resize(state.cracks_recorded); // the summary counts them
}

std::string EventRun::loading_in_words() const
{
  return "from event to event, load steps of at most " +
         coupling::shortest_text(longest_load_step(parameters_)) +
         ", unbalanced forces below " +
         coupling::shortest_text(parameters_.walls.balance_tolerance) +
         " of those of joints";
}

std::unique_ptr<SteppedRun> EventRun::another(const Parameters &parameters,
                                              const RunOptions &options) const
{
  return std::make_unique<EventRun>(parameters, options, log_, communicator_);
}
} // namespace antiform::cases

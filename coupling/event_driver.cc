#include "coupling/event_driver.h"

#include "discrete/joint_events.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace antiform::coupling
{
namespace
{
/// Share of the largest step that is taken even where something breaks at once [-].
constexpr double least_step = 1e-3;
} // namespace

EventDriver::EventDriver(GrainState &state,
                         BalanceOperator &body,
                         HandOver dynamics,
                         const DriverSettings &settings)
    : state_(state)
    , body_(body)
    , dynamics_(std::move(dynamics))
    , settings_(settings)
    , anderson_(static_cast<std::size_t>(settings.anderson_depth))
{
  const std::vector<double> &radius = state.grains.radius;
  const auto n = static_cast<double>(radius.size());
  mean_diameter_ = 2. * std::accumulate(radius.begin(), radius.end(), 0.) / n;
  if (settings_.events_per_step == 0)
    settings_.events_per_step = std::max(1, static_cast<int>(std::lround(n / 200.)));
  if (GrainBalance *grains = body.grains_alone();
      grains != nullptr && settings_.local.radius > 0.)
    local_.emplace(*grains, settings_.local, mean_diameter_);
  report_.solves = 1; // the tangent's, which does not change
}

EventDriver::EventDriver(GrainBalance &body, const DriverSettings &settings)
    : EventDriver(
          body.state(),
          body,
          [&body, dynamics = settings.dynamics](const RestGoal &goal)
          { return settle(body, dynamics, goal); },
          settings)
{
}

bool EventDriver::run_to(const double target)
{
  while (true)
  {
    const LoadRecord &record = find_balance();
    if (settings_.stop_drop > 0. &&
        record.force < (1. - settings_.stop_drop) * largest_force_)
      return false;
    if (load_ == target)
      return true;
    step_towards(target);
  }
}

const LoadRecord &EventDriver::find_balance()
{
  balance();
  add_record();
  return report_.records.back();
}

/// At the present load: break and correct by turns until nothing is left to do.
void EventDriver::balance()
{
  const double most_breaks =
      settings_.most_breaks * static_cast<double>(state_.grains.size());
  int corrections = 0;
  std::int64_t breaks = report_.breaks;
  double held = held_;
  anderson_.reset();
  evaluate();
  while (true)
  {
    if (!is_balanced())
    {
      if (corrections == settings_.most_corrections)
        return hand_over();
      correct(corrections++);
      report_.most_corrections =
          std::max<std::int64_t>(report_.most_corrections, corrections);
      continue;
    }
    if (report_.breaks > breaks)
      report_.least_held = std::min(report_.least_held, held_ - held);
    const std::vector<discrete::LoadedElement> over =
        discrete::overstressed_elements(state_.grains, state_.joints);
    if (over.empty() && !far_field_waits_)
      return;
    if (over.empty())
    {
      correct(corrections++);
      continue;
    }
    held = held_;
    break_batch(over);
    corrections = 0;
    if (static_cast<double>(report_.breaks - breaks) > most_breaks)
      return hand_over();
  }
}

void EventDriver::break_batch(const std::vector<discrete::LoadedElement> &over)
{
  const std::vector<discrete::LoadedElement> batch =
      discrete::local_maxima(over, settings_.exclusion * mean_diameter_);
  discrete::StepTime now;
  now.step = static_cast<std::uint64_t>(report_.load_steps);
  now.time = load_;
  ++report_.batches;
  if (local_)
    break_apart(batch, now);
  else
  {
    discrete::break_elements(state_.grains, state_.joints, batch, now, state_.cracks);
    report_.breaks += static_cast<std::int64_t>(batch.size());
  }
  anderson_.reset();
  evaluate();
}

/// One after the other, each with what follows around it, while the rest stays in place.
void EventDriver::break_apart(const std::vector<discrete::LoadedElement> &batch,
                              const discrete::StepTime &now)
{
  const double allowed = body_.grains_alone()->allowed_force(settings_.limits);
  for (const discrete::LoadedElement &element : batch)
  {
    const LocalResult result = local_->relax(element, now, allowed);
    ++report_.local_moves;
    report_.local_corrections += result.corrections;
    report_.breaks += result.breaks;
    held_ += result.held;
    work_ += result.load_work;
  }
  far_field_waits_ = true;
}

void EventDriver::correct(const int corrections)
{
  Eigen::VectorXd step = body_.correction(unbalanced_);
  ++report_.solves;
  far_field_waits_ = false;
  if (corrections >= settings_.accelerate_after)
  {
    const Eigen::VectorXd &levers = body_.levers();
    step = anderson_.increment(step.cwiseProduct(levers)).cwiseQuotient(levers);
  }
  const double deformation = body_.deformation(
      step, std::min(settings_.part_length, settings_.correction_cap));
  if (deformation > settings_.correction_cap)
  {
    anderson_.reset();
    move(settings_.correction_cap / deformation * step, 0., settings_.correction_cap);
  }
  else
    move(step, 0., deformation);
}

void EventDriver::hand_over()
{
  ++report_.hand_overs;
  far_field_waits_ = false;
  come_to_rest(std::max(settings_.settled_before_peak, settings_.settled_after_peak));
  // A body that has failed on the way is past its peak.
  if (body_.conjugate_force() >= (1. - settings_.past_peak) * largest_force_ &&
      settings_.settled_before_peak < settings_.settled_after_peak)
    come_to_rest(settings_.settled_before_peak);
}

/// By explicit motion, to a mean ratio below @p mean.
void EventDriver::come_to_rest(const double mean)
{
  RestGoal goal(settings_.limits);
  goal.mean = mean;
  if (settings_.stop_drop > 0.)
    goal.least_force = (1. - settings_.stop_drop) * largest_force_;
  evaluate();
  const HeldResult result = dynamics_(goal);
  report_.explicit_steps += result.steps;
  held_ += result.dissipated;
  work_ += result.load_work;
  evaluate();
}

void EventDriver::step_towards(const double target)
{
  const double sign = target > load_ ? 1. : -1.;
  evaluate(); // as one that goes on from a checkpoint must
  const double left = std::abs(target - load_), size = step_size(sign);
  ++report_.load_steps;
  const double load_step = sign * std::min(size, left);
  const Eigen::VectorXd increment = load_step * body_.tangent();
  move(increment, load_step, body_.deformation(increment, settings_.part_length));
  if (size >= left)
    load_ = target;
}

/// To the k-th event of the linearised body, at most the largest step.
double EventDriver::step_size(const double sign)
{
  discrete::Grains &grains = state_.grains;
  const Eigen::VectorXd &rate = body_.tangent();
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const auto first = static_cast<Eigen::Index>(3 * i);
    grains.velocity_x[i] = rate[first];
    grains.velocity_y[i] = rate[first + 1];
    grains.spin[i] = rate[first + 2];
  }
  std::vector<double> steps =
      discrete::steps_to_break(grains, state_.joints, sign * settings_.largest_step);
  for (std::vector<double> *v : {&grains.velocity_x, &grains.velocity_y, &grains.spin})
    std::fill(v->begin(), v->end(), 0.);

  // A little beyond: rounding must not leave the event just ahead for ever.
  const double beyond = 1e-7 * std::max(std::abs(load_), settings_.largest_step);
  // Record the whole body once shortly before its first break, and on the way there.
  double largest = settings_.largest_step, first = HUGE_VAL;
  if (state_.cracks.empty() && !steps.empty())
    first = *std::min_element(steps.begin(), steps.end());
  if (settings_.steps_to_first_break > 0)
    largest = std::clamp((std::abs(load_) + first) / settings_.steps_to_first_break,
                         least_step * largest, largest);
  const double short_by = 0.01 * largest;
  double size = first > 2. * short_by ? std::min(largest, first - short_by) : largest;
  const auto k = static_cast<std::size_t>(settings_.events_per_step);
  if (steps.size() >= k)
  {
    const auto wanted = steps.begin() + static_cast<std::ptrdiff_t>(k - 1);
    std::nth_element(steps.begin(), wanted, steps.end());
    size = std::min(size, *wanted + beyond);
  }
  return size;
}

/// Displace the body. A long way is taken in parts, since the trapezoidal rule, by which
/// work is booked, sees no kink of the law within a part. A correction (no load step) of
/// several parts ends after the one in which it began to go uphill, as one that was
/// accelerated too far does. \param deformation of a joint in it, over sigma_b / k_n [-]
void EventDriver::move(const Eigen::VectorXd &increment,
                       const double load_step,
                       const double deformation)
{
  const int n = static_cast<int>(std::ceil(
      std::clamp(deformation / settings_.part_length, 1., settings_.most_parts)));
  for (int part = 1; part <= n; ++part)
  {
    move_a_part(increment / n, load_step / n);
    if (load_step == 0. && part < n && unbalanced_.dot(increment) < 0.)
      return anderson_.reset();
  }
}

/// Displace the body and book the work of its supports, of its loads, and of what holds
/// it back from moving by itself, each by the trapezoidal rule.
void EventDriver::move_a_part(const Eigen::VectorXd &increment, const double load_step)
{
  const Eigen::VectorXd before = unbalanced_;
  const double force = body_.conjugate_force();
  body_.move(increment);
  load_ += load_step;
  evaluate();
  held_ += 0.5 * (before + unbalanced_).dot(increment);
  work_ +=
      0.5 * (force + body_.conjugate_force()) * load_step + body_.load_work(increment);
}

void EventDriver::evaluate()
{
  unbalanced_ = body_.residual();
  ++report_.evaluations;
}

bool EventDriver::is_balanced() const
{
  BalanceRatios limits = settings_.limits;
  if (far_field_waits_)
    for (double *limit : {&limits.mean, &limits.largest, &limits.of_strength})
      *limit *= settings_.slack;
  return body_.ratios().within(limits);
}

void EventDriver::visit_state(StateArchive &archive)
{
  archive.value("event_driver/load", load_);
  archive.value("event_driver/largest_force", largest_force_);
  archive.value("event_driver/work", work_);
  archive.value("event_driver/held", held_);
  archive.value("event_driver/least_held", report_.least_held);
  std::vector<std::int64_t *> counts{
      &report_.load_steps,     &report_.solves,           &report_.evaluations,
      &report_.batches,        &report_.breaks,           &report_.local_moves,
      &report_.local_corrections, &report_.hand_overs,    &report_.explicit_steps,
      &report_.most_corrections};
  std::vector<std::int64_t> values;
  for (const std::int64_t *count : counts)
    values.push_back(*count);
  archive.array("event_driver/counts", values);
  if (archive.is_loading())
    for (std::size_t k = 0; k < counts.size(); ++k)
      *counts[k] = values[k];
}

void EventDriver::add_record()
{
  LoadRecord record;
  record.load = load_;
  record.force = body_.conjugate_force();
  record.cracks = state_.cracks.size();
  record.ratios = body_.ratios();
  const discrete::JointEnergies joints =
      discrete::joint_energies(state_.grains, state_.joints);
  record.energies.boundary_work = work_;
  record.energies.strain_grains = joints.strain;
  record.energies.slip = joints.slip;
  record.energies.fracture = joints.fracture;
  record.energies.damping = held_;
  body_.add_energies(record.energies);
  report_.records.push_back(record);
  largest_force_ = std::max(largest_force_, record.force);
}
} // namespace antiform::coupling

#include "discrete/relaxation.h"
#include "discrete/packing_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace antiform::discrete
{
namespace
{
// Lengths in mean diameters; unit stiffness and mass.
// Reach of the neighbour lists beyond contact: while disks run, and when they creep.
constexpr double wide_skin = 0.2, narrow_skin = 0.06;
constexpr std::size_t creep = 200;   // steps that a list has served when disks creep
constexpr double largest_move = 0.1; // of a disk in a step
constexpr double largest_step = 0.5; // the fastest mode of six contacts allows 0.58
constexpr double first_step = 0.1;
constexpr std::size_t check_interval = 20;
constexpr std::size_t most_steps = 2000000;
} // namespace

Relaxation::Relaxation(std::vector<Disk> disks, const Confinement &confinement)
    : confinement_(confinement)
{
  replace(std::move(disks));
}

void Relaxation::replace(std::vector<Disk> disks)
{
  disks_ = std::move(disks);
  velocity_.assign(disks_.size(), {});
  force_.assign(disks_.size(), {});
  find_neighbours();
}

void Relaxation::scale(const double factor)
{
  for (Disk &d : disks_)
    d.radius *= factor;
  find_neighbours();
}

void Relaxation::find_neighbours()
{
  skin_ = steps_ - last_search_ > creep ? narrow_skin : wide_skin;
  last_search_ = steps_;
  travelled_ = 0.;
  pairs_ = disk_pairs(disks_, confinement_.period, skin_);
  if (confinement_.edges == nullptr)
    return;
  edge_disk_.clear();
  edge_begin_.assign(1, 0);
  near_edges_.clear();
  for (std::size_t i = 0; i < disks_.size(); ++i)
  {
    confinement_.edges->append_near(disks_[i].centre, disks_[i].radius + 0.5 * skin_,
                                    near_edges_);
    if (static_cast<std::int32_t>(near_edges_.size()) == edge_begin_.back())
      continue;
    edge_disk_.push_back(static_cast<std::int32_t>(i));
    edge_begin_.push_back(static_cast<std::int32_t>(near_edges_.size()));
  }
}

ContactState Relaxation::add_forces()
{
  std::fill(force_.begin(), force_.end(), Vec2{});
  ContactState state;
  double sum = 0., largest = 0.;
  for (std::size_t k = 0; k < pairs_.size();)
  {
    // The pairs of one first disk follow each other: its sum stays in registers.
    const std::int32_t i = pairs_[k].first;
    const Disk disk = disks_[i];
    Vec2 total = force_[i];
    for (; k < pairs_.size() && pairs_[k].first == i; ++k)
    {
      const DiskPair &p = pairs_[k];
      const Disk &other = disks_[p.second];
      const Vec2 d = other.centre + p.shift - disk.centre;
      const double reach = disk.radius + other.radius;
      const double square = dot(d, d);
      if (!(square < reach * reach && square > 0.))
        continue;
      const double distance = std::sqrt(square);
      const double overlap = reach - distance;
      const Vec2 push = (overlap / distance) * d;
      total += -push;
      force_[p.second] += push;
      sum += overlap;
      largest = std::max(largest, overlap);
      ++state.touching;
    }
    force_[i] = total;
  }
  state.largest_overlap = largest;
  sum_contact_force_ = sum;
  n_contacts_ = state.touching;
  for (std::size_t k = 0; k < edge_disk_.size(); ++k)
  {
    const std::int32_t i = edge_disk_[k];
    confinement_.edges->find_contacts(disks_[i], near_edges_.data() + edge_begin_[k],
                                      near_edges_.data() + edge_begin_[k + 1], contacts_);
    for (const EdgeContact &c : contacts_)
    {
      force_[i] += c.overlap * c.normal;
      sum_contact_force_ += c.overlap;
      ++n_contacts_;
      state.largest_overlap = std::max(state.largest_overlap, c.overlap);
    }
  }
  if (state.touching > 0)
    state.mean_overlap = sum / static_cast<double>(state.touching);
  return state;
}

double Relaxation::unbalanced_ratio() const
{
  if (n_contacts_ == 0)
    return 0.;
  double sum = 0.;
  for (const Vec2 &f : force_)
    sum += norm(f);
  return sum / static_cast<double>(disks_.size()) /
         (sum_contact_force_ / static_cast<double>(n_contacts_));
}

ContactState Relaxation::state()
{
  ContactState state = add_forces();
  state.unbalanced_ratio = unbalanced_ratio();
  return state;
}

void Relaxation::drift(const double dt)
{
  double fastest = 0.;
  for (const Vec2 &v : velocity_)
    fastest = std::max(fastest, dot(v, v));
  const double move = std::sqrt(fastest) * std::abs(dt);
  if (move > largest_move)
    for (Vec2 &v : velocity_)
      v = (largest_move / move) * v;
  for (std::size_t i = 0; i < disks_.size(); ++i)
    disks_[i].centre += dt * velocity_[i];
  travelled_ += std::min(move, largest_move);
  if (travelled_ > 0.5 * skin_)
    find_neighbours();
}

ContactState Relaxation::relax(const double tolerance, const double parted)
{
  double dt = first_step, mixing = 0.1;
  int downhill = 0;
  std::fill(velocity_.begin(), velocity_.end(), Vec2{});
  for (std::size_t step = 0; step < most_steps; ++step, ++steps_)
  {
    ContactState state = add_forces();
    if (step % check_interval == 0)
    {
      state.unbalanced_ratio = unbalanced_ratio();
      if (state.unbalanced_ratio <= tolerance || state.mean_overlap < parted)
        return state;
    }
    double power = 0., forces = 0., speeds = 0.;
    for (std::size_t i = 0; i < disks_.size(); ++i)
      power += dot(force_[i], velocity_[i]);
    if (power > 0.)
    {
      if (++downhill > 20)
      {
        dt = std::min(1.1 * dt, largest_step);
        mixing *= 0.99;
      }
    }
    else if (step > 0)
    {
      // Uphill: half a step back, stop, and start afresh.
      drift(-0.5 * dt);
      std::fill(velocity_.begin(), velocity_.end(), Vec2{});
      downhill = 0;
      dt = std::max(0.5 * dt, 0.1 * first_step);
      mixing = 0.1;
    }
    for (std::size_t i = 0; i < disks_.size(); ++i)
    {
      velocity_[i] += dt * force_[i];
      speeds += dot(velocity_[i], velocity_[i]);
      forces += dot(force_[i], force_[i]);
    }
    const double turn = forces > 0. ? mixing * std::sqrt(speeds / forces) : 0.;
    for (std::size_t i = 0; i < disks_.size(); ++i)
      velocity_[i] = (1. - mixing) * velocity_[i] + turn * force_[i];
    drift(dt);
  }
  const double ratio = state().unbalanced_ratio;
  throw PackingError("the disks do not come to rest; give another seed", ratio,
                     tolerance);
}
} // namespace antiform::discrete

#include "coupling/walled_grains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace antiform::coupling
{
namespace
{
using discrete::Grains;
using discrete::Wall;
using discrete::WallContact;
} // namespace

WalledGrains::WalledGrains(GrainState &state,
                           std::vector<BearingWall> walls,
                           const std::vector<PrescribedMotion> &held,
                           std::vector<OperatorSpring> operator_springs)
    : GrainBalance(state, held, {}, walls.size(), std::move(operator_springs))
    , walls_(std::move(walls))
    , in_operator_(walls_.size())
{
  for (std::size_t w = 0; w < walls_.size(); ++w)
    for (const WallContact &contact : walls_[w].wall->contacts)
      if (wall_gap(*walls_[w].wall, contact, state.grains) <= 0.)
        in_operator_[w].push_back(contact.grain);
  assemble_walls();
}

void WalledGrains::assemble_walls()
{
  std::vector<Eigen::Triplet<double>> springs;
  for (std::size_t w = 0; w < walls_.size(); ++w)
  {
    const Wall &wall = *walls_[w].wall;
    prescribed_[unknown(w)] = walls_[w].is_loaded ? 0. : 1.;
    rate_[unknown(w)] = walls_[w].is_loaded ? 0. : walls_[w].rate;
    for (const WallContact &contact : wall.contacts)
    {
      if (!std::binary_search(in_operator_[w].begin(), in_operator_[w].end(),
                              contact.grain))
        continue;
      // Change of the gap: n . u of the grain less the way of the wall.
      const std::array<std::pair<Eigen::Index, double>, 3> gap{
          {{3 * contact.grain, wall.normal.x},
           {3 * contact.grain + 1, wall.normal.y},
           {unknown(w), -1.}}};
      const double stiffness = contact.weight * contact.stiffness;
      for (const auto &[row, a] : gap)
        for (const auto &[column, b] : gap)
          springs.emplace_back(static_cast<int>(row), static_cast<int>(column),
                               stiffness * a * b);
    }
  }
  assemble(springs);
}

bool WalledGrains::add_pressing_contacts()
{
  bool has_grown = false;
  for (std::size_t w = 0; w < walls_.size(); ++w)
    for (const WallContact &contact : walls_[w].wall->contacts)
    {
      std::vector<std::int32_t> &known = in_operator_[w];
      const auto place = std::lower_bound(known.begin(), known.end(), contact.grain);
      if ((place != known.end() && *place == contact.grain) ||
          wall_gap(*walls_[w].wall, contact, state().grains) >= 0.)
        continue;
      known.insert(place, contact.grain);
      has_grown = true;
    }
  return has_grown;
}

bool WalledGrains::find_contacts(const double reach, const std::vector<double> &modulus)
{
  for (const BearingWall &bearing : walls_)
    find_wall_contacts(state().grains, *bearing.wall, reach, modulus);
  if (!add_pressing_contacts())
    return false;
  assemble_walls();
  return true;
}

void WalledGrains::visit_state(StateArchive &archive)
{
  archive.value("walled_grains/most_carried", most_carried_);
  for (std::size_t w = 0; w < walls_.size(); ++w)
  {
    std::vector<std::int64_t> known(in_operator_[w].begin(), in_operator_[w].end());
    if (archive.is_loading())
      known.clear();
    archive.array("walled_grains/" + std::to_string(w), known);
    in_operator_[w].assign(known.begin(), known.end());
  }
  if (archive.is_loading())
    assemble_walls();
}

void WalledGrains::follow_load(BearingWall &bearing) const
{
  Wall &wall = *bearing.wall;
  // Newton's iteration on a sum of springs that push only: its force grows with the way
  // and is convex, so it ends after as many rounds as contacts close or open.
  for (std::size_t round = 0; round <= 2 * wall.contacts.size(); ++round)
  {
    double reaction = 0., stiffness = 0., nearest = HUGE_VAL;
    for (const WallContact &contact : wall.contacts)
    {
      const double gap = wall_gap(wall, contact, state().grains);
      nearest = std::min(nearest, gap);
      if (gap < 0.)
      {
        reaction -= contact.weight * contact.stiffness * gap;
        stiffness += contact.weight * contact.stiffness;
      }
    }
    const double left = bearing.load - reaction;
    if (std::abs(left) <= 1e-12 * bearing.load)
      return;
    // Away from all grains: up to the nearest, and a little into it.
    wall.displacement += stiffness > 0. ? left / stiffness
                                        : nearest + 1e-9 * state().grains.radius.front();
  }
}

void WalledGrains::add_outer_forces()
{
  if (on_evaluation)
    on_evaluation();
  for (BearingWall &bearing : walls_)
  {
    if (walls_follow_ && bearing.is_loaded)
      follow_load(bearing);
    add_wall_forces(state().grains, *bearing.wall);
  }
}

void WalledGrains::add_outer_forces_on(const Grains &grains,
                                       const std::vector<std::int32_t> &local,
                                       const std::size_t n,
                                       Eigen::VectorXd &force) const
{
  for (const BearingWall &bearing : walls_)
    for (WallContact contact : bearing.wall->contacts)
    {
      contact.grain = local[contact.grain];
      if (contact.grain < 0 || contact.grain >= static_cast<std::int32_t>(n))
        continue;
      const double push = wall_force(*bearing.wall, contact, grains);
      force[3 * contact.grain] += push * bearing.wall->normal.x;
      force[3 * contact.grain + 1] += push * bearing.wall->normal.y;
    }
}

const Eigen::VectorXd &WalledGrains::residual()
{
  GrainBalance::residual();
  for (std::size_t w = 0; w < walls_.size(); ++w)
  {
    const double reaction = walls_[w].wall->reaction;
    residual_[unknown(w)] = walls_[w].is_loaded ? walls_[w].load - reaction : 0.;
    support_[unknown(w)] = walls_[w].is_loaded ? 0. : reaction;
  }
  return residual_;
}

BalanceRatios WalledGrains::ratios() const
{
  double worst = 0.;
  for (const BearingWall &bearing : walls_)
    if (bearing.is_loaded)
      worst = std::max(worst, std::abs(bearing.load - bearing.wall->reaction));
  return ratios_with(worst);
}

void WalledGrains::move(const Eigen::VectorXd &increment)
{
  GrainBalance::move(increment);
  for (std::size_t w = 0; w < walls_.size(); ++w)
    walls_[w].wall->displacement += increment[unknown(w)];
}

double WalledGrains::load_work(const Eigen::VectorXd &increment) const
{
  double work = GrainBalance::load_work(increment);
  for (std::size_t w = 0; w < walls_.size(); ++w)
    if (walls_[w].is_loaded)
      work += walls_[w].load * increment[unknown(w)];
  return work;
}

std::vector<double> WalledGrains::ground_stiffness() const
{
  std::vector<double> sum(state().grains.size(), 0.);
  for (const BearingWall &bearing : walls_)
    for (const WallContact &contact : bearing.wall->contacts)
      sum[contact.grain] += contact.weight * contact.stiffness;
  return sum;
}

HeldResult WalledGrains::settle(const HeldDynamics &settings, const RestGoal &goal)
{
  double before = 0., after = 0.; // work of the walls' loads since their start [J]
  for (const BearingWall &bearing : walls_)
    before += bearing.is_loaded ? bearing.load * bearing.wall->displacement : 0.;
  // A wall that starts out of balance jumps to it: what its load does beyond the springs'
  // energy is lost. From then on it goes with the grains.
  double lost = 0.;
  for (BearingWall &bearing : walls_)
    if (bearing.is_loaded)
    {
      const discrete::Wall &wall = *bearing.wall;
      const double energy = wall_energy(state().grains, wall), place = wall.displacement;
      follow_load(bearing);
      lost += bearing.load * (wall.displacement - place) -
              (wall_energy(state().grains, wall) - energy);
    }
  walls_follow_ = true;
  HeldResult result = coupling::settle(*this, settings, goal);
  walls_follow_ = false;
  result.dissipated += lost;
  for (const BearingWall &bearing : walls_)
    after += bearing.is_loaded ? bearing.load * bearing.wall->displacement : 0.;
  result.load_work += after - before;
  return result;
}
} // namespace antiform::coupling

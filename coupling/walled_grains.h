#pragma once

#include "coupling/grain_balance.h"
#include "coupling/held_dynamics.h"
#include "discrete/walls.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace antiform::coupling
{
/// What a wall does to the grains that it bears on: it goes with the load parameter, or
/// presses with a force that does not change.
struct BearingWall
{
  discrete::Wall *wall = nullptr;
  double rate = 0.;       ///< inward way per unit of the load parameter [m]
  bool is_loaded = false; ///< it moves freely under `load` instead
  double load = 0.;       ///< inward [N]
};

/// Bonded grains between rigid frictionless walls, in balance. The place of a wall is an
/// unknown more, behind those of the grains: prescribed, or free under its load. Contacts
/// of a wall push only; the operator has the springs of all that had pressed when it was
/// last assembled, at the beginning of a load step, so that it is no softer than the body
/// but for contacts that close within one.
class WalledGrains : public GrainBalance
{
public:
  /// \param state  referred to, as the walls are
  /// \param held   what holds grains beside the walls; it must keep the body from moving
  ///               along them. Throws NumericalError where it does not.
  WalledGrains(GrainState &state,
               std::vector<BearingWall> walls,
               const std::vector<PrescribedMotion> &held,
               std::vector<OperatorSpring> operator_springs = {});

  const Eigen::VectorXd &residual() override;
  /// A free wall out of balance counts as a grain that is.
  BalanceRatios ratios() const override;
  void move(const Eigen::VectorXd &increment) override;
  double load_work(const Eigen::VectorXd &increment) const override;
  std::vector<double> ground_stiffness() const override;
  void add_outer_forces_on(const discrete::Grains &grains,
                           const std::vector<std::int32_t> &local,
                           std::size_t n,
                           Eigen::VectorXd &force) const override;

  /// To be followed by assemble_walls() where walls are held or let go.
  std::vector<BearingWall> &walls() { return walls_; }
  /// The operator of the walls as they are now. \return whether a contact has joined it
  void assemble_walls();
  /// Contacts with grains that have come within @p reach of a wall [m]; the operator
  /// follows where some press that it does not have. \param modulus E* by region [Pa]
  /// \return whether the operator has changed
  bool find_contacts(double reach, const std::vector<double> &modulus);
  /// The operator's contacts, and with them the contacts found on the way: state that a
  /// checkpoint must have beside the walls.
  void visit_state(StateArchive &archive);

  /// Explicit motion from rest, as settle() of bare grains; free walls without mass.
  HeldResult settle(const HeldDynamics &settings, const RestGoal &goal);

  /// Called at each evaluation of the forces; may throw, and the body is lost then.
  std::function<void()> on_evaluation;

private:
  void add_outer_forces() override;
  /// Move a free wall without mass to where it carries its load.
  void follow_load(BearingWall &bearing) const;
  bool add_pressing_contacts();
  Eigen::Index unknown(std::size_t wall) const
  {
    return static_cast<Eigen::Index>(3 * state().grains.size() + wall);
  }

  std::vector<BearingWall> walls_;
  std::vector<std::vector<std::int32_t>> in_operator_; ///< grains of each wall, ascending
  bool walls_follow_ = false; ///< free walls move as the grains do (explicit motion)
};
} // namespace antiform::coupling

#pragma once

#include "coupling/bridged_balance.h"
#include "coupling/event_driver.h"
#include "coupling/joining_components.h"
#include "coupling/simulation.h"
#include "coupling/walled_grains.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace antiform::coupling
{
/// Loads a scene of grains, or of grains joined to a mesh, from one state of balance to
/// the next (EventDriver): a step of the simulation is a load step and the balance after
/// it, and there is no time. A pressure on all sides comes up first, in even steps,
/// before the ends shorten or extend the section.
class EventLoading : public Component
{
public:
  struct Options
  {
    DriverSettings driver;
    double target = 0.;          ///< of the load parameter: shortening, or extension [-]
    double pressure = 0.;        ///< on all sides before [Pa]
    double height = 0.;          ///< of an end [m]
    double length = 0.;          ///< of a side, and that for a shortening of 1 [m]
    double reach = 0.;           ///< of the walls' search for contacts [m]
    std::vector<double> modulus; ///< E* by region [Pa]
    /// Load steps between two looks at the stability of the balance; 0: none.
    std::int64_t stability_interval = 0;
  };

  /// \param ends   walls that shorten the section, or none; referred to, as the sides are
  /// \param sides  walls that keep the pressure, or none
  /// \param held   what holds or moves grains beside them
  /// \param mesh,domain what the grains are joined to; null: nothing. The ends, without
  ///               sides and pressure, take the mesh's prescribed dofs with them
  EventLoading(GrainState &state,
               std::vector<discrete::Wall> &ends,
               std::vector<discrete::Wall> &sides,
               const std::vector<PrescribedMotion> &held,
               MeshState *mesh,
               BridgingDomain *domain,
               const Options &options);

  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  /// Shortening of the section, or its extension, since the pressure stands [-].
  double load() const { return driver_->load(); }
  /// Work per unit of it, over the length that it counts on: force of an end [N].
  double force() const { return body().conjugate_force() / options_.length; }
  BalanceRatios ratios() const { return body().ratios(); }
  /// Largest of all records.
  const BalanceRatios &worst_ratios() const { return worst_; }
  const DriverReport &report() const { return driver_->report(); }
  /// Load at which the balance was first found to be unstable with its walls held
  /// (n_unstable_directions()); later than it happened by up to the interval.
  std::optional<double> unstable_from() const { return unstable_from_; }
  /// For what an end carries.
  Walls &walls() { return walls_; }
  /// Called at each evaluation of the forces; may throw to give up the load step at hand.
  void set_watch(std::function<void()> watch)
  {
    grains().on_evaluation = std::move(watch);
  }

private:
  std::vector<BearingWall> bearing_walls();
  BalanceOperator &body();
  const BalanceOperator &body() const;
  WalledGrains &grains() { return alone_ ? *alone_ : bridged_->grains(); }
  void load_next();
  void press();
  void look_at_stability();

  GrainState &state_;
  MeshState *mesh_;
  BridgingDomain *domain_;
  std::vector<discrete::Wall> &ends_, &sides_;
  Options options_;
  std::optional<WalledGrains> alone_;     ///< without a mesh
  std::optional<BridgedBalance> bridged_; ///< with one
  std::optional<EventDriver> driver_;
  // Their arrays in a checkpoint, and what the walls carry, are those of explicit motion.
  GrainMotion motion_;
  std::optional<MeshMotion> mesh_motion_;
  Bonds bonds_;
  Walls walls_;
  // State.
  std::int64_t pressure_steps_ = 0; ///< done
  bool has_begun_ = false;          ///< the body without load has been recorded
  BalanceRatios worst_;
  std::optional<double> unstable_from_;
};
} // namespace antiform::coupling

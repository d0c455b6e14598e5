#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/grain_components.h"
#include "coupling/mesh_components.h"
#include "coupling/simulation.h"
#include "discrete/integrate.h"
#include "discrete/walls.h"

#include <functional>
#include <vector>

namespace antiform::coupling
{
/// The constraint of the bridging domain on the half-step velocities.
class Bridging : public Component
{
public:
  Bridging(BridgingDomain &domain, GrainState &grains, MeshState &mesh)
      : domain_(domain)
      , grains_(grains)
      , mesh_(mesh)
  {
  }
  void run(Stage, const Clock &) override
  {
    domain_.project(grains_.grains, mesh_.velocity);
  }

private:
  BridgingDomain &domain_;
  GrainState &grains_;
  MeshState &mesh_;
};

/// Unbalanced forces over the mean force of a joint [-]; without grains both are the norm
/// of the mesh' free forces over that of its internal forces.
struct UnbalancedRatio
{
  double mean = 0., largest = 0.;
};

/// Turns the forces into the constrained forces r = f - C^T L, which vanish at rest on
/// grains and nodes that carry multipliers, and records the unbalanced ratio. Any part
/// may be absent.
class ConstrainedForces : public Component
{
public:
  ConstrainedForces(GrainState *grains,
                    MeshState *mesh,
                    const BridgingDomain *domain,
                    bool at_samples_only)
      : grains_(grains)
      , mesh_(mesh)
      , domain_(domain)
      , at_samples_only_(at_samples_only)
  {
  }
  void run(Stage stage, const Clock &clock) override;

  /// Mean free force over mean joint force of the last sample [-]; without grains the
  /// norm of the mesh' free forces over that of its internal forces.
  double unbalanced_ratio() const { return ratio_; }
  /// Of the present forces; after run() in a step for which Clock::balance_due. Collective.
  UnbalancedRatio measure() const;

private:

  GrainState *grains_;
  MeshState *mesh_;
  const BridgingDomain *domain_;
  bool at_samples_only_;
  double ratio_ = 0.;
};

/// Local or combined damping of grains and mesh (GrainDamping), on the constrained
/// forces. It kicks the grains as it damps them; its turn comes after GrainMotion's.
class LocalDamping : public Component
{
public:
  LocalDamping(GrainState *grains,
               MeshState *mesh,
               double coefficient,
               bool combined = false);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  const std::vector<double> *mesh_forces() const { return &mesh_force_; }

private:
  void damp_mesh(double dt);

  GrainState *grains_;
  MeshState *mesh_;
  double coefficient_;
  discrete::GrainDamping grain_damping_;
  std::vector<double> mesh_force_, mesh_before_;
  double mesh_energy_ = 0.; ///< removed so far [J]
};

/// Rigid frictionless walls at the ends of the section: contact of the grains, prescribed
/// dofs of the mesh, motion, reactions and work. With grains alone they may turn.
class Walls : public Component
{
public:
  /// \param speed inward speed of each wall at a time [m/s]
  Walls(std::vector<discrete::Wall> &walls,
        GrainState *grains,
        MeshState *mesh,
        const BridgingDomain *domain,
        std::function<double(double)> speed);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  /// Mean over the walls of the force that presses on grains of @p region, and on the
  /// mesh [N].
  double grain_reaction(int region) const;
  /// \return that of the whole mesh, or of the layer's part of it; collective
  double mesh_reaction(bool of_layer = false) const;
  /// Shortening of the section so far, preloading left out: inward displacement of all
  /// walls [m].
  double closure() const;

  /// Let the walls that can (discrete::Wall::turn) turn, in the sense that presses the
  /// section's lower side. \param spin of each wall at a time [rad/s]
  void turn(std::function<double(double)> spin) { spin_ = std::move(spin); }
  /// Means over walls that turn, positive where the lower side is pressed [rad], [N m].
  double rotation() const;
  double moment() const;

  /// Until a time the walls follow a speed that depends on their reactions (a pressure is
  /// put on); only then shortening begins.
  struct Preload
  {
    double until = 0.; ///< [s]
    std::function<double(const discrete::Wall &, const Clock &)> speed;
  };
  void preload(Preload preload) { preload_ = std::move(preload); }

  /// Give mesh_reaction() as the mean of this many steps: the forces of a sub-cycled mesh
  /// come as impulses.
  void average_over(const std::int64_t steps) { averaged_ = steps; }

private:
  void set_speeds(const Clock &clock);
  void react(const Clock &clock);
  double way() const; ///< inward displacement of all walls [m]

  std::vector<discrete::Wall> &walls_;
  GrainState *grains_;
  MeshState *mesh_;
  const BridgingDomain *domain_;
  std::function<double(double)> speed_, spin_;
  Preload preload_;
  std::int64_t averaged_ = 1; ///< steps
  double closure_before_ = 0.; ///< way of the walls when shortening begins [m]
  double support_work_ = 0.;   ///< of the prescribed mesh dofs [J]
};
} // namespace antiform::coupling

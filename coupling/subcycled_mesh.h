#pragma once

#include "coupling/mesh_components.h"
#include "coupling/simulation.h"

#include <cstdint>

namespace antiform::coupling
{
/// Mesh whose forces are evaluated every n steps of the grains only and act as one
/// impulse n dt F there; velocities are projected on the constraint and positions move in
/// every step. In place of MeshMotion. Damping of the overlap (OverlapDamping) belongs to
/// it: without any the impulses may meet a resonance of the mesh.
///
/// Stages forces (rank of the mesh), damp (below every other rank of that stage), kick
/// and drift. Forces that other components add to the mesh at stage forces are part of
/// the impulse, so constant ones only may be added (they are put on in every n-th step,
/// times n). The energies of the ledger are exact to second order in n dt at the steps
/// that are multiples of n, in which records are to be taken.
class SubcycledMesh : public MeshMotion
{
public:
  /// Largest n dt over the stable step of the weighted mesh.
  static constexpr double largest_share = 0.3;

  /// \param interval  n >= 1
  /// \param mesh_step stable step of the mesh with the masses of the run [s]
  /// Throws NumericalError when n > 1 and n dt is above 0.3 of it, std::invalid_argument
  /// when n < 1.
  SubcycledMesh(MeshState &state,
                const std::vector<discrete::Wall> &walls,
                std::int64_t interval,
                double dt,
                double mesh_step);
  void run(Stage stage, const Clock &clock) override;

private:
  bool is_due(const Clock &clock) const { return clock.step % interval_ == 0; }

  MeshState &state_;
  std::int64_t interval_;
};

/// Watches the energy ledger of a run whose scheme does not conserve it exactly: throws
/// NumericalError at a sample when stored and spent energy exceed the first sample's and
/// the work since by more than a fraction of the largest energy so far. Losses pass.
/// Stage sample, on one rank.
class EnergyWatch : public Component
{
public:
  EnergyWatch(const Simulation &simulation, double largest_growth)
      : simulation_(simulation)
      , largest_growth_(largest_growth)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void visit_state(StateArchive &archive) override;

  /// Balance of the last sample over the largest energy so far [-]; positive: growth.
  double growth() const { return growth_; }

private:
  const Simulation &simulation_;
  double largest_growth_;
  double has_first_ = 0.; ///< 1 once a sample was seen
  double first_ = 0.;     ///< stored and spent less work at the first sample [J]
  double largest_ = 0.;   ///< stored so far [J]
  double growth_ = 0.;
};
} // namespace antiform::coupling

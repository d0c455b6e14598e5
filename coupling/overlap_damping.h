#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/grain_components.h"
#include "coupling/mesh_components.h"
#include "coupling/simulation.h"

#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// Absorbs in the overlap what the mesh cannot take: the force
///   -eta_i (v_i - sum_K N_K(x_i) V_K),   eta_i = rate mu_i m_i (inertial mass),
/// on every grain that has part in the constraint, and its opposite on the nodes. Waves
/// that the mesh follows are left alone, since the grains move with it then; total
/// momentum is kept. A rate of about 0.05 c/d, c the speed of P waves, stops the growth
/// that sub-cycling causes.
///
/// The velocities are those of the last half step, so a motion of angular frequency omega
/// has the stable step of one without damping times sqrt(1 + z^2) - z, z = rate/(2
/// omega): 1 % less for the rate above.
///
/// Stages damp (rank below the constrained forces) and drift.
class OverlapDamping : public Component
{
public:
  /// \param rate [1/s]; throws std::invalid_argument when it is negative
  OverlapDamping(const BridgingDomain &domain,
                 const continuum::ElasticSolid &solid,
                 GrainState &grains,
                 MeshState &mesh,
                 double rate);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override { energies.damping += energy_; }
  void visit_state(StateArchive &archive) override;

private:
  /// Velocity of overlap grain @p k relative to the mesh [m/s].
  Vec2 slip(std::size_t k) const;
  void book_half_step(double dt);

  const std::vector<std::int32_t> &overlap_grains_;
  GrainState &grains_;
  MeshState &mesh_;
  double rate_;
  std::vector<continuum::PointEvaluation> shape_; ///< at each overlap grain
  std::vector<Vec2> force_;                       ///< on each overlap grain [N]
  double energy_ = 0.;                            ///< taken so far [J]
};
} // namespace antiform::coupling

#pragma once

#include "continuum/absorbing_boundary.h"
#include "coupling/mesh_components.h"

#include <vector>

namespace antiform::coupling
{
class BridgingDomain;

/// Dashpots on far faces of the mesh (continuum/absorbing_boundary.h). Their force is
/// that of the mean velocity of the step, -C (v- + v+) / 2, solved for node by node: the
/// stable step stays that of the mesh without them, whatever C, since in every step they
/// take v.C v >= 0 of that mean. Prescribed dofs keep their motion; the dashpot's force
/// is then part of the reaction of their support.
///
/// Stages damp, kick and drift. At the kick its rank must be above that of the mesh's
/// motion, since it corrects what that has done. For real masses: scaled ones do not
/// match the impedance.
class AbsorbingBoundary : public Component
{
public:
  /// \param domain bridging domain of the mesh, or null. Throws std::invalid_argument
  ///               where a node has both a dashpot and a multiplier: the projection would
  ///               undo the dashpot's work.
  AbsorbingBoundary(MeshState &state,
                    std::vector<continuum::NodalDashpot> dashpots,
                    const BridgingDomain *domain = nullptr);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override { energies.damping += energy_; }
  void visit_state(StateArchive &archive) override;

private:
  struct Node
  {
    continuum::NodalDashpot dashpot;
    double velocity_x = 0., velocity_y = 0.; ///< before the kick [m/s]
    double force_x = 0., force_y = 0.;       ///< of the last kick [N]
  };
  /// Take the dashpot's share of the kick from the node's velocity.
  void correct(Node &node, double dt);

  MeshState &state_;
  std::vector<Node> nodes_;
  double energy_ = 0.; ///< taken so far [J]
};
} // namespace antiform::coupling

#pragma once

#include "coupling/grain_components.h"
#include "coupling/mesh_components.h"
#include "coupling/simulation.h"
#include "coupling/surface_contact.h"
#include "coupling/surface_tie.h"

#include <string>

namespace antiform::coupling
{
/// The tie of layer and mesh in the loop: constrained forces at `damp`, before damping
/// and unbalanced force are taken, projection at `constrain`. What it does to prescribed
/// dofs it adds to their force, where the walls look for it.
class TiedSurface : public Component
{
public:
  /// \param at_samples_only constrain forces at samples only: nothing is damped
  /// \param follow_every    steps after which the tie follows the deformed edge; 0: never
  TiedSurface(SurfaceTie &tie,
              GrainState &grains,
              MeshState &mesh,
              const bool at_samples_only,
              const int follow_every = 0)
      : tie_(tie)
      , grains_(grains)
      , mesh_(mesh)
      , at_samples_only_(at_samples_only)
      , follow_every_(follow_every)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void visit_state(StateArchive &archive) override;

private:
  SurfaceTie &tie_;
  GrainState &grains_;
  MeshState &mesh_;
  bool at_samples_only_;
  int follow_every_;
};

/// Contact of layer and mesh in the loop: forces after those of bonds and mesh.
class SurfaceContactForces : public Component
{
public:
  /// \param name of the checkpoint's arrays, one for each contact of a scene
  SurfaceContactForces(SurfaceContact &contact,
                       GrainState &grains,
                       MeshState &mesh,
                       std::string name = "surface")
      : contact_(contact)
      , grains_(grains)
      , mesh_(mesh)
      , name_(std::move(name))
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

private:
  SurfaceContact &contact_;
  GrainState &grains_;
  MeshState &mesh_;
  std::string name_;
};
} // namespace antiform::coupling

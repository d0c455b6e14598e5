#pragma once

#include "cases/effects.h"
#include "cases/geometry.h"
#include "cases/grain_section.h"
#include "cases/parameters.h"
#include "cases/surface_join.h"
#include "continuum/elastic_solid.h"
#include "coupling/bridging_domain.h"
#include "coupling/event_loading.h"
#include "coupling/grain_components.h"
#include "coupling/joining_components.h"
#include "coupling/membrane_load.h"
#include "coupling/mesh_components.h"
#include "coupling/simulation.h"
#include "coupling/specimen_components.h"
#include "coupling/step_and_relax.h"
#include "discrete/contacts.h"

#include <mpi.h>

#include <memory>
#include <optional>

namespace antiform::cases
{
/// What a deck has been built into: the state, and the simulation that moves it. Absent
/// parts are empty.
struct Scene
{
  explicit Scene(const Parameters &p)
      : parameters(p)
      , geometry(p)
  {
  }

  Parameters parameters;
  SectionGeometry geometry;

  std::optional<GrainSection> grains;
  discrete::Contacts contacts;
  std::vector<discrete::Wall> walls;

  std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> triangulation;
  std::unique_ptr<continuum::ElasticSolid> solid;
  std::optional<coupling::MeshState> mesh;
  // What joins grains and mesh, one of them or none.
  std::unique_ptr<coupling::BridgingDomain> bridging;
  std::unique_ptr<SurfaceJoin> surface;

  std::vector<double> mass_weight; ///< mu of each grain; empty: 1

  std::unique_ptr<coupling::Simulation> simulation;
  std::vector<discrete::Wall> side_walls; ///< of a confined specimen

  // What loads the ends, one of them or none.
  coupling::Walls *wall_motion = nullptr;
  coupling::Grips *grips = nullptr;
  coupling::MembraneLoad *membrane = nullptr;
  coupling::StepAndRelax *load_steps = nullptr; ///< null at a constant rate
  coupling::EventLoading *events = nullptr; ///< null where the scene steps in time

  coupling::ConstrainedForces *constrained = nullptr;
  bool breakage_components = false; ///< friction, contacts and search have joined

  double dt0 = 0.;             ///< of density scaling [s]
  double transit_time = 0.;    ///< of an axial wave along the layer [s]
  double shortening_rate = 0.; ///< at full speed [1/s]

  /// Closure over the section's length, or minus the extension over the length between
  /// the grips [-].
  double shortening() const;
  /// 1 where the section is shortened, -1 where it is extended: what grows.
  double loading_sign() const { return pulls() ? -1. : 1.; }
  /// By grips.
  bool pulls() const { return parameters.has("walls") && parameters.walls.pulls(); }
  /// Mean rotation of walls that turn, positive where the lower side is pressed [rad].
  double rotation() const;
  /// What counts as strain of the loading and grows: shortening, extension, or of walls
  /// that turn h/L times their rotation [-].
  double strain() const;
  /// By which field files are told apart: the shortening [-], or the rotation of walls
  /// that turn [degrees].
  double field_time() const;
  /// Mean of the forces with which the grips pull [N].
  double tension() const;
  /// Mean unbalanced force over the mean force of a joint, of the last record [-].
  double unbalanced_ratio() const;
  std::size_t n_multipliers() const;
  /// Largest displacement gap of what keeps grains and mesh together [m].
  double displacement_gap() const;
  /// The constraints of grains and mesh for their present inertial masses.
  void factorise_constraints();
  MPI_Comm communicator() const;
  /// Friction, contacts and search, which the first broken bond calls for.
  void add_breakage_components();
  /// Components' arrays; joins the breakage components first where the state has them.
  void visit_state(coupling::StateArchive &archive);
};

/// The bodies of a checked deck's scene, and what joins them, at rest: no simulation.
/// Throws as build().
std::unique_ptr<Scene> build_bodies(const Parameters &parameters,
                                    MPI_Comm communicator,
                                    const Progress &progress);

/// Build the scene of a checked deck. Throws InputError for what only the packing can
/// tell (a Poisson ratio out of reach), NumericalError for a constraint that is singular.
std::unique_ptr<Scene>
build(const Parameters &parameters, MPI_Comm communicator, const Progress &progress);
} // namespace antiform::cases

#pragma once

#include "continuum/contact_laws.h"
#include "coupling/static_system.h"
#include "coupling/surface_interface.h"
#include "discrete/grains.h"

#include <array>
#include <functional>
#include <vector>

namespace antiform::coupling
{
/// Contact of a layer's outer grains with the edge of a mesh, by the laws between strips
/// of mesh (continuum/contact_laws.h) at one point a grain: frictional, frictionless, or
/// sliding (docs/theory/surface_interface.md). Penalty, in the present configuration:
///   opening = |x_i - x_e| - D_i,  x_e the place of the edge nearest to the centre x_i,
/// D_i their distance as built, and slip the way of the grain's material at x_e along the
/// edge's, rolling included. Force on the grain at x_e, the opposite on the edge's nodes
/// by their shape functions there: so momentum and angular momentum are kept. At the end
/// of the edge grains roll off its corner. Tractions are per length l_i of the reference
/// edge that the grain stands for; a grain takes it along as it slides. One rank.
class SurfaceContact
{
public:
  /// What the grains do to a mesh on which they are laid down in touch, at a place of the
  /// edge with this normal (from the mesh to the grain): the stress times the normal
  /// [Pa].
  using InitialTraction = std::function<Vec2(const Vec2 &place, const Vec2 &normal)>;

  /// Throws std::invalid_argument for stiffnesses that are not > 0, friction or cohesion
  /// below 0, an initial traction that the law does not carry, and a grain whose centre
  /// lies on the edge or behind it.
  SurfaceContact(SurfaceInterface interface,
                 const continuum::ContactLaw &law,
                 const InitialTraction &initial = {});

  const SurfaceInterface &interface() const { return interface_; }

  /// Add the forces of the present positions to grains and @p mesh_force, and let slip go
  /// on by a step. Throws NumericalError when a grain's centre goes through the edge.
  /// \param mesh_velocity half-step velocities that led here from @p dt ago [m/s]; with
  ///                      dt = 0 slip stays. All by local dof.
  void add_forces(discrete::Grains &grains,
                  const continuum::Vector &displacement,
                  const continuum::Vector &mesh_velocity,
                  double dt,
                  continuum::Vector &mesh_force);

  /// One entry a point, of the last evaluation.
  struct State
  {
    EdgeCurve::Place place;
    Vec2 normal; ///< from the mesh to the grain
    continuum::ContactGap gap;
    continuum::ContactTraction traction; ///< mesh by grain, tension positive [Pa]
    continuum::ContactPhase phase = continuum::ContactPhase::open;
    double slip_at_rest = 0.; ///< the law's [m]
    double dissipated = 0.;   ///< by slip so far [J]
  };
  const std::vector<State> &states() const { return states_; }
  /// For a checkpoint.
  std::vector<State> &history() { return states_; }

  double elastic_energy() const; ///< since it was built [J]
  double slip_energy() const;    ///< dissipated so far [J]

  /// Springs of the linearised contact as built: closed, frictional ones sticking.
  void add_to(StaticSystem &system) const;

  /// Add each contact's stiffness, as if closed and sticking: to the sums of its grain,
  /// and to the mesh's row sums by local dof, twice k N for a node [N/m]. Masses scaled
  /// with these sums to a step are stable at it.
  void add_stiffness(discrete::StiffnessSums &grain_sums,
                     std::vector<double> &mesh_row_sums) const;

  /// Largest angular frequency of a contact alone, squared, on its share of the inertia
  /// of its grain and nodes, sums being those of all stiffness [rad^2/s^2].
  double square_of_frequency(std::size_t point,
                             const discrete::Grains &grains,
                             const discrete::StiffnessSums &grain_sums,
                             const continuum::Vector &inverse_mass,
                             const std::vector<double> &row_sums) const;

private:
  /// Elongations of a contact's springs, at its present place.
  struct Springs
  {
    LinearForm normal, tangential;
  };
  Springs springs(std::size_t point) const;
  /// What a node with N = 1 there has of row sums; others have their share N.
  double node_stiffness(std::size_t point) const;
  double slip_increment(const discrete::Grains &grains,
                        std::size_t point,
                        const State &before,
                        const double *velocity,
                        double dt) const;
  void respond(std::size_t point);

  SurfaceInterface interface_;
  continuum::ContactLaw law_;
  double normal_stiffness_, shear_stiffness_ = 0.; ///< [Pa/m]
  std::vector<continuum::ContactTraction> initial_;
  std::vector<State> states_;
};

/// Rigorous stable step of leapfrog for grains, joints, mesh and the contacts between,
/// which all count as closed and sticking: grains and nodes share their inertia among
/// joints or cells on one side and contacts on the other in proportion to stiffness
/// (Irons' theorem); then 2 / omega of the worst of the three. No safety factor.
double surface_stable_step(const discrete::Grains &grains,
                           const discrete::Joints &joints,
                           const continuum::ElasticSolid &solid,
                           const continuum::Vector &inverse_mass,
                           const std::vector<const SurfaceContact *> &contacts);
} // namespace antiform::coupling

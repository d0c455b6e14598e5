#pragma once

#include "continuum/elastic_solid.h"
#include "coupling/constraint_solver.h"
#include "coupling/distributed_system.h"
#include "coupling/grain_ties.h"
#include "coupling/multiplier_space.h"
#include "coupling/overlap_weight.h"
#include "discrete/grains.h"
#include "discrete/joints.h"

#include <memory>
#include <optional>
#include <vector>

namespace antiform::coupling
{
/// Choices of a bridging domain.
struct BridgingOptions
{
  MultiplierSpace multipliers = MultiplierSpace::mesh;
  /// Grains that follow the mesh in all (unsupported_grains()) in place of taking part in
  /// the constraint.
  std::vector<std::int32_t> tied_grains;
};

/// Joins grains and mesh in an overlap (docs/theory/bridging.md). The multiplier J
/// lives on a vertex of the mesh and demands, for x and for y,
///   g_J = sum_i m_i N_J(x_i) (d_i - sum_K N_K(x_i) U_K) = 0,
/// the sum going over the grains of the overlap with their real masses; other spaces of
/// multipliers take other functions than N_J. Rotations are free. Topology and reference
/// positions are those of construction.
///
/// On several ranks every rank has all grains, with the same bits, and its part of the
/// mesh. A multiplier belongs to the rank that owns its vertex; S is assembled and
/// factorised by all, and every rank gets all of L, for its grains. Construction and all
/// that takes vectors of the mesh are collective there.
class BridgingDomain
{
public:
  /// \param solid already weighted by weight.mesh()
  /// \param smallest_mass a vertex is a multiplier when the grains give it more than this
  ///                      mass; coupling design: 0.02 rho h^2 [kg]
  /// Throws as constraint_rows() does.
  BridgingDomain(const discrete::Grains &grains,
                 const discrete::Joints &joints,
                 const continuum::ElasticSolid &solid,
                 OverlapWeight weight,
                 double smallest_mass,
                 const BridgingOptions &options = {});

  /// Mass weight of each grain: mu_i = max(w_D(x_i), w_D of its joints); the largest
  /// joint weight keeps the stable step of the uncoupled grains.
  const std::vector<double> &grain_mass_weight() const { return mu_; }
  /// Lumped real mass of the mesh with the grains' surplus (mu_i - w_D) taken off, at
  /// least half the weighted mass, and with the weighted mass of tied grains [kg].
  const continuum::Vector &mesh_mass() const { return mesh_mass_; }

  /// Grains that follow the mesh in all. With any, the loop needs TiedGrains and, once
  /// the inertial masses are set, ties().hold().
  const GrainTies &ties() const { return ties_; }

  /// Build and factorise S = C_D Mi_D C_D^T + C_C Mi_C C_C^T for the inertial masses.
  void factorise(const discrete::Grains &grains, const continuum::Vector &inverse_mass);

  /// Whether the overlap's grains have the masses that S was factorised for.
  bool is_factorised_for(const discrete::Grains &grains) const;

  /// Project half-step velocities onto the constraint: v -= Mi C^T L, S L = C v;
  /// tied grains get the velocities of the mesh.
  void project(discrete::Grains &grains, continuum::Vector &velocity);
  /// Impulses of the last project() on a mesh dof, (C_C^T L) [N s], by local
  /// index; dofs without multipliers: 0. The reaction of a prescribed dof needs it.
  double mesh_impulse(std::size_t dof) const;

  /// Constrained forces: @p fx, @p fy of the grains and @p mesh_force become
  /// f - C^T L with S L = C Mi f; at rest they vanish where f does not.
  void constrain_forces(const discrete::Grains &grains,
                        const continuum::Vector &inverse_mass,
                        std::vector<double> &fx,
                        std::vector<double> &fy,
                        continuum::Vector &mesh_force) const;

  /// Largest |g_J| over the multiplier's mass: the displacement gap [m].
  double displacement_gap(const discrete::Grains &grains,
                          const continuum::Vector &displacement) const;

  std::size_t n_multipliers() const { return 2 * rows_.grains.n_rows(); }
  /// Grains that carry multipliers, ascending; the columns of grain_rows().
  const std::vector<std::int32_t> &overlap_grains() const { return rows_.overlap_grains; }
  const OverlapWeight &weight() const { return weight_; }
  /// Constraint rows of the x components (those of y have the same values): multipliers
  /// by grains, and by the mesh nodes of this rank; node k has the dofs node_dofs()[k]
  /// (x, y; local indices).
  const SparseRows &grain_rows() const { return rows_.grains; }
  const SparseRows &mesh_rows() const { return rows_.nodes; }
  const std::vector<std::array<std::uint32_t, 2>> &node_dofs() const
  {
    return rows_.node_dofs;
  }
  /// Whether the multipliers of a row belong to this rank.
  bool owns_row(const std::size_t row) const { return rows_.is_own[row]; }

private:
  void weigh_masses(const discrete::Grains &grains,
                    const discrete::Joints &joints,
                    const continuum::ElasticSolid &solid,
                    const std::vector<GrainPlace> &places);
  /// This rank's share of S: its nodes, and the grains in its rows.
  template <class Matrix>
  Matrix constraint_matrix() const;
  /// Overwrite this rank's share of b by all of L.
  void solve(std::vector<double> &b) const;
  /// This rank's share of b = C (grain field, mesh field), by its nodes and by the grains
  /// in its rows: x multipliers, then y. The fields are functions of a grain's number and
  /// of a node's dofs.
  template <class GrainField, class MeshField>
  void apply(const GrainField &grain_field,
             const MeshField &mesh_field,
             std::vector<double> &b) const;
  /// Hands (C_D^T L) of each overlap grain and (C_C^T L) of each node to the functions.
  template <class ToGrain, class ToNode>
  void apply_transposed(const std::vector<double> &L,
                        const ToGrain &to_grain,
                        const ToNode &to_node) const;

  OverlapWeight weight_;
  GrainTies ties_;
  std::vector<double> mu_;
  continuum::Vector mesh_mass_;
  ConstraintRows rows_;                     ///< by multiplier
  SparseRows grain_columns_, mesh_columns_; ///< the same by overlap grain, by mesh node
  std::vector<double> grain_inverse_mass_;  ///< of the overlap grains, as factorised
  std::vector<std::array<double, 2>> node_inverse_mass_;
  std::vector<std::int32_t> node_of_dof_; ///< index into node_dofs(), or -1
  std::vector<double> multiplier_;        ///< L of the last projection
  MPI_Comm communicator_;
  bool is_alone_; ///< on one rank
  std::optional<ConstraintSolver> solver_;         ///< on one rank
  std::unique_ptr<DistributedSystem> distributed_; ///< on several
};

/// Weight of a joint: w_D at its contact point.
std::vector<double> joint_weights(const discrete::Grains &grains,
                                  const discrete::Joints &joints,
                                  const OverlapWeight &weight);
} // namespace antiform::coupling

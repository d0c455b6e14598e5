#pragma once

#include "continuum/elastic_solid.h"
#include "coupling/overlap_weight.h"
#include "coupling/simulation.h"
#include "discrete/grains.h"
#include "discrete/joints.h"

#include <cstdint>
#include <vector>

namespace antiform::coupling
{
struct GrainState;
struct MeshState;

/// Grains outside of the core that nothing but the constraint's means would hold, so that
/// the static system is singular and the loop carries free bodies, ascending:
/// - grains of a connected part of the joints' graph that has no grain in the core, those
///   without any joint among them;
/// - grains that could move while the grains that they are joined to rest (on one joint
///   that bears no moment they roll), and what hangs on these alone in turn.
/// A cluster that hangs on the rest by one joint with moments is supported. A joint
/// weighted by the floor of the weights counts like any other.
std::vector<std::int32_t> unsupported_grains(const discrete::Grains &grains,
                                             const discrete::Joints &joints,
                                             const OverlapWeight &weight);

/// A grain that follows the mesh in all: d = sum_K N_K U_K, theta = 1/2 curl of it. Every
/// rank has all ties, with the nodes that it owns.
struct GrainTie
{
  struct Node
  {
    std::uint32_t dof_x, dof_y; ///< local indices
    double value;          ///< N_K(x_i) [-]
    double by_x, by_y;     ///< its derivatives [1/m]
    double mass_share = 0; ///< of the grain's mass; not negative, also under Q2 cells [-]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive & dof_x & dof_y & value & by_x & by_y & mass_share;
    }
  };
  std::int32_t grain;
  std::vector<Node> nodes;

  template <class Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive & grain & nodes;
  }
};

/// Grains tied to the mesh. They have no inertia of their own: their weighted mass
/// belongs to the nodes (lumped; the spin's inertia, smaller by (d/h)^2, is left out) and
/// their forces go to the nodes, by the transpose of what moves them. So the work of a
/// force is the same on the grain and on the nodes, and momentum and angular momentum are
/// kept.
class GrainTies
{
public:
  GrainTies() = default;
  /// Throws std::out_of_range when a grain lies outside of the mesh. Collective.
  GrainTies(const discrete::Grains &grains,
            const continuum::ElasticSolid &solid,
            std::vector<std::int32_t> tied);

  const std::vector<GrainTie> &ties() const { return ties_; }
  bool empty() const { return ties_.empty(); }

  /// Take the grains' own inertia away (inverse masses 0). Once, after the masses are
  /// set.
  void hold(discrete::Grains &grains) const;
  /// Add the grains' forces and torques to the nodes; the grains' become zero.
  void move_forces(discrete::Grains &grains, continuum::Vector &mesh_force) const;
  /// Velocities and spins of the grains from those of the nodes. Collective.
  void follow(discrete::Grains &grains, const continuum::Vector &mesh_velocity) const;

  /// Per dof of the mesh sum |K| over the row that the tied grains' joints add to it, for
  /// mass scaling and the stable step [N/m]. On one rank.
  std::vector<double> absolute_row_sums(const discrete::Grains &grains,
                                        const discrete::Joints &joints,
                                        std::size_t n_dofs) const;

private:
  std::vector<GrainTie> ties_;
  MPI_Comm communicator_ = MPI_COMM_SELF;
};

/// Hands the forces of tied grains to the mesh. Stage damp, before the constrained forces
/// and every damping; the velocities follow at the bridging domain's projection.
class TiedGrains : public Component
{
public:
  TiedGrains(const GrainTies &ties, GrainState &grains, MeshState &mesh)
      : ties_(ties)
      , grains_(grains)
      , mesh_(mesh)
  {
  }
  void run(Stage stage, const Clock &clock) override;

private:
  const GrainTies &ties_;
  GrainState &grains_;
  MeshState &mesh_;
};
} // namespace antiform::coupling

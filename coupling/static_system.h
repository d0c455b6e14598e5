#pragma once

#include "continuum/elastic_solid.h"
#include "coupling/bridging_domain.h"
#include "coupling/linear_form.h"
#include "discrete/grains.h"
#include "discrete/joints.h"

#include <Eigen/SparseCore>

#include <map>
#include <vector>

namespace antiform::coupling
{
/// Displacements and rotations of grains, displacements of the mesh, and multipliers.
struct StaticSolution
{
  std::vector<double> ux, uy, rotation; ///< per grain [m], [rad]
  continuum::Vector mesh;               ///< [m]; empty without a mesh
  double residual = 0.; ///< largest |K u + C^T L - f| over the largest |f| or |K u| [-]
};

/// Matrices of a section before its supports are taken out. Unknown 3 i + c is component
/// c of grain i (x, y, rotation); the dofs of the mesh follow.
struct SaddlePoint
{
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix stiffness;     ///< springs included
  Matrix constraint;    ///< C, scaled; may have no rows
  double diagonal = 0.; ///< mean of the stiffness'
};

/// Linear static equilibrium of intact bonded grains, mesh and bridging domain: the
/// saddle-point system of the energies and the constraint, solved directly by Trilinos
/// (Amesos, MUMPS). Each constraint row is scaled to the mean diagonal of the grains.
/// Every part is optional; joint and mesh weights are those of the objects.
///
/// On several ranks the mesh is distributed and the grains are the same on all: what
/// concerns grains is said on every rank, a dof of the mesh is fixed by any rank, a force
/// on it is added by one. Springs and constraints by linear forms are for one rank.
class StaticSystem
{
public:
  StaticSystem(const discrete::Grains &grains,
               const discrete::Joints &joints,
               const continuum::ElasticSolid *solid,
               const BridgingDomain *bridging);

  /// Prescribe a displacement (component 0, 1) or rotation (2) of a grain, or a mesh dof.
  void fix_grain(std::size_t grain, unsigned int component, double value);
  void fix_mesh(std::size_t dof, double value);
  /// Spring to the ground on a grain [N/m].
  void add_grain_spring(std::size_t grain, unsigned int component, double stiffness);
  /// Spring along @p normal between the centres of two grains (a frictionless contact)
  /// [N/m].
  void
  add_pair_spring(std::size_t one, std::size_t two, const Vec2 &normal, double stiffness);
  /// Spring whose elongation is a linear form of grains and mesh [N/m]. Throws
  /// std::invalid_argument on several ranks, as add_constraint() does.
  void add_spring(const LinearForm &elongation, double stiffness);
  /// A linear form of grains and mesh that stays 0: a multiplier more.
  void add_constraint(const LinearForm &form);
  /// External force on a grain [N] (component 2: torque [N m]) or on a mesh dof [N].
  void add_grain_force(std::size_t grain, unsigned int component, double force);
  void add_mesh_force(std::size_t dof, double force);

  /// Throws NumericalError when the factorisation fails or the residual exceeds 1e-8.
  /// Collective.
  StaticSolution solve() const;

  /// This rank's share of the matrices. Collective.
  SaddlePoint saddle_point() const;
  /// Prescribed unknowns and their values, by the unknowns' numbers.
  const std::map<std::size_t, double> &fixed() const { return fixed_; }
  std::size_t index(const std::size_t grain, const unsigned int component) const
  {
    return 3 * grain + component;
  }
  /// This rank's entries of what ties a displacement (0, 1) or the rotation (2) of a
  /// grain.
  std::vector<std::pair<std::size_t, double>> tie_row(const GrainTie &tie,
                                                      unsigned int component) const;
  std::size_t mesh_begin() const { return 3 * grains_.size(); }
  std::size_t n_unknowns() const { return force_.size(); }
  const discrete::Grains &grains() const { return grains_; }
  const discrete::Joints &joints() const { return joints_; }
  /// Null without a mesh.
  const continuum::ElasticSolid *solid() const { return solid_; }
  /// Displacements in the unknowns @p x, all of them on every rank.
  StaticSolution solution_of(const Eigen::VectorXd &x) const;

private:
  const discrete::Grains &grains_;
  const discrete::Joints &joints_;
  const continuum::ElasticSolid *solid_;
  const BridgingDomain *bridging_;
  MPI_Comm communicator_;
  bool tells_grains_; ///< this rank has the rows of the grains
  std::map<std::size_t, double> fixed_;
  std::vector<double> spring_, force_;
  struct PairSpring
  {
    std::size_t one, two;
    Vec2 normal;
    double stiffness;
  };
  std::vector<PairSpring> pair_springs_;
  /// Linear forms by unknown; a spring's stiffness.
  using Terms = std::vector<std::pair<std::size_t, double>>;
  Terms terms(const LinearForm &form) const;
  void demand_one_rank() const;
  /// Constraint rows of the bridging domain, then of tied grains, then linear forms.
  std::size_t ties_begin() const;
  std::size_t forms_begin() const;
  /// Of joints and springs.
  std::vector<Eigen::Triplet<double>> grain_stiffness() const;
  /// This rank's part of C; @p diagonal mean of the stiffness'.
  SaddlePoint::Matrix constraint_share(double diagonal) const;
  /// Fixed unknowns of all ranks.
  std::map<std::size_t, double> all_fixed() const;
  std::vector<int> own_unknowns(std::size_t n_constraints) const;
  std::vector<std::pair<Terms, double>> form_springs_;
  std::vector<Terms> constraints_;
};

/// The linearised kinematics of joint @p j at rest: rows gap, shear, rotation over the
/// dofs (x, y, rotation) of its first and second grain.
std::array<std::array<double, 6>, 3> joint_rows(const discrete::Joints &joints,
                                                std::size_t j);
/// Stiffness of the three rows, weighted [N/m], [N/m], [N m].
std::array<double, 3> joint_stiffness(const discrete::Joints &joints, std::size_t j);
} // namespace antiform::coupling

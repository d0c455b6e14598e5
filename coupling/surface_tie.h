#pragma once

#include "coupling/constraint_solver.h"
#include "coupling/linear_form.h"
#include "coupling/static_system.h"
#include "coupling/surface_interface.h"

#include <Eigen/SparseCore>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Joins outer grains and mesh edges by multipliers in the edges' trace space, a mortar
/// (docs/theory/surface_interface.md): at each vertex J of an edge
///   g_J = sum_i l_i N_J(x_i) (d_i + theta_i z x a_i - sum_K N_K(x_i) U_K) = 0,
/// x and y where cemented, along the edge's normals n_i where sliding. x_i is the place
/// on the edge that faces grain i, a_i the arm from the grain's centre to it: rigid
/// motions of all leave no gap, and forces on grain and mesh act at one point. A row is
/// divided by the length sum_i l_i N_J(x_i), so that its multiplier L_J is a force [N];
/// the traction is linear between the values L_J over length. Kinematics are linear in
/// the rotation, as those of the mesh, unless follow() is asked to turn arms and normals.
/// One rank.
class SurfaceTie
{
public:
  enum class Kind
  {
    cemented, ///< keeps together in both directions
    sliding   ///< keeps together across the edge, carries no shear along it
  };

  /// \param interfaces which share no grain unless they are in one tie
  SurfaceTie(const discrete::Grains &grains,
             std::vector<SurfaceInterface> interfaces,
             Kind kind);

  Kind kind() const { return kind_; }
  const std::vector<SurfaceInterface> &interfaces() const { return interfaces_; }
  std::size_t n_multipliers() const { return rows_.size(); }
  /// The constraints, each a mean displacement gap [m]: divided by sum_i l_i N_J(x_i).
  const std::vector<LinearForm> &rows() const { return rows_; }
  void add_to(StaticSystem &system) const;

  /// Put the arms where grains and edges are now; where sliding, also find the places
  /// that the grains have slid to, and turn the normals with the edge. It needs
  /// factorise() afterwards.
  void follow(const discrete::Grains &grains, const continuum::Vector &displacement);

  /// Build and factorise S = C Mi C^T for the inertial masses; throws NumericalError
  /// where fewer than about two grains a cell face the edge.
  void factorise(const discrete::Grains &grains, const continuum::Vector &inverse_mass);
  /// Whether the grains have the masses that S was factorised for.
  bool is_factorised_for(const discrete::Grains &grains) const;

  /// Project half-step velocities onto the constraint: v -= Mi C^T L, S L = C v.
  void project(discrete::Grains &grains, continuum::Vector &velocity);
  /// Hand the impulse (C^T L) [N s] of the last project() on each mesh dof that the edge
  /// has to @p action(dof, impulse).
  void for_mesh_impulses(const std::function<void(std::uint32_t, double)> &action) const;

  /// Constrained forces: forces and torques of the grains and @p mesh_force become
  /// f - C^T L with S L = C Mi f; at rest they vanish where f does not.
  void constrain_forces(discrete::Grains &grains, continuum::Vector &mesh_force) const;

  /// Largest |g_J| over sum_i l_i N_J(x_i), linear kinematics [m].
  double displacement_gap(const discrete::Grains &grains,
                          const continuum::Vector &displacement) const;

private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  void build_rows(const discrete::Grains &grains, const double *displacement);
  /// Rows of one edge, @p displacement as EdgeCurve takes it.
  void build_rows(const SurfaceInterface &interface,
                  const std::vector<EdgeCurve::Place> &places,
                  const discrete::Grains &grains,
                  const double *displacement);
  Eigen::VectorXd gather(const std::vector<double> &x,
                         const std::vector<double> &y,
                         const std::vector<double> &rotation,
                         const double *mesh) const;
  std::vector<double> multipliers(const Eigen::VectorXd &field) const;

  Kind kind_;
  std::vector<SurfaceInterface> interfaces_;
  std::vector<std::vector<EdgeCurve::Place>> places_; ///< of each interface's points, now
  std::vector<LinearForm> rows_;
  std::vector<std::string> row_names_;
  /// Unknowns of the rows: three a grain, then mesh dofs; both ascending.
  std::vector<std::int32_t> tied_grains_;
  std::vector<std::uint32_t> tied_dofs_;
  Matrix matrix_;                ///< C, rows by unknowns
  Eigen::VectorXd inverse_mass_; ///< of the unknowns, as factorised
  Eigen::VectorXd impulse_;      ///< C^T L of the last projection
  std::optional<ConstraintSolver> solver_;
};
} // namespace antiform::coupling

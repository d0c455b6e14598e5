#pragma once

#include "coupling/constraint_solver.h"
#include "coupling/linear_form.h"
#include "coupling/state_file.h"
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
///   g_J = int N_J (sum_i phi_i (d_i + theta_i z x (x - x_i)) - sum_K N_K U_K) ds = 0,
/// x and y where cemented, along the edge's normals where sliding. phi_i are the linear
/// functions between grains that are neighbours along the edge; a grain moves the edge as
/// a rigid arm from its centre. So rigid motions of all leave no gap, forces on grain and
/// mesh act at one point, and an even traction loads the mesh evenly, whatever places the
/// grains have in its cells. A row is divided by int N_J ds, so that its multiplier L_J
/// is a force [N]. Kinematics are linear in the rotation, as those of the mesh, unless
/// follow() is asked to turn arms and normals. One rank.
class SurfaceTie
{
public:
  enum class Kind
  {
    cemented, ///< keeps together in both directions
    sliding   ///< keeps together across the edge, carries no shear along it
  };

  /// \param interfaces which share no grain unless they are in one tie
  /// \param shared mesh dofs moved by walls that hold the layer's end too: cemented
  ///               vertices demand nothing in that direction, else grains would hang on
  ///               the walls by their edge and not by their contact with them
  SurfaceTie(const discrete::Grains &grains,
             std::vector<SurfaceInterface> interfaces,
             Kind kind,
             std::vector<std::uint32_t> shared = {});

  Kind kind() const { return kind_; }
  const std::vector<SurfaceInterface> &interfaces() const { return interfaces_; }
  std::size_t n_multipliers() const { return rows_.size(); }
  /// The constraints, each a mean displacement gap [m].
  const std::vector<LinearForm> &rows() const { return rows_; }
  void add_to(StaticSystem &system) const;

  /// Put the arms where grains and edges are now; where sliding, also find the places
  /// that the grains have slid to, and turn the normals with the edge. It needs
  /// factorise() afterwards.
  void follow(const discrete::Grains &grains, const continuum::Vector &displacement);

  /// Places and rows of the last follow(). After loading it needs factorise().
  void visit_state(StateArchive &archive, const std::string &name);

  /// Build and factorise S = C Mi C^T for the inertial masses. Throws NumericalError that
  /// names a vertex if all that its row binds is held.
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

  /// Largest |g_J| over int N_J ds, linear kinematics [m].
  double displacement_gap(const discrete::Grains &grains,
                          const continuum::Vector &displacement) const;

private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  void build_rows(const discrete::Grains &grains, const double *displacement);
  void number_unknowns();
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
  std::vector<std::uint32_t> shared_; ///< ascending
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

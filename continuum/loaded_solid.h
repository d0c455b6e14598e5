#pragma once

#include "continuum/follower_pressure.h"
#include "continuum/nonlinear_solid.h"
#include "continuum/static_solver.h"

#include <optional>
#include <vector>

namespace antiform::continuum
{
/// What acts on a body; absent parts are empty.
struct Loads
{
  std::optional<Vector> dead; ///< nodal forces (loads.h), whatever the shape [N]
  std::vector<FollowerPressure> pressures;
  DirichletValues displacements; ///< of supports and pistons [m]
};

/// A body under loads of which one part is constant and the other grows with a load
/// factor: constant + factor times growing. A dof that either part prescribes is
/// prescribed at any factor, with 0 from the part that does not name it.
class LoadedSolid
{
public:
  /// The solid must outlive this object. Collective, as all that follows.
  LoadedSolid(NonlinearSolid &solid, const Loads &constant, const Loads &growing);

  NonlinearSolid &solid() { return solid_; }
  /// Whether tangents are symmetric: no pressure follows and all laws say so.
  bool has_symmetric_tangent() const;

  /// Evaluate the body at a displacement (ghosts set) [m] and a load factor, after a step
  /// of @p time_step [s]; @p tangent of NonlinearSolid::make_matrix() or null. Throws
  /// NumericalError as NonlinearSolid::assemble() and where a result is not a number.
  void assemble(const Vector &displacement,
                double factor,
                double time_step,
                dealii::TrilinosWrappers::SparseMatrix *tangent);

  /// Load less internal force, of the last assemble() [N]; 0 where prescribed. Forces of
  /// hanging nodes, all that follow too, are with the nodes of their edges.
  const Vector &residual() const { return residual_; }
  /// The forces with which supports hold the body there [N]; 0 elsewhere.
  const Vector &reactions() const { return reactions_; }
  /// What residuals are measured by: the norm of the internal force, reactions included,
  /// or of the load if that is greater [N].
  double force_scale() const;

  /// d load / d factor at the displacement of the last assemble() [N].
  Vector load_rate(const Vector &displacement) const;
  /// Prescribed displacements at a factor, and per factor, of all dofs known here [m].
  DirichletValues displacements(double factor) const;
  const DirichletValues &displacement_rates() const { return rates_; }

private:
  void give_to_masters(Vector &force) const;
  void add_loads(const Vector &displacement,
                 double factor,
                 Vector &force,
                 dealii::TrilinosWrappers::SparseMatrix *tangent) const;

  NonlinearSolid &solid_;
  Loads constant_, growing_;
  DirichletValues values_, rates_; ///< at factor 0 and per factor: the same dofs
  Vector internal_force_, load_, residual_, reactions_;
};

/// Whether iterations towards an equilibrium are there: |residual| is a small share of
/// the internal force, or it no longer falls and is within round-off of its sums, an eps
/// times largest row sum of the tangent times largest displacement.
class Convergence
{
public:
  struct Options
  {
    double tolerance = 1e-8; ///< of |residual| over LoadedSolid::force_scale()
    double least_force = 0.; ///< scale where that is less: of bodies free of stress [N]
  };
  explicit Convergence(const Options &options)
      : options_(options)
  {
  }

  /// Of the last assemble() at @p displacement. Collective.
  bool is_reached(const LoadedSolid &body,
                  const dealii::TrilinosWrappers::SparseMatrix &tangent,
                  const Vector &displacement);
  /// Whether the last residual was within round-off.
  bool is_round_off() const { return is_round_off_; }
  /// Relative residuals so far.
  const std::vector<double> &residuals() const { return residuals_; }

private:
  Options options_;
  std::vector<double> residuals_;
  bool is_round_off_ = false;
};
} // namespace antiform::continuum

#pragma once

#include "continuum/loaded_solid.h"
#include "continuum/static_solver.h"

#include <functional>
#include <vector>

namespace antiform::continuum
{
/// Brings a loaded body into equilibrium by Newton's method in load steps. The first
/// iterate of a step is the tangent's prediction, with the prescribed displacements of
/// its end; later ones are searched along the Newton direction d until |d.r| or |r|
/// falls.
class NewtonSolver
{
public:
  struct Options
  {
    Convergence::Options convergence;
    unsigned int max_iterations = 20; ///< of a step
    /// Least share of the Newton step that the line search tries.
    double smallest_search = 1. / 64.;
    /// Least load step, over that which advance() begins with.
    double smallest_step = 1. / 1024.;
    StaticSolver::Method method = StaticSolver::Method::direct;
  };

  /// What a step of the load took.
  struct Step
  {
    double factor;                 ///< load factor at its end
    std::vector<double> residuals; ///< relative, before each iteration and at the end
  };

  /// The body must outlive the solver. Throws std::invalid_argument if conjugate
  /// gradients are asked for and a tangent may be unsymmetric.
  NewtonSolver(LoadedSolid &body, const Options &options);

  /// One step from an equilibrium at @p displacement, whose hanging nodes are put on
  /// their edges, to that at @p factor,
  /// in @p time_step [s]; the body's history is accepted. Throws NumericalError on all
  /// ranks where none is found; displacement and history are then as before.
  void solve(double factor, double time_step, Vector &displacement);

  using Observer = std::function<void(double factor, const Vector &displacement)>;
  /// From equilibrium at factor @p from to that at @p to in @p n_steps even steps and a
  /// time of @p duration [s]. A step that fails is halved, and steps grow back after it.
  /// \param observe called after every step; may be empty
  /// Throws NumericalError on all ranks where steps get smaller than the least; the state
  /// is then that of the last good step.
  void advance(double from,
               double to,
               unsigned int n_steps,
               Vector &displacement,
               double duration = 0.,
               const Observer &observe = {});

  /// Of all steps that were taken.
  const std::vector<Step> &steps() const { return steps_; }

private:
  Vector direction(const Vector &displacement, double factor) const;
  void search_line(const Vector &direction,
                   bool is_round_off,
                   double factor,
                   double time_step,
                   Vector &displacement);

  LoadedSolid &body_;
  Options options_;
  dealii::TrilinosWrappers::SparseMatrix tangent_;
  std::vector<Step> steps_;
};
} // namespace antiform::continuum

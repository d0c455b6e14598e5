#include "continuum/newton_solver.h"

#include "continuum/errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
/// What is left of |d.r| along a Newton step d that need not be shortened (Crisfield
/// 1991, 9.2).
constexpr double slack_of_search = 0.8;

/// displacement + share * direction, with ghosts.
Vector moved(const Vector &displacement, const double share, const Vector &direction)
{
  Vector result = displacement;
  result.add(share, direction);
  result.update_ghost_values();
  return result;
}
} // namespace

NewtonSolver::NewtonSolver(LoadedSolid &body, const Options &options)
    : body_(body)
    , options_(options)
    , tangent_(body.solid().make_matrix())
{
  if (options.method == StaticSolver::Method::conjugate_gradients &&
      !body.has_symmetric_tangent())
    throw std::invalid_argument("newton solver: conjugate gradients need a symmetric "
                                "tangent; with pressures that "
                                "follow or laws without one use the direct method.");
}

/// Newton's step at the last assembly, which takes prescribed dofs to their values.
Vector NewtonSolver::direction(const Vector &displacement, const double factor) const
{
  DirichletValues rest = body_.displacements(factor);
  for (auto &[dof, value] : rest)
    value -= displacement(dof);
  StaticSolver::Options options;
  options.method = options_.method;
  Vector result = body_.solid().make_vector();
  StaticSolver(body_.solid(), tangent_, rest, options).solve(body_.residual(), result);
  return result;
}

/// Go along @p direction, all the way if that lessens |d.r| or |r|, else to where the
/// line through d.r at both ends is 0, and so on. In round-off nothing need get less.
void NewtonSolver::search_line(const Vector &direction,
                               const bool is_round_off,
                               const double factor,
                               const double time_step,
                               Vector &displacement)
{
  const double start = direction * body_.residual();
  const double norm = body_.residual().l2_norm();
  double share = 1.;
  while (share >= options_.smallest_search)
  {
    const Vector trial = moved(displacement, share, direction);
    double next = 0.5 * share;
    try
    {
      body_.assemble(trial, factor, time_step, &tangent_);
      const double here = direction * body_.residual();
      if (is_round_off || std::abs(here) <= slack_of_search * std::abs(start) ||
          body_.residual().l2_norm() < norm)
      {
        displacement = trial;
        return;
      }
      if (here * start < 0.)
        next = share * start / (start - here);
    }
    catch (const NumericalError &) // no answer there: nearer
    {
    }
    share = std::clamp(next, 0.1 * share, 0.5 * share);
  }
  throw NumericalError("newton solver",
                       "the line search finds no better state; is there no equilibrium "
                       "at this load, past a limit point? Share of the step",
                       share, options_.smallest_search);
}

void NewtonSolver::solve(const double factor,
                         const double time_step,
                         Vector &displacement)
{
  Convergence convergence(options_.convergence);
  body_.solid().make_continuous(displacement); // a copied vector has no ghosts
  body_.assemble(displacement, factor, time_step, &tangent_);
  convergence.is_reached(body_, tangent_, displacement); // before the prediction
  Vector u = moved(displacement, 1., direction(displacement, factor));
  body_.assemble(u, factor, time_step, &tangent_);
  while (!convergence.is_reached(body_, tangent_, u))
  {
    if (convergence.residuals().size() > options_.max_iterations)
      throw NumericalError(
          "newton solver",
          "no equilibrium in " + std::to_string(options_.max_iterations) +
              " iterations; take smaller load steps. Residual over "
              "internal force",
          convergence.residuals().back(), options_.convergence.tolerance);
    search_line(direction(u, factor), convergence.is_round_off(), factor, time_step, u);
  }
  body_.solid().accept();
  displacement = u;
  steps_.push_back({factor, convergence.residuals()});
}

void NewtonSolver::advance(const double from,
                           const double to,
                           const unsigned int n_steps,
                           Vector &displacement,
                           const double duration,
                           const Observer &observe)
{
  // In shares of the way; steps are binary parts of the first, so the end is met.
  const double whole = 1. / n_steps;
  double done = 0., length = whole;
  while (done < 1. - 1e-12)
  {
    const double next = std::min(1., done + length);
    const double factor = from + next * (to - from);
    try
    {
      solve(factor, duration * (next - done), displacement);
    }
    catch (const NumericalError &problem)
    {
      length *= 0.5;
      if (length < options_.smallest_step * whole)
        throw NumericalError("newton solver",
                             "load steps get too small at load factor " +
                                 std::to_string(from + done * (to - from)) +
                                 "; last problem: " + problem.what() +
                                 ". Share of the first step",
                             length / whole, options_.smallest_step);
      continue;
    }
    done = next;
    length = std::min(2. * length, whole);
    if (observe)
      observe(factor, displacement);
  }
}
} // namespace antiform::continuum

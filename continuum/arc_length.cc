#include "continuum/arc_length.h"

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
/// Tries to end a path at its target, by false position with halved weights (Illinois).
constexpr unsigned int max_landings = 30;

/// Lengths of steps from one point that end nearer and nearer to a target which the last
/// of them passed: false position that halves a stuck end (Illinois).
class Landing
{
public:
  /// \param rest what is left of the measure at the point
  explicit Landing(const double rest)
      : rest_before_(rest)
  {
  }

  bool has_begun() const { return n_tries_ > 0; }
  unsigned int n_tries() const { return n_tries_; }

  /// The next length, after one of @p length left @p rest.
  double next(const double length, const double rest)
  {
    ++n_tries_;
    const bool passed = (rest < 0.) != (rest_before_ < 0.);
    if (passed)
    {
      behind_ = length;
      rest_behind_ = rest;
      rest_before_ *= was_passed_ ? 0.5 : 1.;
    }
    else
    {
      before_ = length;
      rest_before_ = rest;
      rest_behind_ *= was_passed_ ? 1. : 0.5;
    }
    was_passed_ = passed;
    return (before_ * rest_behind_ - behind_ * rest_before_) /
           (rest_behind_ - rest_before_);
  }

private:
  double before_ = 0., behind_ = 0., rest_before_, rest_behind_ = 0.;
  bool was_passed_ = false;
  unsigned int n_tries_ = 0;
};

/// One factor of the tangent, for the two right-hand sides of a step.
class TangentSolver
{
public:
  TangentSolver(LoadedSolid &body, const TrilinosWrappers::SparseMatrix &tangent)
      : body_(body)
      , none_(body.displacement_rates())
      , solver_(body.solid(), tangent, none_, direct())
  {
    for (auto &[dof, value] : none_)
      value = 0.;
  }

  /// Displacement per load factor.
  Vector rate(const Vector &displacement)
  {
    solver_.set_values(body_.displacement_rates());
    Vector result = body_.solid().make_vector();
    solver_.solve(body_.load_rate(displacement), result);
    return result;
  }

  /// Newton's correction of the residual.
  Vector correction()
  {
    solver_.set_values(none_);
    Vector result = body_.solid().make_vector();
    solver_.solve(body_.residual(), result);
    return result;
  }

private:
  static StaticSolver::Options direct()
  {
    StaticSolver::Options options;
    options.method = StaticSolver::Method::direct;
    return options;
  }

  LoadedSolid &body_;
  DirichletValues none_;
  StaticSolver solver_;
};
} // namespace

ArcLength::ArcLength(LoadedSolid &body, const Options &options)
    : body_(body)
    , options_(options)
    , tangent_(body.solid().make_matrix())
    , last_increment_(body.solid().make_vector())
{
  if (!(options.first_length > 0.))
    throw std::invalid_argument(
        "arc length: give the first step a length > 0 m, some share of the displacement "
        "that is looked for.");
  if (options.largest_length == 0.)
    options_.largest_length = 8. * options.first_length;
  if (options.smallest_length == 0.)
    options_.smallest_length = 1e-5 * options.first_length;
}

double ArcLength::size(const Vector &increment) const
{
  return increment.l2_norm() / std::sqrt(static_cast<double>(increment.size()));
}

ArcLength::State ArcLength::step(const Vector &displacement,
                                 const double factor,
                                 const double length,
                                 unsigned int &iterations)
{
  body_.assemble(displacement, factor, 0., &tangent_);
  Vector increment = TangentSolver(body_, tangent_).rate(displacement);
  const double turn = increment * last_increment_;
  double d_factor = (turn < 0. ? -1. : 1.) * length / size(increment);
  increment *= d_factor;

  Convergence convergence(options_.convergence);
  for (iterations = 1; iterations <= options_.max_iterations; ++iterations)
  {
    State state{displacement, factor + d_factor};
    state.displacement.add(1., increment);
    state.displacement.update_ghost_values();
    body_.assemble(state.displacement, state.factor, 0., &tangent_);
    if (convergence.is_reached(body_, tangent_, state.displacement))
      return state;

    TangentSolver solver(body_, tangent_);
    const Vector rate = solver.rate(state.displacement), correction = solver.correction();
    const double more = -(increment * correction) / (increment * rate);
    increment.add(1., correction, more, rate);
    d_factor += more;
    if (!(size(increment) < 10. * length)) // also for not-a-number
      break;
  }
  throw NumericalError("arc length", "the path is lost; residual over internal force",
                       convergence.residuals().back(), options_.convergence.tolerance);
}

void ArcLength::follow(Vector &displacement,
                       double &factor,
                       const Measure &measure,
                       const double target)
{
  body_.solid().make_continuous(displacement); // a copied vector has no ghosts
  double rest = measure(displacement, factor) - target;
  const double close = options_.stop_tolerance * std::abs(rest);
  if (path_.empty())
    path_.push_back({factor, rest + target, 0});

  double length = options_.first_length;
  Landing landing(rest);
  for (unsigned int n = 0; std::abs(rest) > close; ++n)
  {
    if (n == options_.max_steps)
      throw NumericalError(
          "arc length",
          "the target is not met; ask for longer steps, or does the path "
          "never get there? Steps",
          n, options_.max_steps);
    State next;
    unsigned int iterations = 0;
    try
    {
      next = step(displacement, factor, length, iterations);
    }
    catch (const NumericalError &problem)
    {
      length = shorter(length, factor, problem);
      landing = Landing(rest);
      continue;
    }
    const double rest_next = measure(next.displacement, next.factor) - target;
    const bool is_there = std::abs(rest_next) <= close;
    if (!is_there && (rest_next * rest < 0. || landing.has_begun()))
    {
      if (landing.n_tries() == max_landings)
        throw NumericalError("arc length",
                             "the path jumps over its target; what is left of the way",
                             rest_next, close);
      length = landing.next(length, rest_next);
      continue;
    }

    last_increment_ = next.displacement;
    last_increment_.add(-1., displacement);
    body_.solid().accept();
    displacement = next.displacement;
    displacement.update_ghost_values();
    factor = next.factor;
    rest = rest_next;
    landing = Landing(rest);
    path_.push_back({factor, rest + target, iterations});
    if (options_.observe && !options_.observe(displacement, path_.back()))
      return;
    length *= std::sqrt(static_cast<double>(options_.wanted_iterations) / iterations);
    length = std::min(length, options_.largest_length);
  }
}

/// Half the length; throws where that is too short.
double ArcLength::shorter(const double length,
                          const double factor,
                          const NumericalError &problem) const
{
  if (0.5 * length >= options_.smallest_length)
    return 0.5 * length;
  throw NumericalError("arc length",
                       "steps get too short at load factor " + std::to_string(factor) +
                           "; last problem: " + problem.what() + ". Length [m]",
                       0.5 * length, options_.smallest_length);
}
} // namespace antiform::continuum

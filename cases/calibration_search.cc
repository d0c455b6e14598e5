#include "cases/calibration_search.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>

namespace antiform::cases
{
namespace
{
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The search stops here, in tolerances: the packings' scatter is more than the rest.
constexpr double near_enough = 0.25;
/// Of micro-parameters that no flat joint has: far from any answer.
constexpr double impossible = 1e3;

/// d ln(result) / dv where it is known; nothing where tests must tell.
std::optional<double> known_derivative(const Target &target, const std::string &micro)
{
  if (micro == "slit fraction")
    return {};
  if (target.is_modulus && micro == "effective modulus")
    return 1.;
  // The slope of a curve that ends in cracks feels them a little, and comes with the
  // strength; the modulus of an elastic test does not.
  if (target.is_modulus)
    return target.test.kind == Test::Kind::elastic ? std::optional<double>(0.)
                                                   : std::nullopt;
  if (micro == "effective modulus")
    return 0.;
  if (target.test.kind == Test::Kind::tension)
    return micro == "tensile strength" ? 1. : 0.;
  return {};
}

/// The residuals as a function of the free coordinates.
class Residuals
{
public:
  Residuals(const CalibrationProblem &problem,
            const Laboratory &laboratory,
            const std::function<void(const Evaluation &)> &watch)
      : problem_(problem)
      , laboratory_(laboratory)
      , watch_(watch)
  {
  }

  std::size_t n_targets() const { return problem_.targets.size(); }
  std::size_t n_free() const { return problem_.free.size(); }

  VectorXd coordinates(const MicroParameters &micro) const
  {
    VectorXd u(n_free());
    for (std::size_t j = 0; j < n_free(); ++j)
      u[j] = problem_.free[j].coordinate(micro.*problem_.free[j].micro.value);
    return u;
  }

  MicroParameters micro(const VectorXd &u) const
  {
    MicroParameters micro = problem_.start;
    for (std::size_t j = 0; j < n_free(); ++j)
      micro.*problem_.free[j].micro.value = problem_.free[j].value(u[j]);
    return rounded(micro);
  }

  /// One set of micro-parameters each, tested for the targets it names.
  std::vector<Evaluation> evaluate(const std::string &stage,
                                   const std::vector<MicroParameters> &micros,
                                   const std::vector<std::vector<std::size_t>> &targets,
                                   const std::vector<int> &seeds) const
  {
    std::vector<Trial> trials;
    for (std::size_t k = 0; k < micros.size(); ++k)
    {
      std::vector<Target> wanted;
      for (const std::size_t i : targets[k])
        wanted.push_back(problem_.targets[i]);
      for (const Test &test : tests_of(wanted))
        for (const int seed : seeds)
          trials.push_back({test, seed, micros[k]});
    }
    const std::vector<Measurement> measured = laboratory_(trials);
    std::vector<Evaluation> evaluations;
    std::size_t next = 0;
    for (std::size_t k = 0; k < micros.size(); ++k)
    {
      Evaluation e{stage, micros[k], seeds, {}};
      e.results.resize(n_targets());
      std::vector<Target> wanted;
      for (const std::size_t i : targets[k])
        wanted.push_back(problem_.targets[i]);
      for (const Test &test : tests_of(wanted))
      {
        for (const std::size_t i : targets[k])
          if (problem_.targets[i].test == test)
            for (std::size_t s = 0; s < seeds.size(); ++s)
              e.results[i].push_back(problem_.targets[i].is_modulus
                                         ? measured[next + s].young_modulus
                                         : measured[next + s].strength);
        next += seeds.size();
      }
      watch_(e);
      evaluations.push_back(std::move(e));
    }
    return evaluations;
  }

  Evaluation evaluate_all(const std::string &stage,
                          const MicroParameters &micro,
                          const std::vector<int> &seeds) const
  {
    std::vector<std::size_t> all(n_targets());
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = i;
    return evaluate(stage, {micro}, {all}, seeds).front();
  }

  /// In tolerances.
  double residual(const std::size_t target, const double result) const
  {
    const Target &t = problem_.targets[target];
    return std::log(result / t.value) / t.tolerance;
  }
  VectorXd residuals(const Evaluation &e) const
  {
    VectorXd f(n_targets());
    for (std::size_t i = 0; i < n_targets(); ++i)
      f[i] = residual(i, e.mean(i));
    return f;
  }

  /// By tests where it is not known, beside @p u, which @p base has tested. Packings
  /// differ in strength, less in how it depends on the micro-parameters: two will do.
  MatrixXd jacobian(const VectorXd &u, const Evaluation &base) const
  {
    MatrixXd J = MatrixXd::Zero(n_targets(), n_free());
    std::vector<MicroParameters> micros;
    std::vector<std::vector<std::size_t>> unknown;
    std::vector<std::size_t> column;
    std::vector<double> step;
    for (std::size_t j = 0; j < n_free(); ++j)
    {
      const FreeParameter &free = problem_.free[j];
      std::vector<std::size_t> rows;
      for (std::size_t i = 0; i < n_targets(); ++i)
        if (const auto known = known_derivative(problem_.targets[i], free.micro.name))
          J(i, j) = *known * free.slope(u[j]) / problem_.targets[i].tolerance;
        else
          rows.push_back(i);
      if (rows.empty())
        continue;
      VectorXd beside = u;
      beside[j] = step_aside(free, u[j], 1.);
      if (!is_possible(micro(beside)))
        beside[j] = step_aside(free, u[j], -1.);
      micros.push_back(micro(beside));
      unknown.push_back(rows);
      column.push_back(j);
      step.push_back(beside[j] - u[j]);
    }
    if (micros.empty())
      return J;
    const std::size_t n_seeds = std::min<std::size_t>(2, base.seeds.size());
    const auto evaluations =
        evaluate("difference", micros, unknown,
                 std::vector<int>(base.seeds.begin(), base.seeds.begin() + n_seeds));
    for (std::size_t k = 0; k < micros.size(); ++k)
      for (const std::size_t i : unknown[k])
      {
        double change = 0.; // of the same packings
        for (std::size_t s = 0; s < n_seeds; ++s)
          change +=
              residual(i, evaluations[k].results[i][s]) - residual(i, base.results[i][s]);
        J(i, column[k]) = change / (static_cast<double>(n_seeds) * step[k]);
      }
    return J;
  }

private:
  /// A difference away; to the other side when the bound is near there.
  static double step_aside(const FreeParameter &free, const double u, const double sign)
  {
    const auto scaled = [&](const double value)
    { return free.is_logarithmic ? std::log(value) : value; };
    const double low = scaled(free.lower), high = scaled(free.upper);
    const double step = sign * std::min(free.difference, 0.25 * (high - low));
    double v = scaled(free.value(u)) + step;
    if (v < low + 0.02 * (high - low) || v > high - 0.02 * (high - low))
      v -= 2. * step;
    return free.coordinate(free.is_logarithmic ? std::exp(v) : v);
  }

  const CalibrationProblem &problem_;
  const Laboratory &laboratory_;
  const std::function<void(const Evaluation &)> &watch_;
};

VectorXd to_eigen(const gsl_vector *x)
{
  VectorXd result(x->size);
  for (std::size_t i = 0; i < x->size; ++i)
    result[i] = gsl_vector_get(x, i);
  return result;
}

/// GSL's solver on the residuals. It calls back through C, so exceptions wait here.
class LeastSquares
{
public:
  LeastSquares(const Residuals &residuals, std::vector<int> seeds, const int evaluations)
      : residuals_(residuals)
      , seeds_(std::move(seeds))
      , left_(evaluations)
  {
  }

  /// Gives the best evaluation.
  Evaluation operator()(const VectorXd &start)
  {
    gsl_set_error_handler_off();
    gsl_multifit_nlinear_parameters parameters =
        gsl_multifit_nlinear_default_parameters(); // Levenberg-Marquardt
    const std::unique_ptr<gsl_multifit_nlinear_workspace,
                          decltype(&gsl_multifit_nlinear_free)>
        solver(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters,
                                          residuals_.n_targets(), residuals_.n_free()),
               gsl_multifit_nlinear_free);
    gsl_multifit_nlinear_fdf function = {};
    function.f = &LeastSquares::f;
    function.df = &LeastSquares::df;
    function.n = residuals_.n_targets();
    function.p = residuals_.n_free();
    function.params = this;
    const std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)> x(
        gsl_vector_alloc(residuals_.n_free()), gsl_vector_free);
    for (std::size_t j = 0; j < residuals_.n_free(); ++j)
      gsl_vector_set(x.get(), j, start[static_cast<Eigen::Index>(j)]);

    int status = gsl_multifit_nlinear_init(x.get(), &function, solver.get());
    while (status == GSL_SUCCESS && !is_done())
      status = gsl_multifit_nlinear_iterate(solver.get());
    // Whatever else stops it (evaluations spent, no step that helps) leaves the best.
    if (stopped_)
      std::rethrow_exception(stopped_);
    return best_;
  }

  const MatrixXd &jacobian() const { return jacobian_; }

private:
  bool is_done() const
  {
    return stopped_ || left_ <= 0 || best_f_.cwiseAbs().maxCoeff() < near_enough;
  }

  static int f(const gsl_vector *x, void *self, gsl_vector *f)
  {
    auto &search = *static_cast<LeastSquares *>(self);
    return search.guarded([&] { search.evaluate(to_eigen(x), f); });
  }
  static int df(const gsl_vector *x, void *self, gsl_matrix *J)
  {
    auto &search = *static_cast<LeastSquares *>(self);
    return search.guarded([&] { search.differentiate(to_eigen(x), J); });
  }
  int guarded(const std::function<void()> &work)
  {
    try
    {
      if (stopped_)
        return GSL_EBADFUNC;
      work();
      return GSL_SUCCESS;
    }
    catch (...)
    {
      stopped_ = std::current_exception();
      return GSL_EBADFUNC;
    }
  }

  void evaluate(const VectorXd &u, gsl_vector *f)
  {
    const MicroParameters micro = residuals_.micro(u);
    VectorXd value = VectorXd::Constant(residuals_.n_targets(), impossible);
    // A spent budget answers likewise: the step is refused and the loop ends.
    if (is_possible(micro) && left_ > 0)
    {
      --left_;
      const Evaluation e = residuals_.evaluate_all("search", micro, seeds_);
      value = residuals_.residuals(e);
      last_ = e;
      if (best_f_.size() == 0 || value.squaredNorm() < best_f_.squaredNorm())
      {
        best_ = e;
        best_f_ = value;
      }
    }
    last_u_ = u;
    last_f_ = value;
    for (std::size_t i = 0; i < f->size; ++i)
      gsl_vector_set(f, i, value[static_cast<Eigen::Index>(i)]);
  }

  /// Only of the point that was evaluated last: GSL takes a step, then asks for this.
  void differentiate(const VectorXd &u, gsl_matrix *J)
  {
    if (jacobian_.size() == 0)
      jacobian_ = residuals_.jacobian(u, last_);
    else if (const VectorXd s = u - base_u_; s.norm() > shortest_secant)
    {
      // Broyden 1965. Over a shorter step noise would outweigh what it tells.
      const VectorXd y = last_f_ - base_f_;
      jacobian_ += (y - jacobian_ * s) * s.transpose() / s.squaredNorm();
    }
    base_u_ = u;
    base_f_ = last_f_;
    for (std::size_t i = 0; i < J->size1; ++i)
      for (std::size_t j = 0; j < J->size2; ++j)
        gsl_matrix_set(
            J, i, j,
            jacobian_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }

  /// About half of a difference.
  static constexpr double shortest_secant = 0.1;

  const Residuals &residuals_;
  std::vector<int> seeds_;
  int left_;
  std::exception_ptr stopped_;
  Evaluation best_, last_;
  VectorXd best_f_, last_u_, last_f_, base_u_, base_f_;
  MatrixXd jacobian_;
};

std::vector<int> seeds_from(const int first, const int n)
{
  std::vector<int> seeds(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k)
    seeds[static_cast<std::size_t>(k)] = first + k;
  return seeds;
}

/// Means of all packings so far as they would be at @p u, by the Jacobian: residuals.
VectorXd pooled_residuals(const std::vector<Evaluation> &pool,
                          const Residuals &residuals,
                          const MatrixXd &jacobian,
                          const VectorXd &u)
{
  VectorXd sum = VectorXd::Zero(jacobian.rows());
  double n = 0.;
  for (const Evaluation &e : pool)
  {
    const double packings = static_cast<double>(e.seeds.size());
    sum += packings *
           (residuals.residuals(e) + jacobian * (u - residuals.coordinates(e.micro)));
    n += packings;
  }
  return sum / n;
}

/// Least |f + J du|^2 + |du|^2: a unit of a coordinate, which is a half of a strength or
/// 15 degrees, weighs as much as one tolerance, so that noise cannot send it far.
VectorXd damped_step(const MatrixXd &J, const VectorXd &f)
{
  const MatrixXd normal = J.transpose() * J + MatrixXd::Identity(J.cols(), J.cols());
  return normal.ldlt().solve(-J.transpose() * f);
}

/// Bring E* near before anything breaks: E is proportional to it.
MicroParameters elastic_start(const CalibrationProblem &problem,
                              const Residuals &residuals,
                              const std::vector<int> &seeds,
                              const Laboratory &laboratory,
                              const std::function<void(const Evaluation &)> &watch)
{
  MicroParameters start = rounded(residuals.micro(residuals.coordinates(problem.start)));
  for (std::size_t i = 0; i < problem.targets.size(); ++i)
    for (const FreeParameter &free : problem.free)
      if (problem.targets[i].is_modulus && free.micro.name == "effective modulus")
      {
        std::vector<Trial> trials;
        for (const int seed : seeds)
          trials.push_back({{Test::Kind::elastic, 0.}, seed, start});
        Evaluation e{"elastic", start, seeds, {}};
        e.results.resize(problem.targets.size());
        for (const Measurement &m : laboratory(trials))
          e.results[i].push_back(m.young_modulus);
        watch(e);
        start.effective_modulus *= problem.targets[i].value / e.mean(i);
      }
  return rounded(start);
}
} // namespace

double Evaluation::mean(const std::size_t target) const
{
  double sum = 0.;
  for (const double x : results[target])
    sum += x;
  return sum / static_cast<double>(results[target].size());
}

double Evaluation::deviation(const std::size_t target) const
{
  const double n = static_cast<double>(results[target].size()), m = mean(target);
  double sum = 0.;
  for (const double x : results[target])
    sum += (x - m) * (x - m);
  return n > 1. ? std::sqrt(sum / (n - 1.)) : 0.;
}

bool is_met(const Evaluation &e, const std::vector<Target> &targets, const std::size_t i)
{
  return std::abs(e.mean(i) / targets[i].value - 1.) <= targets[i].tolerance;
}

CalibrationResult calibrate(const CalibrationProblem &problem,
                            const Laboratory &laboratory,
                            const std::function<void(const Evaluation &)> &watch)
{
  const Residuals residuals(problem, laboratory, watch);
  int next_seed = problem.first_seed;
  const std::vector<int> search_seeds = seeds_from(next_seed, problem.search_seeds);
  next_seed += problem.search_seeds;
  const MicroParameters start =
      elastic_start(problem, residuals, search_seeds, laboratory, watch);
  LeastSquares search(residuals, search_seeds, problem.evaluations);
  const Evaluation best = search(residuals.coordinates(start));

  CalibrationResult result;
  result.micro = best.micro;
  std::vector<Evaluation> pool{best};
  for (result.rounds = 1;; ++result.rounds)
  {
    const VectorXd u = residuals.coordinates(result.micro);
    const VectorXd expected = pooled_residuals(pool, residuals, search.jacobian(), u);
    result.expected.clear();
    result.packings_before = 0;
    for (const Evaluation &e : pool)
      result.packings_before += static_cast<int>(e.seeds.size());
    for (std::size_t i = 0; i < problem.targets.size(); ++i)
      result.expected.push_back(problem.targets[i].value *
                                std::exp(problem.targets[i].tolerance *
                                         expected[static_cast<Eigen::Index>(i)]));

    result.check = residuals.evaluate_all("check", result.micro,
                                          seeds_from(next_seed, problem.check_seeds));
    next_seed += problem.check_seeds;
    result.met = true;
    for (std::size_t i = 0; i < problem.targets.size(); ++i)
      result.met = result.met && is_met(result.check, problem.targets, i);
    if (result.met || result.rounds == problem.check_rounds)
      return result;
    pool.push_back(result.check);
    const VectorXd step = damped_step(
        search.jacobian(), pooled_residuals(pool, residuals, search.jacobian(), u));
    const MicroParameters corrected = residuals.micro(u + step);
    if (is_possible(corrected))
      result.micro = corrected;
  }
}
} // namespace antiform::cases

#pragma once

#include "continuum/errors.h"
#include "continuum/loaded_solid.h"

#include <functional>
#include <vector>

namespace antiform::continuum
{
/// Follows the equilibria of a loaded body through limit points, the load factor being an
/// unknown. A step has a given length in the displacements alone (cylindrical); its
/// iterations stay in planes normal to the increment so far (Ramm 1981). The first
/// increment goes the way that turns least from the last step, whatever the load does.
class ArcLength
{
public:
  /// A point of the path.
  struct Point
  {
    double factor;
    double measure;          ///< what follow() watches
    unsigned int iterations; ///< that it took
  };

  /// Lengths are root mean squares of the change of all displacements [m].
  struct Options
  {
    double first_length = 0.;    ///< [m], > 0; raises the factor
    double largest_length = 0.;  ///< [m]; 0: 8 times the first
    double smallest_length = 0.; ///< [m]; 0: 1e-5 of the first
    Convergence::Options convergence;
    unsigned int max_iterations = 12;
    /// Steps grow or shrink by the square root of this over the iterations that they
    /// took.
    unsigned int wanted_iterations = 5;
    unsigned int max_steps = 500;
    double stop_tolerance = 1e-6; ///< of follow(), over the way of its measure
    /// Called after every step, the body being as assembled there; false, alike on all
    /// ranks, ends follow(). May be empty.
    std::function<bool(const Vector &displacement, const Point &point)> observe;
  };

  /// The body must outlive this object. Throws std::invalid_argument without a length.
  ArcLength(LoadedSolid &body, const Options &options);

  using Measure = std::function<double(const Vector &displacement, double factor)>;
  /// From an equilibrium at @p displacement and @p factor follow the path
  /// until @p measure, the same on all ranks, is @p target; both arguments are then those
  /// of that point. Histories are accepted step by step, without time.
  /// Throws NumericalError on all ranks where it cannot go on: steps get too small or too
  /// many. The state is then that of the last good point.
  void
  follow(Vector &displacement, double &factor, const Measure &measure, double target);

  /// All points so far, the start of the first follow() included.
  const std::vector<Point> &path() const { return path_; }

private:
  struct State
  {
    Vector displacement;
    double factor;
  };
  /// The state after a step of this length; throws NumericalError.
  State step(const Vector &displacement,
             double factor,
             double length,
             unsigned int &iterations);
  double shorter(double length, double factor, const NumericalError &problem) const;
  double size(const Vector &increment) const;

  LoadedSolid &body_;
  Options options_;
  dealii::TrilinosWrappers::SparseMatrix tangent_;
  Vector last_increment_; ///< of the last accepted step; zero before the first
  std::vector<Point> path_;
};
} // namespace antiform::continuum

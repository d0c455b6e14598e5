#pragma once

#include "cases/calibration_problem.h"

#include <functional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// Results of one set of micro-parameters.
struct Evaluation
{
  std::string stage; ///< elastic | search | difference | check
  MicroParameters micro;
  std::vector<int> seeds;
  std::vector<std::vector<double>> results; ///< of each target, a packing each; or none

  bool has(std::size_t target) const { return !results[target].empty(); }
  double mean(std::size_t target) const;
  /// Standard deviation of the packings (n - 1); 0 of one.
  double deviation(std::size_t target) const;
};

struct CalibrationResult
{
  MicroParameters micro;   ///< those of the last check
  bool met = false;        ///< all targets, on the fresh packings of the last check
  int rounds = 0;          ///< checks done
  Evaluation check;        ///< the last one
  int packings_before = 0; ///< that the micro-parameters rest on, none of the check's
  std::vector<double> expected; ///< mean results from those, for each target
};

/// Does the mean of @p evaluation meet the target?
bool is_met(const Evaluation &evaluation,
            const std::vector<Target> &targets,
            std::size_t target);

/// Search, then check on fresh packings.
///
/// Residuals are ln(mean over packings / target) over the tolerance. Trust-region least
/// squares of GSL bring them to zero, with one Jacobian by differences wide enough for
/// the noise of cracking, which Broyden's formula then keeps up to date. Known without
/// tests: E is proportional to E* and no strength depends on it (the problem is
/// homogeneous in stress and strains are small), and tension is proportional to sigma_b
/// alone.
///
/// Strengths differ by some per cent from packing to packing, so a search over few
/// packings meets few fresh ones by luck only. A check that fails joins its packings to
/// those of the search, one Gauss-Newton step brings the mean of all to the targets, and
/// the next check is of fresh ones again.
/// \param watch hears of each evaluation when it is done
CalibrationResult calibrate(const CalibrationProblem &problem,
                            const Laboratory &laboratory,
                            const std::function<void(const Evaluation &)> &watch);
} // namespace antiform::cases

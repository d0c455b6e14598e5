#pragma once

#include "coupling/anderson.h"
#include "coupling/band_factor.h"
#include "coupling/grain_balance.h"
#include "discrete/joint_events.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// How the neighbourhood of a break is balanced apart
/// (docs/theory/quasi_static_driver.md).
struct LocalSettings
{
  double radius = 5.;        ///< of a patch about a break, mean diameters; 0: none
  double core = 2.5;         ///< within which others break after it, mean diameters
  double share = 0.3;        ///< of the largest allowed force that is left in a patch
  int most_corrections = 20; ///< between two breaks of a patch
  int most_breaks = 20;      ///< in a patch, one after the other
};

/// What became of a patch.
struct LocalResult
{
  std::int64_t corrections = 0, breaks = 0;
  double held = 0.;      ///< taken by holding the grains on their way [J]
  double load_work = 0.; ///< of the constant loads [J]
};

/// Breaks bonds of a body of grains one by one and balances the grains around each, the
/// others held where they stand. What is left then, in and beyond the ring of held
/// grains, is the body's to balance. A patch is a small body of its own, with its
/// grains, their joints and the states of these, which the kernels of joints serve as
/// any other.
class LocalMoves
{
public:
  /// \param body          referred to
  /// \param mean_diameter of its grains [m]
  LocalMoves(GrainBalance &body, const LocalSettings &settings, double mean_diameter);

  /// Balance the patch about @p first and, if it is over its strength still, break it;
  /// then, by turns, balance and the most loaded bond of the patch's core that is over.
  /// Cracks go to the body's state. \param allowed largest unbalanced force in the body
  LocalResult relax(const discrete::LoadedElement &first,
                    const discrete::StepTime &now,
                    double allowed);

private:
  void gather(std::size_t joint);
  void gather_members(std::size_t joint);
  void gather_joints();
  void copy_grains();
  void copy_joints();
  void factorise();
  void evaluate();
  double worst() const;
  void balance(double allowed, LocalResult &result);
  bool break_next(const discrete::StepTime &now, const discrete::LoadedElement *first);
  void give_back();

  GrainBalance &body_;
  LocalSettings settings_;
  double diameter_ = 0.;
  Anderson anderson_{6};

  // The patch at hand. Its own grains come first, then the ring of held ones.
  Vec2 centre_;
  std::vector<std::int32_t> grains_, joints_; ///< numbers in the body
  std::size_t n_members_ = 0;
  std::vector<std::int32_t> local_; ///< of each grain of the body, -1 outside
  GrainState patch_;
  BandFactor factor_;
  Eigen::VectorXd residual_, is_free_, levers_, loads_; ///< of the patch's own grains
};
} // namespace antiform::coupling

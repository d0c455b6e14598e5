#pragma once

#include "continuum/finite_strain_solid.h"
#include "coupling/mesh_components.h"
#include "coupling/simulation.h"

#include <functional>

namespace antiform::coupling
{
/// Keeps the step of a run below the stable step of a mesh of finite strain, whose
/// tangent changes: in every 64th step, if a node has moved by more than 1/200 of the
/// shortest edge since, the rigorous bound is taken at the present positions. Between two
/// looks the gradient changes by some percents at most; the safety that the run's step
/// was chosen with covers them.
/// Stage forces, with a rank behind the mesh's. Keeps no state that a restart needs: its
/// first look is always taken.
class MeshStepCheck : public Component
{
public:
  static constexpr std::int64_t interval = 64; ///< steps
  static constexpr double travel_share = 5e-3; ///< of the shortest edge

  /// \param damping_factor by what damping shortens the stable step, <= 1 [-]
  /// \param extra_rows row sums of further springs on the mesh (foundation) [N/m], or
  /// empty \param on_stiff what to do about a step above the bound, then asked again;
  /// empty: it
  ///                 is refused at once
  MeshStepCheck(MeshState &state,
                const continuum::FiniteStrainSolid &solid,
                double damping_factor = 1.,
                std::vector<double> extra_rows = {},
                std::function<void()> on_stiff = {});

  /// Throws NumericalError on all ranks when the step is above the bound.
  void run(Stage stage, const Clock &clock) override;
  bool acted() const override { return acted_; }

  /// Bound of the last look, damping included [s]; 0 before the first.
  double bound() const { return bound_; }

private:
  bool has_moved() const;

  MeshState &state_;
  const continuum::FiniteStrainSolid &solid_;
  double damping_factor_;
  std::vector<double> extra_rows_;
  std::function<void()> on_stiff_;
  double largest_travel_;       ///< [m]
  continuum::Vector looked_at_; ///< displacement of the last look
  double bound_ = 0.;
  bool acted_ = false;
};
} // namespace antiform::coupling

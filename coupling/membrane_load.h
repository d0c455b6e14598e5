#pragma once

#include "coupling/grain_components.h"
#include "coupling/simulation.h"
#include "discrete/membrane.h"

#include <functional>

namespace antiform::coupling
{
/// A flexible membrane around a specimen that puts a pressure on it where no platen bears.
/// Its ring of grains is found anew when a grain has moved by a tenth of the reach.
class MembraneLoad : public Component
{
public:
  /// \param reach    of the ball that finds the ring [m]
  /// \param pressure at a time [Pa]
  /// \param bears    whether a platen bears on a grain
  MembraneLoad(GrainState &state,
               double reach,
               std::function<double(double)> pressure,
               std::function<bool(std::int32_t)> bears);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override { energies.boundary_work += work_; }
  void visit_state(StateArchive &archive) override;

  double pressure() const { return now_; } ///< of the last step [Pa]

private:
  void find_ring();
  bool has_moved() const;

  GrainState &state_;
  double reach_;
  std::function<double(double)> pressure_;
  std::function<bool(std::int32_t)> bears_;
  discrete::Membrane membrane_;
  std::vector<double> place_x_, place_y_; ///< displacements when the ring was found [m]
  double now_ = 0.;
  double work_ = 0.; ///< [J]
};
} // namespace antiform::coupling

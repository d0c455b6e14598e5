#pragma once

#include "coupling/grain_components.h"
#include "coupling/simulation.h"
#include "discrete/walls.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Displacement, velocity and work of walls, named "GROUP/0/displacement" and so on.
void visit_walls(StateArchive &archive,
                 const std::string &group,
                 std::vector<discrete::Wall> &walls);

/// Rigid frictionless walls along the sides of a specimen that keep a pressure on it.
class ServoWalls : public Component
{
public:
  /// \param speed of a wall at a time, from its reaction [m/s]
  ServoWalls(std::vector<discrete::Wall> &walls,
             GrainState &grains,
             std::function<double(const discrete::Wall &, const Clock &)> speed)
      : walls_(walls)
      , grains_(grains)
      , speed_(std::move(speed))
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

private:
  std::vector<discrete::Wall> &walls_;
  GrainState &grains_;
  std::function<double(const discrete::Wall &, const Clock &)> speed_;
};

/// Grips at both ends of a specimen, which move apart: the grains in them keep their
/// places and do not turn.
class Grips : public Component
{
public:
  /// \param held  grains of the left and of the right grip, whose masses become infinite
  /// \param speed outward speed of each grip at a time [m/s]
  Grips(GrainState &grains,
        std::array<std::vector<std::int32_t>, 2> held,
        std::function<double(double)> speed);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  /// Mean of the forces with which the grips pull [N].
  double tension() const { return 0.5 * (pull_[0] + pull_[1]); }
  /// Way of both grips apart so far [m].
  double extension() const { return extension_; }

private:
  GrainState &grains_;
  std::array<std::vector<std::int32_t>, 2> held_;
  std::function<double(double)> speed_;
  std::array<double, 2> pull_{}; ///< [N]
  double velocity_ = 0.;         ///< outward, of each grip [m/s]
  double extension_ = 0.;
  double work_ = 0.; ///< [J]
};
} // namespace antiform::coupling

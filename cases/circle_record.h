#pragma once

#include "cases/scene.h"
#include "coupling/output/tables.h"
#include "coupling/simulation.h"
#include "discrete/measurement_circles.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// The circles of the deck in the section before shortening: those listed, or a grid
/// along the layer.
std::vector<discrete::MeasurementCircle>
measurement_circles(const Parameters &parameters, const SectionGeometry &geometry);

/// The x and y of each point of "x y; x y". False when the text is something else.
bool parse_points(const std::string &text, std::vector<Vec2> &points);

/// circles.csv: a line a circle at every sample. Reads the scene and changes nothing.
class CircleRecord : public coupling::Component
{
public:
  /// \param resumed the table is continued by visit_state(), which must follow
  CircleRecord(const Scene &scene, const std::string &directory, bool resumed);

  void run(coupling::Stage stage, const coupling::Clock &clock) override;
  bool acted() const override { return acted_; }
  void visit_state(coupling::StateArchive &archive) override;

  static const std::vector<std::string> &columns();

private:
  const Scene &scene_;
  std::string path_;
  std::vector<discrete::MeasurementCircle> circles_;
  std::optional<coupling::Table> table_;
  bool acted_ = false;
};
} // namespace antiform::cases
